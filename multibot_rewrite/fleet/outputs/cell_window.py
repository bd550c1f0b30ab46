"""The RViz config of a cell: one window with the MotionPlanning of all arms.

MoveIt's displays read the parameters of their process, which are the cell's; the rest of the config
stays as it was written for one robot.
"""

from __future__ import annotations

from collections.abc import Iterator

import yaml

from multibot_rewrite.companions.engine import splices_of
from multibot_rewrite.companions.names.rename_map import spell
from multibot_rewrite.companions.rviz.read_config import every, fixed_frame, read_config, targets
from multibot_rewrite.companions.rviz.rewrite import RvizText
from multibot_rewrite.companions.yaml_text import Splice, YamlText, replaced, spliced
from multibot_rewrite.fleet.file.cell_file import Cell
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot

_GROUP = "group"


def cell_window(
    document: YamlText, cell: Cell, first: RewrittenRobot, world: str
) -> RvizText | None:
    """The window, seen from ``world``; it starts with the cell's first group, or with that of the
    ``first`` arm. None for a config without planning groups; raises as ``read_config``."""
    config = read_config(document)
    shown = (place for it in every(config.displays) for place in it.places)
    groups = [it for it in shown if it.kind == _GROUP]
    if not groups:
        return None
    own = spell(first.names, _GROUP, groups[0].slot.value)
    group = next(iter(cell.groups), own)
    splices = [*splices_of(document.text, document.file, ((it, group) for it in groups))]
    splices += _seen_from((fixed_frame(config), *targets(config)), world)
    return RvizText(cell.name, spliced(document, splices))


def _seen_from(nodes: tuple[yaml.Node | None, ...], world: str) -> Iterator[Splice]:
    for it in nodes:
        if isinstance(it, yaml.ScalarNode) and it.value not in ("", "<Fixed Frame>"):
            yield replaced(it, world)
