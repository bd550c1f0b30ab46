# SPDX-License-Identifier: Apache-2.0
"""Examples that rules about references share."""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.rules.description.examples import a_joint, a_link, block
from multibot_rewrite.rules.subject import Subject

LINKS = a_link("a") + a_link("b")
ARM = LINKS + a_joint("j", "continuous", "a", "b")
FIXED = LINKS + a_joint("j", "fixed", "a", "b")
IMU = block('<gazebo reference="a">', '<sensor name="{}" type="imu"/>')


def a_plugin(library: str, name: str, *inside: str) -> str:
    """A plugin of Gazebo Classic."""
    opening = f'<plugin filename="lib{library}.so" name="{name}">'
    return block("<gazebo>", block(opening, *inside))


OWNERS = ("joint", "sensor", "gpio")
COMMAND, STATE = "command_interface", "state_interface"
STANDARD = ("position", "velocity", "effort", "acceleration")
VELOCITY = '<command_interface name="velocity"/>'


def driven(*interfaces: str) -> str:
    """A joint of a <ros2_control>; with a command for its velocity where nothing else is said."""
    return block('<joint name="j">', *(interfaces or (VELOCITY,)))


def owners(subject: Subject) -> Iterator[_Element]:
    """What has interfaces in every <ros2_control>: joints, sensors, gpios."""
    for system in subject.elements.tops("ros2_control"):
        yield from system.iterchildren(*OWNERS)


def name_of(element: _Element) -> str:
    """The name of an element without the white space around it."""
    return element.get("name", "").strip()
