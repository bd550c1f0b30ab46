# SPDX-License-Identifier: Apache-2.0
"""Equal robots compared: the nodes, ends and messages that one lacks and its likes have."""

import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from itertools import combinations
from typing import NamedTuple

from multibot_rewrite.base.conventions import EVERYBODYS, SENT_FRAMES, chooses
from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.grouping import dicts_by_key, lists_by_key
from multibot_rewrite.base.wording import SEVERAL, shorten
from multibot_rewrite.producers.bags.recording import is_recorded
from multibot_rewrite.rules.declaration import system_rule
from multibot_rewrite.system import words
from multibot_rewrite.system.index import TF, Ends, Index, at_work, ends_of, nodes_of, once
from multibot_rewrite.system.records import (
    ACTION,
    CALLS,
    PUBLISHES,
    RUNS,
    SERVES,
    SUBSCRIBES,
    TOPIC,
    Edge,
    End,
)
from multibot_rewrite.system.words import is_viewer, last_word

# Fewer nodes in common say nothing.
_ENOUGH = 3
_OTHER_SIDE = {PUBLISHES: SUBSCRIBES, SUBSCRIBES: PUBLISHES, SERVES: CALLS, CALLS: SERVES}
# A number of a process or an address in a node's name.
_RANDOM = re.compile(r"\d{4}")
# Node, kind, role and name, without the robot's.
_Key = tuple[str, str, str, str]


class MadeOf(NamedTuple):
    """What a robot is made of, by names without its own: its nodes, and their ends by key."""

    nodes: Mapping[str, str]
    ends: Mapping[_Key, End]


@system_rule("MG327", "lacks-what-its-likes-have", WARNING, absence=True)
def lacks_what_its_likes_have(seen: Index) -> Iterator[Finding]:
    """Yield what one robot lacks and equal ones have; another finding about it replaces this one."""
    made = made_of(seen)
    if not seen.expected:
        yield from _lost_descriptions(seen)
    for likes in alike(nodes_of_each(seen)):
        others = len(likes) - 1
        nodes = Counter(node for it in likes for node in made[it].nodes)
        ends = Counter(key for it in likes for key in made[it].ends)
        all_but_one = [it for it in nodes if nodes[it] == others]
        ends_but_one = [it for it in ends if ends[it] == others]
        for robot in likes if all_but_one or ends_but_one else ():
            more = any(nodes[it] == 1 for it in made[robot].nodes)
            lost = [it for it in all_but_one if it not in made[robot].nodes]
            # Two robots of which each has a node of its own are made for two things.
            if lost and (others > 1 or not more):
                yield from _lost_nodes(seen, robot, likes, lost)
            surely = {k for it in likes for k, end in made[it].ends.items() if end.sure == RUNS}
            gone = [it for it in ends_but_one if it not in made[robot].ends and it in surely]
            own = [it for it in gone if it[0] in made[robot].nodes]
            yield from _lost_ends(seen, robot, likes, own)


def _lost_descriptions(seen: Index) -> Iterator[Finding]:
    """Find robots of few nodes that have all of another one's but robot_state_publisher."""
    made = made_of(seen)
    # The nodes that a robot has beside its robot_state_publisher -> that one, and the robot.
    full: dict[Set[str], tuple[str, str]] = {}
    for other, its in made.items():
        for node in its.nodes if len(its.nodes) <= _ENOUGH else ():
            if seen.publishes_description(its.nodes[node]):
                full.setdefault(frozenset(its.nodes) - {node}, (node, other))
    for robot, own in made.items():
        counts = range(len(own.nodes), -1, -1) if 0 < len(own.nodes) < _ENOUGH else ()
        parts = (frozenset(it) for count in counts for it in combinations(own.nodes, count))
        node, other = next((full[it] for it in parts if it in full), ("", ""))
        if node and node not in own.nodes:
            yield from _lost_nodes(seen, robot, (other, robot), [node])


@once
def made_of(seen: Index) -> Mapping[str, MadeOf]:
    """Return the nodes and their endpoints of each robot."""
    return {robot: MadeOf(own, _own_ends(seen, own)) for robot, own in nodes_of_each(seen).items()}


@once
def nodes_of_each(seen: Index) -> Mapping[str, Mapping[str, str]]:
    """Return the nodes of each robot by their names without the robot's."""
    own: dict[str, dict[str, str]] = {it: {} for it in seen.robots}
    for name in seen.nodes:
        if (robot := seen.robot(name)) not in own:
            continue
        if not seen.is_tool(name) and not _RANDOM.search(last_word(name)):
            own[robot][seen.plain(name)] = name
    return own


def _own_ends(seen: Index, nodes: Mapping[str, str]) -> Mapping[_Key, End]:
    """Return the ends of some nodes, without those of every node."""
    ends = {}
    by_node, plain_of = seen.by_node, seen.plain
    for plain, name in nodes.items():
        for it in by_node.get(name, ()):
            plumbing = it.name in EVERYBODYS or it.type.startswith(words.OF_EVERY_NODE)
            if not plumbing and it.type != TF and "/_" not in it.name:
                ends[plain, it.kind, it.role, plain_of(it.name)] = it
    return ends


def alike(nodes: Mapping[str, Mapping[str, str]]) -> Iterator[Sequence[str]]:
    """Yield groups of robots that share more than half of all nodes, and enough of them."""
    left = [it for it in nodes if len(nodes[it]) >= _ENOUGH]
    while left:
        first = nodes[left[0]].keys()
        group = [it for it in left if _are_alike(first, nodes[it].keys())]
        others = {*left}.difference(group)
        left = [it for it in left if it in others]
        if len(group) > 1:
            yield group


def _are_alike(one: Set[str], other: Set[str]) -> bool:
    """Return whether two sets of nodes share more than half, and enough, of their names."""
    same = len(one & other)
    return same >= _ENOUGH and 2 * same > len(one) + len(other) - same


def _lost_nodes(
    seen: Index, robot: str, likes: Sequence[str], lost: Sequence[str]
) -> Iterator[Finding]:
    """Report all nodes of one robot in one finding."""
    like, made = next(it for it in likes if it != robot), made_of(seen)
    keys = [key for key in made[like].ends if key[0] in lost]
    own = _missed_names(seen, robot, keys)
    theirs = sorted(made[like].nodes[it] for it in lost)
    if not (own or len(likes) > 2 or any(seen.publishes_description(it) for it in theirs)):
        return
    yield lacks_what_its_likes_have.finding(
        f"{robot} has no {shorten(sorted(it.strip('/') for it in lost), SEVERAL)}, as {like} has"
        f" ({shorten(theirs, SEVERAL)})",
        "start it for this robot too, if the two are to be equal",
        robot=robot, names=own,
    )  # fmt: skip


def _lost_ends(
    seen: Index, robot: str, likes: Sequence[str], gone: Iterable[_Key]
) -> Iterator[Finding]:
    """Report all ends of a node in one finding."""
    like, made = next(it for it in likes if it != robot), made_of(seen)
    by_node = lists_by_key((key[0], key) for key in gone)
    for plain, keys in by_node.items():
        own, node = _missed_names(seen, robot, keys), made[robot].nodes[plain]
        if not own:
            continue
        theirs = [made[like].ends[key] for key in keys]
        does = shorten([f"{it.role} {it.name}" for it in theirs], SEVERAL)
        others = {it.node for name in own for it in at_work(ends_of(seen, name))} - {node}
        wait = f"; {shorten(sorted(others), SEVERAL)} has it in vain" if others else ""
        yield lacks_what_its_likes_have.finding(
            f"lacks {shorten(own, SEVERAL)}; {theirs[0].node} {does}{wait}",
            "a remap rule, a parameter or a version of its own?",
            robot=robot, node=node, names=own,
        )  # fmt: skip


def _missed_names(seen: Index, robot: str, keys: Sequence[_Key]) -> tuple[str, ...]:
    """Return the robot's names that a node waits for and only what the robot lacks would serve."""
    sides = {(kind, _OTHER_SIDE[role], name): role for _, kind, role, name in keys}
    found: dict[str, None] = {}
    for (_, kind, role, name), it in made_of(seen)[robot].ends.items():
        lost = sides.get((kind, role, name))
        there = at_work(ends_of(seen, it.name)) if lost and not is_viewer(it.node) else ()
        if lost and _is_needy(it) and not any(one.role == lost for one in there):
            found[it.name] = None
    return tuple(found)


def _is_needy(end: End) -> bool:
    """Return whether an end is useless alone: a reader, a client, a managed node, joints, a drive."""
    if end.role == SUBSCRIBES and chooses(end.node):
        return False
    wants = end.role in (SUBSCRIBES, CALLS) or end.name.endswith(words.CHANGE_STATE)
    return wants or end.type == words.JOINTS or words.moves(end.name, end.type)


# Topics of one robot and of another are as often, unless something is wrong: so many times.
RATIO = 3.0
# Of what a body measures, in messages a second.
_SELDOM = 1.0
# Where there were too many topics to listen to all.
_NOT_ALL = "headers-not-read"
# Fewer messages say nothing of a rate.
ENOUGH = 10


@system_rule("MG326", "less-than-another-robot", WARNING)
def less_than_another_robot(seen: Index) -> Iterator[Finding]:
    """Report robots with fewer messages on a topic than another robot has on its own one."""
    yield from _silent_or_slow(seen)
    yield from _slow_transforms(seen)
    # Name without the robot's -> robot -> name, of the topics whose messages were counted.
    counted = dicts_by_key(
        (seen.plain(name), robot, name)
        for name in seen.known.messages
        if (robot := seen.robot(name))
    )
    for there in counted.values():
        best = max(there.values(), key=lambda it: seen.known.messages[it])
        most = seen.known.messages[best]
        for robot, name in there.items() if most >= ENOUGH else ():
            count = seen.known.messages[name]
            message = "" if count else f"{name} has no message, {best} has {most}"
            if count and count * RATIO <= most and seen.known.seconds:
                slow, usual = (f"{it / seen.known.seconds:.1f} Hz" for it in (count, most))
                message = f"{name} came at {slow}, {best} at {usual}"
            if message:
                yield less_than_another_robot.finding(message, robot=robot, names=(name,))


def _slow_transforms(seen: Index) -> Iterator[Finding]:
    """Report slow odometry and localization, which never pause: joints and sensors may."""
    there: dict[tuple[str, str], dict[str, Edge]] = defaultdict(dict)
    for it in (edge for tree in seen.trees for edge in tree.edges if edge.rate):
        robot = seen.frame_robot(it.child) or seen.robot(it.topic)
        parent = seen.plain_frame(it.parent)
        if robot and parent in SENT_FRAMES:
            there[parent, seen.plain_frame(it.child)][robot] = it
    for own in there.values():
        best = max(own.values(), key=lambda it: it.rate)
        for robot, it in own.items():
            if it.rate * RATIO <= best.rate:
                said, other = (f"{one.parent} -> {one.child} on {one.topic}" for one in (it, best))
                yield less_than_another_robot.finding(
                    f"{said} comes at {it.rate:.1f} Hz, {other} at {best.rate:.1f} Hz",
                    "see the node that sends it, and the processor time that it has",
                    robot=robot, names=(it.child, it.topic),
                )  # fmt: skip


def _silent_or_slow(seen: Index) -> Iterator[Finding]:
    """Report sensors of a running system that are slower than another robot's, or silent."""
    rates = dict(sorted((it.topic, it.rate) for it in seen.system.heard))
    robots, flows = ({seen.robot(it) for it in rates if rates[it] >= least} for least in (0, 1e-9))
    kinds = {(seen.robot(it.name), it.type) for it in seen.topics if it.name in rates}
    missed = any(it.code == _NOT_ALL for it in seen.system.environment.caveats)
    if missed or seen.known.messages or is_recorded(seen.system):
        robots = set()
    # Those without a robot only where none has a name.
    sensors = dicts_by_key(
        ((seen.plain(it.name), it.type), robot, it)
        for it in (seen.topics if rates else ())
        if bool(robot := seen.robot(it.name)) is bool(seen.robots)
        and (words.kind_of_data(it.name, it.type) and at_work(it.publishers))
    )
    for (_, type_), own in sensors.items():
        best = max(own.values(), key=lambda it: rates.get(it.name, -1.0)).name
        most = rates.get(best, -1.0)
        for robot, it in own.items():
            rate, read = rates.get(it.name), bool(at_work(it.subscribers))
            dead = read and words.is_of_a_body(type_)
            alone = dead and words.is_of_one_sensor(type_) and (robot, type_) not in kinds
            said, hint = "", "see its log"
            if rate and rate * RATIO <= most:
                said = f" at {rate:.1f} Hz, {best} comes at {most:.1f} Hz"
                hint += ", and the processor time that it has"
                # So seldom a scan is as good as none.
                dead = dead and rate < _SELDOM
            elif rate and rate < _SELDOM and dead and words.is_of_one_sensor(type_):
                # Its kind never comes so seldom.
                said, dead = f" at {rate:.1f} Hz", False
                hint += ", and the processor time that it has"
            elif rate is None and robot in robots and (most >= 0 or (alone and robot in flows)):
                said = ", on which no message came" + (f"; {best} has some" if most >= 0 else "")
            if said:
                yield less_than_another_robot.finding(
                    f"publishes {it.name}{said}", hint, level=ERROR if dead else WARNING,
                    robot=robot, node=nodes_of(at_work(it.publishers))[0], names=(it.name,),
                )  # fmt: skip


@system_rule("MG322", "driver-missing", ERROR, absence=True, drawn="leak")
def driver_missing(seen: Index) -> Iterator[Finding]:
    """Report a missing driver by its readers, with another robot's node that does the same."""
    lost: dict[tuple[str, str], list[Ends]] = defaultdict(list)
    actions = [it for it in seen.by_name.values() if it.kind == ACTION]
    for ends in (*seen.topics, *actions) if len(seen.robots) > 1 else ():
        if node := done_elsewhere(seen, ends):
            robot = seen.robot(ends.name)
            lost[robot, _loader(seen, node, robot)].append(ends)
    yield from _never_sent(seen)
    for (robot, node), missed in lost.items():
        names, plain = tuple(it.name for it in missed), seen.plain(node)
        using = ((*it.subscribers, *it.publishers, *it.clients) for it in missed)
        users = nodes_of(end for own in using for end in at_work(own))
        vain = f"{shorten(users, SEVERAL)} in vain"
        there = nodes_of_each(seen)[robot].get(plain, "")
        message = (
            f"{robot} has no {plain.strip('/')}, as {seen.robot(node)} has ({node});"
            f" {shorten(names, SEVERAL)} is used by {vain}"
        )
        hint = "start it for this robot too"
        if there:
            message = f"lacks {shorten(names, SEVERAL)}, which {node} has; it is used by {vain}"
            hint = "see its log; does it have other remap rules, parameters or another version?"
        yield driver_missing.finding(
            message, hint, level=ERROR if seen.is_live else WARNING,
            robot=robot, node=there, names=names,
        )  # fmt: skip


def _loader(seen: Index, node: str, robot: str) -> str:
    """Return the controller_manager in a node's process where the robot has none, else the node."""
    each, plain = nodes_of_each(seen), "/controller_manager"
    loader = each[seen.robot(node)].get(plain, node)
    together = seen.node[node].process == seen.node[loader].process != ""
    return loader if together and plain not in each[robot] else node


def _never_sent(seen: Index) -> Iterator[Finding]:
    """Report a laser, an IMU or odometry of a running robot that sends none of its kind."""
    body = [it for it in seen.topics if words.is_of_a_body(it.type) and it.type != words.JOINTS]
    # A filter makes its data of others of their type.
    read = {(end.node, it.type) for it in body for end in it.subscribers}
    made = ((it, end.node) for it in body for end in it.publishers)
    sent = {(seen.robot(it.name), it.type) for it, node in made if (node, it.type) not in read}
    for it in body if seen.is_observed and not seen.expected else ():
        robot = seen.robot(it.name)
        readers = [end for end in at_work(it.subscribers) if seen.robot(end.node) == robot]
        nodes = nodes_of(end for end in readers if end.sure == RUNS and not chooses(end.node))
        missed = nodes and not it.publishers and (robot, it.type) not in sent
        if missed and not done_elsewhere(seen, it):
            yield driver_missing.finding(
                f"no node sends {it.name}, read by {shorten(nodes, SEVERAL)}",
                "start its driver; its log says why it ended", robot=robot, names=(it.name,),
            )  # fmt: skip


def done_elsewhere(seen: Index, ends: Ends) -> str:
    """Return another robot's node that does what is missing at a robot's name; empty for none."""
    robot = seen.robot(ends.name)
    role = _missed_side(seen, ends) if robot else ""
    node = _first_to_do(seen).get((ends.kind, seen.plain(ends.name), ends.type, role), "")
    if role != PUBLISHES or not words.moves(seen.plain(ends.name), ends.type):
        return node
    # Who only sends velocities may be idle: a link between such a sender and the drive is lost.
    read = (it for it in seen.by_node.get(node, ()) if it.role == SUBSCRIBES)
    is_link = any(words.moves(seen.plain(it.name), it.type) for it in read)
    return node if is_link and not has_likes_of(seen, robot, node) else ""


def has_likes_of(seen: Index, robot: str, node: str) -> bool:
    """Return whether a robot has the like of another robot's node, or it runs outside of robots."""
    plain = seen.plain(node)
    return plain in nodes_of_each(seen).get(robot, {}) or plain in seen.node


@once
def _first_to_do(seen: Index) -> Mapping[tuple[str, str, str, str], str]:
    """Return the first node for each use of its robot's names, by kind, plain name, type and role."""
    first: dict[tuple[str, str, str, str], str] = {}
    for ends in seen.by_name.values():
        robot = seen.robot(ends.name) if ends.kind in (TOPIC, ACTION) else ""
        for end in at_work((*ends.publishers, *ends.subscribers, *ends.servers)) if robot else ():
            if seen.robot(end.node) == robot:
                first.setdefault((ends.kind, seen.plain(ends.name), ends.type, end.role), end.node)
    return first


def _missed_side(seen: Index, ends: Ends) -> str:
    """Return the role that is missing at a robot's name although a node waits for it; or ""."""
    if ends.kind == ACTION:
        return SERVES if at_work(ends.clients) and not ends.servers else ""
    kind, own = words.kind_of_data(ends.name, ends.type), seen.robot(ends.name)
    if not kind:
        return ""
    if ends.publishers and words.moves(seen.plain(ends.name), ends.type):
        sent = any(seen.robot(it.node) == own for it in at_work(ends.publishers))
        return SUBSCRIBES if sent and not at_work(ends.subscribers) else ""
    read = any(seen.robot(it.node) == own and it.sure == RUNS for it in at_work(ends.subscribers))
    return PUBLISHES if read and not ends.publishers else ""
