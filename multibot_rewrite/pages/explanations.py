"""What the codes on the page mean: a folded explanation of each rule."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping

from multibot_rewrite.base.findings.finding import ERROR
from multibot_rewrite.base.findings.rule import Rule
from multibot_rewrite.pages.svg import safe


def rule_link(code: str) -> str:
    """The link to the explanation of a code."""
    return f"#rule-{code}"


def explanations(codes: Iterable[str], rules: Mapping[str, Rule]) -> Iterator[str]:
    """A section with what the rules find, why that is a problem and how to fix it."""
    found = [rules[code] for code in sorted(set(codes)) if code in rules]
    if found:
        yield '<section id="rules">\n<h2>What the codes mean</h2>\n'
        yield from map(_explained, found)
        yield "</section>\n"


def _explained(rule: Rule) -> str:
    css_class = "bad" if rule.level == ERROR else "odd"
    parts = ("", rule.what), ("Why: ", rule.why), ("Fix: ", rule.fix)
    lines = "".join(f"<p><b>{head}</b>{with_code(text)}</p>" for head, text in parts)
    return (
        f'<details id="rule-{rule.code}"><summary class="{css_class}"><b>{rule.code}</b>'
        f" {rule.name} <span>{rule.level}</span></summary>\n<div>{lines}</div></details>\n"
    )


def with_code(markdown: str) -> str:
    """A sentence with words in backticks."""
    return re.sub("`([^`]*)`", r"<code>\1</code>", safe(markdown))
