"""A system with the look-ups that its rules share, and whose each of its names is."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cache, partial

from multibot_rewrite.record import NamedTuple
from multibot_rewrite.rules import words
from multibot_rewrite.rules.ownership import Whose
from multibot_rewrite.system.conventions import EVERYBODYS, only_looks
from multibot_rewrite.system.records import (
    CALLS,
    OFF,
    PUBLISHES,
    SERVES,
    SUBSCRIBES,
    TOPIC,
    Edge,
    End,
    System,
)

# In the order of the fields of Ends.
_PLACE = {role: at for at, role in enumerate((PUBLISHES, SUBSCRIBES, SERVES, CALLS))}
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


class Index(NamedTuple):
    """A system; ``names`` has the ends of each (kind, name), without hidden ones.

    ``robot`` and ``frame_robot`` have the robot of a node or name and of a frame, empty where it is of
    none or of all; ``plain`` and ``plain_frame`` the name without the robot's. ``nodes`` counts the
    nodes by name. ``topics`` are the topics but tf and what every node has; ``orders`` those by which a
    robot is moved or sent somewhere. ``by_robot`` makes, when it is first asked, the ends of each
    (robot, kind, name without the robot's).
    """

    system: System
    robots: tuple[str, ...]
    robot: Callable[[str], str]
    plain: Callable[[str], str]
    frame_robot: Callable[[str], str]
    plain_frame: Callable[[str], str]
    nodes: Mapping[str, int]
    names: Mapping[tuple[str, str], Ends]
    topics: tuple[Ends, ...]
    orders: Mapping[str, Ends]
    trees: tuple[Tree, ...]
    by_robot: Callable[[], Mapping[tuple[str, str, str], Ends]]

    def of_robot(self, robot: str, kind: str, plain: str) -> Ends | None:
        """The ends of a robot's name, by the name without the robot's."""
        return self.by_robot().get((robot, kind, plain))


def index(system: System, whose: Whose) -> Index:
    """The look-ups, made once."""
    names = {(it.kind, it.name): it for it in _ends(system.ends)}
    topics = [it for it in names.values() if it.kind == TOPIC]
    return Index(
        system,
        *whose,
        Counter(node.name for node in system.nodes),
        names,
        tuple(it for it in topics if it.name not in EVERYBODYS and it.type != TF),
        {it.name: it for it in topics if words.is_order(whose.plain(it.name), it.type)},
        tuple(_trees(system, names.values())),
        cache(partial(_by_robot, whose, names)),
    )


def _by_robot(
    whose: Whose, names: Mapping[tuple[str, str], Ends]
) -> Mapping[tuple[str, str, str], Ends]:
    return {
        (whose.robot(name), kind, whose.plain(name)): ends for (kind, name), ends in names.items()
    }


def _ends(endpoints: Iterable[End]) -> Iterator[Ends]:
    found: dict[tuple[str, str], tuple[list[End], ...]] = {}
    for end in endpoints:
        key = (end.kind, end.name)
        if "/_" in end.name:
            continue
        sides = found.get(key)
        if sides is None:
            sides = found[key] = ([], [], [], [])
        sides[_PLACE[end.role]].append(end)
    for (kind, name), sides in found.items():
        first = next(filter(None, sides))[0]
        yield Ends(kind, name, first.type, *map(tuple, sides))


def _trees(system: System, names: Iterable[Ends]) -> Iterator[Tree]:
    topics: dict[str, list[Ends]] = defaultdict(list)
    edges: dict[str, list[Edge]] = defaultdict(list)
    for ends in names:
        if ends.type == TF:
            topics[tree_topic(ends.name)].append(ends)
    for frame in (it for it in system.edges if it.sure != OFF):
        edges[tree_topic(frame.topic)].append(frame)
    for topic in dict.fromkeys((*edges, *topics)):
        own = topics.get(topic, ())
        heard = (node for frame in edges.get(topic, ()) for node in frame.publishers)
        senders = (*(end.node for it in own for end in it.publishers), *heard)
        listeners = (end.node for it in own if it.name == topic for end in it.subscribers)
        yield Tree(topic, tuple(edges.get(topic, ())), unique(senders), unique(listeners))


def unique(names: Iterable[str]) -> tuple[str, ...]:
    """Each name once, in their order."""
    return tuple(dict.fromkeys(names))


def nodes_of(ends: Iterable[End]) -> tuple[str, ...]:
    """The nodes of some endpoints, each once, in the order of their names."""
    return tuple(sorted({end.node for end in ends}))


def is_viewer(node: str) -> bool:
    """Does the node only look, or pass on what a person asks for?"""
    return only_looks(last_word(node))


def is_hidden(node: str) -> bool:
    """Is it a node of the ``ros2`` command, or another that hides itself?"""
    return last_word(node).startswith("_")


def is_spawner(node: str) -> bool:
    """Does the node load controllers, and wait for a manager until then?"""
    return last_word(node).startswith("spawner_")


def at_work(ends: Iterable[End]) -> list[End]:
    """The endpoints of nodes that do more than look."""
    return [end for end in ends if not is_viewer(end.node)]


def last_word(name: str) -> str:
    """The last segment of a name."""
    return name.rpartition("/")[2]


def robots_of(it: Index, nodes: Iterable[str]) -> tuple[str, ...]:
    """The robots that some nodes belong to, each once.

    A node outside of all that is called as one of theirs is of one more robot, which has no namespace.
    """
    known = unique(nodes)
    robots = unique(filter(None, map(it.robot, known)))
    theirs = {it.plain(node) for node in known if it.robot(node)}
    twins = any(node in theirs for node in known if not it.robot(node))
    return (*robots, NO_NAMESPACE) if twins else robots


def tree_topic(topic: str) -> str:
    """The topic a tree is called after: tf and tf_static of one robot are one tree, ``tf``."""
    return "/".join("tf" if word == "tf_static" else word for word in topic.split("/"))


def and_then(words: Sequence[str]) -> str:
    """``a``, ``a and b``, ``a, b and c``."""
    return " and ".join(filter(None, (", ".join(words[:-1]), *words[-1:])))


def only(robots: Sequence[str]) -> str:
    """The one robot; empty where there are several, or none."""
    return robots[0] if len(robots) == 1 else ""
