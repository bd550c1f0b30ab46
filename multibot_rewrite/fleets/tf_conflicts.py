"""Frames that two nodes publish: listeners see them jump between two places.

What a node publishes is what its parameters say, else its defaults (``evidence``).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from multibot_rewrite.companions.params.sections import PARAMETERS, raw_sections
from multibot_rewrite.companions.yaml_text import YamlText, line_of, read_yaml
from multibot_rewrite.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.findings.rule import declare
from multibot_rewrite.fleets.fleet import Fleet
from multibot_rewrite.fleets.fleet_plan import FleetPlan
from multibot_rewrite.fleets.member import line_of as line_of_element
from multibot_rewrite.fleets.output_values import OutputText, line_in_source
from multibot_rewrite.fleets.rewritten_robots import RewrittenRobot, at_robot
from multibot_rewrite.fleets.robot_groups import RobotGroup, group_robots
from multibot_rewrite.graph.transforms import Edge
from multibot_rewrite.record import NamedTuple
from multibot_rewrite.rewriters.own_defaults import frame_sites
from multibot_rewrite.rewriters.text import text_at
from multibot_rewrite.spelling.plan import tf_topic

DESCRIPTION = "the description"
SIMULATOR = "the bridge from gz-sim"


FRAME_TWICE = declare(
    "MF607",
    "frame-published-twice",
    WARNING,
    what="Two nodes of a robot publish the same frame, or (an error) two robots publish a shared frame "
    "on one tf topic.",
    why="Who listens sees the frame jump between two places: the robot trembles in RViz and "
    "navigation goes wrong.",
    fix="Remove one of the nodes, or switch its transform off (publish_tf: false). For two robots: "
    "remove the frame from shared_frames, or choose a layout with a tf topic for each robot.",
    bad="""\
stack: [amcl, slam_toolbox]
robots:
  - {name: robot1, description: robot.urdf}
  - {name: robot2, description: robot.urdf}
""",
    good="""\
stack: [slam_toolbox]
robots:
  - {name: robot1, description: robot.urdf}
  - {name: robot2, description: robot.urdf}
""",
    line=3,
    formats=("fleet",),
)


class SentTransform(NamedTuple):
    """A transform, and the node that publishes it: its name in the stack and its full name."""

    edge: Edge
    by: str
    full: str


Parsed = Sequence[tuple[OutputText, YamlText]]


def tf_conflicts(plan: FleetPlan, fleet: Fleet, files: Sequence[OutputText]) -> Iterator[Finding]:
    """Frames that two nodes of a robot publish, or two robots on one topic."""
    for group in group_robots(plan):
        robot = group.robots[0]
        parsed = list(_parsed(it for it in files if it.path.startswith(f"{robot.spec.name}/")))
        yield from _of_two_nodes(robot, list(_sent(fleet, group)), parsed)
    yield from _of_two_robots(plan, fleet)


def _parsed(files: Iterable[OutputText]) -> Iterator[tuple[OutputText, YamlText]]:
    for file in files:
        if PARAMETERS in file.text:
            yield file, read_yaml(file.text.encode(), file.path)


def _of_two_nodes(
    robot: RewrittenRobot, sent: Sequence[SentTransform], files: Parsed
) -> Iterator[Finding]:
    first: dict[str, SentTransform] = {}
    reported: set[str] = set()
    for it in sent:
        child = it.edge.child
        other = first.setdefault(child, it)
        # Two joints have one child in a closed loop of an SDF, which is no tree.
        looped = robot.member.source.root.tag != "robot" or other.edge == it.edge
        if (other.by == it.by and (it.by != DESCRIPTION or looped)) or child in reported:
            continue
        reported.add(child)
        apart = other.edge.parent != it.edge.parent
        below = f" below {other.edge.parent} and {it.edge.parent}" if apart else ""
        both = f"both {other.by} and {it.by}" if other.by != it.by else f"two joints of {it.by}"
        message = f"frame {child} of {robot.spec.name} is published{below} by {both}"
        first_file, first_line = _place(robot, other, files)
        see = f"{other.by}: {first_file}:{first_line}"
        hint = f"only one node may publish a frame: remove one, or switch its transform off; {see}"
        file, line = _place(robot, it, files)
        yield FRAME_TWICE.finding(message, hint, file=file, line=line, column=1)


def _place(robot: RewrittenRobot, sent: SentTransform, files: Parsed) -> tuple[str, int]:
    """The node's section in a source, or the joint; else the robot in the fleet file."""
    if sent.by == DESCRIPTION:
        return robot.spec.description, _line_of_joint(robot, sent.edge)
    for file, document in files:
        for found in raw_sections(document):
            if file.sources and f"/{found.path}" == sent.full:
                return line_in_source(file, line_of(found.keys[0]))
    return robot.spec.file, robot.spec.line


def _line_of_joint(robot: RewrittenRobot, edge: Edge) -> int:
    """The line in the source: inserted text moves those of the result."""
    number = robot.tree.index(edge)
    return line_of_element(robot.member.source, "joint", number)


def _sent(fleet: Fleet, group: RobotGroup) -> Iterator[SentTransform]:
    robot = group.robots[0]
    name = robot.spec.namespace
    tree = robot.tree
    yield from (SentTransform(edge, DESCRIPTION, "") for edge in tree)
    yield from (SentTransform(edge, SIMULATOR, "") for edge in _simulated(robot))
    full = {
        it.node: f"{it.namespace.rstrip('/')}/{it.name}"
        for it in fleet.table.nodes
        if it.robot == name
    }
    for (owner, node), edges in fleet.edges.items():
        if owner == name:
            yield from (
                SentTransform(it, node, full.get(node, "")) for it in edges if it not in tree
            )


def _simulated(robot: RewrittenRobot) -> Iterator[Edge]:
    """The transforms of gz-sim's drive and odometry systems, which the bridge brings to tf."""
    for host, section in robot.member.inventory.served:
        sites = frame_sites(host, section, robot.names.naming)
        given = [text_at(host, it.path) for it in sites]
        if len(given) == 2 and all(given):
            yield Edge(given[0], given[1], False)


def _of_two_robots(plan: FleetPlan, fleet: Fleet) -> Iterator[Finding]:
    """Shared frames that more than one robot publishes on one topic."""
    naming = fleet.naming
    first: dict[tuple[str, str], str] = {}
    reported: set[str] = set()
    by_space = {it.spec.namespace: it for it in plan.robots}
    # If a description starts with the world, the drive looks as if it moved the world.
    links = {link for it in plan.robots for link in it.links}
    for (robot, node), edges in fleet.edges.items():
        for edge in edges:
            other = first.setdefault((tf_topic(robot, naming), edge.child), robot)
            if other == robot or edge.child in reported or edge.child in links:
                continue
            reported.add(edge.child)
            robots = f"{other} and {robot} ({node})"
            message = f"frame {edge.child} is published by two robots on one topic: {robots}"
            hint = "remove it from shared_frames, or choose a layout with a tf topic per robot"
            yield at_robot(FRAME_TWICE, by_space[robot], message, hint, ERROR)
