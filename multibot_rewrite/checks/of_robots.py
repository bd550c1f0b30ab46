# SPDX-License-Identifier: Apache-2.0
"""What is wrong with the robots of a fleet themselves, whatever files go with them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from itertools import combinations, pairwise
from math import ceil, dist

from multibot_rewrite.base.conventions import CLOCK, USUAL_FRAMES
from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding, declare
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.checks.lacking import lacking, without_camera
from multibot_rewrite.checks.meeting import named_twice
from multibot_rewrite.description.checks.problem import to_findings
from multibot_rewrite.description.checks.shapes import filled_by
from multibot_rewrite.description.readback.meeting import OPENED
from multibot_rewrite.description.rewriters.plugin_definitions import Definitions, load_definitions
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.fleet.file.robot_spec import Pose, RobotSpec, Sources
from multibot_rewrite.fleet.fleet import FRAME_PREFIX
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.moveit_parameters import moveit_frames
from multibot_rewrite.fleet.robots.node_names import names_of
from multibot_rewrite.fleet.robots.own_values import own_value, sources_of
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot, at_robot
from multibot_rewrite.fleet.robots.robot_groups import group_robots
from multibot_rewrite.fleet.robots.robot_nodes import RobotEvidence, node_sources
from multibot_rewrite.fleet.robots.simulators import is_simulated, other_hardware
from multibot_rewrite.knowledge.parameters import KnownNodes, load_known_nodes
from multibot_rewrite.knowledge.records import MANAGER
from multibot_rewrite.planning.bridged_topics import is_bridged
from multibot_rewrite.planning.transforms import STATE_PUBLISHER
from multibot_rewrite.producers.addresses import of_hardware, of_parameters, of_words
from multibot_rewrite.producers.launch.findings import NOT_LAUNCHED
from multibot_rewrite.producers.launch.handed_on import for_robot
from multibot_rewrite.related_files.names.rename_map import spell
from multibot_rewrite.rules.check import judge
from multibot_rewrite.rules.files.ros_names import in_description
from multibot_rewrite.rules.launch.models import in_each_other
from multibot_rewrite.rules.system.clocks import clocks_mixed, compares_times, two_clocks
from multibot_rewrite.rules.system.sharing import one_device
from multibot_rewrite.system.index import index
from multibot_rewrite.system.ownership import whose_by_plan
from multibot_rewrite.system.records import DEVICE, SERVES, Address, Place, Robot, System

OTHER_PREFIX = declare("MF841", "launch-file-adds-prefix", WARNING, formats=("fleet",))
# Robots of which each pair is looked at; of more the nearest neighbours in a list are.
MOST = 400


def of_robots(plan: FleetPlan) -> Iterator[Finding]:
    """Yield what is wrong with the robots themselves, whatever files go with them."""
    yield from plan.of_rewrites
    yield from other_hardware(plan.robots, plan.file)
    yield from _two_simulators(plan)
    yield from moved_services(plan)
    yield from named_twice(plan.robots)
    yield from _one_device_each(plan)
    yield from lacking(plan)
    yield from without_camera(plan)
    yield from _too_near(plan)
    yield from _launched_prefixes(plan)
    yield from moveit_frames(plan)
    yield from differences(plan)
    yield from of_sdf_alone(plan)
    yield from _on_another_time(plan)
    yield from _not_started(plan)
    # Each description that names another robot of the fleet in values of unknown use, at its first such
    # value; what is for the one robot of it is right.
    words = {word for it in plan.robots for word in it.spec.words}
    for group in group_robots(plan):
        first, *more = group.robots
        source = first.member.source
        others = words if more else words.difference(first.spec.words)
        problems = in_description(source.root, others, first.names.declared)
        yield from to_findings(source, problems, ERROR)


def _not_started(plan: FleetPlan) -> Iterator[Finding]:
    """Yield launched nodes that something else makes under their name."""
    # A simulator's plugin makes a controller manager named as ros2_control_node's.
    table = plan.fleet.table
    for robot in plan.robots:
        started = {*names_of(table, robot.spec.namespace).started, *names_of(table, "").started}
        taken = {it.node for it in table.runs if it.robot in (robot.spec.namespace, "")} - started
        for name, it in plan.evidence_of(robot).handed_on.items():
            if name in taken:
                message = f"{' '.join(it.program)} is not started: a plugin makes the node {name}"
                hint = "the robot has one node of a name; leave it out of the launch file"
                yield NOT_LAUNCHED.finding(message, hint, file=it.place.file, line=it.place.line)


def _two_simulators(plan: FleetPlan) -> Iterator[Finding]:
    """Yield a finding if no one simulator runs the simulated robots: the clock would have two."""
    found = {it.is_classic: it for it in plan.robots if is_simulated(it)}
    if len(found) > 1 and not plan.file.apart.domains:
        classic, gz = (found[it].spec.description for it in (True, False))
        message = f"{classic} is for Gazebo Classic and {gz} for gz-sim: no simulator runs both"
        hint = "take descriptions for one simulator, or write simulator: none for real robots"
        yield at_robot(two_clocks, found[True], message, hint)._replace(names=(CLOCK,))


def _on_another_time(plan: FleetPlan) -> Iterator[Finding]:
    """Yield simulated robots that use the machine's time, and nodes that compare times."""
    for robot in plan.robots:
        facts = plan.evidence_of(robot).nodes if robot.spec.use_sim_time is False else ()
        own = (it.name for it in facts if not (it.when or it.shared))
        timed = [it for it in own if compares_times(it.rpartition("/")[2])]
        bridged = is_simulated(robot) and is_bridged(robot.member.inventory)
        if timed and bridged:
            who = f"robot {robot.spec.name!r} is in a simulator and on the time of the machine"
            message = f"{who}; its sensors have that of the simulator: {shorten(timed)}"
            hint = "leave use_sim_time: false out, or write simulator: none for a real robot"
            yield at_robot(clocks_mixed, robot, message, hint, level=WARNING)


def _one_device_each(plan: FleetPlan) -> Iterator[Finding]:
    """Yield what two robots share of devices, addresses, numbers and ports, and is not reported."""
    robots = plan.robots
    told = {name for it in plan.fleet.table.problems if it.code == OPENED for name in it.names}
    known = load_known_nodes(plan.file.nodes, plan.file.distro)
    definitions = load_definitions(plan.file.definitions, plan.file.distro)
    hardware = {it.spec.name: tuple(_hardware_addresses(it, told, definitions)) for it in robots}
    by_name = {it.spec.name: it for it in robots}
    count = Counter((it.name, it.value) for its in hardware.values() for it in its)
    hints: dict[Sources, str] = {}
    for it in _conflicts(robots, [one for its in hardware.values() for one in its]):
        sources = by_name[it.robot].spec.sources
        if sources not in hints:
            # How a robot gets its own of what others have, too.
            robot = by_name[it.robot]
            params = robot.member.source.root.iterfind("ros2_control/hardware/param")
            keys = ((one, (one.get("name", ""), (one.text or "").strip())) for one in params)
            met = [one for one, key in keys if count.get(key, 0) > 1]
            hints[sources] = own_value(sources_of(robot.written, robot.member, met))
        yield _for_fleet_with_hint(it, "; ".join(filter(None, (it.hint, hints[sources]))))
    of_all = Counter(path for it in robots for path in it.spec.related_files.get("params", ()))
    # What a file for several robots has is told there, or numbered.
    shared = frozenset(path for path, count in of_all.items() if count > 1)
    given = [one for it in robots for one in _in_nodes(it, plan.evidence_of(it), known, shared)]
    given += [one for it in robots for one in _argument_addresses(it, plan.evidence_of(it))]
    yield from (_for_fleet_with_hint(it, it.hint) for it in _conflicts(robots, given))


def _conflicts(robots: Sequence[RewrittenRobot], addresses: Sequence[Address]) -> Iterator[Finding]:
    """Yield the addresses that several robots use."""
    named = tuple(Robot(it.spec.name, namespace=it.spec.namespace) for it in robots)
    fleet = System(robots=named, addresses=tuple(addresses))
    found = judge(index(fleet, whose_by_plan(fleet))) if addresses else ()
    yield from (it for it in found if it.code == one_device.code)


def _for_fleet_with_hint(it: Finding, hint: str) -> Finding:
    return it._replace(message=f"{it.node} {it.message}", hint=hint, node="", robot="")


def _hardware_addresses(
    robot: RewrittenRobot, told: Collection[str], definitions: Definitions
) -> Iterator[Address]:
    """Yield the addresses of a robot's devices; none if it is simulated."""
    spec = robot.spec
    if spec.simulator != "gazebo":
        node, place = f"/{spec.namespace}/{MANAGER}", Place(spec.file, spec.line, 1)
        root = robot.member.inventory.document.root
        found = of_hardware(root, node, place, definitions)
        yield from (it for it in found if it.value not in told)


def _in_nodes(
    robot: RewrittenRobot, evidence: RobotEvidence, known: KnownNodes, shared: Collection[str]
) -> Iterator[Address]:
    """Yield the addresses in the parameters of a robot's nodes."""
    for node in evidence.given:
        facts = known.nodes.get(node.fact.known)
        own = {name: it for name, it in node.values.items() if it.place.file not in shared}
        name = f"/{robot.spec.namespace}/{node.node}"
        found = of_parameters(name, facts.params if facts else {}, own)
        simulated = robot.spec.simulator == "gazebo"
        yield from (it for it in found if it.kind != DEVICE or not simulated)


def _argument_addresses(robot: RewrittenRobot, evidence: RobotEvidence) -> Iterator[Address]:
    """Yield the addresses in the arguments of nodes and processes of launch files."""
    spec = robot.spec
    rows = [(name, it.arguments, it.place) for name, it in evidence.handed_on.items()]
    own = (it for it in evidence.processes if not it.once)
    rows += [(it.name, it.node.arguments, it.node.place) for it in own]
    for name, words, place in rows:
        yield from of_words(f"/{spec.namespace}/{name}", for_robot(words, spec.name), place)


def _too_near(plan: FleetPlan) -> Iterator[Finding]:
    """Yield the simulated robots that start inside another one, or all at the origin."""
    # A robot turns in its place, so half of the larger one's reach is allowed. Somebody else may
    # place a fleet, but the launch file of a build does not.
    robots = [it for it in plan.robots if is_simulated(it)]
    if not any(any(_start_position(it.spec)) for it in robots):
        if len(robots) > 1:
            room = max(1, ceil(4 * max(map(_filled_radius, robots))))
            message = f"the {len(robots)} robots are spawned at the origin, in each other"
            hint = f"write pose: {{x: {room}}} for {robots[1].spec.name}, and so on"
            yield at_robot(in_each_other, robots[1], message, hint, level=WARNING)
        return
    sources = [it.spec.sources for it in robots]
    reach = {key: _filled_radius(it) for key, it in dict(zip(sources, robots, strict=True)).items()}
    placed = [
        (it, _start_position(it.spec), reach[key]) for key, it in zip(sources, robots, strict=True)
    ]
    pairs = combinations(placed, 2) if len(placed) <= MOST else pairwise(placed)
    for (one, here, own), (other, there, more) in pairs:
        if (gap := dist(here, there)) < own + more:
            message = (
                f"robot {other.spec.name!r} starts {gap:.2f} m from robot {one.spec.name!r}; their"
                f" shapes need {own + more:.2f} m"
            )
            yield at_robot(in_each_other, other, message, "give them pose: further apart")


def _filled_radius(it: RewrittenRobot) -> float:
    return filled_by(it.member.inventory.document.root)


def _start_position(spec: RobotSpec) -> tuple[float, float, float]:
    pose = spec.pose or Pose()
    return pose.x, pose.y, pose.z


MOVED = declare("MF851", "service-of-hardware-moved", NOTE, formats=("fleet",))


def moved_services(plan: FleetPlan) -> Iterator[Finding]:
    """Yield the absolute services of hardware that have the robot's name now, one finding a robot."""
    tables = plan.fleet.table.by_robot(it.spec.namespace for it in plan.robots)
    for robot in plan.robots:
        runs = (it for it in tables[robot.spec.namespace].runs if it.fact.of_hardware)
        own = (it for run in runs for it in run.names)
        served = [it for it in own if it[0].role == SERVES and it[0].name[0] == "/"]
        moved = [(end.name, name) for end, name in served if name != end.name]
        if moved:
            rules = ", ".join(f"{old}:={new}" for old, new in moved)
            message = f"the controller manager of robot {robot.spec.name!r} has the rules {rules}"
            hint = f"call {moved[0][1]}: nothing serves {moved[0][0]} any more"
            yield at_robot(MOVED, robot, message, hint)


DIFFERENT = declare("MF711", "model-differs-from-description", WARNING, formats=("fleet",))

SDF_ALONE = declare("MF712", "sdf-for-state-publisher", WARNING, formats=("fleet",))


def of_sdf_alone(plan: FleetPlan) -> Iterator[Finding]:
    """Yield the robots whose robot_state_publisher gets an SDF."""
    # robot_state_publisher.cpp reads it by urdf::Model, which asks the installed parsers.
    published = {it.name for it in plan.fleet.facts if it.package == STATE_PUBLISHER}
    runs = {it.robot for it in plan.fleet.table.runs if it.node in published}
    for robot in plan.robots:
        if robot.member.described.document.root.tag == "sdf" and robot.spec.namespace in runs:
            links = shorten(robot.member.described.declared.get("link", ()))
            message = (
                f"robot_state_publisher of {robot.spec.name} gets an SDF, which it reads with the "
                f"package sdformat_urdf alone; else no node sends {links}"
            )
            hint = "name its URDF as description and this file as simulated, or install the package"
            yield at_robot(SDF_ALONE, robot, message, hint)


def differences(plan: FleetPlan) -> Iterator[Finding]:
    """Yield what the model of a robot and its description do not have in common."""
    for robot in plan.robots:
        if robot.simulated:
            described, model = _moving(robot.member.described), _moving(robot.member.inventory)
            lacking = [it for it in described if it not in model]
            if lacking:
                what = "has no moving joint" if len(lacking) == 1 else "has no moving joints"
                message = f"what the simulator gets of {robot.spec.name} {what} {shorten(lacking)}"
                hint = "nothing in the simulator sends their states; give both files the same names"
                yield at_robot(DIFFERENT, robot, message, hint)
            yield from _unknown_frames(robot)


def _moving(inventory: Inventory) -> list[str]:
    """Return the joints that need states: neither fixed nor following another one."""
    return [
        str(it.get("name", ""))
        for it in inventory.document.root.iter("joint")
        if it.get("type", "fixed") != "fixed"
        if it.find("mimic") is None and it.find("axis/mimic") is None
    ]


def _unknown_frames(robot: RewrittenRobot) -> Iterator[Finding]:
    names = robot.names._replace(robot=robot.spec.tag)
    usual = (spell(names, "frame", it) for it in USUAL_FRAMES)
    known = {*robot.links, *names.naming.shared_frames, *usual}
    named = {
        claim.value.strip()
        for claim in robot.member.inventory.claims
        if claim.site.kinds == ("frame",) and claim.site.form == "whole"
    }
    unknown = sorted(it for it in named - known if it and "<" not in it and "$" not in it)
    if unknown:
        model = f"what the simulator gets of {robot.spec.name}"
        message = f"{model} names frames that its description has not: {shorten(unknown)}"
        hint = "name links of the description, or send a transform to them"
        yield at_robot(DIFFERENT, robot, message, hint)


def _launched_prefixes(plan: FleetPlan) -> Iterator[Finding]:
    """Yield wrong frame prefixes that launch files give to robot_state_publisher."""
    # It is put before each frame; tf2 takes a leading slash away (robot_state_publisher.cpp).
    for key, found in plan.evidence.items():
        robot = next(it for it in plan.robots if node_sources(it.spec) == key)
        # What its own robot_state_publisher gets; there may be another one, as of a dock.
        every = [it for it in found.given if it.fact.known == STATE_PUBLISHER]
        own = next((it for it in every if it.node == STATE_PUBLISHER), None)
        publisher = own or (every[0] if len(every) == 1 else None)
        given = publisher.values.get(FRAME_PREFIX) if publisher else None
        # What is in a parameter file is rewritten there.
        if given and given.place.file in robot.spec.related_files.get("params", ()):
            continue
        prefix = str(given.value).strip("/") if given else ""
        named = bool(prefix) and all(it.startswith(f"{prefix}/") for it in robot.links)
        if not given or named or prefix == robot.frame_prefix.strip("/"):
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
