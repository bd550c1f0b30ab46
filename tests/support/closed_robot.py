# SPDX-License-Identifier: Apache-2.0
"""The files of two fleets of two robots that close: a rover with controllers, a filter, a bridge,
MoveIt and Nav2, and an arm on a base with MoveIt, sensors and filters."""

from __future__ import annotations

from paths import FIXTURES

MASS = (
    '<inertial><mass value="1"/>'
    '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
)
FILES, ARM_FILES = (
    {it.name: it.read_text() for it in sorted((FIXTURES / folder).iterdir())}
    for folder in ("closed_rover", "closed_arm")
)
