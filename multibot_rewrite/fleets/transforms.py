"""Where the robots of a fleet stand: a static transform each, or an initial pose where one is sent.

Sources: tf2_ros jazzy ``static_transform_publisher``; nav2_amcl jazzy (``set_initial_pose``).
"""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from multibot_rewrite.companions.rviz.rewrite import world_frame
from multibot_rewrite.fleets.describe import Described
from multibot_rewrite.fleets.fleet_file import FleetFile, Pose
from multibot_rewrite.fleets.plan import FleetPlan
from multibot_rewrite.graph.transforms import Edge, description_edges
from multibot_rewrite.model import WARNING, Finding
from multibot_rewrite.naming import Naming
from multibot_rewrite.remap.bridge import TF_TYPE, known_topics
from multibot_rewrite.remap.records import TOPIC
from multibot_rewrite.remap.table import placed, target_of
from multibot_rewrite.steps.collect import Inventory

NODE = "start_pose"
AMCL = "amcl"
ORIGIN = Pose()
# Elements of gz-sim's drive and odometry systems that name the frame their odometry starts at.
ODOMETRY = ("frame_id", "odom_frame")


class StaticTransform(NamedTuple):
    """What one ``static_transform_publisher`` of a robot sends, and how it is named and started."""

    robot: str
    parent: str
    child: str
    pose: Pose
    namespace: str
    node: str
    remaps: tuple[tuple[str, str], ...]


class InitialPose(NamedTuple):
    """What a localisation has to be told instead: parameters of ``node``, its name in the stack."""

    robot: str
    node: str
    values: Mapping[str, object]


class Placed(NamedTuple):
    """The places of a fleet's robots, and why some have none."""

    transforms: tuple[StaticTransform, ...]
    initial: tuple[InitialPose, ...]
    findings: tuple[Finding, ...]


def place(plan: FleetPlan) -> Placed:
    """A transform from the world for each robot that has a pose and that nothing else places."""
    found: list[object] = []
    for robot in plan.robots:
        if robot.spec.pose is not None:
            found += _place(plan, robot, robot.spec.pose)
    return Placed(
        tuple(it for it in found if isinstance(it, StaticTransform)),
        tuple(it for it in found if isinstance(it, InitialPose)),
        tuple(it for it in found if isinstance(it, Finding)),
    )


def world_of(file: FleetFile, naming: Naming) -> str:
    """The shared frame that poses are in."""
    return file.world or world_frame(naming)


def _place(plan: FleetPlan, robot: Described, pose: Pose) -> Iterator[object]:
    naming, name = plan.fleet.naming, robot.spec.namespace
    world = world_of(plan.file, naming)
    if not world:
        hint = "share one: shared_frames, or world"
        yield _finding(robot, "MF704", "it has a pose, and no frame is shared to put it in", hint)
        return
    sent = _sent(plan, robot)
    locators = [node for node, edges in sent.items() if any(_locates(it, naming) for it in edges)]
    if AMCL in locators:
        yield InitialPose(name, AMCL, initial_pose(pose))
        return
    if locators:
        what = f"{' and '.join(locators)} sends where it is, so its pose makes no transform"
        yield _finding(robot, "MF701", what, "a second parent would make the frame jump")
        return
    roots = _roots(sent, naming)
    if len(roots) != 1:
        what = f"it has {len(roots)} frames without a parent: {', '.join(roots) or 'none'}"
        hint = "the world is its description's parent already" if not roots else "join its frames"
        yield _finding(robot, "MF702", f"{what}; its pose makes no transform", hint)
        return
    local = AMCL in sent
    if local:
        yield InitialPose(name, AMCL, initial_pose(pose))
    yield static_transform(name, world, roots[0], ORIGIN if local else pose, naming)


def static_transform(
    robot: str, parent: str, child: str, pose: Pose, naming: Naming
) -> StaticTransform:
    """The transform of a robot, under names that no other robot has."""
    namespace, node = placed(robot, NODE, naming)
    target = target_of("/tf_static", TOPIC, robot, naming)
    remaps = (("/tf_static", target),) if target else ()
    return StaticTransform(robot, parent, child, pose, namespace, node, remaps)


def command(it: StaticTransform) -> str:
    """The line that sends a transform."""
    return shlex.join(["ros2", "run", "tf2_ros", "static_transform_publisher", *arguments(it)])


def arguments(it: StaticTransform) -> list[str]:
    """What follows ``static_transform_publisher``; values may be negative, names come last."""
    words = [word for key, value in it.pose._asdict().items() for word in (f"--{key}", str(value))]
    words += ["--frame-id", it.parent, "--child-frame-id", it.child]
    rules = [f"__ns:={it.namespace}"] if it.namespace != "/" else []
    rules += [f"__node:={it.node}", *(f"{source}:={target}" for source, target in it.remaps)]
    return [*words, "--ros-args", *(text for rule in rules for text in ("-r", rule))]


def initial_pose(pose: Pose) -> dict[str, object]:
    """The parameters that tell amcl where it starts; they count only with ``set_initial_pose``."""
    values = {f"initial_pose.{key}": getattr(pose, key) for key in ("x", "y", "z", "yaw")}
    return {"set_initial_pose": True, **values}


def _sent(plan: FleetPlan, robot: Described) -> dict[str, list[Edge]]:
    """What each node of a robot sends; the description's tree under an empty name."""
    name, inventory = robot.spec.namespace, robot.member.inventory
    sent = {node: [*edges] for (own, node), edges in plan.fleet.edges.items() if own == name}
    tree = list(description_edges(inventory))
    bare = set(inventory.declared["link"]) - {edge.child for edge in tree}
    odometry = list(_gz_odometry(inventory, robot.spec.model))
    base = next(iter(sorted(bare)), "")
    return {
        **sent,
        "": [*tree, *(Edge(it, base, False) for it in odometry if base)]
        or [Edge(link, link, True) for link in bare],
    }


def _gz_odometry(inventory: Inventory, model: str) -> Iterator[str]:
    """The frames that gz-sim's systems start their odometry at, and a bridge brings to tf."""
    for host in inventory.hosts:
        name = host.node.section.names[0] if host.node.section else ""
        topics = known_topics()["plugins"].get(name, ())
        if any(row[2] == TF_TYPE for row in topics):
            told = (host.element.findtext(tag, "").strip() for tag in ODOMETRY)
            yield next(filter(None, told), f"{model}/odom")
            return


def _locates(edge: Edge, naming: Naming) -> bool:
    """It places a robot's frame in a frame of all."""
    shared = naming.shared_frames
    return not edge.static and edge.parent in shared and edge.child not in shared


def _roots(sent: Mapping[str, list[Edge]], naming: Naming) -> list[str]:
    """The robot's own frames that nothing is the parent of."""
    edges = [edge for own in sent.values() for edge in own]
    children = {edge.child for edge in edges if edge.parent != edge.child}
    parents = dict.fromkeys(edge.parent for edge in edges)
    return [it for it in parents if it not in children and it not in naming.shared_frames]


def _finding(robot: Described, code: str, what: str, hint: str) -> Finding:
    spec = robot.spec
    return Finding(code, WARNING, f"robot {spec.name!r}: {what}", hint, spec.file, spec.line, 1)
