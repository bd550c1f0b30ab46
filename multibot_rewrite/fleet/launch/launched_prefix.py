# SPDX-License-Identifier: Apache-2.0
"""A prefix of frames that a launch file gives robot_state_publisher, in addition to the built
description.

Source: robot_state_publisher src/robot_state_publisher.cpp: frame_prefix is put before each frame; tf2
takes a leading slash away.
"""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import WARNING, Finding, declare
from multibot_rewrite.fleet.fleet import FRAME_PREFIX
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.robots.robot_nodes import node_sources
from multibot_rewrite.spelling.transforms import STATE_PUBLISHER

OTHER_PREFIX = declare("MF841", "launch-file-adds-prefix", WARNING, formats=("fleet",))


def launched_prefixes(plan: FleetPlan) -> Iterator[Finding]:
    """Report prefixes that launch files give, for the first robot of each kind."""
    for key, found in plan.evidence.items():
        robot = next(it for it in plan.robots if node_sources(it.spec) == key)
        # What its own robot_state_publisher gets; there may be another one, as of a dock.
        every = [it for it in found.given if it.fact.known == STATE_PUBLISHER]
        own = next((it for it in every if it.node == STATE_PUBLISHER), None)
        publisher = own or (every[0] if len(every) == 1 else None)
        given = publisher.values.get(FRAME_PREFIX) if publisher else None
        # What is in a parameter file is rewritten there.
        if given and given.place.file in robot.spec.companions.get("params", ()):
            continue
        prefix = str(given.value).strip("/") if given else ""
        if not given or prefix == robot.frame_prefix.strip("/"):
            continue
        layout = robot.names.naming.layout.name
        starts = f"{STATE_PUBLISHER} of {robot.spec.name} is started with"
        message = f"{starts} frame_prefix {prefix!r}, which layout {layout} has not"
        hint = "leave it out of the launch file, or use layout frame-prefix"
        if not prefix:
            message = f"{starts} no frame_prefix, and layout {layout} needs {robot.frame_prefix!r}"
            hint = f"give it frame_prefix: {robot.frame_prefix}"
        file, line, _ = given.place
        yield OTHER_PREFIX.finding(message, hint, file=file, line=line)
