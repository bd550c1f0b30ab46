# SPDX-License-Identifier: Apache-2.0
"""What examples of rules stand beside, and are made of."""

from __future__ import annotations

from collections.abc import Mapping

_ROVER = """\
<robot name="rover">
  <link name="base_link"/>
  <link name="lidar_link"/>
  <joint name="lidar_joint" type="fixed"><parent link="base_link"/><child link="lidar_link"/></joint>
  <link name="left"/>
  <joint name="left_wheel_joint" type="continuous">
    <parent link="base_link"/><child link="left"/><axis xyz="0 1 0"/>
  </joint>
  <link name="right"/>
  <joint name="right_wheel_joint" type="continuous">
    <parent link="base_link"/><child link="right"/><axis xyz="0 1 0"/>
  </joint>
</robot>
"""
ROVER: Mapping[str, str] = {
    "package.xml": "<package><name>rover</name></package>",
    "urdf/rover.urdf": _ROVER,
}


def a_section(node: str, line: str) -> str:
    """A parameter file with one line, the third."""
    return f"{node}:\n  ros__parameters:\n    {line}\n"


def a_row(line: str = "") -> str:
    """A row of a bridge file with one more line, the fifth."""
    return (
        "- ros_topic_name: scan\n"
        "  gz_topic_name: scan\n"
        "  ros_type_name: sensor_msgs/msg/LaserScan\n"
        "  gz_type_name: gz.msgs.LaserScan\n"
        f"{f'  {line}' if line else ''}\n"
    )


def a_controller(declared: str, section: str) -> str:
    """A controller that a manager declares, and from the fourth line a section for one."""
    return (
        "controller_manager:\n"
        "  ros__parameters:\n"
        f"    {declared}: {{type: joint_trajectory_controller/JointTrajectoryController}}\n"
        f"{section}:\n"
        "  ros__parameters: {joints: [left_wheel_joint], command_interfaces: [position],\n"
        "    state_interfaces: [position]}\n"
    )
