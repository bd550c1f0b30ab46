"""The value of each name in an RViz config for a robot."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import yaml

from multibot_rewrite.base.naming import NAMESPACE
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.companions.names.placeholders import is_robot, without_robot
from multibot_rewrite.companions.names.rename_map import CompanionNames, spell
from multibot_rewrite.companions.names.robot_topics import NOTHING, robot_topic
from multibot_rewrite.companions.rviz.colours import Colour
from multibot_rewrite.companions.rviz.read_config import RvizItem, ValuePlace, text_of
from multibot_rewrite.companions.yaml_text import Splice, replaced

TOPIC, GRAPH_NAMESPACE, FRAME = "topic", "namespace", "frame"
LINK, JOINT, GROUP = "link", "joint", "group"
COLOUR, FLAT_COLOUR, TF_PREFIX = "colour", "flat_colour", "tf_prefix"
NAMED = frozenset({TOPIC, GRAPH_NAMESPACE, FRAME, LINK, JOINT, GROUP, TF_PREFIX})
_NULL = "tag:yaml.org,2002:null"


class RvizRobot(NamedTuple):
    """A robot to be shown. ``names`` is the rename map of its frames, ``topics`` of its ROS names.

    ``name`` is the title of its group. ``colour`` is a name, ``#rrggbb`` or three numbers, empty for
    one of the palette. ``known`` is its ``fleet_topics``. ``tf_prefix`` is for a description with
    bare links and prefixed frames (robot_state_publisher's ``frame_prefix``); it stays empty for a
    rewritten description, whose links have the prefix themselves. ``rules`` are the name and the remap
    rules of an rviz2 of its own, which its stacks start.
    """

    name: str
    names: CompanionNames
    topics: CompanionNames
    colour: str | tuple[int, ...] = ""
    known: Mapping[str, str] = NOTHING
    tf_prefix: str = ""
    rules: tuple[tuple[str, str], ...] = ()

    @property
    def has_process(self) -> bool:
        """Does what works for one process alone find this robot in an rviz2 of its own?"""
        return self.names.naming.layout.namespaced or bool(self.rules)


def is_name(place: ValuePlace) -> bool:
    """Does this place hold a name? Null values and blocks of text do not."""
    node = place.node
    return place.word in NAMED and node.tag != _NULL and node.style not in ("|", ">")


def robot_value(place: ValuePlace, robot: RvizRobot) -> str:
    """The value of a place for the robot."""
    value = str(place.node.value)
    if place.word == TF_PREFIX:
        # Where frames have no prefix, one that stands for the robot is none.
        own = robot.names.naming.layout.frames or is_robot(value)
        return robot.tf_prefix if own else value
    if place.word == TOPIC:
        return robot_topic(robot.topics, without_robot(value, "/"), robot.known)
    if place.word == GRAPH_NAMESPACE:
        reached = robot.topics.naming.topics == NAMESPACE
        return robot_topic(robot.topics, without_robot(value, "/")) if reached else value
    return spell(robot.names, place.word, without_robot(value, ""))


def changed_values(one: RvizItem, robot: RvizRobot) -> Iterator[tuple[ValuePlace, str]]:
    """The places of a display or tool whose value differs for the robot, and the new value."""
    for place in filter(is_name, one.places):
        new = robot_value(place, robot)
        if new != place.node.value:
            yield place, new


def item_splices(one: RvizItem, robot: RvizRobot, colour: Colour | None) -> list[Splice]:
    """The splices that make a display or tool show the robot."""
    made = [replaced(place.node, new) for place, new in changed_values(one, robot)]
    return made + ([*_painted(one, colour)] if colour else [])


def _painted(one: RvizItem, colour: Colour) -> Iterator[Splice]:
    """The robot's colour, if the display has one colour for all its data."""
    flat = text_of(one.node, "Color Transformer") == "FlatColor"
    for place in one.places:
        if place.word == COLOUR or (place.word == FLAT_COLOUR and flat):
            yield painted(place.node, colour)


def painted(node: yaml.ScalarNode, colour: Colour) -> Splice:
    """The splice of a colour as RViz writes it."""
    text = "; ".join(map(str, colour))
    return Splice(node.start_mark.index, node.end_mark.index, text)


def frame_of(node: yaml.Node | None, robot: RvizRobot) -> str:
    """The robot's version of the frame in a scalar; empty for any other node."""
    given = str(node.value) if isinstance(node, yaml.ScalarNode) else ""
    return spell(robot.names, FRAME, without_robot(given, ""))
