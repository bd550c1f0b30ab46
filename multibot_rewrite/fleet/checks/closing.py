"""Does each robot of a fleet close, before and after its rewrite? What a rewrite opens is an error."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from multibot_rewrite.base.findings.finding import NOTE, WARNING, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.fleet.checks.closing_bridges import bridge_findings
from multibot_rewrite.fleet.checks.closing_controllers import controller_findings
from multibot_rewrite.fleet.checks.closing_semantics import semantic_findings
from multibot_rewrite.fleet.checks.gap_findings import at_gap
from multibot_rewrite.fleet.checks.judged import apart, contradicted, missing, whose_names
from multibot_rewrite.fleet.checks.written_system import of_each_kind, with_robots, written_system
from multibot_rewrite.fleet.fleet import Fleet
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.output_values import OutputText
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.fleet.robots.robot_groups import group_robots
from multibot_rewrite.fleet.robots.robot_nodes import node_sources
from multibot_rewrite.fleet.robots.systems import system_after, system_before
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.producers.launch.spawners import active
from multibot_rewrite.rules.closure.frames import unsent_gaps
from multibot_rewrite.rules.closure.gap import Gap

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

MAP = "map"


def closing(plan: FleetPlan, fleet: Fleet, texts: Sequence[OutputText]) -> Iterator[Finding]:
    """What is open in the robots of a fleet; robots of the same sources are looked at once.

    ``fleet`` has all nodes that are started, ``texts`` are the files that were made.
    """
    shown = of_each_kind(plan)
    few = with_robots(fleet, shown)
    whole, whose = written_system(plan, few, shown, texts), whose_names(few)
    yield from contradicted(plan, whole, whose)
    known = load_known_nodes(plan.file.nodes, plan.file.distro)
    for group in group_robots(plan):
        robot = group.robots[0]
        evidence = plan.evidence[node_sources(robot.spec)]
        before, library = system_before(robot, evidence), evidence.known
        after = system_after(robot, texts, known, whole)
        yield from controller_findings(
            robot, before, after, library, texts, active(evidence.spawned)
        )
        yield from apart(robot, before.system, after.system, whose)
        edges = before.system.edges
        yield from _unsent(robot, unsent_gaps(edges, before.given, library))
        yield from missing(robot, before.system, after.system, whose)
        yield from semantic_findings(plan, robot, before, after)
        yield from bridge_findings(plan, robot, texts)


def _unsent(robot: RewrittenRobot, gaps: Iterable[Gap]) -> Iterator[Finding]:
    for it in gaps:
        message = f"{it.node} of {robot.spec.name} reads frame {it.name}, which no known node sends"
        hint = f"{it.near} ({it.near_place}); use a frame that is sent, or name the node that does"
        # A map often comes from a node that is started apart.
        yield at_gap(NOT_THERE, robot, it, message, hint, NOTE if it.name == MAP else WARNING)
