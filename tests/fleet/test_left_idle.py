# SPDX-License-Identifier: Apache-2.0
"""Nodes that a robot's own files leave idle: build says it as check-launch does."""

from __future__ import annotations

import pytest
from given_parameters import run_given

from multibot_rewrite.checks.judged_plan import left_idle
from multibot_rewrite.knowledge.node_sets import load_nodes
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts
from multibot_rewrite.planning.records import Given, Run
from multibot_rewrite.system.records import CALLS, Place

FILE = Place("nav2.yaml", 7)
NODES = load_nodes("jazzy")
SMOOTHER, MAPPER = (NODES[it] for it in ("velocity_smoother", "slam_toolbox"))
ARM = NODES["joint_trajectory_controller"]


def manager(*listed: str) -> NodeFacts:
    made = (Endpoint("service", CALLS, f"{it}/change_state") for it in listed)
    base = NODES.get("lifecycle_manager") or NodeFacts("manager", "nav2_lifecycle_manager", ())
    return base._replace(name="manager", known="lifecycle_manager", endpoints=tuple(made))


def given(name: str, known: str = "", manager: str = "", **values: object) -> Run:
    of = {key: Given(value, FILE) for key, value in values.items()}
    return run_given(name, known or name, "", of, FILE, manager)


@pytest.mark.parametrize(
    ("listed", "own", "idle"),
    [
        (("velocity_smoother",), ("manager",), []),
        (("amcl",), ("manager",), ["velocity_smoother"]),
        (("amcl",), (), []),
    ],
)
def test_a_node_that_the_robots_own_list_leaves_out_is_told(
    listed: tuple[str, ...], own: tuple[str, ...], idle: list[str]
) -> None:
    nodes = [manager(*listed), SMOOTHER, MAPPER]
    found = list(left_idle(nodes, [given(it) for it in own], NODES))
    assert [(it.code, it.message.split()[0], it.file, it.line) for it in found] == [
        ("MG726", it, "nav2.yaml", 7) for it in idle
    ]


@pytest.mark.parametrize(
    ("own", "timeout", "count"),
    [("manager", None, 1), ("manager", 0.0, 0), ("manager", 2.0, 1), ("slam_toolbox", None, 0)],
)
def test_a_listed_node_without_a_bond_is_told(own: str, timeout: float | None, count: int) -> None:
    mapper = MAPPER._replace(endpoints=tuple(it for it in MAPPER.endpoints if it.name != "bond"))
    values = {} if timeout is None else {"bond_timeout": timeout}
    nodes = [manager("slam_toolbox", "velocity_smoother"), SMOOTHER, mapper]
    found = list(left_idle(nodes, [given(own, **values)], NODES))
    assert [it.message for it in found] == [
        "manager waits for a bond with slam_toolbox, which keeps none"
    ] * count


@pytest.mark.parametrize(
    ("known", "values", "idle"),
    [
        (ARM.name, {}, True),
        (ARM.name, {"joints": [], "command_interfaces": ["position"]}, True),
        (ARM.name, {"command_interfaces": ["position"], "state_interfaces": ["position"]}, True),
        (ARM.name, {"joints": ["shoulder"], "command_interfaces": ["position"]}, False),
        # A joint is named; that the interfaces are missing is MB115.
        (ARM.name, {"joints": ["shoulder"]}, False),
        (ARM.name, {"joints": [f"joint{it}" for it in range(21)], "interface_name": "position"}, False),
        (ARM.name, {"command_joints": ["shoulder"]}, False),
        ("forward_command_controller", {"joints": ["shoulder"]}, False),
        ("diff_drive_controller", {"left_wheel_names": ["left"]}, False),
        ("diff_drive_controller", {"wheel_radius": 0.1}, True),
        ("gripper_action_controller", {"joint": "finger"}, False),
    ],
)  # fmt: skip
def test_a_controller_that_no_parameter_names_a_joint_for_is_told(
    known: str, values: dict[str, object], idle: bool
) -> None:
    own = given("arm", known, "controller_manager", **values)
    found = list(left_idle([NODES[known]._replace(name="arm", when="")], [own], NODES))
    assert [it.code for it in found] == ["MG725"] * idle
