# SPDX-License-Identifier: Apache-2.0
"""What nodes wait for in vain while their robot has it under another name: by what it is."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence, Set
from functools import cache, partial

from multibot_rewrite.base.conventions import chooses, is_from_outside, team, types_of
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.nearest import nearest
from multibot_rewrite.system import words
from multibot_rewrite.system.index import Ends, Index, at_work, ends_of, once, spaces
from multibot_rewrite.system.records import CALLS, PUBLISHES, RUNS, SERVICE, SUBSCRIBES, End
from multibot_rewrite.system.words import is_viewer, last_word

_DIGITS = lazy_compile(r"_?\d+")
# So alike that it is a slip: cmd_vel_smoth, not cmd_vel_ui beside cmd_vel_nav.
_SLIP = 0.85
MANAGER, _CHANGE = "lifecycle_manager", ("/change_state", "/get_state")
# Every node serves them, or many do: another one of such a type says nothing.
COMMON = types_of("common")
# Of such a type are many topics that have nothing to do with each other.
_PLAIN_TYPES = "std_"
# Such messages are sent for many ends: the name has to say which.
_PLAIN_DATA = ("std_msgs/", "geometry_msgs/", "visualization_msgs/")
# Shorter words of a name, and these, say nothing of what it is.
_SAYING = 4
_OF_ALL = frozenset({"data", "state", "status", "pose", "info", "robot", "topic"})
# Of which the name says what they are for.
_TRIGGERS = "std_srvs/"


def sent_instead(seen: Index, end: End) -> Ends | None:
    """Return the robot's topic or service that a node may have meant by an end; None for none."""
    if end.sure != RUNS:
        return None
    if known := meant(seen, end):
        return known
    # Where nodes may run that are not known, one of them may send it, or read the other.
    if seen.in_doubt or is_viewer(end.node) or not end.type:
        return None
    if end.role == CALLS:
        # The one with the likest name.
        given = {it.name: it for it in _served(seen, end)}
        return given.get(nearest(end.name, given, alike=0.0)) or next(iter(given.values()), None)
    if end.role != SUBSCRIBES or chooses(end.node):
        return None
    return _topic_with_data(seen, end) or _unread_topic(seen, end)


def _unread_topic(seen: Index, end: End) -> Ends | None:
    """Return the robot's one unread topic of the end's type, or with a word in common; or None."""
    robot = seen.robot(end.name)
    # Does its node read the same of another robot, from which it comes?
    others = _names_read(seen).get((end.node, end.kind, end.type), set()) - {end.name}
    merges = others and not any(
        it.name != end.name and seen.plain(it.name) == seen.plain(end.name)
        for it in seen.by_node[end.node]
        if it.role == SUBSCRIBES and it.name in seen.published
    )
    if seen.robot(end.node) not in ("", robot):
        return None
    given = [
        it
        for it in _unread(seen).get((end.type, robot), ())
        if last_word(end.node) not in (last_word(one.node) for one in it.publishers)
        and _DIGITS.sub("", it.name) != _DIGITS.sub("", end.name)
        and not _waits_itself(seen, it, end)
    ]
    begins = [it for it in given if _begin_alike(seen.plain(it.name), seen.plain(end.name))]
    if merges:
        return _only_one(seen, begins, end)
    akin = [it for it in given if _telling_words(seen, it.name) & _telling_words(seen, end.name)]
    akin = akin or begins
    plain = end.type.startswith(_PLAIN_DATA) or end.name.startswith(f"{end.node}/")
    plain = plain or is_from_outside(end.name)
    return _only_one(seen, akin, end) or (None if plain else _only_one(seen, given, end))


def _waits_itself(seen: Index, ends: Ends, end: End) -> bool:
    """Return whether a topic is made from the missing one, or from others of its type."""
    readers = _readers(seen)(end.name, end.type)
    return bool(ends.publishers) and readers.issuperset(it.node for it in ends.publishers)


@once
def _readers(seen: Index) -> Callable[[str, str], frozenset[str]]:
    """Return a function that returns the nodes which read a topic, directly or not."""
    return cache(partial(_readers_of, seen))


def _readers_of(seen: Index, name: str, type_: str) -> frozenset[str]:
    """Return the nodes that read a topic, and those that read what these make of it."""
    readers: set[str] = set()
    names = [name]
    for it in names:
        own = {one.node for one in ends_of(seen, it) if one.role == SUBSCRIBES} - readers
        readers |= own
        sent = (one for node in own for one in seen.by_node[node] if one.role == PUBLISHES)
        names += [one.name for one in sent if one.type == type_]
    return frozenset(readers)


def _is_costmap(ends: Ends) -> bool:
    """Return whether costmaps of Nav2 publish it: no map for another node (nav2_costmap_2d's names)."""
    made = {last_word(one.node) for one in ends.publishers} <= {"local_costmap", "global_costmap"}
    return made and ends.type == "nav_msgs/msg/OccupancyGrid"


@once
def _unread(seen: Index) -> Mapping[tuple[str, str], Sequence[Ends]]:
    """Return topics that nodes at work send and no node at work reads, by type and robot."""
    found: dict[tuple[str, str], list[Ends]] = defaultdict(list)
    for it in seen.topics:
        senders = [one for one in at_work(it.publishers) if team(one.node) == one.node]
        senders = [one for one in senders if not chooses(one.node)]
        if senders and not at_work(it.subscribers):
            found[it.type, seen.robot(it.name)].append(it)
    return found


def _begin_alike(one: str, other: str) -> bool:
    """Return whether the last word of one is the beginning of the other's: joy, joystick."""
    short, long = sorted((last_word(one), last_word(other)), key=len)
    return long.startswith(short)


def _telling_words(seen: Index, name: str) -> set[str]:
    """Return the words of a name that say what it is."""
    return {it for it in re.split(r"[/_]", seen.plain(name)) if len(it) >= _SAYING} - _OF_ALL


def _topic_with_data(seen: Index, end: End) -> Ends | None:
    """Return the topic with an end's data: an unread one; for sensor data also one that others read."""
    # Such as a footprint, which a person may send.
    by_hand = "teleop" in last_word(end.name) or not words.moves(end.name, end.type)
    outside = is_from_outside(end.name) and by_hand
    kind = words.kind_of_data(end.name, end.type)
    # What a node has below its own name is for whoever calls it by that: servo, a controller.
    if end.name.startswith(f"{end.node}/") or (outside and kind != words.DESCRIPTION):
        return None
    # One that merges need not have all; what is not the robot's own may be of nobody's.
    others = _names_read(seen).get((end.node, end.kind, end.type), set()) - {end.name}
    if others or seen.robot(end.name) != seen.robot(end.node):
        return None
    mine = seen.robot(end.node) or seen.robot(end.name)
    sent = _sent(seen).get((kind, mine), ()) if kind else ()
    given = [it for it in sent if _is_offered(seen, it, end)]
    # A second camera that is off is no other name of the first one.
    given = [it for it in given if _DIGITS.sub("", it.name) != _DIGITS.sub("", end.name)]
    unread = [it for it in given if not at_work(it.subscribers)]
    # Joints come from several nodes, and a node that merges them need not have all.
    several = words.JOINTS in (kind, end.type) and not seen.publishes_description(end.node)
    akin = [it for it in unread if _telling_words(seen, it.name) & _telling_words(seen, end.name)]
    unread = akin if len(akin) == 1 else unread
    same = [it for it in given if it.type == end.type and words.is_of_a_body(end.type)]
    left = given if several and unread else unread or ([] if several else same)
    return _only_one(seen, left, end)


@once
def _names_read(seen: Index) -> Mapping[tuple[str, str, str], Set[str]]:
    """Return the names of a kind and type that a node reads and somebody sends."""
    found: dict[tuple[str, str, str], set[str]] = defaultdict(set)
    for ends in seen.by_name.values():
        for it in ends.subscribers if ends.publishers else ():
            found[it.node, it.kind, it.type].add(it.name)
    return found


def _only_one(seen: Index, given: Sequence[Ends], end: End) -> Ends | None:
    """Return the only topic, or the only one of the end's kind; None unless there is just one."""
    fitting = [it for it in given if not is_of_another_kind(seen, end, it)] or given
    return fitting[0] if len(fitting) == 1 else None


def is_of_another_kind(seen: Index, end: End, ends: Ends) -> bool:
    """Return whether a topic is from another source or place than the one that an end reads."""
    sender = (*ends.publishers, *ends.servers)[0].node
    wanted, offered, sender = map(seen.plain, (end.name, ends.name, sender))
    return words.is_of_other_kind(wanted, offered, sender, end.type)


def _is_offered(seen: Index, ends: Ends, end: End) -> bool:
    """Return whether another node of the robot sends a topic that this node does not read yet."""
    if any(it.node == end.node for it in ends.subscribers) or _waits_itself(seen, ends, end):
        return False
    robot = seen.robot(end.node) or seen.robot(end.name)
    commands = words.moves(ends.name, ends.type)
    return any(
        last_word(it.node) != last_word(end.node)
        and seen.robot(it.node) == robot
        and (not chooses(it.node) if commands else team(it.node) == it.node)
        for it in at_work(_givers(ends))
    )


@once
def _sent(seen: Index) -> Mapping[tuple[str, str], Sequence[Ends]]:
    """Return the topics with a publisher, by kind of data and the publishers' robots."""
    found: dict[tuple[str, str], list[Ends]] = defaultdict(list)
    for it in seen.topics:
        kind = words.kind_of_data(it.name, it.type) if it.publishers else ""
        for robot in {seen.robot(one.node) for one in it.publishers} if kind else ():
            found[kind, robot].append(it)
    return found


def _served(seen: Index, end: End) -> Iterator[Ends]:
    """Yield the robot's services and actions of the end's type that nobody calls."""
    robot, last = seen.robot(end.node) or seen.robot(end.name), last_word(end.name)
    for it in _servers(seen).get((end.kind, end.type, robot), ()):
        own = any(one.node != end.node and seen.robot(one.node) == robot for one in it.servers)
        common = end.type.startswith(COMMON)
        same = last == last_word(it.name) or _telling_words(seen, it.name) == _telling_words(
            seen, end.name
        )
        alike = end.type.startswith(_TRIGGERS) and same
        if own and not at_work(it.clients) and (alike or not common):
            yield it


@once
def _servers(seen: Index) -> Mapping[tuple[str, str, str], Sequence[Ends]]:
    """Return what is served, by kind, type and the servers' robots."""
    found: dict[tuple[str, str, str], list[Ends]] = defaultdict(list)
    for it in seen.by_name.values():
        for robot in {seen.robot(one.node) for one in it.servers}:
            found[it.kind, it.type, robot].append(it)
    return found


@once
def _served_by_nobody(seen: Index) -> Mapping[tuple[str, str, str], Sequence[Ends]]:
    """Return what is served under a name without a robot, by kind, type and last word."""
    found: dict[tuple[str, str, str], list[Ends]] = defaultdict(list)
    for it in seen.by_name.values():
        if it.servers and not seen.robot(it.name):
            found[it.kind, it.type, last_word(it.name)].append(it)
    return found


def in_other_namespace(seen: Index, end: End) -> str:
    """Return the service that a client misses by a namespace too many or too few; empty for none."""
    known = _served_by_nobody(seen).get((end.kind, end.type, last_word(end.name)), ())
    for it in () if seen.robot(end.name) else known:
        short, long = sorted((it.name, end.name), key=len)
        space = long.removesuffix(short)
        if space != long and space not in spaces(seen) and space not in seen.nodes:
            return it.name
    return ""


def listed_in_vain(seen: Index, end: End) -> str:
    """Return the node that a lifecycle manager lists and nothing starts; empty for none."""
    node = end.name.rpartition("/")[0]
    manager = end.kind == SERVICE and last_word(end.node).startswith(MANAGER)
    return node if manager and end.name.endswith(_CHANGE) and node not in seen.nodes else ""


def is_needed(end: End) -> bool:
    """Return whether something of the robot must give an end; a chooser seldom has all inputs."""
    by_code = end.role in (SUBSCRIBES, CALLS) and end.code_name and end.sure == RUNS
    outside = is_from_outside(end.name) or is_from_outside(end.code_name)
    idle = is_viewer(end.node) or (end.role == SUBSCRIBES and chooses(end.node))
    return bool(by_code) and not outside and not idle


def meant(seen: Index, end: End) -> Ends | None:
    """Return what was meant by an end: its type, and its last word or the likest name; or None."""
    if (key := (meant, end)) not in seen.memo:
        seen.memo[key] = _likest(seen, end)
    found: Ends | None = seen.memo[key]
    return found


def _likest(seen: Index, end: End) -> Ends | None:
    mux = end.role == SUBSCRIBES and chooses(end.node)
    if not (is_needed(end) or (mux and end.code_name)) or not end.type:
        return None
    given = _sent_or_served(seen)
    own = {"", seen.robot(end.node)}
    same = {at: it for one in own for at, it in given.get((end.kind, end.type, one), ())}
    likely = [same[at] for at in sorted(same) if _may_be(seen, same[at], end)]
    likely = [it for it in likely if not _waits_itself(seen, it, end)]
    fitting = [it for it in likely if not is_of_another_kind(seen, end, it)]
    alike = {it.name: it for it in fitting or likely}
    if end.type.startswith(_PLAIN_TYPES):
        # What their names in the code have in common counts, not the robot's namespace.
        words = {last_word(one.code_name): it for it in alike.values() for one in _givers(it)}
        return words.get(nearest(last_word(end.code_name), words))
    last = [name for name in alike if name.endswith(f"/{last_word(end.name)}")]
    if mux:  # idle, unless it is misspelt
        words_of = {last_word(seen.plain(it)): it for it in alike}
        near = nearest(last_word(seen.plain(end.name)), words_of, alike=_SLIP)
        return alike.get(words_of.get(near, ""))
    if end.type.startswith(_PLAIN_DATA) and not last:
        own_words = _telling_words(seen, end.name)
        alike = {name: it for name, it in alike.items() if own_words & _telling_words(seen, name)}
    return alike.get(nearest(end.name, last or alike, alike=0.0))


@once
def _sent_or_served(seen: Index) -> Mapping[tuple[str, str, str], list[tuple[int, Ends]]]:
    """Return what is sent or served, with its position, by kind, type and sending robot."""
    found: dict[tuple[str, str, str], list[tuple[int, Ends]]] = defaultdict(list)
    for at, it in enumerate(seen.by_name.values()):
        givers = () if _is_costmap(it) else _givers(it)
        for robot in {seen.robot(one.node) for one in givers}:
            found[it.kind, it.type, robot].append((at, it))
    return found


def _may_be(seen: Index, ends: Ends, end: End) -> bool:
    """Return whether another node, of the robot or of none, sends what this node does not read yet."""
    if any(it.node == end.node for it in (*ends.subscribers, *ends.clients)):
        return False
    own, twin = seen.robot(end.node), last_word(end.node)
    named, sensor = own and seen.robot(ends.name), end.type.startswith("sensor_msgs/")
    senders = [it.node for it in _givers(ends) if not sensor or team(it.node) == it.node]
    # A node of the same name elsewhere does the same for another robot.
    robots = {seen.robot(node) or named for node in senders if last_word(node) != twin}
    return not robots.isdisjoint(("", own))


def _givers(ends: Ends) -> list[End]:
    """Return the ends that surely send or serve a name."""
    return [it for it in (*ends.publishers, *ends.servers) if it.sure == RUNS]
