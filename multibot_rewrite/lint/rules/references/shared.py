"""Examples that rules about references share."""

from __future__ import annotations

from lxml.etree import _Element

from multibot_rewrite.lint.rules.examples import a_joint, a_link, block

LINKS = a_link("a") + a_link("b")
ARM = LINKS + a_joint("j", "continuous", "a", "b")
FIXED = LINKS + a_joint("j", "fixed", "a", "b")
IMU = block('<gazebo reference="a">', '<sensor name="{}" type="imu"/>')


def a_pair(*inside: str) -> str:
    """Two joints, 9 lines; with something in the second it is in line 9, and there are 10."""
    return ARM + a_link("c") + a_joint("k", "continuous", "b", "c", *inside)


def a_system(*inside: str) -> str:
    """A <ros2_control>."""
    return block('<ros2_control name="s" type="system">', *inside)


def a_plugin(library: str, name: str, *inside: str) -> str:
    """A plugin of Gazebo Classic."""
    opening = f'<plugin filename="lib{library}.so" name="{name}">'
    return block("<gazebo>", block(opening, *inside))


def name_of(element: _Element) -> str:
    """The name of an element without the white space around it."""
    return element.get("name", "").strip()
