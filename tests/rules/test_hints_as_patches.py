# SPDX-License-Identifier: Apache-2.0
"""The remap rules that a hint names are passed, and the rules are asked again: the finding is gone, and
nothing else is wrong."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import pytest
from graph_calls import diagnose, seen_plan
from graph_examples import read_system
from graph_faults import FAULTS, Fault

from multibot_rewrite.base.findings.finding import Finding, Remap, Setting
from multibot_rewrite.rules.check import check, judge
from multibot_rewrite.system.records import (
    SIM_TIME,
    SUBSCRIBES,
    TOPIC,
    Edge,
    End,
    Heard,
    Parameter,
    System,
)

CLOCK = "rosgraph_msgs/msg/Clock"
TWIST, SCAN = "geometry_msgs/msg/Twist", "sensor_msgs/msg/LaserScan"


def remapped(graph: System, rules: Iterable[Remap]) -> System:
    """The system after its nodes got these rules, as rcl applies them; what one sends goes along."""
    for rule in rules:
        ends = tuple(
            it._replace(name=rule.new) if (it.node, it.name) == (rule.node, rule.old) else it
            for it in graph.ends
        )
        edges = (moved for it in graph.edges for moved in _moved(it, rule))
        graph = graph._replace(ends=ends, edges=tuple(_once(edges)))
    return graph


def with_settings(graph: System, settings: Iterable[Setting]) -> System:
    """The system whose nodes have these values: of parameters, or in what they send."""
    for it in settings:
        if it.topic:
            heard = (one._replace(**_told(one, it)) for one in graph.heard)
            graph = graph._replace(heard=tuple(heard))
            continue
        others = (one for one in graph.parameters if one[:2] != (it.node, it.name))
        graph = graph._replace(parameters=(*others, Parameter(it.node, it.name, it.value)))
        if it.name == SIM_TIME:
            clock = End(TOPIC, SUBSCRIBES, "/clock", CLOCK, node=it.node)
            apart = (one for one in graph.ends if one[:3] != clock[:3] or one.node != it.node)
            graph = graph._replace(ends=(*apart, *[clock] * (it.value == "true")))
    return graph


def _told(heard: Heard, it: Setting) -> dict[str, str]:
    field = "child" if it.name == "child_frame_id" else "frame"
    return {field: it.value} if heard.topic == it.topic else {}


def _moved(edge: Edge, rule: Remap) -> Iterator[Edge]:
    if edge.topic != rule.old or rule.node not in edge.publishers:
        yield edge
        return
    # Several sent it to one topic, each its own.
    yield edge._replace(topic=rule.new, publishers=(rule.node,), several=False)
    others = tuple(it for it in edge.publishers if it != rule.node)
    if others:
        yield edge._replace(publishers=others)


def _once(edges: Iterable[Edge]) -> Iterator[Edge]:
    found: dict[tuple[str, str, str], Edge] = {}
    for it in edges:
        key = it.topic, it.parent, it.child
        senders = {*it.publishers, *(found[key].publishers if key in found else ())}
        found[key] = it._replace(publishers=tuple(sorted(senders)))
    return iter(found.values())


def about(found: Iterable[Finding]) -> set[tuple[str, str, str]]:
    return {(it.code, it.robot, it.node) for it in found}


NAMED = [(it, diagnose(it.change(it.system())).findings) for it in FAULTS]
NAMED = [(it, found) for it, found in NAMED if any(one.remaps for one in found)]


def test_many_faults_have_such_a_hint() -> None:
    assert len(NAMED) > 40
    codes = {one.code for _, found in NAMED for one in found if one.remaps}
    assert codes >= {"MG303", "MG304", "MG308", "MG310", "MG315", "MG320", "MG402", "MG405"}


@pytest.mark.parametrize(("fault", "found"), NAMED, ids=[it.name for it, _ in NAMED])
def test_rules_of_a_hint_mend_the_fault(fault: Fault, found: tuple[Finding, ...]) -> None:
    graph = fault.change(fault.system())
    for it in found:
        if not it.remaps:
            continue
        for rule in it.remaps:
            assert rule.old.rpartition("/")[2] in it.hint, "the hint does not say it"
        after = diagnose(remapped(graph, it.remaps)).findings
        assert (it.code, it.robot, it.node) not in about(after), it
        assert about(after) <= about(found), it


SET = [(it, diagnose(it.change(it.system())).findings) for it in FAULTS]
SET = [(it, found) for it, found in SET if any(one.settings for one in found)]


def test_faults_of_clocks_and_frames_have_such_a_hint() -> None:
    codes = {one.code for _, found in SET for one in found if one.settings}
    assert codes >= {"MG411", "MG412", "MG503"}


@pytest.mark.parametrize(("fault", "found"), SET, ids=[it.name for it, _ in SET])
def test_values_of_a_hint_mend_the_fault(fault: Fault, found: tuple[Finding, ...]) -> None:
    graph = fault.change(fault.system())
    for it in (one for one in found if one.settings):
        assert all(one.value in it.hint for one in it.settings), "the hint does not say it"
        after = diagnose(with_settings(graph, it.settings)).findings
        assert (it.code, it.robot, it.node) not in about(after), it
        assert about(after) <= about(found), it


PLANS = [
    (it, plan, check(plan, it.change(it.system())))
    for it in FAULTS
    for plan in [seen_plan(diagnose(it.system()))]
]
PLANNED = [row for row in PLANS if any(one.remaps for one in row[2])]


def test_many_faults_have_such_a_hint_by_their_plan() -> None:
    assert len(PLANNED) > 30
    assert any("by the plan" in one.hint for *_, found in PLANNED for one in found if one.remaps)


@pytest.mark.parametrize(("fault", "plan", "found"), PLANNED, ids=[it.name for it, *_ in PLANNED])
def test_rules_of_a_hint_by_the_plan_mend_the_fault(
    fault: Fault, plan: System, found: list[Finding]
) -> None:
    """What two robots have alike is one finding to its reader, and its rules are given to both."""
    graph = fault.change(fault.system())
    for it in (one for one in found if one.remaps):
        rules = [rule for one in found if one.code == it.code for rule in one.remaps]
        after = check(plan, remapped(graph, rules))
        assert (it.code, it.robot, it.node) not in about(after), it
        # That its node is not planned is said with the fault until then. A node that serves all robots
        # has no rule that would do, and a tool is a note.
        missed = ("MG102", "MG303", "MG304")
        all_robots = {one for one in about(after) if one[2].count("/") == 1 and one[0] in missed}
        notes = about(one for one in after if one.level == "note")
        new = {one for one in about(after) - about(found) if one[0] != "MG108"} - notes - all_robots
        assert not new, [str(one) for one in after]
        targets = {(rule.node, rule.old): rule.new for rule in it.remaps}
        assert len(targets) == len({*it.remaps}), "two rules for one name of a node"


def said(*lines: str) -> Iterator[tuple[str, str, bool]]:
    for it in judge(read_system("\n".join(f"running: {it}" for it in lines))):
        yield it.code, it.hint, bool(it.remaps)


TWO = [
    f"/robot{at}/{node} {does} /robot{at}/{name} {type_}"
    for at in (1, 2)
    for node, does, name, type_ in (
        ("collision_monitor", "subscribes", "cmd_vel_smoothed", TWIST),
        ("collision_monitor", "publishes", "cmd_vel", TWIST),
        ("driver", "subscribes", "cmd_vel", TWIST),
    )
]


def test_no_hint_leads_a_robots_commands_to_another_robot() -> None:
    """robot1's smoother has no namespace in its topic; robot2's collision monitor waits as well."""
    lines = [*TWO, f"/robot1/velocity_smoother publishes /cmd_vel_smoothed {TWIST}"]
    found = [hint for _, hint, _ in said(*lines) if ":=" in hint]
    assert found and all("robot2" not in hint for hint in found)


def test_no_hint_goes_past_what_limits_velocities() -> None:
    smoothers = (
        f"/robot{it}/velocity_smoother publishes /robot{it}/cmd_vel_smoothed {TWIST}" for it in "12"
    )
    found = [*said(*TWO, *smoothers, f"/robot1/teleop_node publishes /robot1/cmd_vel_joy {TWIST}")]
    assert [(code, is_patch) for code, _, is_patch in found if code == "MG308"] == [
        ("MG308", False)
    ]
    assert not [hint for *_, hint, _ in found if "cmd_vel_joy:=" in hint]


@pytest.mark.parametrize(
    ("lines", "hint"),
    [
        (
            [f"/lidar publishes /scan {SCAN}",
             *(f"/robot{it}/amcl subscribes /scan {SCAN}" for it in "12")],
            "/lidar sends it to all robots: start one for each, in its namespace",
        ),
        (
            [f"/robot{it}/lidar publishes /robot2/scan {SCAN}" for it in "12"],
            "a namespace, remap rule or parameter of robot1 names robot2; pass the rule"
            " /robot2/scan:=scan to /robot1/lidar",
        ),
    ],
)  # fmt: skip
def test_who_has_to_change(lines: list[str], hint: str) -> None:
    assert [it for code, it, _ in said(*lines) if code == "MG320"] == [hint]
