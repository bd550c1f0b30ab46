"""Frozen records of the remap table: what nodes ask for, the rules they get, where names lead."""

from __future__ import annotations

from typing import NamedTuple

TOPIC, SERVICE, ACTION = "topic", "service", "action"
KINDS = (TOPIC, SERVICE, ACTION)
PUBLISHES, SUBSCRIBES, SERVES, CALLS = "publishes", "subscribes", "serves", "calls"
ROLES = (PUBLISHES, SUBSCRIBES, SERVES, CALLS)


class Endpoint(NamedTuple):
    """A topic, service or action as a node's code asks for it, before any rule.

    ``name`` is relative, absolute or private (``~/x``). ``transport`` is true for an image topic,
    which brings its image_transport siblings. ``fixed`` says why no rule reaches it; else empty.
    ``parameter`` is the node parameter that sets the name, if one does.
    ``also`` are other types it has, by parameter or release. ``when`` is the condition under which
    it is there, empty for always. ``helper`` tells that a helper node with a name of its own asks
    for it, in the same process: a rule for the whole process reaches it, one for this node does
    not. ``remapped`` is what the stack's usual launch file makes of the name by a rule of its own:
    a table's rule has to lead there, since only the first match counts.
    """

    kind: str
    role: str
    name: str
    type: str = ""
    transport: bool = False
    parameter: str = ""
    fixed: str = ""
    note: str = ""
    also: tuple[str, ...] = ()
    when: str = ""
    helper: bool = False
    remapped: str = ""


class FrameParameter(NamedTuple):
    """A parameter that holds a frame id, which no remap rule reaches, and its default."""

    parameter: str
    default: str


class NodeFacts(NamedTuple):
    """What is known of a node: its default name, its package, and what it asks for.

    A name with slashes is a node in a namespace of its own below the robot's, as costmaps are.
    ``shared`` tells that one node serves all robots (a bridge, RViz, a clock). ``host`` is the node
    whose process it always runs in. ``when`` is the condition under which it is started, empty for
    always. ``frames`` and ``fixed`` are what no rule reaches beside the endpoints. ``sends`` are the
    transforms it sends, as the parameters that hold parent and child.
    """

    name: str
    package: str
    endpoints: tuple[Endpoint, ...]
    shared: bool = False
    note: str = ""
    host: str = ""
    when: str = ""
    frames: tuple[FrameParameter, ...] = ()
    fixed: tuple[str, ...] = ()
    sends: tuple[tuple[str, str], ...] = ()


class NodeRule(NamedTuple):
    """One remap rule of one robot's node, as rcl takes it: ``source:=target``.

    ``node`` is the stack's name of it, without the robot; ``kind`` is that of the name it is for,
    empty where only the rule is known; ``why`` says what would go wrong without it.
    """

    robot: str
    node: str
    source: str
    target: str
    kind: str
    why: str


class ResolvedName(NamedTuple):
    """Where an endpoint of a robot's node leads once the rules are in force.

    ``node`` and ``name`` are fully qualified.
    """

    robot: str
    node: str
    endpoint: Endpoint
    name: str


class Problem(NamedTuple):
    """What a table cannot do or does wrongly; an error means two robots would meet."""

    code: str
    level: str
    robot: str
    node: str
    message: str
    hint: str


class NodeTable(NamedTuple):
    """One node of one robot: its namespace and name, and its rules in the order they are given."""

    robot: str
    node: str
    namespace: str
    name: str
    rules: tuple[NodeRule, ...]


class Table(NamedTuple):
    """The table of a fleet."""

    layout: str
    nodes: tuple[NodeTable, ...]
    names: tuple[ResolvedName, ...]
    problems: tuple[Problem, ...]
