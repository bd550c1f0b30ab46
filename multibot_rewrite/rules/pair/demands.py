# SPDX-License-Identifier: Apache-2.0
"""Rules about what a plan asks beyond names: who may send, what is offered, which node of several."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from fnmatch import fnmatchcase

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.wording import SEVERAL, shorten
from multibot_rewrite.rules.declaration import found_by_plan, pair_rule
from multibot_rewrite.rules.pair.causes import DOES
from multibot_rewrite.rules.system.matching import not_latched
from multibot_rewrite.system.index import Index, ends_of, once
from multibot_rewrite.system.records import (
    PUBLISHES,
    SERVES,
    SERVICE,
    TOPIC,
    End,
    Topic,
    alternatives,
)

# How the nodes of ros_gz_bridge are called.
_BRIDGES = ("bridge", "parameter_bridge")


@pair_rule("MG121", "sender-not-planned", ERROR, drawn="cross-talk")
def sender_not_planned(plan: Index, seen: Index) -> Iterator[Finding]:
    """Of topics with senders; one finding for each other node."""
    for topic in (it for it in plan.system.topics if it.senders):
        allowed = shorten(topic.senders, SEVERAL)
        for node in dict.fromkeys(it.node for it in _publishers(seen, topic.name)):
            if not _may_send(topic, node):
                message = f"publishes {topic.name}, which only {allowed} may publish"
                hint = (
                    f"stop it or remap it; if it is right, add it to topics: {topic.name}: senders"
                )
                yield sender_not_planned.finding(message, hint, **_about(plan, topic, node))


def _may_send(topic: Topic, node: str) -> bool:
    return any(fnmatchcase(node, pattern) for pattern in topic.senders)


def _publishers(seen: Index, name: str) -> Sequence[End]:
    ends = seen.by_name.get((TOPIC, name))
    return ends.publishers if ends else ()


def _about(plan: Index, topic: Topic, node: str) -> dict[str, object]:
    robot = plan.robot(topic.name) or plan.robot_of.get(node, "")
    return {"robot": robot, "node": node, "names": (topic.name,)}


@found_by_plan(sender_not_planned)
def several_senders(plan: Index, seen: Index) -> Iterator[Finding]:
    """One finding a topic, at the sender that is not planned if there is one."""
    for topic in (it for it in plan.system.topics if it.one_sender):
        nodes = dict.fromkeys(it.node for it in _publishers(seen, topic.name))
        if len(nodes) > 1:
            planned = (TOPIC, PUBLISHES, topic.name)
            others = [
                it for it in nodes if (it, *planned) not in plan.by_key and not _may_send(topic, it)
            ]
            node = next(iter((*others, *nodes)))
            listed = shorten(nodes, SEVERAL)
            message = f"{topic.name} has {len(nodes)} senders: {listed}; the plan has one"
            hint = f"stop {node}, or put a twist_mux before the topic"
            yield sender_not_planned.finding(message, hint, **_about(plan, topic, node))


@found_by_plan(sender_not_planned, nodes=False)
def more_senders_than_planned(plan: Index, seen: Index) -> Iterator[Finding]:
    """Where it is not known which nodes run: more publishers of a robot's topic than the plan has."""
    nodes: dict[str, set[str]] = defaultdict(set)
    for node, kind, role, name in plan.by_key if not seen.nodes else ():
        if (kind, role) == (TOPIC, PUBLISHES):
            nodes[name].add(node)
    single = {it.name for it in plan.system.topics if it.one_sender}
    for name, own in nodes.items():
        there, most = len(_publishers(seen, name)), 1 if name in single else len(own)
        if there > most and seen.robot(name) and not any("*" in it for it in own):
            message = f"{name} has {there} publishers, planned are {most}"
            hint = f"planned: {shorten(sorted(own), SEVERAL)}"
            yield sender_not_planned.finding(message, hint, robot=seen.robot(name), names=(name,))


@found_by_plan(not_latched, nodes=False)
def other_qos_offered(plan: Index, seen: Index) -> Iterator[Finding]:
    """Where the snapshot knows what is offered."""
    for topic in (it for it in plan.system.topics if it.qos):
        for end in _publishers(seen, topic.name):
            different = list(_different(topic, end))
            if different:
                message = f"{topic.name} is published with {', '.join(different)}"
                hint = f"set it with qos_overrides.{topic.name}.publisher in its parameters"
                yield not_latched.finding(message, hint, **_about(plan, topic, end.node))


def _different(topic: Topic, end: End) -> Iterator[str]:
    """Each policy that is not as planned; one whose word is not known is none."""
    for policy, word in topic.qos if end.qos else ():
        offered = getattr(end.qos, policy)
        if offered not in (word, "UNKNOWN", "SYSTEM_DEFAULT"):
            yield f"{policy} {offered}, the plan has {word}"


@pair_rule("MG124", "no-alternative-runs", ERROR, absence=True, drawn="missing")
def no_alternative_runs(plan: Index, seen: Index) -> Iterator[Finding]:
    """A robot of which nothing runs has a finding of its own."""
    for group in alternatives(plan.system):
        robot = _robot_of(plan, group)
        if not (robot and _absent(plan, seen, robot)) and seen.nodes.keys().isdisjoint(group):
            message = f"none of {shorten(group, SEVERAL)} is in the graph; the plan has one of them"
            yield no_alternative_runs.finding(
                message, "start one of them", robot=robot, names=group
            )


@pair_rule("MG125", "several-alternatives-run", ERROR)
def several_alternatives_run(plan: Index, seen: Index) -> Iterator[Finding]:
    """One finding a group."""
    for group in alternatives(plan.system):
        running = [node for node in group if node in seen.nodes]
        if len(running) > 1:
            message = f"{shorten(running, SEVERAL)} run at once; the plan has one of them"
            hint = f"stop {shorten(running[1:], SEVERAL)}"
            about = {
                "robot": _robot_of(plan, group),
                "node": running[0],
                "names": tuple(running),
            }
            yield several_alternatives_run.finding(message, hint, **about)


@pair_rule("MG126", "bridged-topic-missing", ERROR, absence=True, drawn="missing")
def bridged_topic_missing(plan: Index, seen: Index) -> Iterator[Finding]:
    """One finding for a robot; one for all where nothing is bridged."""
    rows = [(topic, role) for topic in plan.system.topics for role in topic.bridge]
    missing = [(topic, role) for topic, role in rows if not _is_carried(seen, topic, role)]
    if missing and len(missing) == len(rows):
        running = not all(_absent(plan, seen, it.name) for it in plan.system.robots)
        yield from [_not_carried(plan, seen, "", missing, WARNING)] * running
        return
    by_robot: dict[str, list[tuple[Topic, str]]] = defaultdict(list)
    for topic, role in missing:
        by_robot[plan.robot(topic.name)].append((topic, role))
    for robot, own in by_robot.items():
        if not (robot and _absent(plan, seen, robot)):
            yield _not_carried(plan, seen, robot, own, ERROR)


def _absent(plan: Index, seen: Index, robot: str) -> bool:
    """A robot of which nothing runs has a finding of its own."""
    return seen.nodes.keys().isdisjoint(plan.own[robot])


def _is_carried(seen: Index, topic: Topic, role: str) -> bool:
    """Whether anything does with a topic what a bridge has to do."""
    kind = SERVICE if role == SERVES else TOPIC
    ends = (it for it in ends_of(seen, topic.name) if (it.kind, it.role) == (kind, role))
    return any(topic.type in ("", it.type) for it in ends)


def _not_carried(
    plan: Index, seen: Index, robot: str, rows: Sequence[tuple[Topic, str]], level: str
) -> Finding:
    topic, role = rows[0]
    more = f"; so it is with {len(rows) - 1} more of the bridge" if len(rows) > 1 else ""
    type_ = f" with the type {topic.type}" if topic.type else ""
    verb = DOES[role]
    message = f"nothing {verb} {topic.name}{type_}, which a ros_gz_bridge has to bridge{more}"
    names = tuple(dict.fromkeys(it.name for it, _ in rows))
    there = _bridges_there(plan, seen, robot)
    hint = f"{there}; for real robots write simulator: none in the fleet file"
    return bridged_topic_missing.finding(message, hint, level=level, robot=robot, names=names)


def _bridges_there(plan: Index, seen: Index, robot: str) -> str:
    bridges = _bridges(plan, seen)
    own = bridges.get(robot) or [it for of_one in bridges.values() for it in of_one]
    if not own:
        return "no ros_gz_bridge is in the graph: start one with the robot's bridge.yaml"
    return f"add the row to the file of {shorten(own)}"


@once
def _bridges(plan: Index, seen: Index) -> Mapping[str, Sequence[str]]:
    """The bridges that run, by their robot."""
    found: dict[str, list[str]] = defaultdict(list)
    for it in seen.nodes:
        if it.rpartition("/")[2].endswith(_BRIDGES):
            found[plan.robot(it)].append(it)
    return found


def _robot_of(plan: Index, nodes: Iterable[str]) -> str:
    return next((plan.robot_of[node] for node in nodes if node in plan.robot_of), "")
