"""A file beside a description -> what the rules for its kind find in it."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.findings.selection import level_of
from multibot_rewrite.base.model import InputError
from multibot_rewrite.companions.kinds import kind_of
from multibot_rewrite.lint.groups import active_rules
from multibot_rewrite.rules.settings import Settings


def beside_findings(path: str, data: bytes, settings: Settings) -> Iterator[Finding]:
    """What the active rules find in a file; raises InputError for one that is of no known kind."""
    kind = kind_of(data)
    if not kind:
        hint = "name descriptions, or files of parameters, RViz, MoveIt or ros_gz_bridge"
        raise InputError(f"{path}:1:1: it is none of the files that are linted; {hint}")
    # A lint of a URDF needs none of these.
    from multibot_rewrite.companions.yaml_text import read_yaml
    from multibot_rewrite.lint.beside.named import named_in_package
    from multibot_rewrite.rules.files.judge import judged

    file = named_in_package(kind, read_yaml(data, path), settings)
    for it in judged(file, active_rules(settings, kind)) if file else ():
        yield it._replace(level=level_of(settings, it.code, it.level))
