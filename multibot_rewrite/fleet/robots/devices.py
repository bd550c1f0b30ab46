# SPDX-License-Identifier: Apache-2.0
"""Two robots of a fleet that were given one device: its address, number or calibration, a port."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.knowledge.records import MANAGER
from multibot_rewrite.producers.addresses import of_hardware
from multibot_rewrite.rules.check import judge
from multibot_rewrite.rules.system.addresses import one_device
from multibot_rewrite.system.index import index
from multibot_rewrite.system.ownership import whose_by_plan
from multibot_rewrite.system.records import Address, Place, Robot, System


def one_device_each(
    robots: Sequence[RewrittenRobot], told: Collection[str] = ()
) -> Iterator[Finding]:
    """What two robots were both given, at the second one, but for values that are ``told`` already."""
    addresses = tuple(
        address for it in robots for address in _addresses(it) if address.value not in told
    )
    fleet = System(robots=tuple(Robot(it.spec.namespace) for it in robots), addresses=addresses)
    for it in judge(index(fleet, whose_by_plan(fleet))):
        if it.code == one_device.code:
            yield it._replace(message=f"{it.node} {it.message}", node="", robot="")


def _addresses(robot: RewrittenRobot) -> Iterator[Address]:
    """At the robot's line of the fleet file; those of simulators have no devices."""
    spec = robot.spec
    if spec.simulator != "gazebo":
        node, place = f"/{spec.namespace}/{MANAGER}", Place(spec.file, spec.line, 1)
        yield from of_hardware(robot.member.inventory.document.root, node, place)
