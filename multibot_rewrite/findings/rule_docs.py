"""Rules in words: one for ``explain``, all of a page for the docs."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from multibot_rewrite.findings.rule import Rule
from multibot_rewrite.record import NamedTuple

# What an example is written in -> how a Markdown page colours it; XML where it is not here.
_LANGUAGES = {
    **dict.fromkeys(("params", "rviz", "moveit", "bridge", "fleet", "remap"), "yaml"),
    **dict.fromkeys(("params file", "rviz file", "moveit file", "bridge file"), "yaml"),
    "system": "text",
    "pair": "text",
    "lua": "lua",
}


class Group(NamedTuple):
    """The rules whose codes begin with ``start``, and what they are about; ``intro`` is Markdown."""

    start: str
    title: str
    rules: tuple[Rule, ...]
    intro: str = ""


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


def page(head: str, groups: Iterable[Group]) -> str:
    """A page of rules in Markdown, a heading for each group and rule."""
    parts = [head]
    for group in groups:
        intro = f"\n{group.intro}" if group.intro else ""
        parts.append(f"\n## {group.start}: {group.title}\n{intro}")
        parts += (_section(rule) for rule in group.rules)
    return "".join(parts)


def _section(rule: Rule) -> str:
    lines = [f"\n### {rule.code} {rule.name}\n", f"*{rule.level}*. {_marked(rule.what)}\n"]
    lines += [f"**Why.** {_marked(rule.why)}\n", f"**Fix.** {_marked(rule.fix)}\n"]
    language = next((_LANGUAGES[it] for it in rule.formats if it in _LANGUAGES), "xml")
    for title, example in _examples(rule):
        lines.append(f"{title}:\n\n```{language}\n{example.rstrip()}\n```\n")
    return "\n".join(lines)


def _marked(text: str) -> str:
    """Text for Markdown, where ``<tag>`` would be HTML unless it is in backticks."""
    parts = text.split("`")
    parts[::2] = [it.replace("<", "\\<") for it in parts[::2]]
    return "`".join(parts)


def _examples(rule: Rule) -> list[tuple[str, str]]:
    good = "" if rule.good == rule.fixed else rule.good
    texts = (("Bad", rule.bad), ("Fixed by --fix", rule.fixed), ("Good", good))
    return [(title, text) for title, text in texts if text]
