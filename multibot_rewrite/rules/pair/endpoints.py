"""Rule about planned topics, services and actions: does their node have them."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.findings.finding import ERROR, Finding
from multibot_rewrite.rules.declaration import graph_rule
from multibot_rewrite.rules.pair.causes import (
    DOES,
    Cause,
    how_to_remap,
    in_namespaces_above,
    names_without_rules,
    use_absolute,
    why_not_remapped,
)
from multibot_rewrite.rules.pair.comparison import View
from multibot_rewrite.rules.pair.similar_names import similar
from multibot_rewrite.system.records import (
    CALLS,
    PUBLISHES,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    End,
)

TO_DO = {
    PUBLISHES: "publish",
    SUBSCRIBES: "subscribe to",
    SERVES: "offer",
    CALLS: "have a client for",
}


@graph_rule(
    "MG102",
    "missing-endpoint",
    ERROR,
    absence=True,
    drawn="missing",
    what="A running node does not have a topic, service or action that the plan has for it.",
    why="The other side waits for ever, without an error message.",
    fix="The hint has the name that the node uses in its place, and the remap rule that is not"
    " applied or the line of the description that lacks it: pass that rule.",
    bad="""\
planned: /robot1/driver subscribes /robot1/cmd_vel
running: /robot1/driver subscribes /cmd_vel
""",
    good="as planned: /robot1/driver subscribes /robot1/cmd_vel\n",
)
def missing_endpoint(view: View) -> Iterator[Finding]:
    """Only where its node is in the graph."""
    for planned in view.missing.values():
        robot = view.robot_of.get(planned.node, "")
        if planned.node not in view.seen:
            continue
        # Of two nodes with one name, rcl shows the services of only one.
        if view.seen[planned.node] > 1 and planned.kind != TOPIC:
            continue
        message = f"should {TO_DO[planned.role]} {planned.kind} {planned.name}, but does not"
        cause = _why_missing(view, planned)
        yield missing_endpoint.finding(
            message, **cause._asdict(), robot=robot, node=planned.node, names=(planned.name,)
        )


def _why_missing(view: View, planned: End) -> Cause:
    """Answers the most common question: why do we never get the topic /robot1/cmd_vel?"""
    used = _used_instead(view, planned)
    if not used:
        managed = (planned.node, SERVICE, SERVES, f"{planned.node}/get_state") in view.planned
        state = f"; is it configured? ros2 lifecycle get {planned.node}" if managed else ""
        return Cause(f"it has no similar name; is it switched off by a parameter?{state}")
    instead = f"it {DOES[planned.role]} {used} instead"
    if used in names_without_rules(view, planned):
        why = why_not_remapped(view, planned)
        return why._replace(hint=f"{instead}: {why.hint}{how_to_remap(view, planned)}")
    return Cause(f"{instead}{_why_remapped(view, planned, used)}")


def _why_remapped(view: View, planned: End, used: str) -> str:
    """Why an endpoint has a name that comes from a rule or parameter."""
    if not view.ownership.robot(planned.name):
        return f": a rule remaps it, but the plan has one {planned.name} for all robots"
    if used in _moved_down(view, planned):
        return f": {use_absolute(planned.name)}"
    other = view.ownership.robot(used)
    if other and other != view.robot_of.get(planned.node, other):
        return f", a name of {other}: a remap rule or parameter names the wrong robot"
    return ": is the name misspelled in a remap rule or parameter?"


def _used_instead(view: View, planned: End) -> str:
    """The name that the node probably uses in place of a planned one, or an empty string."""
    unplanned = _unplanned_names(view, planned)
    likely = [name for name in names_without_rules(view, planned) if name in unplanned]
    likely += _moved_down(view, planned)
    if likely:
        return likely[0]
    # A node for all robots has names of several: which robot's is in the name itself.
    ownership = view.ownership
    robot = view.robot_of.get(planned.node) or ownership.robot(planned.name)
    plain = {
        ownership.without_robot(name, ownership.robot(name) or robot): name for name in unplanned
    }
    wanted = ownership.without_robot(planned.name, robot)
    near = plain.get(wanted, "") or plain.get(similar(wanted, plain), "")
    if near or planned.node in view.robot_of:
        return near
    return similar(planned.name, unplanned)


def _moved_down(view: View, planned: End) -> list[str]:
    """The unplanned names that are a relative name resolved below the node's own namespace."""
    return [
        name
        for name in _unplanned_names(view, planned)
        if planned.name in in_namespaces_above(planned.node, name)
    ]


def _unplanned_names(view: View, planned: End) -> list[str]:
    """The names that the node uses in the role of a planned endpoint without being planned."""
    node, kind, role = planned.node, planned.kind, planned.role
    return [
        e.name
        for e in view.by_node.get(node, ())
        if (e.kind, e.role) == (kind, role) and (node, kind, role, e.name) not in view.planned
    ]
