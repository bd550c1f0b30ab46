"""Rules in words: one for ``--explain``, all of them as a page."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from multibot_rewrite.lint.records import Rule
from multibot_rewrite.lint.registry import GROUPS, RULES

PAGE = "docs/lint-rules.md"
_HEAD = """\
# Rules of urdf-lint

Made by `python -m multibot_rewrite.lint > docs/lint-rules.md`; `urdf-lint --explain CODE` prints one.
An *error* is refused by some loader or cannot work, a *warning* is very probably wrong, a *note* never
makes the lint fail. Examples are tested: the first is found, the second is not; a fragment stands
inside `<robot name="r">`.
"""


def explained(rule: Rule) -> str:
    """A rule with its examples, for a terminal."""
    head = f"{rule.code} {rule.name} ({rule.level})"
    parts = [head, "", rule.what, "", f"Why: {rule.why}", "", f"Fix: {rule.fix}"]
    for title, example in _examples(rule):
        parts += ["", f"{title}:", "", *(f"    {line}" for line in example.splitlines())]
    return "\n".join(parts) + "\n"


def listed(rules: Iterable[Rule]) -> Iterator[tuple[str, str, str, str]]:
    """Code, level, name and first sentence of each."""
    return ((it.code, it.level, it.name, it.what.partition(". ")[0].rstrip(".")) for it in rules)


def page() -> str:
    """The page of all rules, Markdown."""
    parts = [_HEAD]
    for start, title, _ in GROUPS:
        rules = [rule for code, rule in RULES.items() if code.startswith(start)]
        parts.append(f"\n## {start}: {title}\n")
        parts += (_section(rule) for rule in rules)
    return "".join(parts)


def _section(rule: Rule) -> str:
    lines = [f"\n### {rule.code} {rule.name}\n", f"*{rule.level}*. {rule.what}\n"]
    lines += [f"**Why.** {rule.why}\n", f"**Fix.** {rule.fix}\n"]
    for title, example in _examples(rule):
        lines.append(f"{title}:\n\n```xml\n{example.rstrip()}\n```\n")
    return "\n".join(lines)


def _examples(rule: Rule) -> list[tuple[str, str]]:
    return [(title, text) for title, text in (("Bad", rule.bad), ("Good", rule.good)) if text]
