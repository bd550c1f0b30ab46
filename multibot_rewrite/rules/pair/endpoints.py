# SPDX-License-Identifier: Apache-2.0
"""Rule about planned topics, services and actions: does their node have them."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping

from multibot_rewrite.base.conventions import EVERYBODYS
from multibot_rewrite.base.findings.finding import ERROR, Finding
from multibot_rewrite.base.wording import SEVERAL, shorten
from multibot_rewrite.rules.declaration import found_by_plan, pair_rule
from multibot_rewrite.rules.pair.causes import (
    DOES,
    Cause,
    how_to_remap,
    names_without_rules,
    use_absolute,
    why_not_remapped,
)
from multibot_rewrite.rules.pair.meeting import missing
from multibot_rewrite.rules.pair.similar_names import similar
from multibot_rewrite.system.index import Index
from multibot_rewrite.system.records import (
    CALLS,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    End,
)
from multibot_rewrite.system.tool_nodes import in_namespaces_above

TO_DO = {
    PUBLISHES: "publish",
    SUBSCRIBES: "subscribe to",
    SERVES: "offer",
    CALLS: "have a client for",
}


@pair_rule("MG102", "missing-endpoint", ERROR, absence=True, drawn="missing")
def missing_endpoint(plan: Index, seen: Index) -> Iterator[Finding]:
    """Only where its node is in the graph."""
    for planned in missing(plan, seen).values():
        robot = plan.robot_of.get(planned.node, "")
        if planned.node not in seen.nodes:
            continue
        # Of two nodes with one name, rcl shows the services of only one.
        if seen.nodes[planned.node] > 1 and planned.kind != TOPIC:
            continue
        message = f"should {TO_DO[planned.role]} {planned.kind} {planned.name}, but does not"
        cause = _why_missing(plan, seen, planned)
        yield missing_endpoint.finding(
            message, **cause._asdict(), robot=robot, node=planned.node, names=(planned.name,)
        )


def _why_missing(plan: Index, seen: Index, planned: End) -> Cause:
    """Answers the most common question: why do we never get the topic /robot1/cmd_vel?"""
    used = _used_instead(plan, seen, planned)
    if not used:
        managed = (planned.node, SERVICE, SERVES, f"{planned.node}/get_state") in plan.by_key
        state = f"; is it configured? ros2 lifecycle get {planned.node}" if managed else ""
        same = [it for it in _unplanned_names(plan, seen, planned) if _has_type(seen, planned, it)]
        # Of text and numbers are many things.
        if len(same) == 1 or (same and "std_" not in planned.type):
            return Cause(
                f"it {DOES[planned.role]} {shorten(same)} of that type: is that meant?{state}"
            )
        return Cause(f"it has no similar name; is it switched off by a parameter?{state}")
    instead = f"it {DOES[planned.role]} {used} instead"
    if used in names_without_rules(plan, planned):
        why = why_not_remapped(plan, planned)
        return why._replace(hint=f"{instead}: {why.hint}{how_to_remap(plan, planned)}")
    return Cause(f"{instead}{_why_remapped(plan, seen, planned, used)}")


def _has_type(seen: Index, planned: End, name: str) -> bool:
    """Is the name of the planned type?"""
    end = seen.by_key.get((planned.node, planned.kind, planned.role, name))
    return bool(end and planned.type and end.type == planned.type)


def _why_remapped(plan: Index, seen: Index, planned: End, used: str) -> str:
    """Why an endpoint has a name that comes from a rule or parameter."""
    if not plan.robot(planned.name):
        return f": a rule remaps it, but the plan has one {planned.name} for all robots"
    if used in _moved_down(plan, seen, planned):
        return f": {use_absolute(planned.name)}"
    other = plan.robot(used)
    if other and other != plan.robot_of.get(planned.node, other):
        return f", a name of {other}: a remap rule or parameter names the wrong robot"
    return ": is the name misspelled in a remap rule or parameter?"


def _used_instead(plan: Index, seen: Index, planned: End) -> str:
    """The name that the node probably uses in place of a planned one, or an empty string."""
    unplanned = _unplanned_names(plan, seen, planned)
    likely = [name for name in names_without_rules(plan, planned) if name in unplanned]
    likely += _moved_down(plan, seen, planned)
    if likely:
        return likely[0]
    # A node for all robots has names of several: which robot's is in the name itself.
    ownership = plan.of_names
    robot = plan.robot_of.get(planned.node) or ownership.robot(planned.name)
    plain = {
        ownership.without_robot(name, ownership.robot(name) or robot): name for name in unplanned
    }
    wanted = ownership.without_robot(planned.name, robot)
    near = plain.get(wanted, "") or plain.get(similar(wanted, plain), "")
    if near or planned.node in plan.robot_of:
        return near
    return similar(planned.name, unplanned)


def _moved_down(plan: Index, seen: Index, planned: End) -> list[str]:
    """The unplanned names that are a relative name resolved below the node's own namespace."""
    return [
        name
        for name in _unplanned_names(plan, seen, planned)
        if planned.name in in_namespaces_above(planned.node, name)
    ]


def _unplanned_names(plan: Index, seen: Index, planned: End) -> list[str]:
    """The names that the node uses in the role of a planned endpoint without being planned."""
    node, kind, role = planned.node, planned.kind, planned.role
    return [
        e.name
        for e in seen.by_node.get(node, ())
        if (e.kind, e.role) == (kind, role) and (node, kind, role, e.name) not in plan.by_key
    ]


@found_by_plan(missing_endpoint, nodes=False)
def topic_of_some_robots(plan: Index, seen: Index) -> Iterator[Finding]:
    """Where it is not known which nodes run: a topic that each robot sends by the plan, and that is
    there for some of them."""
    if seen.nodes:
        return
    there = {name for kind, name in seen.by_name if kind == TOPIC}
    for names in _sent_by_each(plan).values():
        others = [name for name in names.values() if name in there]
        for robot, name in names.items() if others else ():
            if name not in there:
                message = f"{name} is not there, {shorten(others, SEVERAL)} is"
                cause = "did its node run, in its robot's namespace, and was the topic recorded?"
                yield missing_endpoint.finding(message, cause, robot=robot, names=(name,))


def _sent_by_each(plan: Index) -> Mapping[str, Mapping[str, str]]:
    """Name without the robot's -> robot -> topic that is published by the plan; tf is of each."""
    shared = {*plan.system.shared_topics, *EVERYBODYS}
    sent = [name for _, kind, role, name in plan.by_key if (kind, role) == (TOPIC, PUBLISHES)]
    trees = [it.tf_topic for it in plan.system.robots if it.frames]
    found: dict[str, dict[str, str]] = defaultdict(dict)
    for name in (*sent, *trees):
        robot = plan.robot(name)
        if robot and name not in shared:
            found[plan.of_names.without_robot(name, robot)][robot] = name
    return found
