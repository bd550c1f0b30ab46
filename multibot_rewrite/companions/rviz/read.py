"""An RViz config as rules ask it: its names, and the texts of unknown use."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import yaml

from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.kinds import RVIZ
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.names.placeholders import without_robot
from multibot_rewrite.companions.rviz.display_groups import leaves
from multibot_rewrite.companions.rviz.read_config import (
    FRAME,
    RvizConfig,
    RvizItem,
    fixed_frame,
    read_config,
    targets,
)
from multibot_rewrite.companions.rviz.values import RvizRobot, is_name
from multibot_rewrite.companions.sites import Site, site_at
from multibot_rewrite.companions.yaml_text import YamlText, is_text, pairs

# Titles of displays and windows: never names of links.
_TITLES = ("Name", "Class")


def read_rviz(document: YamlText, context: Context) -> NamedFile:
    """The names of a config; raises InputError for one that is not for RViz 2."""
    config = read_config(document)
    shown = (*leaves(config.displays), *config.tools)
    names = (*_frames(config), *(it for one in shown for it in filter(is_name, one.places)))
    others = tuple(site for one in shown for site in _others(one))
    return NamedFile(
        RVIZ,
        document.file,
        document.text,
        context,
        {},
        names,
        others,
        document=document,
        shown=tuple(leaves(config.displays)),
    )


def read_for(document: YamlText, robots: Sequence[RvizRobot], release: str) -> NamedFile:
    """The names of a config that shows these robots: what one of them declares is there."""
    every = [it.names.declared for it in robots]
    declared = {
        kind: {name: it for own in every for name, it in own.get(kind, {}).items()}
        for kind in {kind for own in every for kind in own}
    }
    names = robots[0].names._replace(declared=declared)
    return read_rviz(document, Context(names, names, {}, release))


def _frames(config: RvizConfig) -> Iterator[Site]:
    for node in (fixed_frame(config), *targets(config)):
        if isinstance(node, yaml.ScalarNode):
            yield site_at(node, FRAME, without_robot(str(node.value), ""))


def _others(one: RvizItem) -> Iterator[Site]:
    claimed = {it.slot.start for it in one.places}
    for node in _scalars(one.node):
        if node.start_mark.index not in claimed and is_text(node):
            yield site_at(node, "", str(node.value))


def _scalars(node: yaml.Node) -> Iterator[yaml.ScalarNode]:
    """The values of a display and its maps, without titles."""
    for key, there in pairs(node):
        if key.value in (*_TITLES, "Displays"):
            continue
        if isinstance(there, yaml.ScalarNode):
            yield there
        yield from _scalars(there)
