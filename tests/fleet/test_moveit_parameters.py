# SPDX-License-Identifier: Apache-2.0
"""MoveIt's files as parameters: what MoveItConfigsBuilder makes of them (moveit_configs.py)."""

from __future__ import annotations

import math
from typing import Any

import pytest

from multibot_rewrite import InputError
from multibot_rewrite.fleet.outputs.moveit_parameters import (
    _without_nulls,
    move_group_parameters,
    parameters_from,
)

FILES = {
    "c/kinematics.yaml": "arm: {kinematics_solver: k, none: }\n",
    "c/joint_limits.yaml": "joint_limits: {j: {max_velocity: 1}}\n",
    "c/controllers.yaml": "controller_names: [a]\na: {type: T}\n",
    "c/initial_positions.yaml": "j: 0.5\n",
    "c/servo.yaml": "move_group_name: arm\n",
    "c/empty.yaml": "",
    "c/sensors_3d.yaml": "sensors: [eye]\neye: {sensor_plugin: s}\n",
}
SIMPLE = "moveit_simple_controller_manager"
FOUND: dict[str, Any] = {
    "robot_description_semantic": "<robot/>",
    "publish_robot_description_semantic": True,
    "robot_description_kinematics": {"arm": {"kinematics_solver": "k"}},
    "robot_description_planning": {"joint_limits": {"j": {"max_velocity": 1}}},
    "moveit_controller_manager": f"{SIMPLE}/MoveItSimpleControllerManager",
    SIMPLE: {"controller_names": ["a"], "a": {"type": "T"}},
    "moveit_servo": {"move_group_name": "arm"},
    "sensors": ["eye"],
    "eye": {"sensor_plugin": "s"},
}
REQUEST, RESPONSE = "default_planning_request_adapters", "default_planning_response_adapters"
# default_configs/ompl_planning.yaml of moveit_configs_utils.
OMPL = {
    "planning_plugins": ["ompl_interface/OMPLPlanner"],
    "request_adapters": [
        f"{REQUEST}/ResolveConstraintFrames", f"{REQUEST}/ValidateWorkspaceBounds",
        f"{REQUEST}/CheckStartStateBounds", f"{REQUEST}/CheckStartStateCollision",
    ],
    "response_adapters": [
        f"{RESPONSE}/AddTimeOptimalParameterization", f"{RESPONSE}/ValidateSolution",
        f"{RESPONSE}/DisplayMotionPath",
    ],
}  # fmt: skip
HUMBLE = "default_planner_request_adapters/"
OMPL_HUMBLE = {
    "planning_plugin": "ompl_interface/OMPLPlanner",
    "request_adapters": f"{HUMBLE}AddTimeOptimalParameterization {HUMBLE}ResolveConstraintFrames "
    f"{HUMBLE}FixWorkspaceBounds {HUMBLE}FixStartStateBounds {HUMBLE}FixStartStateCollision "
    f"{HUMBLE}FixStartStatePathConstraints",
}


@pytest.mark.parametrize(
    ("more", "release", "pipelines"),
    [
        ({}, "jazzy", {"ompl": OMPL}),
        ({}, "humble", {"ompl": OMPL_HUMBLE}),
        ({"ompl_planning.yaml": "arm: {x: 1}\n"}, "jazzy", {"ompl": {**OMPL, "arm": {"x": 1}}}),
        (
            {"ompl_planning.yaml": "planning_plugins: [o]\n"}, "jazzy",
            {"ompl": {"planning_plugins": ["o"]}},
        ),
        (
            {"ompl_planning.yaml": "planning_plugin: o\n"}, "humble",
            {"ompl": {"planning_plugin": "o"}},
        ),
        (
            {"chomp_planning.yaml": "planning_plugins: [c]\n"}, "jazzy",
            {"chomp": {"planning_plugins": ["c"]}},
        ),
        (
            {
                "chomp_planning.yaml": "planning_plugins: [c]\n",
                "ompl_planning.yaml": "planning_plugins: [o]\n",
            }, "jazzy",
            {"chomp": {"planning_plugins": ["c"]}, "ompl": {"planning_plugins": ["o"]}},
        ),
    ],
)  # fmt: skip
def test_the_whole_of_the_parameters(
    more: dict[str, str], release: str, pipelines: dict[str, Any]
) -> None:
    first = "ompl" if "ompl" in pipelines else "chomp"
    assert parameters_from("<robot/>", {**FILES, **more}, release) == {
        **FOUND,
        **pipelines,
        "planning_pipelines": [*pipelines],
        "default_planning_pipeline": first,
    }


def test_what_move_group_alone_reads() -> None:
    files = {**FILES, "ompl_planning.yaml": "planning_plugins: [o]\n"}
    own = {"kinematics_solver": "k", "none": None}
    wanted = {
        "robot_description": "<urdf/>",
        "robot_description_semantic": "<srdf/>",
        "robot_description_kinematics": {"arm": own},
        "robot_description_planning": FOUND["robot_description_planning"],
        **FOUND[SIMPLE],
        "sensors": ["eye"],
        "eye": {"sensor_plugin": "s"},
        "ompl": {"planning_plugins": ["o"]},
    }
    assert move_group_parameters("<urdf/>", "<srdf/>", files) == wanted
    assert "robot_description_semantic" not in move_group_parameters("<urdf/>", "", files)


@pytest.mark.parametrize(
    ("value", "plain"),
    [
        ({1: 2, "a": None, "b": [], "c": {}, "d": 0, "e": ""}, {"1": 2, "d": 0, "e": ""}),
        ({"a": {"b": None, "c": [1, 2.5]}}, {"a": {"c": [1.0, 2.5]}}),
        ([1, 2], [1, 2]), ([1, "a"], None), ([[1]], None), ([{"a": 1}], None), ([1, True], None),
        ([True, False], [True, False]), ("a", "a"),
    ],
)  # fmt: skip
def test_values_are_those_that_rcl_takes(value: object, plain: object) -> None:
    """rcl_yaml_param_parser: no null, and a list of one type that is no list."""
    found = _without_nulls(value)
    assert (found, repr(found)) == (plain, repr(plain))


def test_an_angle_in_degrees_is_in_radians_as_launch_files_read_it() -> None:
    """launch_param_builder utils.py: PyYAML has !degrees and !radians; rcl has neither of them."""
    text = "joint_limits:\n  a: {max_position: !degrees 180, min_position: !radians -1, x: !!float 2}\n"
    found = parameters_from("", {"config/joint_limits.yaml": text}, "jazzy")
    limits = found["robot_description_planning"]["joint_limits"]["a"]
    assert limits == {"max_position": math.pi, "min_position": -1.0, "x": 2.0}
    assert all(isinstance(it, float) for it in limits.values())


@pytest.mark.parametrize("value", ["!foo 3", "!degrees x", "!degrees [1]"])
def test_a_tag_that_no_launch_file_reads_has_its_line(value: str) -> None:
    text = f"joint_limits:\n  a:\n    max_position: {value}\n"
    with pytest.raises(InputError, match=r"joint_limits\.yaml:3:"):
        parameters_from("", {"joint_limits.yaml": text}, "jazzy")
