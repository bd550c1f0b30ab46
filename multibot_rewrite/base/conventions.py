# SPDX-License-Identifier: Apache-2.0
"""What is everybody's by convention (topics, frames, tools), and words of several packages.

Each row of ``conventions.txt`` has its source. The rows are lines of words and no YAML: the start of
every command reads them, and none pays for a parser."""

import os
import re
from collections.abc import Mapping, Sequence
from functools import cache, lru_cache
from typing import NamedTuple

from multibot_rewrite.base.lazy import lazy_compile


def _rows() -> Mapping[str, Sequence[tuple[list[str], str]]]:
    """Return the table by its parts: of each row the words, and the text behind ``#``."""
    found: dict[str, list[tuple[list[str], str]]] = {}
    name = ""
    with open(os.path.join(os.path.dirname(__file__), "conventions.txt"), encoding="utf-8") as file:
        for line in filter(None, map(str.strip, file)):
            if line.startswith("["):
                name = line.strip("[]")
            elif not line.startswith("#"):
                words, _, behind = line.partition(" # ")
                found.setdefault(name, []).append((words.split(), behind))
    return found


# The rows of the table, by its parts.
ROWS = _rows()

# Who sends a topic, or reads it: every node there is; any node may; some nodes do; a single one.
EVERY, ANY, SOME, ONE = range(4)
_WHO = {"every": EVERY, "any": ANY, "some": SOME, "one": ONE}


class SharedTopic(NamedTuple):
    """A topic that all robots may share; by default a rewrite leaves a ``kept`` one."""

    name: str
    senders: int
    readers: int
    kept: bool
    source: str


TOPICS = tuple(
    SharedTopic(name, _WHO[sends], _WHO[reads], bool(kept), source)
    for (name, sends, reads, *kept), source in ROWS["topics"]
)
CLOCK = "/clock"
# Topics that may be shared; what every node sends, has, may send; what a rewrite leaves.
EVERYBODYS = tuple(it.name for it in TOPICS)
SENT_BY_EVERY_NODE = tuple(it.name for it in TOPICS if it.senders == EVERY)
READ_BY_EVERY_NODE = tuple(it.name for it in TOPICS if it.readers == EVERY)
OF_EVERY_NODE = tuple(it.name for it in TOPICS if EVERY in (it.senders, it.readers))
SENT_BY_ANY_NODE = tuple(it.name for it in TOPICS if it.senders in (EVERY, ANY))
SHARED_TOPICS = tuple(it.name for it in TOPICS if it.kept)
# The kinds of frames by what they are fixed to.
WORLD, START, BODY = range(3)
_FIXED_TO = {"world": WORLD, "start": START, "body": BODY}


class UsualFrame(NamedTuple):
    """A frame that has the same name on most robots.

    It is of the ``WORLD``, which is everybody's, of the ``START`` of one robot, or of its ``BODY``.
    ``expected``: nearly every robot has it."""

    name: str
    fixed_to: int
    expected: bool
    source: str


FRAMES = tuple(
    UsualFrame(name, _FIXED_TO[to], bool(usual), source)
    for (name, to, *usual), source in ROWS["frames"]
)
WORLD_FRAMES = tuple(it.name for it in FRAMES if it.fixed_to == WORLD)
BODY_FRAMES = tuple(it.name for it in FRAMES if it.fixed_to == BODY)
# Frames that nodes send, whatever a description has.
SENT_FRAMES = tuple(it.name for it in FRAMES if it.fixed_to != BODY)
USUAL_FRAMES = tuple(it.name for it in FRAMES if it.expected)


class ToolNode(NamedTuple):
    """Nodes in addition to any fleet, by a pattern; ``looks``: only to observe, so no own sender."""

    pattern: str
    looks: bool
    source: str


# How the names of tf2's listener nodes start; the rest is an address.
LISTENER = "transform_listener_impl_"
# How the name of a node ends that another one makes for its clients: nav2_behavior_tree
# bt_action_server_impl.hpp.
CLIENT = "_rclcpp_node"
TOOLS = tuple(
    ToolNode(pattern.format(listener=LISTENER, client=CLIENT), bool(looks), source)
    for (pattern, *looks), source in ROWS["tools"]
)


# Words for parts of any robot and for what they send.
PARTS = frozenset(word for words, _ in ROWS["parts"] for word in words)


# Nodes of a simulator, one for all robots: gazebo_ros gazebo_ros_init.cpp.
WORLD_NODES = frozenset({"gazebo"})
# Nodes that a person starts, whatever a launch file does: what is built starts none of them.
BY_HAND = ("teleop_twist_keyboard", "rviz2")


def tool_patterns() -> tuple[str, ...]:
    """Return the name patterns of all tools, without those inside another pattern."""
    from fnmatch import fnmatchcase  # few commands ask for a pattern

    every = [it.pattern for it in TOOLS]
    return tuple(
        it for it in every if not any(it != other and fnmatchcase(it, other) for other in every)
    )


# A fleet has a handful of such words, each in many nodes.
@lru_cache(maxsize=4096)
def is_tool_word(word: str) -> bool:
    """Return whether a node of this name is a tool, in whatever namespace."""
    return _pattern_of_any(tuple(it.pattern for it in TOOLS)).fullmatch(word) is not None


@lru_cache(maxsize=4096)
def only_looks(word: str) -> bool:
    """Return whether a node of this name only observes, or passes on what a person asks for."""
    return (
        _pattern_of_any(tuple(it.pattern for it in TOOLS if it.looks)).fullmatch(word) is not None
    )


@cache
def _pattern_of_any(patterns: tuple[str, ...]) -> re.Pattern[str]:
    from fnmatch import translate

    return re.compile("|".join(map(translate, patterns)))


def types_of(word: str) -> tuple[str, ...]:
    """Return the message types, or their beginnings, that a convention lists for this word."""
    return tuple(type_ for (type_, *said), _ in ROWS["types"] if word in said)


# Data of one kind: a reader of one type may have meant the other.
KINDS_OF_DATA = {
    type_: it[1:] for (type_, *said), _ in ROWS["types"] for it in said if it[0] == "="
}
FRAMES_OF_SENSORS = {type_: tuple(words) for (type_, *words), _ in ROWS["frames of sensors"]}
# Nodes that compare the time of messages with their own clock.
TIMED = tuple(word for words, _ in ROWS["timed"] for word in words)
FILES = {kind: said.split(" | ") for (kind,), said in ROWS["kinds of files"]}
NAME_SEPARATORS = {kind: mark for (kind, mark), _ in ROWS["separators"]}
TF_SWITCHES, STAMP_SWITCHES = "tf switches", "stamp switches"


def switches(kind: str) -> Mapping[str, tuple[str, ...]]:
    """Return the parameters that switch ``kind``, such as tf, each with patterns of its nodes."""
    return {name: tuple(nodes) for (name, *nodes), _ in ROWS[kind]}


def switch(kind: str, node: str) -> str:
    """Return a node's parameter that switches ``kind``; empty where none is known."""
    last = node.rpartition("/")[2]
    found = (
        name for name, nodes in switches(kind).items() if _pattern_of_any(nodes).fullmatch(last)
    )
    return next(found, "")


# Topics of a robot's body: two of them are enough, or one of tf.
OF_A_ROBOT = tuple(word for words, _ in ROWS["of a robot"] for word in words)


# Topics and services that nodes read and no robot need send, by the last word, and who does.
FROM_OUTSIDE = {who: tuple(words) for words, who in ROWS["from outside"]}
_OUTSIDE = frozenset(word for words in FROM_OUTSIDE.values() for word in words)


def is_from_outside(name: str) -> bool:
    """Return whether a topic or service is one that no node of a robot needs to send."""
    return name.rpartition("/")[2] in _OUTSIDE


# Nodes that send one after another, by an order among themselves: as many as one sender.
TEAMS = {name: tuple(nodes) for nodes, name in ROWS["teams"]}
# Between several senders and a robot: they choose one.
_CHOOSES = lazy_compile(r"mux|prioriti|arbit|selector|switch|twist_manager")


@lru_cache(maxsize=4096)
def team(node: str) -> str:
    """Return the name of the team of nodes that take turns; a node without one is its own."""
    last = node.rpartition("/")[2]
    return next(
        (name for name, nodes in TEAMS.items() if _pattern_of_any(nodes).fullmatch(last)), node
    )


def chooses(node: str) -> bool:
    """Return whether the node chooses between several senders, like twist_mux."""
    return bool(_CHOOSES.search(node.rpartition("/")[2]))


# Words that stand for a robot where a launch file fills them in, between <>, $() or ${}: nav2_common
# ReplaceString (<robot_namespace>), husarion_ugv_ros (<namespace>/), launch_ros ParameterFile
# ($(var namespace)), turtlebot3_description (${namespace}). The second ones are prefixes of frames.
PREFIX_WORDS = ("tf_prefix", "frame_prefix", "prefix")
ROBOT_WORDS = (
    "robot_namespace", "robot_name", "robot_ns", "namespace", "ns", "robot", *PREFIX_WORDS,
)  # fmt: skip
# What a launch file or a script fills in, in a name.
PLACEHOLDER = lazy_compile(r"[<{$%]")
