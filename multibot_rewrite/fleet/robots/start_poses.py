# SPDX-License-Identifier: Apache-2.0
"""The start poses of a fleet: a static transform for each robot, or an initial pose for amcl.

Sources: tf2_ros jazzy ``static_transform_publisher``; nav2_amcl jazzy (``set_initial_pose``).
"""

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding, Rule, declare
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.naming import Naming
from multibot_rewrite.description.rewriters.text import text_at
from multibot_rewrite.fleet.file.fleet_file import FleetFile
from multibot_rewrite.fleet.file.robot_spec import REAL, Pose
from multibot_rewrite.fleet.fleet import Fleet
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot, at_robot
from multibot_rewrite.fleet.robots.robot_groups import said_once, split_per_robot
from multibot_rewrite.fleet.robots.simulators import is_simulated
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts
from multibot_rewrite.planning.bridge_rows import PLUGINS, rows_of
from multibot_rewrite.planning.bridged_topics import TF_ELEMENT, TF_TYPE
from multibot_rewrite.planning.of_runs import placed, target_of
from multibot_rewrite.planning.start import Start
from multibot_rewrite.planning.table import joined, run_of
from multibot_rewrite.related_files.names.rename_map import spell
from multibot_rewrite.related_files.rviz.rewrite import world_frame
from multibot_rewrite.system.records import PUBLISHES, TOPIC, Edge, edge_of
from multibot_rewrite.system.words import START_POSE

AMCL = "amcl"
ORIGIN = Pose()
# Elements of gz-sim's drive and odometry systems that hold the odometry frame.
ODOMETRY = ("frame_id", "odom_frame")
# What drivers call the parameter of their odometry frame.
ODOMETRY_FRAME = lazy_compile(r"(^|[._])odom(etry)?_frame(_id|_name)?$")


class StaticTransform(NamedTuple):
    """What a robot's ``static_transform_publisher`` publishes, and how it is named and started."""

    robot: str
    parent: str
    child: str
    pose: Pose
    namespace: str
    node: str
    remaps: tuple[tuple[str, str], ...]

    @property
    def start(self) -> Start:
        """The process that sends the transform, with values before names; raises nothing."""
        pose = (
            word for key, value in self.pose._asdict().items() for word in (f"--{key}", f"{value}")
        )
        words = (*pose, "--frame-id", self.parent, "--child-frame-id", self.child)
        names = (self.namespace, self.node)
        return Start("tf2_ros", "static_transform_publisher", *names, (), self.remaps, words)


class InitialPose(NamedTuple):
    """The start pose as parameters of the localisation ``node`` (its name in the node set)."""

    robot: str
    node: str
    values: Mapping[str, object]


class StartPoses(NamedTuple):
    """The start poses of a fleet's robots, and findings about robots without one."""

    transforms: tuple[StaticTransform, ...]
    initial: tuple[InitialPose, ...]
    findings: tuple[Finding, ...]


def start_poses(plan: FleetPlan) -> StartPoses:
    """Return for each pose a transform, amcl's pose or both, or why it is not published."""
    found: list[object] = []
    for robot in plan.robots:
        if robot.spec.pose is not None:
            found += _start_of_robot(plan, robot, robot.spec.pose)
    return StartPoses(
        tuple(it for it in found if isinstance(it, StaticTransform)),
        tuple(it for it in found if isinstance(it, InitialPose)),
        tuple(it for it in found if isinstance(it, Finding)),
    )


def world_of(file: FleetFile, naming: Naming) -> str:
    """Return the shared frame that poses are in."""
    return file.world or world_frame(naming)


def _start_of_robot(plan: FleetPlan, robot: RewrittenRobot, pose: Pose) -> Iterator[object]:
    """Yield a robot's transform, amcl's pose, or a finding why neither can be."""
    naming, name = plan.fleet.naming, robot.spec.namespace
    world = world_of(plan.file, naming)
    if not world:
        hint = "set world: or shared_frames:"
        what = "it has a pose, but no frame is shared by all robots"
        yield _at_pose(NO_SHARED_FRAME, robot, what, hint)
        return
    sent = _sent_transforms(plan, robot)
    shared = naming.shared_frames
    placing = {
        node: [it for it in edges if it.parent in shared and it.child not in shared]
        for node, edges in sent.items()
    }
    locators = [node for node, edges in placing.items() if any(not it.static for it in edges)]
    if AMCL in locators:
        yield InitialPose(name, AMCL, initial_pose(pose))
        return
    if locators:
        nodes = " and ".join(it or "its description" for it in locators)
        says = "already says" if len(locators) == 1 else "already say"
        what = f"its pose is not published, because {nodes} {says} where it is"
        hint, level = "remove the pose: a second parent would make the frame jump", WARNING
        if is_simulated(robot):
            hint, level = "the simulator starts it there, which is enough", NOTE
        yield _at_pose(LOCALISED_ALREADY, robot, what, hint)._replace(level=level)
        return
    if held := placing[""]:
        if pose != ORIGIN:
            yield _fixed_to_world_finding(robot, held[0])
        return
    every = [edge for own in sent.values() for edge in own]
    children = {edge.child for edge in every if edge.parent != edge.child}
    parents = dict.fromkeys(edge.parent for edge in every)
    # The robot's own frames without a parent.
    roots = [it for it in parents if it not in children and it not in shared]
    if len(roots) != 1:
        frames = f"{len(roots)} root frames ({', '.join(roots)})" if roots else "no root frame"
        what = f"its pose is not published, because it has {frames} instead of one"
        yield _at_pose(NO_SINGLE_ROOT, robot, what, "connect them by a joint")
        return
    if own := _odometry_sender(plan, robot):
        what = f"its pose is not published, because {own} may send where its base is"
        yield _at_pose(OWN_ODOMETRY, robot, what, "describe it in a file of nodes, with sends:")
        return
    local = AMCL in sent
    if local:
        yield InitialPose(name, AMCL, initial_pose(pose))
    yield static_transform(name, world, roots[0], ORIGIN if local else pose, naming)


def static_transform(
    robot: str, parent: str, child: str, pose: Pose, naming: Naming
) -> StaticTransform:
    """Return the transform of a robot, published by a node with the robot's own name."""
    namespace, node = placed(robot, START_POSE, naming)
    target = target_of("/tf_static", TOPIC, robot, naming)
    remaps = (("/tf_static", target),) if target else ()
    return StaticTransform(robot, parent, child, pose, namespace, node, remaps)


def initial_pose(pose: Pose) -> dict[str, object]:
    """Return amcl's parameters for a start pose, with the switch that makes them count."""
    values = {f"initial_pose.{key}": getattr(pose, key) for key in ("x", "y", "z", "yaw")}
    return {"set_initial_pose": True, **values}


def _sent_transforms(plan: FleetPlan, robot: RewrittenRobot) -> dict[str, list[Edge]]:
    """Return the transforms of each node of a robot; the description's tree has an empty name."""
    name, inventory = robot.spec.namespace, robot.member.inventory
    sent = {node: [*edges] for (own, node), edges in plan.fleet.edges.items() if own == name}
    tree = robot.tree
    children = {edge.child for edge in tree}
    bare = [link for link in robot.links if link not in children]
    odometry = []
    # The odometry frames of gz-sim's systems, which a bridge brings to tf.
    for host in inventory.hosts:
        section = host.node.section.names[0] if host.node.section else ""
        rows = rows_of(PLUGINS, section, inventory.release)
        if any(row.element == TF_ELEMENT and not row.why for row in rows):
            given = (text_at(host.element, tag) for tag in ODOMETRY)
            odometry.append(next(filter(None, given), f"{robot.spec.model}/odom"))
            break
    base = min(bare, default="")
    return {
        **sent,
        "": [*tree, *(edge_of(it, base) for it in odometry if base)]
        or [edge_of(link, link, True) for link in bare],
    }


def _odometry_sender(plan: FleetPlan, robot: RewrittenRobot) -> str:
    """Return the start of a message about an unknown node with an odometry frame, or ""."""
    described = {it.name for it in plan.fleet.facts}
    own = (edges for (name, _), edges in plan.fleet.edges.items() if name == robot.spec.namespace)
    frames = {frame for edges in own for it in edges for frame in (it.parent, it.child)}
    for node in plan.evidence_of(robot).given:
        told = {} if node.fact.known or node.node in described else node.values
        for name, it in told.items():
            value = it.value
            is_frame = ODOMETRY_FRAME.search(name) and isinstance(value, str) and value
            if is_frame and spell(robot.names, "frame", str(value)) not in frames:
                return f"{node.node}, whose {name} is {value!r} ({it.place.file}:{it.place.line}),"
    return ""


def _fixed_to_world_finding(robot: RewrittenRobot, held: Edge) -> Finding:
    """Return the finding about a pose for a link fixed to the world, which only a simulator uses."""
    simulated = robot.spec.simulator not in ("", REAL)
    what = (
        f"its pose is not used in tf: its description fixes {held.child!r} to {held.parent!r}, at the "
        "origin of that joint"
    )
    way = "set the joint's origin by an argument of the xacro and remove the pose"
    own = f"let each robot have its own {held.parent!r} (shared_frames: [map]), or "
    hint, level = (way, WARNING) if simulated else (own + way, "")
    return at_robot(POSE_ON_WORLD, robot, f"robot {robot.spec.name!r}: {what}", hint, level)


def _at_pose(rule: Rule, robot: RewrittenRobot, what: str, hint: str) -> Finding:
    """Return a finding at the robot whose pose it is about."""
    return at_robot(rule, robot, f"robot {robot.spec.name!r}: {what}", hint)


STATIC = "/tf_static"
POSE_NODE = NodeFacts(START_POSE, "tf2_ros", (Endpoint(TOPIC, PUBLISHES, STATIC, TF_TYPE),))


def with_start_pose_nodes(plan: FleetPlan) -> Fleet:
    """Return the fleet with the transform publishers of poses; problems are in its table."""
    poses = [start_poses(one) for one in split_per_robot(plan)]
    held = [it for one in poses for it in one.transforms]
    problems = tuple(said_once(plan, (it for one in poses for it in one.findings)))
    table = plan.fleet.table
    fleet = plan.fleet._replace(table=table._replace(problems=(*table.problems, *problems)))
    if not held:
        return fleet
    runs = tuple(run_of(it.robot, POSE_NODE, fleet.naming) for it in held)
    edges = {(it.robot, START_POSE): [edge_of(it.parent, it.child, True)] for it in held}
    more = fleet.table._replace(runs=runs, problems=())
    return fleet._replace(table=joined(fleet.table, more), edges={**fleet.edges, **edges})


LOCALISED_ALREADY = declare("MF701", "pose-of-localised-robot", WARNING, formats=("fleet",))
NO_SINGLE_ROOT = declare("MF702", "pose-without-root-frame", WARNING, formats=("fleet",))
POSE_ON_WORLD = declare("MF709", "pose-of-robot-on-world", ERROR, formats=("fleet",))
NO_SHARED_FRAME = declare("MF704", "pose-without-shared-frame", WARNING, formats=("fleet",))

OWN_ODOMETRY = declare("MF710", "pose-beside-own-odometry", WARNING, formats=("fleet",))
