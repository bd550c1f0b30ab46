# SPDX-License-Identifier: Apache-2.0
"""What names and types say: topics that move or locate a robot, nodes that are tools of any fleet."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from fnmatch import translate
from functools import lru_cache

from multibot_rewrite.base.conventions import (
    KINDS_OF_DATA,
    ROWS,
    is_tool_word,
    only_looks,
    types_of,
)
from multibot_rewrite.base.lazy import lazy_compile

# They set a robot in motion: of these types always, of the second ones where the name says so.
_ALWAYS, _BY_NAME = types_of("drives"), types_of("drives-by-name")
PLAIN, STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"
_NAMED = ("cmd", "vel", "command", "setpoint", "speed")
# Where to go, and where a robot is.
_POSES = types_of("pose")
# Without underscores.
_POSE_NAMES = ("goalpose", "initialpose", "goal", "movebasesimple/goal")
_BODY, _OF_ONE_SENSOR, _NO_SENSOR, _OF_ONE_ROBOT = map(
    types_of, ("body", "one-sensor", "no-sensor", "one-robot")
)
# Services of every node.
OF_EVERY_NODE = types_of("every-node")
MAP = "nav_msgs/msg/OccupancyGrid"
ODOMETRY, JOINTS = "nav_msgs/msg/Odometry", "sensor_msgs/msg/JointState"
# What a measurement is of, and from which side, as the words of its topic say.
_KINDS: dict[str, dict[str, str]] = {}
for (_of, *_same), _ in ROWS["kinds of sources"]:
    _KINDS.setdefault(_of, {}).update(dict.fromkeys(_same, _same[0]))
_WHEELS, _GPS = "wheel", "gps"
# What is sent to joints, as Isaac Sim and topic_based_ros2_control have it, is no state of them.
_TO_JOINTS = ("cmd", "command", "goal", "target", "desired", "reference")
JOYSTICK = "sensor_msgs/msg/Joy"
_STOPS = lazy_compile("stop|halt|lock|pause|emergency")
DESCRIPTION, _TEXT = "robot_description", "std_msgs/msg/String"
# The node of `ros2 bag play`.
CHANGE_STATE, NODE_NAMES = "/change_state", "node_names"
PLAYER = "rosbag2_player"
# The node of a build that sends where its robot starts.
START_POSE = "start_pose"


def moves(name: str, type_: str) -> bool:
    """Return whether a topic sets a robot in motion."""
    last = name.rpartition("/")[2]
    return type_ in _ALWAYS or (type_ in _BY_NAME and any(it in last for it in _NAMED))


def is_pose_order(plain: str, type_: str) -> bool:
    """Return whether a topic (without its robot's name) sends a robot somewhere, or says its place."""
    if type_ not in _POSES:
        return False
    bare = plain.strip("/").replace("_", "")
    return bare in _POSE_NAMES or bare.startswith("goalpos")


def is_start_pose(plain: str, type_: str) -> bool:
    """Return whether a topic (without its robot's name) tells a node where the robot starts."""
    return type_ == _POSES[1] and is_pose_order(plain, type_)


def is_order(plain: str, type_: str) -> bool:
    """Return whether a topic (without its robot's name) moves a robot or sends it somewhere."""
    return moves(plain, type_) or is_pose_order(plain, type_)


def kind_of_data(name: str, type_: str) -> str:
    """Return the kind of data that a driver, sensor, map or description sends or obeys, or empty."""
    last = name.rpartition("/")[2]
    if moves(name, type_):
        # A robot has one drive, and arms with as many controllers as its makers thought of.
        return KINDS_OF_DATA.get(type_, "")
    if type_ == MAP:
        return MAP if "map" in name.split("/")[-2:] else ""
    if type_ == _TEXT:
        return DESCRIPTION if is_description(name, type_) else ""
    if type_ == JOINTS and any(it in last for it in _TO_JOINTS):
        return ""
    sensor = type_.startswith("sensor_msgs/") and not type_.startswith(_NO_SENSOR)
    return KINDS_OF_DATA.get(type_, type_) if sensor or type_ == ODOMETRY else ""


def is_of_other_kind(wanted: str, offered: str, sender: str, type_: str) -> bool:
    """Return whether topics are of two sources or places: odometry of wheels and of a GPS."""
    for kinds in _KINDS.values():
        mine, other = _kinds_in(kinds, wanted), _kinds_in(kinds, offered)
        other = other or _kinds_in(kinds, last_word(sender))
        if type_ == ODOMETRY and _WHEELS in kinds.values():
            # A name that says nothing is that of a drive; its reader takes any but that of a GPS.
            mine, other = mine or ({*kinds.values()} - {_GPS}), other or {_WHEELS}
        if mine and other and mine.isdisjoint(other):
            return True
    return False


def _kinds_in(kinds: Mapping[str, str], name: str) -> set[str]:
    return {kinds[it] for it in re.split("[/_]", name) if it in kinds}


def is_description(name: str, type_: str) -> bool:
    """Return whether a topic is that of a robot's description."""
    return type_ == _TEXT and name.endswith(("description", "urdf"))


def is_of_a_body(type_: str) -> bool:
    """Return whether a message type is of one robot's own data: joints, odometry, scans."""
    return type_ in _BODY


def is_of_one_sensor(type_: str) -> bool:
    """Return whether messages of a type come from one device or filter."""
    return type_ in _OF_ONE_SENSOR


def is_of_one_robot(plain: str, type_: str) -> bool:
    """Return whether a topic is one robot's: sensors, odometry, maps, commands, a description."""
    sensors = type_.startswith(_OF_ONE_ROBOT)
    return sensors or moves(plain, type_) or plain.endswith(DESCRIPTION)


def is_never_shared(plain: str, type_: str) -> bool:
    """Return whether one robot's topic may not be that of others: of its body, its orders, its stop."""
    own = is_of_a_body(type_) or is_order(plain, type_) or type_ == JOYSTICK
    return own or plain.endswith(DESCRIPTION) or bool(_STOPS.search(last_word(plain)))


def is_tool(node: str, more: tuple[str, ...] = ()) -> bool:
    """Return whether a full name is a tool's; ``more`` patterns without a slash fit any namespace."""
    word = node.rpartition("/")[2]
    if is_tool_word(word):
        return True
    full, last = _patterns(more)
    return bool(more) and bool(last.fullmatch(word) or full.fullmatch(node))


@lru_cache(maxsize=8)
def _patterns(more: tuple[str, ...]) -> tuple[re.Pattern[str], re.Pattern[str]]:
    """Return two patterns for ``more``: of full names, and of last words."""
    sides = ([p for p in more if "/" in p], [p for p in more if "/" not in p])
    full, last = (re.compile("|".join(map(translate, side)) or "(?!)") for side in sides)
    return full, last


def is_viewer(node: str) -> bool:
    """Return whether a node only shows data, or passes on what a person asks for."""
    return only_looks(last_word(node))


def is_hidden(node: str) -> bool:
    """Return whether a node is of the ``ros2`` command, or hides itself."""
    return last_word(node).startswith("_")


def is_spawner(node: str) -> bool:
    """Return whether a node is a spawner, which loads controllers when their manager is there."""
    return last_word(node).startswith("spawner_")


def last_word(name: str) -> str:
    """Return the last segment of a name."""
    return name.rpartition("/")[2]


def in_namespaces_above(node: str, name: str) -> Iterator[str]:
    """Yield a name directly in a node's namespace, moved to each of the namespaces above."""
    namespace = node.rpartition("/")[0]
    while namespace and name.startswith(f"{namespace}/"):
        rest = name.removeprefix(namespace)
        namespace = namespace.rpartition("/")[0]
        yield namespace + rest
        name = namespace + rest
