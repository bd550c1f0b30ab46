"""A file beside a description -> what the rules for its kind find in it."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.findings.finding import Finding
from multibot_rewrite.findings.rule import Rule
from multibot_rewrite.findings.selection import level_of
from multibot_rewrite.lint.beside.kinds import kind_of
from multibot_rewrite.lint.beside.records import Beside, Remark
from multibot_rewrite.lint.config.settings import Settings
from multibot_rewrite.lint.registry import active_rules
from multibot_rewrite.model import InputError


def beside_findings(path: str, data: bytes, settings: Settings) -> Iterator[Finding]:
    """What the active rules find in a file; raises InputError for one that is of no known kind."""
    kind = kind_of(data)
    if not kind:
        hint = "name descriptions, or files of parameters, RViz, MoveIt or ros_gz_bridge"
        raise InputError(f"{path}:1:1: it is none of the files that are linted; {hint}")
    from multibot_rewrite.companions.yaml_text import read_yaml  # a lint of a URDF needs none of it

    beside = Beside(kind, read_yaml(data, path), settings, {})
    for rule in active_rules(settings, kind):
        remarks = list(rule.check(beside)) if rule.check else []
        yield from (_found(beside, rule, it) for it in remarks)


def _found(beside: Beside, rule: Rule, it: Remark) -> Finding:
    mark = it.node.start_mark
    level = level_of(beside.settings, rule.code, rule.level)
    file = beside.document.file
    return Finding(rule.code, level, it.message, it.hint, file, mark.line + 1, mark.column + 1)
