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
