# SPDX-License-Identifier: Apache-2.0
"""Rules about nodes and enclaves by a plan: which do not run, which run and are not planned."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fnmatch import fnmatchcase
from itertools import combinations

from multibot_rewrite.base.conventions import EVERYBODYS
from multibot_rewrite.base.findings.finding import ERROR, INCONCLUSIVE, WARNING, Finding, Setting
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.wording import SEVERAL, shorten, unique
from multibot_rewrite.planning.enclaves import enclave_of
from multibot_rewrite.rules.declaration import planned_rule, system_rule
from multibot_rewrite.rules.system.causes import DOES, Cause, caused, plugin_of, why_other_name
from multibot_rewrite.rules.system.planned_ends import matches, unplanned_nodes
from multibot_rewrite.system.environment import Machines, hidden_from_here, machines, why_not_seen
from multibot_rewrite.system.index import Index, at_work, ends_of, once
from multibot_rewrite.system.records import (
    PUBLISHES,
    SERVES,
    SERVICE,
    TOPIC,
    Robot,
    Topic,
    alternatives,
)
from multibot_rewrite.system.words import is_viewer


@planned_rule("MG101", "missing-node", ERROR, absence=True, drawn="missing")
def missing_node(plan: Index, seen: Index) -> Iterator[Finding]:
    """Report nodes of the plan; a robot without any of its nodes is one ``missing_robot``."""
    for robot in plan.system.robots:
        gone = is_absent(plan, seen, robot.name)
        for node in () if gone else _missing_nodes(plan, seen, robot):
            match = matches(plan, seen).get(node, "")
            cause = why_other_name(plan, node, match) if match else _not_started(plan, node)
            message = (
                f"node {node} is in the plan, but not in the graph{_waiting_hint(plan, seen, node)}"
            )
            yield missing_node.finding(message, **cause._asdict(), robot=robot.name, node=node)
    for node in dict.fromkeys(plan.own[""]):
        if node not in seen.nodes and node not in plan.may_miss:
            message = f"node {node} for all robots is in the plan, but not in the graph"
            yield missing_node.finding(message, "is it started?", level=WARNING, node=node)
    for group, of in _groups_of_one(plan):
        if seen.nodes.keys().isdisjoint(group) and not (of and is_absent(plan, seen, of)):
            message = f"none of {shorten(group, SEVERAL)} is in the graph; the plan has one of them"
            yield missing_node.finding(message, "start one of them", robot=of, names=group)


def _groups_of_one(plan: Index) -> Iterator[tuple[tuple[str, ...], str]]:
    """Yield (nodes of which one runs, their robot)."""
    for group in alternatives(plan.system):
        yield group, next((plan.robot_of[it] for it in group if it in plan.robot_of), "")


def _waiting_hint(plan: Index, seen: Index, node: str) -> str:
    """Return who calls in vain what the node serves, or reads what it sends."""
    for it in plan.by_node.get(node, ()):
        ends = seen.ends_at(it.kind, it.name)
        served = it.role == SERVES and not ends.servers and "lifecycle" not in it.type
        sent = it.role == PUBLISHES and not ends.publishers
        if served and ends.clients:
            return f"; {ends.clients[0].node} calls {it.name}"
        if sent and (readers := at_work(ends.subscribers)):
            return f"; {readers[0].node} reads {it.name}"
    return ""


def _missing_nodes(plan: Index, seen: Index, robot: Robot) -> list[str]:
    """Return the missing nodes; an optional one only if it runs under another name."""
    moved = {it for it in matches(plan, seen) if not is_viewer(it)}
    due = (it for it in plan.own[robot.name] if it in moved or it not in plan.may_miss)
    return [it for it in due if it not in seen.nodes]


def is_absent(plan: Index, seen: Index, robot: str) -> bool:
    """Return whether no node of the robot runs."""
    return seen.nodes.keys().isdisjoint(plan.own[robot])


def _not_started(plan: Index, node: str) -> Cause:
    """Return the likely cause why a planned node does not run."""
    plugin, place = plugin_of(plan, node)
    if plugin:
        started = f"{plugin} of the description should start it, see {place}"
        return caused(f"{started}; is the robot spawned?", place)
    return Cause("is it started, or did it end with an error?")


@planned_rule("MG108", "unplanned-node", WARNING, drawn="unexpected")
def unplanned_node(plan: Index, seen: Index) -> Iterator[Finding]:
    """Report nodes that are not in the plan, if the plan has nodes of their robot."""
    if not unplanned_nodes(plan, seen):
        return
    meant = set(matches(plan, seen).values())
    planned = {robot.name for robot in plan.system.robots if plan.own[robot.name]}
    shared = {*plan.system.shared_topics, *EVERYBODYS}
    without_robot = plan.of_names.without_robot
    originals = {without_robot(node, robot): node for node, robot in plan.robot_of.items()}
    for node in unplanned_nodes(plan, seen) if planned else ():
        robot = plan.robot(node)
        if node in meant or (robot and robot not in planned):
            continue
        if robot:
            # Those without its robot's name may disturb other robots.
            names = unique(it.name for it in seen.by_node.get(node, ()) if "/_" not in it.name)
            foreign = [it for it in names if it not in shared and plan.robot(it) != robot]
            uses = f"; it uses {shorten(foreign)}, without the name of {robot}" if foreign else ""
            message = f"is a node of {robot}, but not in the plan{uses}"
            cause = "add it to the plan: with --node-set or --nodes, or by hand"
        else:
            message = "is of no robot, and not in shared_nodes of the plan"
            cause = "add it there if it serves all robots; otherwise give it its robot's namespace"
        if node in originals:
            cause = f"{originals[node]} runs as well: is this a second one without a robot's name?"
        yield unplanned_node.finding(message, cause, robot=robot, node=node)


@planned_rule("MG109", "missing-robot", ERROR, absence=True, drawn="missing")
def missing_robot(plan: Index, seen: Index) -> Iterator[Finding]:
    """Report a robot none of whose planned nodes runs, in one finding."""
    for robot in plan.system.robots:
        if is_absent(plan, seen, robot.name) and _missing_nodes(plan, seen, robot):
            count = len(plan.own[robot.name])
            message = f"none of the {count} nodes of {robot.name} is in the graph"
            # Its nodes that probably run under other names.
            found = [it for it in plan.own[robot.name] if it in matches(plan, seen)]
            if found:
                cause = why_other_name(plan, found[0], matches(plan, seen)[found[0]])
                more = len(found) - 1
                same = f"; the same for {more} more of its nodes" if more else ""
                cause = cause._replace(hint=cause.hint + same)
            else:
                cause = Cause(why_not_seen(seen.system, robot.name, _machines(seen)))
            hidden = not found and hidden_from_here(seen.system, _machines(seen))
            level = INCONCLUSIVE if hidden else ERROR
            yield missing_robot.finding(message, **cause._asdict(), robot=robot.name, level=level)


@once
def _machines(seen: Index) -> Machines:
    return machines(seen.system)


@planned_rule("MG125", "several-alternatives-run", ERROR)
def several_alternatives_run(plan: Index, seen: Index) -> Iterator[Finding]:
    """Report alternatives that run at the same time, one finding a group."""
    for group, robot in _groups_of_one(plan):
        running = tuple(node for node in group if node in seen.nodes)
        if len(running) > 1:
            message = f"{shorten(running, SEVERAL)} run at once; the plan has one of them"
            hint = f"stop {shorten(running[1:], SEVERAL)}"
            yield several_alternatives_run.finding(
                message, hint, robot=robot, node=running[0], names=running
            )


@system_rule("MG112", "enclave-of-another-robot", ERROR, drawn="cross-talk")
def enclave_of_another_robot(seen: Index) -> Iterator[Finding]:
    """Report nodes in another robot's enclave, by the robots' names in its path."""
    robots = {*seen.robots}
    for name, enclave in dict.fromkeys((it.name, it.enclave) for it in seen.system.nodes):
        robot = seen.robot(name) if enclave else ""
        # A robot's name may have several levels.
        if not robot or f"/{robot}/" in f"{enclave}/":
            continue
        # The words of the path one after the other, as many as a robot's name may have.
        parts = enclave.strip("/").split("/")
        spans = combinations(range(len(parts) + 1), 2)
        named = {"/".join(parts[start:end]) for start, end in spans}
        if other := min(named & robots, default=""):
            message = f"{name} is in the enclave {enclave}, which is of {other}"
            yield enclave_of_another_robot.finding(
                message, **_start_in_enclave(robot, [name])._asdict(), robot=robot, node=name
            )


@system_rule("MG113", "without-enclave", WARNING)
def without_enclave(seen: Index) -> Iterator[Finding]:
    """Report, once a robot, its nodes without an enclave, if others are in one."""
    owned = [it for it in seen.system.nodes if seen.robot(it.name) and not seen.is_tool(it.name)]
    if not any(it.enclave for it in owned):
        return
    bare = lists_by_key((seen.robot(it.name), it.name) for it in owned if not it.enclave)
    for robot, names in bare.items():
        message = f"{shorten(names)}: in no enclave"
        cause = _start_in_enclave(robot, names)._asdict()
        yield without_enclave.finding(message, **cause, robot=robot, node=names[0])


def _start_in_enclave(robot: str, nodes: Sequence[str]) -> Cause:
    """Return how to start nodes in the enclave of their robot."""
    option, enclave = "--enclave", enclave_of(robot)
    settings = tuple(Setting(it, option, enclave) for it in nodes)
    return Cause(f"start it with --ros-args {option} {enclave}", settings=settings)


# How the nodes of ros_gz_bridge are called.
_BRIDGES = ("bridge", "parameter_bridge")


@planned_rule("MG121", "sender-not-planned", ERROR, drawn="cross-talk", nodes=False)
def sender_not_planned(plan: Index, seen: Index) -> Iterator[Finding]:
    """Report each node that may not send; of too many senders of a topic one, an unplanned one."""
    if not seen.nodes:
        yield from _too_many_recorded(plan, seen)
        return
    for topic in (it for it in plan.system.topics if it.senders or it.one_sender):
        name, nodes = topic.name, unique(_publishers(seen, topic.name))
        allowed = topic.senders or unique(_publishers(plan, name))
        others = [it for it in nodes if not any(fnmatchcase(it, one) for one in allowed)]
        message = f"publishes {name}, which only {shorten(allowed, SEVERAL)} may publish"
        hint = f"stop it or remap it; if it is right, add it to topics: {name}: senders"
        if topic.one_sender and len(nodes) > 1 and not (topic.senders and others):
            others = [(*others, *nodes)[0]]
            message = (
                f"{name} has {len(nodes)} senders: {shorten(nodes, SEVERAL)}; the plan has one"
            )
            hint = f"stop {others[0]}, or put a twist_mux before the topic"
        elif not topic.senders:
            continue
        for node in others:
            robot = plan.robot(name) or plan.robot_of.get(node, "")
            yield sender_not_planned.finding(message, hint, robot=robot, node=node, names=(name,))


def _publishers(index: Index, name: str) -> list[str]:
    """Return the node of each publisher of a topic."""
    return [it.node for it in index.ends_at(TOPIC, name).publishers]


def _too_many_recorded(plan: Index, seen: Index) -> Iterator[Finding]:
    """Report more publishers of a robot's topic than planned, if running nodes are unknown."""
    single = {it.name for it in plan.system.topics if it.one_sender}
    for name in seen.published if seen.robots else ():
        own = {*_publishers(plan, name)}
        there, most = len(_publishers(seen, name)), 1 if name in single else len(own)
        if own and there > most and seen.robot(name) and not any("*" in it for it in own):
            message = f"{name} has {there} publishers, planned are {most}"
            hint = f"stop the others than {shorten(sorted(own), SEVERAL)}"
            yield sender_not_planned.finding(message, hint, robot=seen.robot(name), names=(name,))


@planned_rule("MG126", "bridged-topic-missing", ERROR, absence=True, drawn="missing")
def bridged_topic_missing(plan: Index, seen: Index) -> Iterator[Finding]:
    """Report topics that a bridge should bring, one finding for a robot, or for all."""
    rows = [(topic, role) for topic in plan.system.topics for role in topic.bridge]
    missing = [(topic, role) for topic, role in rows if not _is_carried(seen, topic, role)]
    if missing and len(missing) == len(rows):
        running = not all(is_absent(plan, seen, it.name) for it in plan.system.robots)
        yield from [_not_bridged_finding(plan, seen, "", missing, WARNING)] * running
        return
    by_robot = lists_by_key((plan.robot(topic.name), (topic, role)) for topic, role in missing)
    for robot, own in by_robot.items():
        if not (robot and is_absent(plan, seen, robot)):
            yield _not_bridged_finding(plan, seen, robot, own, ERROR)


def _is_carried(seen: Index, topic: Topic, role: str) -> bool:
    """Return whether anything does with a topic what a bridge has to do."""
    kind = SERVICE if role == SERVES else TOPIC
    ends = (it for it in ends_of(seen, topic.name) if (it.kind, it.role) == (kind, role))
    return any(topic.type in ("", it.type) for it in ends)


def _not_bridged_finding(
    plan: Index, seen: Index, robot: str, rows: Sequence[tuple[Topic, str]], level: str
) -> Finding:
    topic, role = rows[0]
    more = f"; so it is with {len(rows) - 1} more of the bridge" if len(rows) > 1 else ""
    type_ = f" with the type {topic.type}" if topic.type else ""
    message = f"nothing {DOES[role]} {topic.name}{type_}, which a ros_gz_bridge has to bridge{more}"
    bridges = _bridges(plan, seen)
    own = bridges.get(robot) or [it for of_one in bridges.values() for it in of_one]
    there = "no ros_gz_bridge is in the graph: start one with the robot's bridge.yaml"
    return bridged_topic_missing.finding(
        message,
        f"{f'add the row to the file of {shorten(own)}' if own else there}; for real robots write"
        " simulator: none in the fleet file",
        level=level, robot=robot, names=unique(it.name for it, _ in rows),
    )  # fmt: skip


@once
def _bridges(plan: Index, seen: Index) -> Mapping[str, Sequence[str]]:
    """Return the running bridges by robot."""
    return lists_by_key(
        (plan.robot(it), it) for it in seen.nodes if it.rpartition("/")[2].endswith(_BRIDGES)
    )
