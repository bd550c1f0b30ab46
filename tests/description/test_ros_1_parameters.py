# SPDX-License-Identifier: Apache-2.0
"""A plugin with parameters of ROS 1 in a robot of ROS 2 is the one of ROS 2: it gets a namespace."""

from __future__ import annotations

import pytest

from multibot_rewrite import rewrite_all

PLUGIN = """\
<gazebo reference="base">
  <sensor name="imu" type="imu">
    <plugin filename="libgazebo_ros_imu_sensor.so" name="imu_plugin">
      <topicName>imu</topicName><bodyName>base</bodyName>
    </plugin>
  </sensor>
</gazebo>
"""
CONTROL = """\
<ros2_control name="sys" type="system">
  <hardware><plugin>gazebo_ros2_control/GazeboSystem</plugin></hardware>
</ros2_control>
"""
OTHER = """\
<gazebo>
  <plugin filename="libgazebo_ros_planar_move.so" name="drive"><ros/></plugin>
</gazebo>
"""


@pytest.mark.parametrize(
    ("more", "is_ros_2"),
    [("", False), (CONTROL, True), (OTHER, False)],
    ids=["1", "control", "ros"],
)
def test_its_node_is_one_of_the_robot(more: str, is_ros_2: bool) -> None:
    text = f'<robot name="rover"><link name="base"/>\n{more}{PLUGIN}</robot>'
    for it in rewrite_all(text, ["robot1", "robot2"], layout="frames-per-robot", distro="humble"):
        plugin = it.data.decode().partition("imu_plugin")[2].partition("</plugin>")[0]
        assert (f"<namespace>/{it.robot}</namespace>" in plugin) == is_ros_2
