"""Examples that rules about references share."""

from __future__ import annotations

from lxml.etree import _Element

TWO = "<link name='a'/><link name='b'/>"
JOINT = '<link name="a"/><link name="b"/><joint name="j" type="continuous"><parent link="a"/>'
JOINT += '<child link="b"/>'
ARM = f"{JOINT}</joint>"
PAIR = ARM + '<link name="c"/><joint name="k" type="continuous"><parent link="b"/>'
PAIR += '<child link="c"/>{}</joint>'
SYSTEM = '<ros2_control name="s" type="system">{}</ros2_control>'
IMU = '<gazebo reference="{}"><sensor name="{}" type="imu"/></gazebo>'
PLUGIN = '<gazebo><plugin filename="lib{}.so" name="{}">{}</plugin></gazebo>'


def name_of(element: _Element) -> str:
    """The name of an element without the white space around it."""
    return element.get("name", "").strip()
