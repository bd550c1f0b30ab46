# SPDX-License-Identifier: Apache-2.0
"""Two robots of a fleet that were given one device: its address, number or calibration, a port."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.fleet.file.robot_spec import Sources
from multibot_rewrite.fleet.robots.own_values import own_value, sources_of
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.fleet.robots.robot_nodes import RobotEvidence
from multibot_rewrite.knowledge.parameters import KnownNodes
from multibot_rewrite.knowledge.records import MANAGER
from multibot_rewrite.producers.addresses import of_hardware, of_parameters
from multibot_rewrite.rules.check import judge
from multibot_rewrite.rules.system.sharing import one_device
from multibot_rewrite.system.index import index
from multibot_rewrite.system.ownership import whose_by_plan
from multibot_rewrite.system.records import DEVICE, Address, Place, Robot, System


def one_device_each(
    robots: Sequence[RewrittenRobot],
    evidence_of: Callable[[RewrittenRobot], RobotEvidence],
    known: KnownNodes,
    told: Collection[str] = (),
) -> Iterator[Finding]:
    """What two robots were both given, at the second one, but for values that are ``told`` already."""
    hardware = {it.spec.namespace: tuple(_of_hardware(it, told)) for it in robots}
    by_name = {it.spec.namespace: it for it in robots}
    count = Counter((it.name, it.value) for its in hardware.values() for it in its)
    hints: dict[Sources, str] = {}
    for it in _met(robots, [one for its in hardware.values() for one in its]):
        sources = by_name[it.robot].spec.sources
        if sources not in hints:
            hints[sources] = _own_values(by_name[it.robot], count)
        yield _said(it, "; ".join(filter(None, (it.hint, hints[sources]))))
    of_all = Counter(path for it in robots for path in it.spec.companions.get("params", ()))
    # What a file for several robots has is told there, or numbered.
    shared = frozenset(path for path, count in of_all.items() if count > 1)
    given = [one for it in robots for one in _of_nodes(it, evidence_of(it), known, shared)]
    yield from (_said(it, it.hint) for it in _met(robots, given))


def _met(robots: Sequence[RewrittenRobot], addresses: Sequence[Address]) -> Iterator[Finding]:
    fleet = System(
        robots=tuple(Robot(it.spec.namespace) for it in robots), addresses=tuple(addresses)
    )
    found = judge(index(fleet, whose_by_plan(fleet))) if addresses else ()
    yield from (it for it in found if it.code == one_device.code)


def _said(it: Finding, hint: str) -> Finding:
    return it._replace(message=f"{it.node} {it.message}", hint=hint, node="", robot="")


def _of_hardware(robot: RewrittenRobot, told: Collection[str]) -> Iterator[Address]:
    """At the robot's line of the fleet file; those of simulators have no devices."""
    spec = robot.spec
    if spec.simulator != "gazebo":
        node, place = f"/{spec.namespace}/{MANAGER}", Place(spec.file, spec.line, 1)
        found = of_hardware(robot.member.inventory.document.root, node, place)
        yield from (it for it in found if it.value not in told)


def _own_values(robot: RewrittenRobot, count: Mapping[tuple[str, str], int]) -> str:
    """How a robot gets its own of what others have, too."""
    params = robot.member.source.root.iterfind("ros2_control/hardware/param")
    met = [it for it in params if count.get((it.get("name", ""), (it.text or "").strip()), 0) > 1]
    return own_value(sources_of(robot.written, robot.member, met))


def _of_nodes(
    robot: RewrittenRobot, evidence: RobotEvidence, known: KnownNodes, shared: Collection[str]
) -> Iterator[Address]:
    for node in evidence.given:
        facts = known.nodes.get(node.known)
        own = {name: it for name, it in node.values.items() if it.place.file not in shared}
        name = f"/{robot.spec.namespace}/{node.name}"
        found = of_parameters(name, facts.params if facts else {}, own)
        simulated = robot.spec.simulator == "gazebo"
        yield from (it for it in found if it.kind != DEVICE or not simulated)
