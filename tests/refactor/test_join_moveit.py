# SPDX-License-Identifier: Apache-2.0
"""MoveIt's files of parts as one of each kind: what they become, by hand; what is refused."""

from __future__ import annotations

from pathlib import Path
from textwrap import dedent
from typing import Any

import pytest
import yaml

from multibot_rewrite import InputError, Joined, Part, UsageError, join
from multibot_rewrite.cli.multibot import main

ARM = """\
<robot name="arm">
  <link name="base"/>
  <link name="tool"/>
  <joint name="turn" type="continuous">
    <parent link="base"/><child link="tool"/><axis xyz="0 0 1"/>
  </joint>
</robot>
"""
SRDF = '<robot name="arm"><group name="arm"><joint name="turn"/></group></robot>\n'
TABLE = '<robot name="cell"><link name="table"/></robot>\n'
FILES = {
    "kinematics.yaml": "arm:\n  kinematics_solver: kdl_kinematics_plugin/KDLKinematicsPlugin\n"
    "  kinematics_solver_timeout: 0.05\n",
    "my_joint_limits.yaml": "default_velocity_scaling_factor: SCALE\n"
    "joint_limits:\n  turn: {has_velocity_limits: true, max_velocity: 2.0}\n",
    "moveit_controllers.yaml": "moveit_simple_controller_manager:\n  controller_names: [follow]\n"
    "  follow: {type: FollowJointTrajectory, action_ns: follow_joint_trajectory, joints: [turn]}\n",
    "ompl_planning.yaml": "adapters: [x, {y: 1}]\nplanner_configs: {Fast: {type: geometric::RRT}}\n"
    "arm: {planner_configs: [Fast]}\n",
}
SOLVER = {
    "kinematics_solver": "kdl_kinematics_plugin/KDLKinematicsPlugin",
    "kinematics_solver_timeout": 0.05,
}
LIMIT = {"has_velocity_limits": True, "max_velocity": 2.0}
MANAGER = "moveit_simple_controller_manager"


def controller(joint: str) -> dict[str, Any]:
    return {
        "type": "FollowJointTrajectory",
        "action_ns": "follow_joint_trajectory",
        "joints": [joint],
    }


def arm_files(folder: Path, scale: float = 0.1, names: tuple[str, ...] = tuple(FILES)) -> list[str]:
    folder.mkdir(exist_ok=True)
    for name in names:
        (folder / name).write_text(FILES[name].replace("SCALE", str(scale)))
    return [str(folder / name) for name in names]


def two(folder: Path, srdf: str | None = SRDF, scale: float = 0.1, flat: str = "") -> Joined:
    each = [("left_", 0.1), ("right_", scale)]
    arms = [
        Part(ARM, "table", prefix=it, srdf=srdf, moveit=arm_files(folder / it, factor))
        for it, factor in each
    ]
    if flat:
        _, *below = FILES["moveit_controllers.yaml"].splitlines(keepends=True)
        (folder / flat / "moveit_controllers.yaml").write_text(dedent("".join(below)))
    return join([Part(TABLE), *arms])


@pytest.mark.parametrize("flat", ["", "left_", "right_"])
def test_there_is_one_file_of_each_kind_with_the_names_of_all_parts(
    tmp_path: Path, flat: str
) -> None:
    """Also where a launch file puts one part's controllers below their manager."""
    made = {name: yaml.safe_load(data) for name, data in two(tmp_path, flat=flat).moveit.items()}
    assert made == {
        "kinematics.yaml": {"left_arm": SOLVER, "right_arm": SOLVER},
        "joint_limits.yaml": {
            "default_velocity_scaling_factor": 0.1,
            "joint_limits": {"left_turn": LIMIT, "right_turn": LIMIT},
        },
        "moveit_controllers.yaml": {
            MANAGER: {
                "controller_names": ["left_follow", "right_follow"],
                "left_follow": controller("left_turn"),
                "right_follow": controller("right_turn"),
            }
        },
        "ompl_planning.yaml": {
            "adapters": ["x", {"y": 1}],
            "planner_configs": {"Fast": {"type": "geometric::RRT"}},
            "left_arm": {"planner_configs": ["Fast"]},
            "right_arm": {"planner_configs": ["Fast"]},
        },
    }


def test_of_two_values_the_first_counts_and_it_is_told(tmp_path: Path) -> None:
    made = two(tmp_path, scale=0.5)
    limits = yaml.safe_load(made.moveit["joint_limits.yaml"])
    assert limits["default_velocity_scaling_factor"] == 0.1
    told = "default_velocity_scaling_factor is 0.5, before it 0.1, which is taken"
    assert any(it.endswith(told) for it in made.notes)


def test_a_file_of_servo_is_left_out_and_told(tmp_path: Path) -> None:
    servo = tmp_path / "servo.yaml"
    servo.write_text("move_group_name: arm\njoint_topic: /joint_states\n")
    made = join([Part(TABLE), Part(ARM, "table", prefix="l_", srdf=SRDF, moveit=[str(servo)])])
    assert made.moveit == {}
    assert any("one servo_node, and left out" in it for it in made.notes)


def test_groups_without_an_srdf_are_refused(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"kinematics.yaml: .*; name its SRDF, too"):
        two(tmp_path, srdf=None)
    # Without a prefix they stay.
    files = arm_files(tmp_path / "bare", names=("kinematics.yaml",))
    made = join([Part(TABLE), Part(ARM, "table", moveit=files)]).moveit["kinematics.yaml"]
    head, _, rest = made.decode().partition("\n")
    assert head == "# joined by multibot from kinematics.yaml"
    assert yaml.safe_load(rest) == {"arm": SOLVER}


def test_a_file_that_is_not_moveits_is_refused(tmp_path: Path) -> None:
    (tmp_path / "other.yaml").write_text("something: {else: 1}\n")
    with pytest.raises(InputError, match=r"other\.yaml"):
        join([Part(TABLE), Part(ARM, "table", moveit=[str(tmp_path / "other.yaml")])])


def test_the_command_writes_them_beside_the_description(here: Path) -> None:
    for name, text in (("table.urdf", TABLE), ("arm.urdf", ARM), ("arm.srdf", SRDF)):
        (here / name).write_text(text)
    given = ",".join(arm_files(here / "config", names=("kinematics.yaml",)))
    arm = f"description: arm.urdf, at: {{parent: table}}, srdf: arm.srdf, moveit: [{given}]"
    Path("all.join").write_text(f"join: [{{description: table.urdf}}, {{prefix: l_, {arm}}}]\n")
    words = ["join", "all.join"]
    assert main([*words, "-o", "robot.urdf", "-q"]) == 0
    assert yaml.safe_load(Path("robot_kinematics.yaml").read_text()) == {"l_arm": SOLVER}
    assert main([*words, "-q"]) == 2
