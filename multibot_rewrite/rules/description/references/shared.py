# SPDX-License-Identifier: Apache-2.0
"""What rules about references share: the parts of a ``<ros2_control>`` that have interfaces."""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.rules.subject import Subject

OWNERS = ("joint", "sensor", "gpio")
COMMAND, STATE = "command_interface", "state_interface"
STANDARD = ("position", "velocity", "effort", "acceleration")


def owners(subject: Subject) -> Iterator[_Element]:
    """What has interfaces in every <ros2_control>: joints, sensors, gpios."""
    for system in subject.elements.tops("ros2_control"):
        yield from system.iterchildren(*OWNERS)


def name_of(element: _Element) -> str:
    """The name of an element without the white space around it."""
    return element.get("name", "").strip()
