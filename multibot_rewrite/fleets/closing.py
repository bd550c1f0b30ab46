"""Does each robot of a fleet close, before and after its rewrite? What a rewrite opens is an error."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from multibot_rewrite.closure.frames import Sender, frame_gaps, tree_gaps, unsent_gaps
from multibot_rewrite.closure.gap import Gap
from multibot_rewrite.findings.finding import ERROR, NOTE, WARNING, Finding
from multibot_rewrite.findings.rule import declare
from multibot_rewrite.fleets.closing_bridges import bridge_findings
from multibot_rewrite.fleets.closing_controllers import controller_findings
from multibot_rewrite.fleets.closing_semantics import semantic_findings
from multibot_rewrite.fleets.closing_topics import topic_findings
from multibot_rewrite.fleets.fleet import Fleet
from multibot_rewrite.fleets.fleet_plan import FleetPlan
from multibot_rewrite.fleets.gap_findings import at_gap
from multibot_rewrite.fleets.output_values import OutputText
from multibot_rewrite.fleets.rewritten_robots import RewrittenRobot
from multibot_rewrite.fleets.robot_groups import group_robots
from multibot_rewrite.fleets.robot_nodes import node_sources
from multibot_rewrite.fleets.systems import system_after, system_before
from multibot_rewrite.fleets.tf_conflicts import tf_conflicts
from multibot_rewrite.graph.transforms import edges_in
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.producers.launch.spawners import active

NOBODY_SENDS = declare(
    "MF813",
    "odometry-not-sent",
    WARNING,
    what="Every node of a robot that could send the transform to its base is told not to: an error if "
    "there are two, a warning if another node, which no file names, may send it.",
    why="The robot's frames are not connected to the odometry: navigation and RViz do not see it move.",
    fix="Let one of them send it: enable_odom_tf of the controller, or publish_tf of the filter.",
    bad="""\
controller_manager:
  ros__parameters:
    drive: {type: diff_drive_controller/DiffDriveController}
drive:
  ros__parameters:
    enable_odom_tf: false
""",
    good="""\
controller_manager:
  ros__parameters:
    drive: {type: diff_drive_controller/DiffDriveController}
drive:
  ros__parameters:
    enable_odom_tf: true
""",
    line=6,
    formats=("params",),
)


NOT_THERE = declare(
    "MF809",
    "frame-not-sent",
    WARNING,
    what="A node reads odom, base_footprint, base_link or map by its parameters, and neither the "
    "description nor a known node sends it, though others send transforms. A note for the map.",
    why="The node waits for a transform that never comes.",
    fix="Use the frame that is sent, or name the node or stack that sends it.",
    bad="""\
ekf_filter_node:
  ros__parameters: {odom_frame: odom_ekf, world_frame: odom_ekf, base_link_frame: base_link}
collision_monitor:
  ros__parameters: {odom_frame_id: odom, base_frame_id: base_link}
""",
    good="""\
ekf_filter_node:
  ros__parameters: {odom_frame: odom, world_frame: odom, base_link_frame: base_link}
collision_monitor:
  ros__parameters: {odom_frame_id: odom, base_frame_id: base_link}
""",
    line=4,
    formats=("params",),
)
TWO_TREES = declare(
    "MF817",
    "two-tf-trees",
    WARNING,
    what="Nodes of a robot send transforms that make two trees of its frames.",
    why="tf finds no way from the one to the other: a map is not connected to the robot.",
    fix="Use the same odometry frame in both.",
    bad="""\
slam_toolbox:
  ros__parameters: {odom_frame: odom, map_frame: map}
ekf_filter_node:
  ros__parameters: {odom_frame: odom_filtered, world_frame: odom_filtered, base_link_frame: base_link}
""",
    good="""\
slam_toolbox:
  ros__parameters: {odom_frame: odom, map_frame: map}
ekf_filter_node:
  ros__parameters: {odom_frame: odom, world_frame: odom, base_link_frame: base_link}
""",
    line=3,
    formats=("params",),
)

MAP = "map"


def closing(plan: FleetPlan, fleet: Fleet, texts: Sequence[OutputText]) -> Iterator[Finding]:
    """What is open in the robots of a fleet; robots of the same sources are looked at once.

    ``fleet`` has all nodes that are started, ``texts`` are the files that were made.
    """
    yield from tf_conflicts(plan, fleet, texts)
    known = load_known_nodes(plan.file.nodes, plan.file.distro)
    for group in group_robots(plan):
        robot = group.robots[0]
        evidence = plan.evidence[node_sources(robot.spec)]
        before, library = system_before(robot, evidence), evidence.known
        after = system_after(robot, fleet, texts, known)
        yield from controller_findings(
            robot, before, after, library, texts, active(evidence.spawned)
        )
        yield from _frames(robot, frame_gaps(before.given, library, before.sent), before.senders)
        joints = list(edges_in(robot.member.source.root))
        old = list(tree_gaps(joints, before.senders))
        yield from _trees(robot, old, WARNING)
        yield from _unsent(robot, unsent_gaps(joints, before.senders, before.given, library))
        now = tree_gaps(robot.tree, after.senders)
        known_before = {it.key for it in old}
        yield from _trees(robot, (it for it in now if it.key not in known_before), ERROR)
        yield from topic_findings(robot, before, after)
        yield from semantic_findings(plan, robot, before, after)
        yield from bridge_findings(plan, robot, texts)


def _frames(
    robot: RewrittenRobot, gaps: Iterable[Gap], senders: Sequence[Sender]
) -> Iterator[Finding]:
    others = (it for it in senders if it.place and it.edges)
    sent = next((f"; {it.node} ({it.place}) sends {it.edges[0].child}" for it in others), "")
    for it in gaps:
        both = f"{it.node} and {it.near} ({it.near_place}) are" if it.near else f"{it.node} is"
        message = f"nothing sends frame {it.name} of {robot.spec.name}: {both} told not to"
        hint = (
            "let one node send it: the controller (enable_odom_tf) or the filter (publish_tf)"
            + sent
        )
        # Another node, which no file names, may send what one alone does not.
        yield at_gap(NOBODY_SENDS, robot, it, message, hint, ERROR if it.near else WARNING)


def _unsent(robot: RewrittenRobot, gaps: Iterable[Gap]) -> Iterator[Finding]:
    for it in gaps:
        message = f"{it.node} of {robot.spec.name} reads frame {it.name}, which no known node sends"
        hint = f"{it.near} ({it.near_place}); use a frame that is sent, or name the node that does"
        # A map often comes from a node that is started apart.
        yield at_gap(NOT_THERE, robot, it, message, hint, NOTE if it.name == MAP else WARNING)


def _trees(robot: RewrittenRobot, gaps: Iterable[Gap], level: str) -> Iterator[Finding]:
    for it in gaps:
        message = f"{it.node} of {robot.spec.name} sends {it.name}, apart from {it.near}"
        where = f" ({it.near_place})" if it.near_place else ""
        hint = f"use the same odometry frame in both{where}, or add what joins them"
        yield at_gap(TWO_TREES, robot, it, message, hint, level)
