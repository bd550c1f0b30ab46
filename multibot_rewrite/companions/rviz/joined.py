# SPDX-License-Identifier: Apache-2.0
"""RViz configs of parts as one config of the robot that they make: one window, one description.

The first one stays. Of each further one the displays that it does not show yet follow as a group with
the part's name; they have its prefix before links, frames and groups.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from multibot_rewrite.base.naming import PREFIX
from multibot_rewrite.companions.names.rename_map import companion_names
from multibot_rewrite.companions.rviz.display_groups import group_text, leaves
from multibot_rewrite.companions.rviz.read_config import (
    GRAPH_NAMESPACE,
    TOPIC,
    RvizConfig,
    RvizItem,
    fixed_frame,
    read_config,
    targets,
    value,
)
from multibot_rewrite.companions.rviz.rewrite import frame_splices
from multibot_rewrite.companions.rviz.values import RvizRobot, item_splices
from multibot_rewrite.companions.yaml_text import cut_out, inserted, moved, read_yaml, spliced
from multibot_rewrite.description.joining.part import PREFIXED, prefixing
from multibot_rewrite.description.steps.collect import Inventory


class PartRviz(NamedTuple):
    """The config of a part, called ``name``, as its prefix spells it."""

    name: str
    file: str
    config: RvizConfig


class JoinedRviz(NamedTuple):
    """The one config, and what a person should know: a file, and what of it."""

    data: bytes
    notes: tuple[tuple[str, str], ...]


def part_rviz(data: bytes, file: str, part: Inventory, name: str, prefix: str) -> PartRviz:
    """A config with the prefix of its part; ``part`` is its description without. Raises InputError for
    one that is not for RViz 2."""
    config = read_config(read_yaml(data, file))
    naming = prefixing((*PREFIXED, "group"), PREFIX)
    names = companion_names(part.declared, naming, prefix, {})
    robot = RvizRobot(name, names, names)
    document = config.document
    shown = (*leaves(config.displays), *config.tools) if prefix else ()
    splices = [it for one in shown for it in item_splices(document, one, robot, None)]
    views = (fixed_frame(config), *targets(config)) if prefix else ()
    splices += [it for node in views for it in frame_splices(node, robot)]
    return PartRviz(name, file, read_config(read_yaml(spliced(document, splices).encode(), file)))


def joined_rviz(parts: Sequence[PartRviz]) -> JoinedRviz:
    """All configs as one."""
    first, *others = parts
    config, document = first.config, first.config.document
    known = {_shows(it) for it in leaves(config.displays)}
    column = config.displays[0].block.column if config.displays else 0
    groups, notes = "", []
    for it in others:
        new = [one for one in leaves(it.config.displays) if _shows(one) not in known]
        known.update(map(_shows, new))
        if column and new:
            groups += group_text(document, it.name, column, _copies(it, new, column))
        what = f"its displays are in the group {it.name}" if column and new else "it shows no more"
        notes.append((it.file, f"{what}; tools, panels and views are those of {first.file}"))
    end = config.displays[-1].block.end if config.displays else 0
    splices = [inserted(document, end, groups)] if groups else []
    return JoinedRviz(spliced(document, splices).encode(), tuple(notes))


def _copies(it: PartRviz, shown: Sequence[RvizItem], column: int) -> Iterator[str]:
    for one in shown:
        text = cut_out(it.config.document, one.block.start, one.block.end)
        yield moved(text, column - one.block.column)


def _shows(one: RvizItem) -> tuple[str, ...]:
    """What a display shows: its class and its topics; a grid, its frame."""
    named = (it for it in one.places if it.kind in (TOPIC, GRAPH_NAMESPACE))
    frame = value(one.node, "Reference Frame")
    return (
        one.cls,
        *(f"{it.key}={it.text.strip('/')}" for it in named),
        str(frame.value if frame else ""),
    )
