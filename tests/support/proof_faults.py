# SPDX-License-Identifier: Apache-2.0
"""Wrong outputs of a rewrite, and the check of the proof that has to refuse each of them."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from paths import FIXTURES, fixture_text

FILE = FIXTURES / "proof_faults.txt"

# A link and a joint have one name, a link has as many letters as odom/robot1, one line ends as
# Windows does, and there are escapes, quotes and comments of both sorts.
ROVER = b"""\
<?xml version="1.0" encoding="utf-8"?>
<!-- made by hand -->
<robot name="rover">
  <link name="base"/>
  <link name='wheel'><visual><geometry><mesh filename="wheel.stl"/></geometry></visual></link>
  <link name="odom_link_1"/>
  <link name="nut &amp; bolt"/>
  <joint name="axle" type="continuous"><parent link="base"/><child link="wheel"/></joint>
  <joint name="base" type="fixed"><parent link="base"/><child link="odom_link_1"/></joint>\r
  <joint name="bolt" type="fixed"><parent link="wheel"/><child link="nut &amp; bolt"/></joint>
  <note link="base">base and axle</note>
  <gazebo reference="base"><mu1>0.2</mu1></gazebo>
  <gazebo>
    <plugin name="drive" filename="libgazebo_ros_diff_drive.so">
      <ros><namespace>/demo</namespace><remapping>cmd_vel:=demo/cmd_vel</remapping></ros>
      <update_rate>50</update_rate>
      <left_joint>axle</left_joint>
      <robot_base_frame>base</robot_base_frame>
    </plugin>
    <plugin name="imu" filename="libgazebo_ros_imu_sensor.so"/>
  </gazebo>
</robot>
"""

# The touch of two links that are lumped into one.
TOUCH = fixture_text("proof_faults_touch.urdf").encode()

MODEL = b"""\
<sdf version="1.9"><model name="cart">
  <link name="base"/><link name="arm"/><frame name="tip" attached_to="arm"/>
  <joint name="elbow" type="fixed"><parent>base</parent><child>arm</child></joint>
  <model name="tool"><link name="grip"><pose relative_to="__model__"/></link></model>
  <joint name="wrist" type="fixed"><parent>arm</parent><child>tool::grip</child></joint>
</model></sdf>
"""

GROUPS = b"""\
<robot name="arm">
  <group name="all"><link name="a"/><joint name="j"/></group>
  <disable_collisions link1="a" link2="b" reason="Adjacent"/>
</robot>
"""
ARM = b'<robot name="arm"><link name="a"/><link name="b"/><joint name="j" type="fixed"/></robot>'

# Elements that are there and empty.
EMPTY = fixture_text("proof_faults_empty.urdf").encode()

SOURCES = {"rover": ROVER, "touch": TOUCH, "model": MODEL, "groups": GROUPS, "empty": EMPTY}


class Fault(NamedTuple):
    """In the output of ``source``, ``old`` is ``new``; ``refused_by`` sees that for what it is.

    Other checks may see it, too.
    """

    about: str
    refused_by: str
    source: str
    layout: str
    old: bytes
    new: bytes

    def planted(self, text: bytes) -> bytes:
        """Return the output with the fault in it, at the first place where it fits."""
        assert self.old in text, f"{self.about}: the output holds no {self.old!r}"
        return text.replace(self.old, self.new, 1)


def read_faults(file: Path = FILE) -> list[Fault]:
    """Return the faults of a file, which itself says how they are written."""
    faults = []
    head: list[str] = []
    for block in file.read_text().split("\n\n"):
        lines = [line for line in block.split("\n") if line and not line.startswith("#")]
        if not lines:
            continue
        if lines[0].startswith("== "):
            head = lines[0].split()[1:]
            continue
        about, old, new = lines
        assert old.startswith("- ") and new.startswith("+"), about
        faults.append(Fault(about, *head, _written(old[2:]), _written(new[2:])))
    return faults


def _written(text: str) -> bytes:
    return text.encode().decode("unicode_escape").encode()
