# SPDX-License-Identifier: Apache-2.0
"""Whether robots and their hardware are simulated, and whether it is known what moves them.

The fleet file or its launch files say it. What a description has for a simulator does nothing on
a real robot: plugins start no node, sensors and drives need no bridge."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from lxml import etree
from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding, declare
from multibot_rewrite.base.model import Claim, Edit
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.description.checks.hazards import LEFT, world_systems
from multibot_rewrite.description.checks.links_and_joints import read_robot, weighs
from multibot_rewrite.description.checks.unknown import SAY_IT
from multibot_rewrite.description.readback.active import HARDWARE, PLUGIN, ActivePart, active_parts
from multibot_rewrite.description.readback.nodes import PUBLISHES
from multibot_rewrite.description.rewriters.tree import library_key
from multibot_rewrite.description.sources.access import BOUNDED
from multibot_rewrite.description.sources.own_names import filled
from multibot_rewrite.description.steps.apply import Spans, cut
from multibot_rewrite.description.steps.collect import values_with_own_model
from multibot_rewrite.fleet.file.fleet_file import FleetFile
from multibot_rewrite.fleet.file.robot_spec import REAL
from multibot_rewrite.fleet.file.simulator_switch import (
    hardware_classes,
    loads_hardware,
    may_be_simulated,
    of_simulator,
    suits_real,
    suits_simulator,
    switch_for,
)
from multibot_rewrite.fleet.robots.member import has_parts_for_simulator, is_for_simulator
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot, at_robot, robot_with_text
from multibot_rewrite.fleet.robots.robot_nodes import RobotEvidence, nodes_of_sets
from multibot_rewrite.knowledge.records import MANAGER, NodeFacts
from multibot_rewrite.planning.bridged_topics import DIRECTIONS, bridged_topics
from multibot_rewrite.producers.evidence.semantics import FIXED
from multibot_rewrite.system.words import moves

SIMULATED_OR_REAL = declare("MF828", "simulated-or-real", NOTE, formats=("fleet",))
OTHER_HARDWARE = declare("MF843", "hardware-of-real-robot-simulated", ERROR, formats=("fleet",))


def other_hardware(robots: Sequence[RewrittenRobot], file: FleetFile) -> Iterator[Finding]:
    """Find hardware that is not of the world that the robots are in, once for each description."""
    told = set()
    for it in robots:
        wrong = _unsuited_hardware(it, nodes_of_sets(it.spec, file))
        if wrong and it.spec.sources not in told:
            told.add(it.spec.sources)
            yield _hardware_finding(it, wrong)


def _unsuited_hardware(robot: RewrittenRobot, node_set: Iterable[NodeFacts]) -> str:
    """Return the first hardware class that does not suit a robot, real or simulated; or empty."""
    # What a simulator's plugin does not load waits for ros2_control_node, as a real robot does.
    root: etree._Element = robot.member.inventory.document.root
    classes = hardware_classes(root)
    simulator = robot.spec.simulator
    if not simulator:
        return ""
    if simulator != REAL and loads_hardware(root):
        return next((it for it in classes if not may_be_simulated(it)), "")
    waiting = any(
        MANAGER in (it.kind, it.host) if simulator == REAL else it.kind == MANAGER and not it.plugin
        for it in node_set
    )
    return next(filter(of_simulator, classes), "") if waiting else ""


def _hardware_finding(robot: RewrittenRobot, wrong: str) -> Finding:
    real = robot.spec.simulator == REAL
    suits = suits_real if real else suits_simulator
    spec = robot.spec
    given = filled(spec.arguments, spec.name)
    switch = switch_for(spec.simulated or spec.description, given, suits, BOUNDED)
    message = f"{wrong} is a simulator's, and robot {spec.name!r} is real"
    if not real and of_simulator(wrong):
        message = f"{wrong} is a simulator's, and no plugin of robot {spec.name!r} loads it"
        hint = "add the simulator's plugin of ros2_control to the description"
        return at_robot(OTHER_HARDWARE, robot, message, f"{hint}, or switch it on")
    if not real:
        message = f"{wrong} is no simulator's, and robot {spec.name!r} is simulated"
    other = "gazebo" if real else "none"
    hint = f"write simulator: {other}, or give it hardware of its world"
    if switch:
        hint = f"give the argument {switch[0]}: {switch[1]!r}, or write simulator: {other}"
    return at_robot(OTHER_HARDWARE, robot, message, hint)


def may_be_real(robot: RewrittenRobot, evidence: RobotEvidence) -> bool:
    """Return whether a robot has parts for a simulator, and nothing says that it runs in one."""
    return evidence.unsimulated and not is_said(robot) and has_parts_for_simulator(robot.member)


def is_simulated(robot: RewrittenRobot) -> bool:
    """Return whether a robot runs in a simulator, by the fleet file or else its description."""
    if is_said(robot):
        return robot.spec.simulator != REAL
    return bool(robot.spec.simulated) or is_for_simulator(robot.member)


def is_said(robot: RewrittenRobot) -> bool:
    """Return whether the fleet file says if a robot runs in a simulator."""
    return bool(robot.spec.simulator or robot.spec.related_files.get("bridge"))


def note(robot: RewrittenRobot) -> Finding:
    """Return the finding that nothing tells whether robots are simulated."""
    message = (
        "no launch file starts a simulator, and the description has plugins or sensors for one"
    )
    hint = "write simulator: none for real robots, simulator: gazebo for simulated ones"
    return at_robot(SIMULATED_OR_REAL, robot, message, hint)


def without_mass(robot: RewrittenRobot) -> Iterator[Finding]:
    """Yield a finding for a robot without mass, if the file does not say that it is real."""
    root: etree._Element = robot.member.inventory.document.root
    if robot.spec.simulator or is_simulated(robot) or weighs(read_robot(root)):
        return
    message = f"robot {robot.spec.name!r} has no mass: the launch file does not spawn it"
    hint = "write simulator: none for a real robot; else add <inertial> to its links"
    yield at_robot(SIMULATED_OR_REAL, robot, message, hint)


def lookups_of_model(robot: RewrittenRobot) -> Iterator[Claim]:
    """Yield the values that use the robot's own model, but for topics given in full."""
    inventory = robot.member.inventory
    if found := [*values_with_own_model(inventory)]:
        bridged, _ = bridged_topics({"": inventory}, robot.topics.naming)
        given = {it.gz for it in bridged}
        yield from (it for it in found if it.value.strip() not in given)


def with_model(robot: RewrittenRobot) -> RewrittenRobot:
    """Return the robot with the name that it is spawned with."""
    # That of the fleet file, else its own model's where a plugin looks for that, else the robot's.""
    spec = robot.spec
    own = spec.model or (any(lookups_of_model(robot)) and robot.member.inventory.model)
    return robot._replace(spec=spec._replace(model=own or spec.name))


UNREAD_DRIVE = declare("MF844", "drive-of-unknown-code", NOTE, formats=("fleet",))


def unread_drives(robot: RewrittenRobot, hardware: bool) -> Iterator[Finding]:
    """Yield plugins that may move the robot and are unknown, and such ``hardware`` if loaded."""
    root: etree._Element = robot.member.source.root
    simulated = robot.spec.simulator != REAL
    asked = {HARDWARE: hardware or (simulated and loads_hardware(root)), PLUGIN: simulated}
    parts = [
        it
        for it in active_parts(root, robot.member.definitions)
        if asked.get(it.kind) and next(it.element.iterancestors("sensor"), None) is None
    ]
    unread = [it for it in parts if not it.is_known]
    alone = bool(unread) and not _has_drive(robot, parts)
    for it in unread:
        # Hardware without a joint is a sensor's.
        why = _part(it, root) or ("is all that may move it" if alone and it.kind == PLUGIN else "")
        if why:
            who = f"robot {robot.spec.name!r}: {it.kind} {it.name}"
            message = f"{who} {why}, and its code is not known, nor whether it drives the robot"
            yield at_robot(UNREAD_DRIVE, robot, message, SAY_IT)


def _part(part: ActivePart, root: etree._Element) -> str:
    """Return the joint or link that a plugin or class names, for a message."""
    inner = part.element.iterdescendants()
    texts = (text for it in inner for text in (it.text or "", *map(str, it.attrib.values())))
    words = {word.rpartition("::")[2] for text in texts for word in text.replace(",", " ").split()}
    moving = (it for it in root.iter("joint") if it.get("type", FIXED) != FIXED)
    links = () if part.kind == HARDWARE else root.iter("link")
    for what, its in (("joint", moving), ("link", links)):
        names = sorted(words & {it.get("name", "") for it in its} - {""})
        if names:
            return f"names the {what} {names[0]}"
    return ""


def _has_drive(robot: RewrittenRobot, parts: Iterable[ActivePart]) -> bool:
    """Return whether there is known hardware, or a plugin that names a joint or reads commands."""
    root: etree._Element = robot.member.source.root
    ends = (it for node in robot.member.reading.nodes for it in node.endpoints)
    topics, _ = bridged_topics({"": robot.member.inventory}, robot.topics.naming)
    return (
        # A plugin of a state tells where joints are, and moves none.
        any(it.is_known and "joint " in _part(it, root) for it in parts if "state" not in it.name)
        or any(moves(it.code_name, it.type) for it in ends if it.role != PUBLISHES)
        or any(it.direction == DIRECTIONS["out"] for it in topics)
    )


# The rule about a description alone; a fleet takes its advice.
_IN_ROBOT = "MB416"
_GZ = "gz-sim-"
MOVED = declare(LEFT, "system-of-the-world", NOTE, formats=("fleet",))


def without_world_systems(robots: Sequence[RewrittenRobot]) -> list[RewrittenRobot]:
    """Return the robots without world systems, each with those that it had; the first has the note."""
    made = [_without_world_systems(it) for it in robots]
    first = next((it for it in made if it.world_systems), None)
    if first is None:
        return made
    every = systems_of(made)
    message = f"the world loads {shorten(sorted(every))}, not each robot"
    hint = "another world than the fleet's has to load them"
    result = []
    for robot in made:
        said = [at_robot(MOVED, first, message, hint)] if robot is first else []
        for library, text in robot.world_systems.items():
            if text.split() != every[library].split():
                other = f"{robot.spec.name} has other settings of {library}: they are not used"
                said.append(at_robot(MOVED, robot, other, "write one text for all", WARNING))
        result.append(robot._replace(findings=(*robot.findings, *said)))
    return result


def systems_of(robots: Sequence[RewrittenRobot]) -> dict[str, str]:
    """Return the plugins that these robots had, by library; for one library that of the first robot."""
    found: dict[str, str] = {}
    for it in robots:
        found = {**it.world_systems, **found}
    return found


def _without_world_systems(robot: RewrittenRobot) -> RewrittenRobot:
    said = tuple(it for it in robot.findings if it.code != _IN_ROBOT)
    if robot.spec.simulator == REAL:  # no simulator loads it
        return robot._replace(findings=said)
    document = robot.member.inventory.document
    own = [it.element for it in world_systems(robot.member.inventory)]
    # A description for Gazebo Classic keeps them: its worlds are not made here.
    if not own or not all(_library_of(it).startswith(_GZ) for it in own):
        return robot
    spans = Spans(document)
    edits = [Edit(spans.start_of(it), spans.end_of(it), b"", None) for it in own]
    data = b"".join(cut(document.source, sorted(edits)))
    texts = {_library_of(it): spans.text_of(it).decode() for it in own}
    return robot_with_text(robot, data)._replace(world_systems=texts, findings=said)


def _library_of(plugin: _Element) -> str:
    return library_key((plugin.get("filename") or "").rpartition("/")[2])
