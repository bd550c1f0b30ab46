# SPDX-License-Identifier: Apache-2.0
"""An RViz config as records: displays, tools and panels, their names, and these for a robot."""

from collections.abc import Iterator, Mapping, Sequence
from colorsys import hls_to_rgb
from functools import lru_cache
from typing import Any, NamedTuple

import yaml

from multibot_rewrite.base.bounded import load_own_yaml
from multibot_rewrite.base.model import FOR_ROS_1, InputError
from multibot_rewrite.base.naming import NAMESPACE
from multibot_rewrite.base.nearest import did_you_mean_one_of
from multibot_rewrite.related_files.names.node_topics import NOTHING, robot_topic
from multibot_rewrite.related_files.names.placeholders import is_robot, without_robot
from multibot_rewrite.related_files.names.rename_map import RelatedNames, spell
from multibot_rewrite.related_files.sites import Site, site_at
from multibot_rewrite.related_files.yaml_text import (
    Block,
    YamlText,
    blocks,
    is_block,
    pairs,
    refuse_anchors,
    refused,
)

MANAGER = "Visualization Manager"
GROUP = "rviz_common/Group"
DOCK, SHARED, PROCESS, ABSOLUTE = "dock", "shared", "process", "absolute"
TOPIC, GRAPH_NAMESPACE, FRAME = "topic", "namespace", "frame"
_NULL = "tag:yaml.org,2002:null"
# Classes of ROS 1, which pluginlib of ROS 2 does not find.
ROS1 = "rviz/"


class RvizItem(NamedTuple):
    """A display, tool or panel: its lines, class, name, values of interest, and the displays below.

    ``flag`` and ``known`` are what ``rviz.yaml`` has about its class.
    """

    block: Block
    node: yaml.Node
    cls: str
    name: str
    flag: str
    known: bool
    places: tuple[Site, ...]
    children: "tuple[RvizItem, ...]" = ()


class RvizConfig(NamedTuple):
    """An RViz 2 config; ``manager`` is its map ``Visualization Manager``."""

    document: YamlText
    manager: yaml.Node
    displays: tuple[RvizItem, ...]
    tools: tuple[RvizItem, ...]
    panels: tuple[RvizItem, ...]


@lru_cache(maxsize=1)
def rviz_data() -> Mapping[str, Any]:
    """Return the data of ``rviz.yaml``."""
    data: Mapping[str, Any] = load_own_yaml(__file__, "rviz.yaml")
    return data


def read_config(document: YamlText) -> RvizConfig:
    """Return the config in a YAML text; raises InputError if it is not a config of RViz 2."""
    manager = value(document.root, MANAGER)
    if not isinstance(manager, yaml.MappingNode):
        raise InputError(
            f"{document.file}: not an RViz config: it has no {MANAGER!r}; save it with rviz2"
        )
    for node in _all_maps(document.root):
        cls = text_of(node, "Class")
        if cls.startswith(ROS1):
            what = f"this is a ROS 1 config ({cls}), which rviz2 cannot load; create it in rviz2"
            raise refused(document, node, what, FOR_ROS_1)
    refuse_anchors(document)
    displays = value(manager, "Displays")
    return RvizConfig(
        document,
        manager,
        tuple(_items_of_list(document, displays, "displays")),
        tuple(_items_of_list(document, value(manager, "Tools"), "tools")),
        tuple(_items_of_list(document, value(document.root, "Panels"), "panels")),
    )


def _all_maps(node: yaml.Node | None) -> Iterator[yaml.Node]:
    if isinstance(node, yaml.MappingNode):
        yield node
    for item in node.value if isinstance(node, yaml.CollectionNode) else ():
        yield from _all_maps(item[1] if isinstance(item, tuple) else item)


def _items_of_list(document: YamlText, node: yaml.Node | None, what: str) -> Iterator[RvizItem]:
    if not isinstance(node, yaml.SequenceNode) or not node.value:
        return
    if not is_block(node):
        hint = "which cannot be copied; save the file with rviz2"
        raise refused(document, node, f"{what} are in brackets, {hint}")
    data = rviz_data()
    for block, item in zip(blocks(document, node), node.value, strict=True):
        cls = text_of(item, "Class")
        below = _items_of_list(document, value(item, "Displays"), what) if cls == GROUP else ()
        names = data["displays"].get(cls, data["any"])
        places = []
        # RViz keeps links and frames that it has seen once: those are keys.
        for path, kind in names.items() if cls != GROUP else ():
            lead = "/" if kind in (TOPIC, GRAPH_NAMESPACE) else ""
            for at in _scalars_at(item, path.split(".")):
                text = without_robot(str(at.value), lead)
                places.append(site_at(at, kind, text, path, "*" in path))
        known = what != "displays" or cls == GROUP or cls in data["displays"]
        flag = data["flags"].get(cls, "")
        name = text_of(item, "Name")
        yield RvizItem(block, item, cls, name, flag, known, tuple(places), tuple(below))


def _scalars_at(node: yaml.Node | None, path: Sequence[str]) -> Iterator[yaml.ScalarNode]:
    """Yield the scalars at a path; ``*`` gives keys."""
    if not path:
        node = value(node, "Value") if isinstance(node, yaml.MappingNode) else node
        if isinstance(node, yaml.ScalarNode) and node.tag != _NULL:
            yield node
    elif path[0] in ("*", "**"):
        for key, below in pairs(node):
            if key.value not in rviz_data()["fixed_keys"]:
                yield key
            if path[0] == "**":
                yield from _scalars_at(below, path)
    else:
        yield from _scalars_at(value(node, path[0]), path[1:])


def value(node: yaml.Node | None, key: str) -> yaml.Node | None:
    """Return the value of a key of a map, the last one of a repeated key; None if it is missing."""
    return next((there for name, there in reversed(pairs(node)) if name.value == key), None)


def text_of(node: yaml.Node | None, key: str) -> str:
    """Return the value of a key as text; empty if it is missing or not a scalar."""
    there = value(node, key)
    return str(there.value) if isinstance(there, yaml.ScalarNode) else ""


def every(shown: Sequence[RvizItem]) -> Iterator[RvizItem]:
    """Yield displays and those in groups."""
    for one in shown:
        yield one
        yield from every(one.children)


def fixed_frame(config: RvizConfig) -> yaml.Node | None:
    """Return the frame that everything is shown in."""
    return value(value(config.manager, "Global Options"), "Fixed Frame")


def views_of(config: RvizConfig) -> tuple[yaml.Node | None, yaml.Node | None]:
    """Return the current view, and the list of saved ones."""
    views = value(config.manager, "Views")
    return value(views, "Current"), value(views, "Saved")


def targets(config: RvizConfig) -> Iterator[yaml.Node]:
    """Yield the frames that views follow."""
    current, saved = views_of(config)
    listed = saved.value if isinstance(saved, yaml.SequenceNode) else []
    for view in (current, *listed):
        target = value(view, "Target Frame")
        if isinstance(target, yaml.ScalarNode):
            yield target


Colour = tuple[int, int, int]
# Steps of the golden angle never repeat a hue.
_STEP = 0.618034


def read_colour(given: str | tuple[int, ...], robot: str = "") -> Colour:
    """Return a colour from a name, ``#rrggbb`` or three numbers; raises InputError."""
    if not isinstance(given, str):
        red, green, blue = given
        return red, green, blue
    known = rviz_data()["colours"]
    if given.lower() in known:
        red, green, blue = known[given.lower()]
        return red, green, blue
    digits = given[1:] if given.startswith("#") else ""
    try:
        if len(digits) == 6:
            red, green, blue = bytes.fromhex(digits)
            return red, green, blue
    except ValueError:
        pass
    hint = did_you_mean_one_of(given, known) or "write #rrggbb or [r, g, b]"
    place = f"robot {robot!r}: " if robot else ""
    raise InputError(f"{place}colour {given!r} is not known; {hint}")


def palette(at: int) -> Colour:
    """Return the colour of the robot at this place, unlike all others: red, green, blue."""
    first = rviz_data()["palette"]
    if at < len(first):
        red, green, blue = first[at]
        return red, green, blue
    turns = at - len(first)
    lightness = (0.45, 0.6, 0.75)[turns % 3]
    red, green, blue = hls_to_rgb(turns * _STEP % 1, lightness, 0.85)
    return round(red * 255), round(green * 255), round(blue * 255)


LINK, JOINT, GROUP_NAME = "link", "joint", "group"
COLOUR, FLAT_COLOUR, TF_PREFIX = "colour", "flat_colour", "tf_prefix"
NAMED = frozenset({TOPIC, GRAPH_NAMESPACE, FRAME, LINK, JOINT, GROUP_NAME, TF_PREFIX})


class RvizRobot(NamedTuple):
    """A robot to be shown. ``names`` is the rename map of its frames, ``topics`` of its ROS names.

    ``name`` is the title of its group. ``colour`` is a name, ``#rrggbb`` or three numbers, empty
    for one of the palette. ``known`` is its ``fleet_topics``. ``tf_prefix`` is for a description
    with links without the robot's name and prefixed frames (robot_state_publisher's
    ``frame_prefix``); it stays empty for a rewritten description, whose links have the prefix
    themselves. ``rules`` are the name and the remap rules of an rviz2 of its own, which its node
    sets start. ``apart``: it has a window of its own in any case."""

    name: str
    names: RelatedNames
    topics: RelatedNames
    colour: str | tuple[int, ...] = ""
    known: Mapping[str, str] = NOTHING
    tf_prefix: str = ""
    rules: tuple[tuple[str, str], ...] = ()
    apart: bool = False

    @property
    def has_process(self) -> bool:
        """Return whether a tool for one robot finds this one from an rviz2 of its own."""
        return self.names.naming.layout.namespaced or bool(self.rules)


def is_name(site: Site) -> bool:
    """Return whether a site holds a name. Blocks of text do not."""
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


def frame_of(node: yaml.Node | None, robot: RvizRobot) -> str:
    """Return the robot's version of the frame in a scalar; empty for any other node."""
    given = str(node.value) if isinstance(node, yaml.ScalarNode) else ""
    return spell(robot.names, FRAME, without_robot(given, ""))
