# SPDX-License-Identifier: Apache-2.0
"""A system with the look-ups that its rules share, and whose each of its names is."""

from collections import Counter, defaultdict
from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence, Set
from functools import wraps
from typing import Any, NamedTuple, TypeVar, cast

from multibot_rewrite.base.conventions import EVERYBODYS
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.wording import unique
from multibot_rewrite.system import words
from multibot_rewrite.system.ownership import NameOwnership, Whose
from multibot_rewrite.system.records import (
    CALLS,
    KINDS,
    OFF,
    PUBLISHES,
    SERVES,
    SUBSCRIBES,
    TOPIC,
    UNKNOWN_NODES,
    Edge,
    End,
    Node,
    Robot,
    System,
    incomplete,
    may_miss,
    nodes_by_robot,
    surely,
)
from multibot_rewrite.system.tf_copies import copying_nodes, tree_topic
from multibot_rewrite.system.words import is_tool, is_viewer, last_word

# In the order of the fields of Ends.
_PLACE = {role: at for at, role in enumerate((PUBLISHES, SUBSCRIBES, SERVES, CALLS))}
NO_COUNTS: Mapping[str, int] = {}
# Node, kind, role and name of an end.
EndKey = tuple[str, str, str, str]
_Look = TypeVar("_Look", bound=Callable[..., Any])
TF = "tf2_msgs/msg/TFMessage"
NO_NAMESPACE = "the robot without a namespace"


class Ends(NamedTuple):
    """The ends of one name and kind, by what their nodes do.

    ``type`` is that of the name, where its ends agree on one; else the type of the first end.
    """

    kind: str
    name: str
    type: str
    publishers: tuple[End, ...]
    subscribers: tuple[End, ...]
    servers: tuple[End, ...]
    clients: tuple[End, ...]


class Tree(NamedTuple):
    """The transforms on a tf topic and its tf_static; ``topic`` is the tf topic.

    ``senders`` are the nodes that publish there: a transform does not say which of them sent it.
    ``listeners`` subscribe to the tf topic.
    """

    topic: str
    edges: tuple[Edge, ...]
    senders: tuple[str, ...]
    listeners: tuple[str, ...]


class Sent(NamedTuple):
    """A transform that a node sends by the plan."""

    node: str
    parent: str
    child: str

    def __str__(self) -> str:
        return f"{self.parent} -> {self.child}"


class Known(NamedTuple):
    """What else is known: ``messages`` in ``seconds``; the system ``before``, if that is the plan."""

    messages: Mapping[str, int] = NO_COUNTS
    seconds: float = 0.0
    before: System | None = None


NOTHING_KNOWN = Known()


def once(make: _Look) -> _Look:
    """Decorate a property: its value is made when first asked for, the last index asked keeps it."""

    @wraps(make)
    def found(*indices: Any) -> Any:
        memo = indices[-1].memo
        if make not in memo:
            memo[make] = make(*indices)
        return memo[make]

    return cast(_Look, found)


class Index(NamedTuple):
    """A system, seen or planned, with its look-ups, each made when it is first asked.

    ``robot`` and ``frame_robot`` have the robot of a node or name and of a frame, empty where it is of
    none or of all; ``plain`` and ``plain_frame`` the name without the robot's; ``of_names`` and
    ``of_frames`` are how a plan has it. ``known`` is what is known besides. ``memo`` is filled while
    rules look (``once``). ``expected`` is its plan, where there is one.
    """

    system: System
    robots: tuple[str, ...]
    robot: Callable[[str], str]
    plain: Callable[[str], str]
    frame_robot: Callable[[str], str]
    plain_frame: Callable[[str], str]
    of_names: NameOwnership
    of_frames: NameOwnership
    known: Known
    memo: dict[object, Any]
    expected: "Index | None" = None

    @property
    @once
    def sure(self) -> "Index":
        """The index without the ends that exist only on a condition."""
        system = surely(self.system)
        return self if system is self.system else self._replace(system=system, memo={})

    @property
    @once
    def nodes(self) -> Mapping[str, int]:
        """How many nodes have each name."""
        return Counter(node.name for node in self.system.nodes)

    @property
    @once
    def node(self) -> Mapping[str, Node]:
        """The last node of each name."""
        return {it.name: it for it in self.system.nodes}

    @property
    @once
    def own(self) -> Mapping[str, Sequence[str]]:
        """The nodes that a plan has for each robot, and for all (empty name)."""
        return nodes_by_robot(self.system)

    @property
    @once
    def robot_of(self) -> Mapping[str, str]:
        """The robot of each node that a plan has for one."""
        return {it.name: it.robot for it in self.system.nodes if it.robot}

    @property
    @once
    def may_miss(self) -> Set[str]:
        """The nodes that need not run: on a condition, or because another one may run instead."""
        return {it.name for it in self.system.nodes if may_miss(it)}

    @property
    @once
    def declared(self) -> Mapping[str, Robot]:
        """The record of each robot of a plan, by name."""
        return {it.name: it for it in self.system.robots}

    @property
    @once
    def frames_of(self) -> Mapping[str, Set[str]]:
        """The frames that each planned robot has, or may have."""
        return {it.name: {*it.frames, *it.other_frames} for it in self.system.robots}

    @property
    @once
    def sent(self) -> Sequence[Sent]:
        """The transforms that a plan has, each with the node that sends it."""
        return [
            Sent(node, it.parent, it.child) for it in self.system.edges for node in it.publishers
        ]

    @property
    @once
    def by_key(self) -> Mapping[EndKey, End]:
        """The last end with each node, kind, role and name; hidden ones, too."""
        return {(it.node, it.kind, it.role, it.name): it for it in self.system.ends}

    @property
    @once
    def by_node(self) -> Mapping[str, Sequence[End]]:
        """The ends of each node; hidden ones, too."""
        return lists_by_key((end.node, end) for end in self.system.ends)

    @property
    @once
    def by_name(self) -> Mapping[tuple[str, str], Ends]:
        """The ends of each kind and name, without hidden ones."""
        found: dict[tuple[str, str], tuple[list[End], ...]] = {}
        for end in self.system.ends:
            if "/_" in end.name:
                continue
            key = end.kind, end.name
            if key not in found:
                found[key] = ([], [], [], [])
            found[key][_PLACE[end.role]].append(end)
        return {
            key: Ends(*key, next(filter(None, sides))[0].type, *map(tuple, sides))
            for key, sides in found.items()
        }

    def ends_at(self, kind: str, name: str) -> Ends:
        """Return the ends of a kind and name; without ends for an unknown name."""
        return self.by_name.get((kind, name)) or Ends(kind, name, "", (), (), (), ())

    @property
    @once
    def topics(self) -> Sequence[Ends]:
        """The topics but tf and what every node has."""
        found = (it for it in self.by_name.values() if it.kind == TOPIC and it.type != TF)
        return [it for it in found if it.name not in EVERYBODYS]

    @property
    @once
    def orders(self) -> Mapping[str, Ends]:
        """The topics by which a robot is moved or sent somewhere."""
        found = (it for it in self.by_name.values() if it.kind == TOPIC)
        return {it.name: it for it in found if words.is_order(self.plain(it.name), it.type)}

    @property
    @once
    def trees(self) -> Sequence[Tree]:
        """The transforms by their tf topic."""
        topics = lists_by_key(
            (tree_topic(it.name), it) for it in self.by_name.values() if it.type == TF
        )
        known = (it for it in self.system.edges if "/_" not in it.topic and it.sure != OFF)
        edges = lists_by_key((tree_topic(it.topic), _without_slash(it)) for it in known)
        found = []
        for topic in dict.fromkeys((*edges, *topics)):
            own, heard = topics[topic], (node for it in edges[topic] for node in it.publishers)
            senders = (*(end.node for it in own for end in it.publishers), *heard)
            listeners = (end.node for it in own if it.name == topic for end in it.subscribers)
            found.append(Tree(topic, tuple(edges[topic]), unique(senders), unique(listeners)))
        return found

    @property
    @once
    def published(self) -> Set[str]:
        """The topics that somebody publishes."""
        found = self.by_name.items()
        return {name for (kind, name), ends in found if kind == TOPIC and ends.publishers}

    def of_robot(self, robot: str, kind: str, plain: str) -> Ends | None:
        """Return the ends of a robot's name, by the name without the robot's; None without."""
        return _ends_by_robot(self).get((robot, kind, plain))

    @property
    @once
    def is_live(self) -> bool:
        """Return whether the system was seen running, and not read from launch files."""
        return not any(it.place.file for it in self.system.nodes)

    @property
    @once
    def is_observed(self) -> bool:
        """Return whether the system was seen running, and no source says what its nodes do."""
        return self.is_live and not any(it.known for it in self.system.nodes)

    @property
    def in_doubt(self) -> bool:
        """Return whether nodes may run that no source names, such as a driver."""
        return any(it.code == UNKNOWN_NODES for it in self.system.environment.caveats)

    @property
    def nobody(self) -> str:
        """Return ``no node``, or ``no known node`` if nodes may be missing in the view."""
        return "no known node" if incomplete(self.system) else "no node"

    def is_tool(self, node: str) -> bool:
        """Return whether the node is no robot's, but one that comes and goes with any."""
        plan = self.expected
        if plan is None:
            # /amcl_bridge of a robot called bridge is none.
            return is_tool(self.plain(node))
        return node not in plan.robot_of and is_tool(node, plan.system.ignored_nodes)

    def publishes_description(self, node: str) -> bool:
        """Return whether the node is robot_state_publisher."""
        return last_word(self.plain(node)).startswith("robot_state_publisher")

    @property
    @once
    def home(self) -> Mapping[str, str]:
        """The tf topic that the plan has for each robot."""
        robots = self.expected.system.robots if self.expected else ()
        return {it.name: tree_topic(it.tf_topic) for it in robots}

    @property
    @once
    def senders(self) -> Mapping[tuple[str, str], tuple[str, ...]]:
        """The nodes that send each transform (parent, child) by the plan."""
        found: dict[tuple[str, str], tuple[str, ...]] = defaultdict(tuple)
        for it in self.expected.sent if self.expected else ():
            found[it.parent, it.child] += (it.node,)
        return found

    @property
    @once
    def relays(self) -> Container[str]:
        """The nodes that send their robot's tf elsewhere as well, by the plan."""
        return copying_nodes(self.expected.system) if self.expected else ()


def index(system: System, whose: Whose, known: Known = NOTHING_KNOWN) -> Index:
    """Return a system with its look-ups."""
    return Index(system, *whose, known, {})


def beside(
    plan: Index,
    graph: System,
    messages: Mapping[str, int] = NO_COUNTS,
    before: System | None = None,
) -> Index:
    """Return the index of a system with its plan, which says whose each name is."""
    known = Known(messages, graph.environment.seconds, before)
    return plan._replace(system=graph, known=known, memo={}, expected=plan)


@once
def _ends_by_robot(it: Index) -> Mapping[tuple[str, str, str], Ends]:
    """Return the ends by robot, kind and name without the robot's."""
    return {
        (it.robot(name), kind, it.plain(name)): ends for (kind, name), ends in it.by_name.items()
    }


@once
def spaces(it: Index) -> Set[str]:
    """Return all namespaces that have a node in them or below them."""
    found: set[str] = set()
    for space in it.nodes:
        while (space := space.rpartition("/")[0]) and space not in found:
            found.add(space)
    return found


def ends_of(it: Index, name: str) -> Iterator[End]:
    """Return all ends of a name, of any kind."""
    return (end for kind in KINDS for side in it.ends_at(kind, name)[3:] for end in side)


def _without_slash(frame: Edge) -> Edge:
    """Return an edge without slashes in front of frames, as tf2 (buffer_core.cpp stripSlash)."""
    if not (frame.child.startswith("/") or frame.parent.startswith("/")):
        return frame
    child, parent = (it.removeprefix("/") for it in (frame.child, frame.parent))
    return frame._replace(child=child, parent=parent)


def nodes_of(ends: Iterable[End]) -> tuple[str, ...]:
    """Return the nodes of some ends, each once, in the order of their names."""
    return tuple(sorted({end.node for end in ends}))


def at_work(ends: Iterable[End]) -> list[End]:
    """Return the ends without those of viewers."""
    return [end for end in ends if not is_viewer(end.node)]


def sent_on(it: Index, topic: str) -> tuple[str, tuple[str, ...]]:
    """Return (type of a topic, nodes that publish it and are no viewers); empty without."""
    ends = it.ends_at(TOPIC, topic)
    return ends.type, nodes_of(at_work(ends.publishers))


def robots_of(it: Index, nodes: Iterable[str]) -> tuple[str, ...]:
    """Return the robots of some nodes, and NO_NAMESPACE if one of none is called like one of theirs."""
    known, memo = unique(nodes), it.memo.setdefault(robots_of, {})
    # All nodes that send tf are asked for with each of their frames.
    if known not in memo:
        robots = unique(filter(None, map(it.robot, known)))
        theirs = {it.plain(node) for node in known if it.robot(node)}
        twins = any(node in theirs for node in known if not it.robot(node))
        memo[known] = (*robots, NO_NAMESPACE) if twins else robots
    found: tuple[str, ...] = memo[known]
    return found
