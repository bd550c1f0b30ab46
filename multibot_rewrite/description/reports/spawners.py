# SPDX-License-Identifier: Apache-2.0
"""What the controllers of a description have to be spawned with: rules that its text cannot hold."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import Finding, RewriteRefused
from multibot_rewrite.base.naming import DEFAULT_LAYOUT, make_naming
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.pipeline import prepare
from multibot_rewrite.description.readback.meeting import NOT_TAKEN
from multibot_rewrite.description.rewriters.tree import Tree

# One layout where names get the robot's name, and one where its namespace keeps them apart.
LAYOUTS = (DEFAULT_LAYOUT, "both")


class SpawnerRules(NamedTuple):
    """The plugin that loads controllers, a layout, and what each is spawned with in it."""

    place: str
    layout: str
    advice: str


def spawner_rules(data: bytes, file: str, tree: Tree) -> Iterator[SpawnerRules]:
    """Those of one file; none where it has no controllers, they take rules, or it is refused."""
    if b"ros2_control" not in data:
        return
    for layout in LAYOUTS:
        for it in _findings(data, file, tree, layout):
            if it.code == NOT_TAKEN:
                yield SpawnerRules(f"{it.file}:{it.line}", layout, it.hint)


def _findings(data: bytes, file: str, tree: Tree, layout: str) -> list[Finding]:
    try:
        return prepare(data, file, make_naming(layout), tree).findings
    except RewriteRefused:
        return []
