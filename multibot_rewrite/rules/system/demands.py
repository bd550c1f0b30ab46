# SPDX-License-Identifier: Apache-2.0
"""Rules about topics of which a plan says more than who has them: who may send, what is bridged."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from fnmatch import fnmatchcase

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.wording import SEVERAL, shorten, unique
from multibot_rewrite.rules.declaration import planned_rule
from multibot_rewrite.rules.system.causes import DOES
from multibot_rewrite.rules.system.planned_nodes import is_absent
from multibot_rewrite.system.index import Index, ends_of, once
from multibot_rewrite.system.records import SERVES, SERVICE, TOPIC, Topic

# How the nodes of ros_gz_bridge are called.
_BRIDGES = ("bridge", "parameter_bridge")


@planned_rule("MG121", "sender-not-planned", ERROR, drawn="cross-talk", nodes=False)
def sender_not_planned(plan: Index, seen: Index) -> Iterator[Finding]:
    """One finding for each node that may not send; of too many senders one a topic, at one that is not
    planned if there is one."""
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
    """The node of each publisher of a topic."""
    ends = index.by_name.get((TOPIC, name))
    return [it.node for it in ends.publishers] if ends else []


def _too_many_recorded(plan: Index, seen: Index) -> Iterator[Finding]:
    """More publishers of a robot's topic than the plan has, where it is not known which nodes run."""
    single = {it.name for it in plan.system.topics if it.one_sender}
    for name in seen.published if seen.robots else ():
        own = {*_publishers(plan, name)}
        there, most = len(_publishers(seen, name)), 1 if name in single else len(own)
        if own and there > most and seen.robot(name) and not any("*" in it for it in own):
            message = f"{name} has {there} publishers, planned are {most}"
            hint = f"planned: {shorten(sorted(own), SEVERAL)}"
            yield sender_not_planned.finding(message, hint, robot=seen.robot(name), names=(name,))


@planned_rule("MG126", "bridged-topic-missing", ERROR, absence=True, drawn="missing")
def bridged_topic_missing(plan: Index, seen: Index) -> Iterator[Finding]:
    """One finding for a robot; one for all where nothing is bridged."""
    rows = [(topic, role) for topic in plan.system.topics for role in topic.bridge]
    missing = [(topic, role) for topic, role in rows if not _is_carried(seen, topic, role)]
    if missing and len(missing) == len(rows):
        running = not all(is_absent(plan, seen, it.name) for it in plan.system.robots)
        yield from [_not_carried(plan, seen, "", missing, WARNING)] * running
        return
    by_robot: dict[str, list[tuple[Topic, str]]] = defaultdict(list)
    for topic, role in missing:
        by_robot[plan.robot(topic.name)].append((topic, role))
    for robot, own in by_robot.items():
        if not (robot and is_absent(plan, seen, robot)):
            yield _not_carried(plan, seen, robot, own, ERROR)


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
