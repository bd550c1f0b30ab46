# SPDX-License-Identifier: Apache-2.0
"""The value of each name in an RViz config for a robot."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

import yaml

from multibot_rewrite.base.naming import NAMESPACE
from multibot_rewrite.companions.engine import splices_of
from multibot_rewrite.companions.names.placeholders import is_robot, without_robot
from multibot_rewrite.companions.names.rename_map import CompanionNames, spell
from multibot_rewrite.companions.names.robot_topics import NOTHING, robot_topic
from multibot_rewrite.companions.rviz.read_config import (
    FRAME,
    GRAPH_NAMESPACE,
    TOPIC,
    Colour,
    RvizItem,
    text_of,
)
from multibot_rewrite.companions.sites import Site
from multibot_rewrite.companions.yaml_text import Splice, YamlText

LINK, JOINT, GROUP = "link", "joint", "group"
COLOUR, FLAT_COLOUR, TF_PREFIX = "colour", "flat_colour", "tf_prefix"
NAMED = frozenset({TOPIC, GRAPH_NAMESPACE, FRAME, LINK, JOINT, GROUP, TF_PREFIX})


class RvizRobot(NamedTuple):
    """A robot to be shown. ``names`` is the rename map of its frames, ``topics`` of its ROS names.

    ``name`` is the title of its group. ``colour`` is a name, ``#rrggbb`` or three numbers, empty
    for one of the palette. ``known`` is its ``fleet_topics``. ``tf_prefix`` is for a description
    with links without the robot's name and prefixed frames (robot_state_publisher's
    ``frame_prefix``); it stays empty for a rewritten description, whose links have the prefix
    themselves. ``rules`` are the name and the remap rules of an rviz2 of its own, which its node
    sets start."""

    name: str
    names: CompanionNames
    topics: CompanionNames
    colour: str | tuple[int, ...] = ""
    known: Mapping[str, str] = NOTHING
    tf_prefix: str = ""
    rules: tuple[tuple[str, str], ...] = ()

    @property
    def has_process(self) -> bool:
        """Return whether a tool for one robot finds this one from an rviz2 of its own."""
        return self.names.naming.layout.namespaced or bool(self.rules)


def is_name(site: Site) -> bool:
    """Return whether this place holds a name. Blocks of text do not."""
    return site.kind in NAMED and not site.slot.is_block


def robot_value(site: Site, robot: RvizRobot) -> str:
    """Return the value of a site of an RViz config for the robot."""
    if site.kind == TF_PREFIX:
        # Where frames have no prefix, one that stands for the robot is none.
        own = robot.names.naming.layout.frames or is_robot(site.slot.value)
        return robot.tf_prefix if own else site.slot.value
    if site.kind == TOPIC:
        return robot_topic(robot.topics, site.text, robot.known)
    if site.kind == GRAPH_NAMESPACE:
        reached = robot.topics.naming.topics == NAMESPACE
        return robot_topic(robot.topics, site.text) if reached else site.slot.value
    return spell(robot.names, site.kind, site.text)


def changed_values(one: RvizItem, robot: RvizRobot) -> Iterator[tuple[Site, str]]:
    """Yield the places of a display or tool with another value for the robot, and that value."""
    made = ((it, robot_value(it, robot)) for it in filter(is_name, one.places))
    yield from ((it, new) for it, new in made if new != it.slot.value)


def item_splices(
    document: YamlText, one: RvizItem, robot: RvizRobot, colour: Colour | None
) -> list[Splice]:
    """Return the splices that make a display or tool show the robot."""
    made = [*splices_of(document.text, document.file, changed_values(one, robot))]
    if colour:
        # As RViz writes it, if the display has one colour for all its data.
        kinds = [COLOUR]
        if text_of(one.node, "Color Transformer") == "FlatColor":
            kinds.append(FLAT_COLOUR)
        slots = (it.slot for it in one.places if it.kind in kinds)
        made += [Splice(it.start, it.end, "; ".join(map(str, colour))) for it in slots]
    return made


def frame_of(node: yaml.Node | None, robot: RvizRobot) -> str:
    """Return the robot's version of the frame in a scalar; empty for any other node."""
    given = str(node.value) if isinstance(node, yaml.ScalarNode) else ""
    return spell(robot.names, FRAME, without_robot(given, ""))
