"""A file beside a description -> what the rules for its kind find in it."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.findings.finding import Finding
from multibot_rewrite.findings.rule import Rule
from multibot_rewrite.findings.selection import level_of
from multibot_rewrite.lazy import lazy_compile
from multibot_rewrite.lint.beside.kinds import kind_of
from multibot_rewrite.lint.beside.records import Beside, Remark
from multibot_rewrite.lint.config.settings import Settings
from multibot_rewrite.lint.groups import active_rules
from multibot_rewrite.model import InputError

# Up to a reason, which is behind a dash.
_COMMENT = lazy_compile(r"#\s*urdf-lint:\s*ignore\s+((?:MB\d+[,\s]*)+)(?:$|[-:])")


def beside_findings(path: str, data: bytes, settings: Settings) -> Iterator[Finding]:
    """What the active rules find in a file; raises InputError for one that is of no known kind."""
    kind = kind_of(data)
    if not kind:
        hint = "name descriptions, or files of parameters, RViz, MoveIt or ros_gz_bridge"
        raise InputError(f"{path}:1:1: it is none of the files that are linted; {hint}")
    from multibot_rewrite.companions.yaml_text import read_yaml  # a lint of a URDF needs none of it

    beside = Beside(kind, read_yaml(data, path), settings, {})
    lines = beside.document.text.split("\n")
    for rule in active_rules(settings, kind):
        for it in rule.check(beside) if rule.check else ():
            if rule.code not in _silenced(lines[it.node.start_mark.line]):
                yield _found(beside, rule, it)


def _silenced(line: str) -> list[str]:
    """The codes in a comment at the end of a line."""
    found = _COMMENT.search(line) if "urdf-lint" in line else None
    return found[1].replace(",", " ").split() if found else []


def _found(beside: Beside, rule: Rule, it: Remark) -> Finding:
    mark = it.node.start_mark
    level = level_of(beside.settings, rule.code, rule.level)
    file = beside.document.file
    return Finding(rule.code, level, it.message, it.hint, file, mark.line + 1, mark.column + 1)
