# SPDX-License-Identifier: Apache-2.0
"""Robots that close in an unusual way: nothing is found, neither by a build nor by a plan."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from closed_robot import ARM_FILES, FILES, MASS
from open_findings import found

from multibot_rewrite.lint.check import lint_file
from multibot_rewrite.rules.settings import Settings

DOOR = (
    "- {ros_topic_name: door, gz_topic_name: /door/open, ros_type_name: std_msgs/msg/Bool, "
    "gz_type_name: gz.msgs.Boolean, direction: ROS_TO_GZ}\n- ros_topic_name: imu/data"
)
FINGER = f'<link name="finger_link">{MASS}</link>\n'
CASTER = (
    f'{FINGER}<link name="caster">{MASS}</link><joint name="caster_joint" type="continuous">'
    '<parent link="base_link"/><child link="caster"/><axis xyz="0 1 0"/></joint>\n'
)
SECOND_FILTER = """\
ekf_map:
  ros__parameters: {odom0: odometry/filtered, world_frame: map, odom_frame: odom, map_frame: map,
    base_link_frame: base_link, publish_tf: false}
ekf_filter_node:
"""
ARM = "    arm_controller: {type: joint_trajectory_controller/JointTrajectoryController}\n"
OTHER = """\
own_controller:
  ros__parameters: {joints: [shoulder_joint], command_interfaces: [position],
    state_interfaces: [position]}
imu_broadcaster:
  ros"""
PID = "    pid: {type: pid_controller/PidController}\n"
CHAINED = """\
pid:
  ros__parameters: {dof_names: [finger_joint], command_interface: position,
    reference_and_state_interfaces: [velocity], gains: {finger_joint: {p: 1.0}}}
imu_broadcaster:
  ros"""
OWN_TYPE = """\
spare_controller:
  ros__parameters: {type: joint_trajectory_controller/JointTrajectoryController, joints: [elbow_joint],
    command_interfaces: [position], state_interfaces: [position]}
imu_broadcaster:
  ros"""
GROUPS = (
    '<virtual_joint name="fixed_base" type="fixed" parent_frame="world" child_link="base_link"/>\n'
    '  <group name="both"><group name="arm"/><group name="hand"/></group>\n  <group name="hand">'
)
RANGES = "odom0: base_controller/odom\n    odom1: visual/odometry\n"
ODD: dict[str, tuple[Any, ...]] = {
    "a row for both directions": (FILES, ("bridge.yaml", "GZ_TO_ROS", "BIDIRECTIONAL")),
    "a type of before Garden": (FILES, ("bridge.yaml", "gz.msgs", "ignition.msgs")),
    "a row for the world": (FILES, ("bridge.yaml", "- ros_topic_name: imu/data", DOOR)),
    "an absolute topic": (FILES, ("ekf.yaml", "imu0: imu/data", "imu0: /imu/data")),
    "the controller sends the odometry": (
        FILES,
        ("ekf.yaml", "publish_tf: true", "publish_tf: false"),
        ("controllers.yaml", "enable_odom_tf: false", "enable_odom_tf: true"),
    ),
    "a second filter that sends nothing": (
        FILES,
        ("ekf.yaml", "ekf_filter_node:\n", SECOND_FILTER),
    ),
    "odometry of a driver that nobody names": (
        FILES,
        ("ekf.yaml", "odom0: base_controller/odom\n", RANGES),
    ),
    "a node that nobody knows": (
        FILES,
        ("nav2.yaml", "slam_toolbox:", "driver:\n  ros__parameters: {topic: x}\nslam_toolbox:"),
    ),
    "a section for all nodes": (
        FILES,
        ("nav2.yaml", "slam_toolbox:", "/**:\n  ros__parameters: {rate: 3}\nslam_toolbox:"),
    ),
    "a lock that a person sends": (
        FILES,
        (
            "nav2.yaml",
            "    topics: {nav",
            "    locks: {stop: {topic: e_stop, timeout: 0.0, priority: 255}}\n    topics: {nav",
        ),
    ),
    "parameters of a source that is not listed": (
        FILES,
        (
            "nav2.yaml",
            "scan: {type: scan, topic: scan}",
            "scan: {type: scan, topic: scan}\n    scan2: {type: scan, topic: scan}",
        ),
    ),
    "a wheel that nothing drives": (FILES, ("rover.urdf", FINGER, CASTER)),
    "two controllers of one joint": (
        ARM_FILES,
        ("controllers.yaml", ARM, f"{ARM}{ARM.replace('arm_', 'own_')}"),
        ("controllers.yaml", "imu_broadcaster:\n  ros", OTHER),
    ),
    "controllers in a chain": (
        ARM_FILES,
        ("controllers.yaml", ARM, ARM + PID),
        ("controllers.yaml", "imu_broadcaster:\n  ros", CHAINED),
    ),
    "a controller with its type in its own section": (
        ARM_FILES,
        ("controllers.yaml", "imu_broadcaster:\n  ros", OWN_TYPE),
    ),
    "groups of groups and a virtual joint": (
        ARM_FILES,
        ("arm.srdf", '<group name="hand">', GROUPS),
    ),
    "MoveIt moves some of the joints": (
        ARM_FILES,
        ("moveit.yaml", "joints: [shoulder_joint, elbow_joint]", "joints: [shoulder_joint]"),
    ),
    "no sources": (ARM_FILES, ("sensors.yaml", "[joint_states]", "[]")),
    "interfaces that nobody claims": (
        ARM_FILES,
        ("moveit.yaml", ", hand_controller]", "]"),
        ("arm.urdf", "torque.z", "torque.z"),
    ),
    "a placeholder of a launch file": (
        ARM_FILES,
        ("controllers.yaml", "sensor_name: tool_imu", "sensor_name: <side>tool_imu"),
    ),
}


@pytest.mark.more
@pytest.mark.sample(10)
@pytest.mark.parametrize("name", ODD)
def test_nothing_is_found(name: str, tmp_path: Path) -> None:
    files, *changes = ODD[name]
    made = dict(files)
    for file, old, new in changes:
        assert old in made[file]
        made[file] = made[file].replace(old, new)
    assert found(tmp_path, made) == ([], [])


# Lists without parameters, sections of no controller: in a file alone.


def linted(text: str, folder: Path, code: str) -> list[tuple[int, str]]:
    (folder / "p.yaml").write_text(text)
    found = lint_file(str(folder / "p.yaml"), Settings(select=(code,)))
    return [(it.line, it.hint.split("(")[0].strip()) for it in found]


@pytest.mark.parametrize(
    ("rest", "meant"),
    [
        ("sources: [frnt], front: {a: 1}", "front"),
        ("layer: {sources: frnt, front: {a: 1}}", "front"),
        # What is listed elsewhere is not meant, nor what differs in a number or is on another level.
        ("sources: [frnt], others: [front], front: {a: 1}", ""),
        ("sources: [front1], front2: {a: 1}", ""),
        ("sources: [frnt], more: {front: {a: 1}}", ""),
        # A name with a dot has its parameters below two names.
        ("file: front_a.pcd, front_a.pcd: {a: 1}, front_b.pcd: {a: 1}", ""),
    ],
)
def test_a_listed_name_without_parameters(rest: str, meant: str, tmp_path: Path) -> None:
    found = linted(f"node:\n  ros__parameters: {{{rest}}}\n", tmp_path, "MB877")
    assert found == ([(2, f"did you mean {meant}")] if meant else [])


CONTROLLERS = FILES["controllers.yaml"]


def test_a_section_that_nobody_declares(tmp_path: Path) -> None:
    assert linted(CONTROLLERS, tmp_path, "MB878") == []
    renamed = CONTROLLERS.replace("base_controller:\n  ros", "base_controler:\n  ros")
    assert linted(renamed, tmp_path, "MB878") == [(7, "did you mean base_controller")]
