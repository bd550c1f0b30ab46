# SPDX-License-Identifier: Apache-2.0
"""With a plan all is found that is found without one: the same code at the same place, or what the plan
says is missing there; and one fault is not more lines for it."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from fault_changes import Fault
from graph_cases import CASES, Case, healthy, read_plan
from graph_faults import FAULTS
from graph_faults_page import PLANS

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.live.diagnose import diagnose
from multibot_rewrite.rules.check import check
from multibot_rewrite.system.records import System

# A node that no plan has.
STRANGER = "MG108"
# The parts of a tree that is in pieces by the plan are not compared with another robot's.
IN_PIECES, COMPARED = "MG406", "MG328"


def hidden(plan: System, graph: System) -> list[str]:
    """Return what is found of a graph without its plan, and not with it."""
    found = check(plan, graph)
    unsaid = (it for it in diagnose(graph).findings if not any(_says(one, it) for one in found))
    lines = "\n".join(map(str, found))
    # Who lacks a name is said, in place of those who wait for it.
    lost = {name for name, node in _missing(plan, graph) if _names(lines, node, plan)}
    return [str(it) for it in unsaid if lost.isdisjoint(it.names)]


def _names(lines: str, node: str, plan: System) -> bool:
    """Is the node named, or its whole robot?"""
    robot = next((it.robot for it in plan.nodes if it.name == node), "")
    return node in lines or f"nodes of {robot} is in" in lines


def _says(one: Finding, other: Finding) -> bool:
    """Is it the same, of the same node, name or robot, or does it explain the other?"""
    about = [
        {it.node, *it.names, f"of {it.robot}" if it.robot else ""} - {""} for it in (one, other)
    ]
    if (one.code, other.code) == (IN_PIECES, COMPARED):
        return one.robot == other.robot
    return one.code == other.code and not about[0].isdisjoint(about[1])


def _missing(plan: System, graph: System) -> Iterator[tuple[str, str]]:
    """Yield the names that planned nodes lack, each with the node."""
    there = {(it.node, it.kind, it.role, it.name) for it in graph.ends}
    for it in plan.ends:
        if (it.node, it.kind, it.role, it.name) not in there:
            yield it.name, it.node


@pytest.mark.more
@pytest.mark.sample(4)
@pytest.mark.parametrize(
    "fault", [it for it in FAULTS if it.system in PLANS], ids=lambda fault: fault.name
)
def test_a_seeded_fault_is_not_hidden_by_its_plan(fault: Fault) -> None:
    assert hidden(PLANS[fault.system](), fault.change(fault.system())) == []


@pytest.mark.sample(1)
@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.layout}-{case.code}")
def test_a_broken_fleet_is_not_hidden_by_its_plan(case: Case) -> None:
    assert hidden(read_plan(case.layout), case.broken(healthy(case.layout))) == []


# Of these one cause is more lines with a plan: what the plan knows besides.
BESIDES = {
    # The frames of each robot have other names than planned; without a plan only one of them is odd.
    "frame_prefix on top of a rewritten description",
    # That no node of a robot, or a planned node, runs.
    "one lidar for both amcl",
}


@pytest.mark.more
@pytest.mark.sample(4)
@pytest.mark.parametrize(
    "fault",
    [it for it in FAULTS if it.system in PLANS and it.name not in BESIDES],
    ids=lambda fault: fault.name,
)
def test_a_seeded_fault_is_not_more_lines_with_its_plan(fault: Fault) -> None:
    """Nodes that the healthy system has and the plan has not are no part of the fault."""
    plan, seen = PLANS[fault.system](), fault.change(fault.system())
    before = {str(it) for it in check(plan, fault.system())}
    found = [it for it in check(plan, seen) if str(it) not in before]
    strangers = [it for it in found if it.code == STRANGER]
    alone = diagnose(seen).findings
    assert len(found) - len(strangers) <= max(1, len(alone)), [*map(str, found)]


@pytest.mark.sample(1)
@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.layout}-{case.code}")
def test_a_broken_fleet_is_not_more_lines_with_its_plan(case: Case) -> None:
    """A node that is in no plan is only found with one."""
    plan, seen = read_plan(case.layout), case.broken(healthy(case.layout))
    found = [it for it in check(plan, seen) if it.code != STRANGER]
    assert len(found) <= max(1, len(diagnose(seen).findings)), [*map(str, found)]
