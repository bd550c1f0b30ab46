"""Rules in words: one for ``explain``, a list of many."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from multibot_rewrite.base.findings.rule import Rule


def explained(rule: Rule) -> str:
    """A rule with its examples, for a terminal."""
    head = f"{rule.code} {rule.name} ({rule.level})"
    parts = [head, "", rule.what, "", f"Why: {rule.why}", "", f"Fix: {rule.fix}"]
    for title, example in examples(rule):
        parts += ["", f"{title}:", "", *(f"    {line}" for line in example.splitlines())]
    return "\n".join(parts) + "\n"


def listed(rules: Iterable[Rule]) -> Iterator[tuple[str, str, str, str]]:
    """Code, level, name and first sentence of each."""
    return ((it.code, it.level, it.name, it.what.partition(". ")[0].rstrip(".")) for it in rules)


def examples(rule: Rule) -> list[tuple[str, str]]:
    """Titles and texts of its examples."""
    good = "" if rule.good == rule.fixed else rule.good
    texts = (("Bad", rule.bad), ("Fixed by --fix", rule.fixed), ("Good", good))
    return [(title, text) for title, text in texts if text]
