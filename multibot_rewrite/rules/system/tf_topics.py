# SPDX-License-Identifier: Apache-2.0
"""Dangers of tf topics: one robot on two of them."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Container, Iterator, Mapping, Sequence, Set

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.wording import shorten, unique
from multibot_rewrite.rules.declaration import system_rule
from multibot_rewrite.rules.system.tf_trees import (
    by_child,
    frames_by_topic,
    home_of,
    taken_elsewhere,
)
from multibot_rewrite.rules.system.transforms import collide, tf_remaps
from multibot_rewrite.system.index import Index, Tree, once
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES, TOPIC, Edge, incomplete
from multibot_rewrite.system.tf_copies import static_topic
from multibot_rewrite.system.words import is_viewer, last_word

TF = "tf"
_BRIDGE = "_bridge"
_REMAP = "/tf:=tf and /tf_static:=tf_static"


@system_rule("MG405", "tf-on-two-topics", ERROR, drawn="leak")
def tf_on_two_topics(seen: Index) -> Iterator[Finding]:
    """Report nodes that send or hear tf on another topic than their robot's, unless that is meant."""
    senders: dict[str, dict[str, list[str]]] = defaultdict(dict)
    listeners: dict[str, dict[str, list[str]]] = defaultdict(dict)
    for tree in _called_tf(seen):
        ways = ((senders, tree.senders, PUBLISHES), (listeners, tree.listeners, SUBSCRIBES))
        for found, nodes, role in ways:
            for node in (it for it in nodes if seen.robot(it) and it not in seen.relays):
                if not (is_viewer(node) or _is_meant(seen, node, role, tree.topic)):
                    found[seen.robot(node)].setdefault(tree.topic, []).append(node)
    # Where robots' frames collide, that is the finding.
    mixed = {tree.topic for tree in seen.trees if collide(seen, tree)}
    known = (it for it in listeners if it in seen.home)
    for robot in unique((*senders, *known)):
        topics = senders.get(robot, {})
        home = _tf_topic_of(seen, robot, topics)
        others = (it for it in topics if it != home and it not in mixed)
        odd = [it for it in others if not _is_own_topic(seen, robot, topics, it)]
        heard = listeners.get(robot, {})
        for topic in unique((*odd, *(it for it in heard if it not in topics and it != home))):
            deaf = [it for it in heard.get(topic, ()) if it not in heard.get(home, ())]
            sending = topics.get(topic, ())
            if sending or deaf:
                yield _tf_on_other_topic(seen, robot, home, topic, sending, deaf)
    yield from _frames_of_another(seen, senders)
    yield from _frames_on_foreign_topic(seen, senders)
    yield from _rviz_hears_nothing(seen)


def _called_tf(seen: Index) -> list[Tree]:
    return [it for it in seen.trees if last_word(seen.plain(it.topic)) == TF]


def _rviz_hears_nothing(seen: Index) -> Iterator[Finding]:
    """Report RViz on a tf topic without senders, while robots have theirs."""
    trees = _called_tf(seen)
    sent = [it.topic for it in trees if it.senders]
    for tree in trees:
        rviz = [it for it in tree.listeners if last_word(it).startswith("rviz")]
        if rviz and sent and not tree.senders:
            yield tf_on_two_topics.finding(
                f"listens to {tree.topic}, on which no node sends; robots send on {shorten(sent)}",
                f"start it with -r {tree.topic}:={sent[0]}"
                f" -r {static_topic(tree.topic)}:={static_topic(sent[0])}, one for each robot",
                level=WARNING, robot=seen.robot(rviz[0]), node=rviz[0], names=(tree.topic,),
                remaps=tf_remaps(rviz, tree.topic, sent[0]),
            )  # fmt: skip


def _frames_of_another(
    seen: Index, senders: Mapping[str, Mapping[str, Sequence[str]]]
) -> Iterator[Finding]:
    """Report a robot's frames on another one's topic; without a plan only of unknown senders."""
    for tree in _called_tf(seen):
        home = home_of(seen.expected, tree) if seen.expected else ()
        owners = home or [it for it in (seen.robot(tree.topic),) if it]
        found: dict[str, list[Edge]] = defaultdict(list)
        for it in tree.edges if owners else ():
            robot, is_odd = seen.frame_robot(it.child), _is_of_its_tree if home else _is_of_nobody
            if robot not in ("", *owners) and is_odd(seen, tree, it):
                found[robot].append(it)
        for robot, edges in found.items():
            sends = tree.topic in senders.get(robot, ()) or _is_relayed(seen, tree, robot)
            if sends or _has_names_of(seen, tree, owners, robot, edges):
                continue
            frames, expected = unique(it.child for it in edges), seen.home.get(robot, "")
            verb = "is" if len(frames) == 1 else "are"
            where, wrong = f"on {tree.topic}, which is of {owners[0]}", ""
            if home:
                where = f"{verb} on {tree.topic}, expected on {expected}"
                known = [it for it in tree.senders if it in seen.nodes]
                wrong = f"; or {shorten(known)} has its description or parameters" if known else ""
            yield tf_on_two_topics.finding(
                f"{shorten(frames)} of {robot} {where}",
                f"start its nodes in its own namespace, with the rules {_REMAP}{wrong}",
                robot=robot, names=(*frames, tree.topic, *filter(None, [expected])),
            )  # fmt: skip


def _is_of_its_tree(seen: Index, _: Tree, edge: Edge) -> bool:
    """Return whether a transform is between frames of one robot, or its node sends it by the plan."""
    one = seen.frame_robot(edge.child) == seen.frame_robot(edge.parent)
    return one or (edge.parent, edge.child) in seen.senders


def _is_of_nobody(seen: Index, tree: Tree, edge: Edge) -> bool:
    """Return whether no robot's node has sent it, and it is not a copy by a known node."""
    robot = seen.frame_robot(edge.child)
    trees = (it.topic for it in seen.trees if seen.robot(it.topic) == robot)
    copied = any(edge.child in by_child(seen)[it] for it in trees) and edge.publishers
    sees = seen.frame_robot(edge.parent) == seen.robot(tree.topic)
    return not (copied or sees or any(map(seen.robot, edge.publishers or tree.senders)))


def _is_relayed(seen: Index, tree: Tree, robot: str) -> bool:
    """Return whether its nodes are planned to send on a topic, or a relay copies its tf there."""
    plan, topics = seen.expected, (tree.topic, static_topic(tree.topic))
    own = plan.own.get(robot, ()) if plan else ()
    planned = plan.by_key if plan else ()
    own_trees = (it for it in seen.trees if seen.robot(it.topic) == robot)
    heard = (node for it in own_trees for node in it.listeners)
    keys = ((node, TOPIC, PUBLISHES, it) for node in own for it in topics)
    return any(it in planned for it in keys) or any(node in tree.senders for node in heard)


def _has_names_of(
    seen: Index, tree: Tree, owners: Sequence[str], robot: str, edges: Sequence[Edge]
) -> bool:
    """Return whether a topic's own robot lacks frames, as its nodes have the names of another one."""
    plan, children = seen.expected, by_child(seen).get(seen.home.get(robot, ""), {})
    if not plan or not seen.nodes or any(it.child not in children for it in edges):
        return False
    there = frames_by_topic(seen)[tree.topic]
    return any(not there >= {*plan.declared[it].frames} for it in owners)


def _frames_on_foreign_topic(
    seen: Index, senders: Mapping[str, Mapping[str, Sequence[str]]]
) -> Iterator[Finding]:
    """Yield a robot's frames on a topic of none of its nodes, sent by a node of no robot."""
    level = WARNING if incomplete(seen.system) else ERROR
    trees = {it.topic: it for it in seen.trees}
    elsewhere = taken_elsewhere(seen.expected) if seen.expected else ()
    for tree in (it for it in _called_tf(seen) if it.topic not in elsewhere):
        found: dict[str, list[Edge]] = defaultdict(list)
        for it in tree.edges if not seen.robot(tree.topic) else ():
            for robot in _robots_of_transform(seen, it):
                found[robot].append(it)
        for robot in (it for it in found if it in senders or it in seen.home):
            home = _tf_topic_of(seen, robot, senders.get(robot, {}))
            own = trees.get(home, Tree(home, (), (), ()))
            children = by_child(seen).get(home, {})
            whole = len(found[robot]) > 1
            odd = [it for it in found[robot] if not _is_copy(seen, own, children, it, whole)]
            if not odd or home == tree.topic or tree.topic in senders.get(robot, ()):
                continue
            node, frames = next(iter(odd[0].publishers), ""), unique(it.child for it in odd)
            yield tf_on_two_topics.finding(
                f"{node or 'a node'} sends {shorten(frames)} on {tree.topic}, but the tf of {robot} is"
                f" on {home}",
                f"start it in the namespace of {robot}, with the rules {_REMAP}",
                level=level, robot=robot, node=node, names=(*frames, tree.topic, home),
            )  # fmt: skip


def _robots_of_transform(seen: Index, edge: Edge) -> Sequence[str]:
    """Return the robots of a transform: by its name, otherwise those that lack it by the plan."""
    robot, plan = seen.frame_robot(edge.child), seen.expected
    if robot:
        known = edge.publishers or robot in seen.home
        return [robot] if robot == seen.frame_robot(edge.parent) and known else ()
    if not plan or seen.nodes or edge.publishers:
        return ()
    planned = [it for it, frames in plan.frames_of.items() if edge.child in frames]
    return [it for it in planned if edge.child not in by_child(seen).get(seen.home[it], ())]


def _is_copy(seen: Index, tree: Tree, children: Container[str], edge: Edge, whole: bool) -> bool:
    """Return whether a transform is in the robot's tree as well, or sent by a reader of it."""
    hears = any(seen.robot(it) or it in tree.listeners for it in edge.publishers)
    if not edge.publishers:
        return False
    named = edge.child in children or (whole and seen.plain_frame(edge.child) in children)
    return hears or named


def _is_own_topic(seen: Index, robot: str, topics: Mapping[str, Sequence[str]], topic: str) -> bool:
    """Return whether a topic is in the robot's namespace, and only its own nodes or bridges send."""
    at_home = topics.get(_tf_topic_of(seen, robot, topics), ())
    others = (it for it in topics[topic] if it not in at_home and _BRIDGE not in last_word(it))
    bridge = f"ros_gz{_BRIDGE}"
    return seen.robot(topic) == robot and all(seen.node[it].known == bridge for it in others)


def _is_meant(seen: Index, node: str, role: str, topic: str) -> bool:
    """Return whether a node is planned with this tf topic, which is not its robot's."""
    keys = ((node, TOPIC, role, it) for it in (topic, static_topic(topic)))
    known = seen.expected.by_key if seen.expected else ()
    return topic != seen.home.get(seen.robot(node)) and any(it in known for it in keys)


def _tf_topic_of(seen: Index, robot: str, topics: Mapping[str, Sequence[str]]) -> str:
    """Return a robot's tf topic: the known one, its own, or where most of its nodes send."""
    if robot in seen.home:
        return seen.home[robot]
    most = max(topics, key=lambda it: len(topics[it]))
    if robot in _named_on_shared(seen).get(most, ()):
        return most
    own = [it for it in topics if seen.robot(it) == robot and seen.plain(it).strip("/") == TF]
    return next(iter(own), most)


@once
def _named_on_shared(seen: Index) -> Mapping[str, Set[str]]:
    """Return, by tf topic of several robots, the robots whose names its frames have."""
    shared = (it for it in seen.trees if len({*map(seen.robot, it.senders)} - {""}) > 1)
    return {it.topic: {seen.frame_robot(edge.child) for edge in it.edges} for it in shared}


def _tf_on_other_topic(
    seen: Index,
    robot: str,
    home: str,
    topic: str,
    sending: Sequence[str],
    deaf: Sequence[str],
) -> Finding:
    """Return the finding about the nodes of a robot that send on another tf topic, or hear that one."""
    first, verb = (sending, "send") if sending else (deaf, "hear")
    nodes = unique((*sending, *deaf))
    does = f"{verb}s" if len(first) == 1 else verb
    message = f"{shorten(first)} {does} tf on {topic}, but the tf of {robot} is on {home}"
    other = seen.robot(topic)
    # tf2 asks for /tf: a rule for the name that another rule made is none.
    target = "tf" if home.startswith(f"/{seen.of_names.tag(robot)}/") else home
    rules = f"-r /{TF}:={target} -r {static_topic(f'/{TF}')}:={static_topic(target)}"
    more = [it for it in nodes if it not in first]
    also = f", as well as to {shorten(more)}, which hear it" if more else ""
    hint = f"pass {rules} to each node{also}; if it shares a process, to the whole process"
    if home == f"/{TF}":
        hint = f"leave out its rules for {home} and {static_topic(home)}, or start it without them"
    if other not in ("", robot):
        hint = f"a namespace or remap rule of {robot} names {other}; {hint}"
    return tf_on_two_topics.finding(
        message, hint, robot=robot, node=nodes[0], names=(topic, home),
        remaps=tf_remaps(nodes, topic, home),
    )  # fmt: skip
