# SPDX-License-Identifier: Apache-2.0
"""Frames of the plan that no transform has: joint states that no node sends, the wrong description."""

from __future__ import annotations

import pytest
from graph_cases import healthy, read_plan

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.rules.check import check
from multibot_rewrite.system.records import System

LAYOUTS = ("frames-per-robot", "tf-per-robot", "both", "postfix")


def found(layout: str, graph: System) -> list[Finding]:
    return [it for it in check(read_plan(layout), graph) if it.code == "MG208"]


def without(graph: System, layout: str, names: tuple[str, ...]) -> System:
    """The graph without robot2's frames of these bare names; all of them for no names."""
    kept = tuple(
        it
        for it in graph.edges
        if not (
            ("robot2" in it.topic or "robot2" in it.child)
            and (not names or any(name in it.child for name in names))
        )
    )
    return graph._replace(edges=kept)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_robot_without_joint_states(layout: str) -> None:
    """Its wheels are in no transform; the other robot's are."""
    (finding,) = found(layout, without(healthy(layout), layout, ("left_wheel", "right_wheel")))
    assert finding.robot == "robot2"
    assert finding.level == "error"
    assert "left_wheel" in finding.message
    assert "right_wheel" in finding.message
