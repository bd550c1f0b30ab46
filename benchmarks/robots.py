# SPDX-License-Identifier: Apache-2.0
"""A robot of any size, with what real ones hold: fixed and moving joints, blocks, plugins."""

from __future__ import annotations

LINK = """
  <link name="link_{n}">
    <inertial>
      <origin xyz="0.01 0 {n}e-3" rpy="0 0 0"/>
      <mass value="0.5"/>
      <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.03"/>
    </inertial>
    <!-- the shell, and a box for what stands on it -->
    <visual>
      <origin xyz="0.012 -0.003 0.1405" rpy="0 0 1.5707963"/>
      <geometry><mesh filename="package://rover_description/meshes/part_{n}.stl"/></geometry>
      <material name="grey"/>
    </visual>
    <visual>
      <origin xyz="0.012 0.144 0.0725" rpy="3.1415926 0 0"/>
      <geometry><box size="0.25 0.125 0.0625"/></geometry>
      <material name="orange"><color rgba="1.0 0.5 0.0 1.0"/></material>
    </visual>
    <collision>
      <origin xyz="0.012 -0.003 0.1405" rpy="0 0 1.5707963"/>
      <geometry><cylinder radius="0.05" length="0.2"/></geometry>
    </collision>
    <collision>
      <origin xyz="0.012 0.144 0.0725" rpy="3.1415926 0 0"/>
      <geometry><box size="0.25 0.125 0.0625"/></geometry>
    </collision>
  </link>
  <gazebo reference="link_{n}"><mu1>0.9</mu1></gazebo>
"""
JOINT = """  <joint name="joint_{n}" type="revolute">
    <parent link="link_{p}"/>
    <child link="link_{n}"/>
    <origin xyz="0 0 0.1" rpy="0 0 0"/>
    <axis xyz="0 0 1"/>
    <limit lower="-1.5" upper="1.5" effort="10" velocity="2"/>
  </joint>
  <transmission name="transmission_{n}">
    <type>transmission_interface/SimpleTransmission</type>
    <joint name="joint_{n}"/>
    <actuator name="motor_{n}"/>
  </transmission>
"""
PLUGIN = """  <gazebo reference="link_{n}">
    <sensor name="lidar_{n}" type="ray">
      <plugin name="driver_{n}" filename="libgazebo_ros_ray_sensor.so">
        <ros><remapping>~/out:=scan_{n}</remapping></ros>
        <frame_name>link_{n}</frame_name>
      </plugin>
    </sensor>
  </gazebo>
"""


def robot(links: int) -> bytes:
    """Return a URDF with that many links, about 2 kB each; as many names per kB (4.5) as the median
    of a thousand public files."""
    parts = ['<?xml version="1.0"?>\n<!-- made for measuring -->\n<robot name="rover">']
    parts.append('\n  <material name="grey"><color rgba="0.5 0.5 0.5 1"/></material>')
    for n in range(links):
        parts.append(LINK.format(n=n))
        if n:
            parts.append(JOINT.format(n=n, p=(n - 1) // 2))
        if n % 10 == 0:
            parts.append(PLUGIN.format(n=n))
    return ("".join(parts) + "</robot>\n").encode()
