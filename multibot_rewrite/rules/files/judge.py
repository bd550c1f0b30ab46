"""A file beside a description -> what the rules for its kind find in it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cache

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.findings.rule import Rule
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.rules.description import rewriting
from multibot_rewrite.rules.description.files import reading
from multibot_rewrite.rules.description.names import ros_names as description_names
from multibot_rewrite.rules.files import (
    bridges,
    frames,
    keys,
    names,
    parameters,
    releases,
    ros_names,
    rviz,
)

THEMES = (parameters, names, ros_names, frames, keys, releases, bridges, rviz)
# They are asked of a description as well.
SHARED: tuple[Rule, ...] = (
    reading.leftover,
    description_names.invalid_ros_name,
    description_names.leading_slash,
    rewriting.unclaimed_mention,
)
# Up to a reason, which is behind a dash.
_COMMENT = lazy_compile(r"#\s*urdf-lint:\s*ignore\s+((?:MB\d+[,\s]*)+)(?:$|[-:])")


@cache
def rules_for(kind: str) -> tuple[Rule, ...]:
    """The rules for files of a kind, by their codes."""
    themes = (it for theme in THEMES for it in vars(theme).values() if isinstance(it, Rule))
    every = (it for it in (*themes, *SHARED) if kind in it.formats)
    return tuple(sorted(every, key=lambda it: it.code))


def judged(file: NamedFile, rules: Iterable[Rule]) -> Iterator[Finding]:
    """What rules find in a file, without what a comment at the end of its line silences."""
    lines = file.text.split("\n")
    for rule in rules:
        for it in rule.check(file) if rule.check else ():
            if rule.code not in _silenced(lines[it.line - 1]):
                level = it.level or rule.level
                place = {"file": file.file, "line": it.line, "column": it.column}
                yield rule.finding(it.message, it.hint, level=level, **place)


def judged_once(file: NamedFile) -> list[Finding]:
    """What all rules find in a file, at its first place, in the order of the places."""
    first: dict[tuple[str, str], Finding] = {}
    for it in sorted(judged(file, rules_for(file.kind)), key=lambda it: (it.line, it.column)):
        first.setdefault((it.code, it.message), it)
    return list(first.values())


def _silenced(line: str) -> list[str]:
    """The codes in a comment at the end of a line."""
    found = _COMMENT.search(line) if "urdf-lint" in line else None
    return found[1].replace(",", " ").split() if found else []
