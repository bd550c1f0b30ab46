"""Frames that two nodes send: listeners see them jump between two places.

What nodes send is read from the parameter files that were written, else from their defaults.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import Any, NamedTuple

from multibot_rewrite.companions.params.sections import PARAMETERS, raw_sections
from multibot_rewrite.companions.yaml_text import YamlText, line_of, read_yaml
from multibot_rewrite.fleets.fleet import Fleet
from multibot_rewrite.fleets.fleet_plan import FleetPlan
from multibot_rewrite.fleets.output_values import OutputText, line_in_source
from multibot_rewrite.fleets.rcl_parameters import node_parameters
from multibot_rewrite.fleets.rewritten_robots import RewrittenRobot
from multibot_rewrite.fleets.robot_groups import RobotGroup, group_robots
from multibot_rewrite.graph.expectation import tf_topic
from multibot_rewrite.graph.transforms import Edge, description_edges
from multibot_rewrite.model import ERROR, WARNING, Finding, InputError
from multibot_rewrite.remap.records import NodeFacts

DESCRIPTION = "the description"
# Parameters that keep a node from sending anything.
SWITCHES = ("publish_tf", "tf_broadcast", "enable_odom_tf", "publish_odom_tf", "broadcast_tf")
# robot_localization: the frame that what it filters is in, one of the other two.
WORLD, MAP, ODOM = "world_frame", "map_frame", "odom_frame"


class SentTransform(NamedTuple):
    """A transform, and the node that sends it: its name in the stack, its full name."""

    edge: Edge
    by: str
    full: str


Parsed = Sequence[tuple[OutputText, YamlText]]


def tf_conflicts(plan: FleetPlan, fleet: Fleet, files: Sequence[OutputText]) -> Iterator[Finding]:
    """What two nodes of a robot send, and what two robots send on one topic."""
    for group in group_robots(plan):
        robot = group.robots[0]
        parsed = list(_parsed(it for it in files if it.path.startswith(f"{robot.spec.name}/")))
        yield from _twice(robot, list(_sent(fleet, group, parsed)), parsed)
    yield from _between(plan, fleet)


def _parsed(files: Iterable[OutputText]) -> Iterator[tuple[OutputText, YamlText]]:
    for file in files:
        if PARAMETERS in file.text:
            yield file, read_yaml(file.text.encode(), file.path)


def _twice(
    robot: RewrittenRobot, sent: Sequence[SentTransform], files: Parsed
) -> Iterator[Finding]:
    first: dict[str, SentTransform] = {}
    told: set[str] = set()
    for it in sent:
        child = it.edge.child
        other = first.setdefault(child, it)
        if other.by == it.by or child in told:
            continue
        told.add(child)
        apart = other.edge.parent != it.edge.parent
        below = f" below {other.edge.parent} and {it.edge.parent}" if apart else ""
        message = f"frame {child} of {robot.spec.name} is sent{below} by {other.by} and by {it.by}"
        hint = "a frame has one parent and one sender: leave one out, or switch its transform off"
        yield Finding("MF607", WARNING, message, hint, *_place(robot, it, files), 1)


def _place(robot: RewrittenRobot, sent: SentTransform, files: Parsed) -> tuple[str, int]:
    """The node's section in a source, else the robot in the fleet file."""
    for file, document in files:
        for found in raw_sections(document):
            if file.sources and f"/{found.path}" == sent.full:
                return line_in_source(file, line_of(found.keys[0]))
    return robot.spec.file, robot.spec.line


def _sent(fleet: Fleet, group: RobotGroup, files: Parsed) -> Iterator[SentTransform]:
    robot = group.robots[0]
    name = robot.spec.namespace
    tree = list(description_edges(robot.member.inventory))
    yield from (SentTransform(edge, DESCRIPTION, "") for edge in tree)
    facts = {it.name: it for it in group.facts if it.sends}
    full = {
        it.node: f"{it.namespace.rstrip('/')}/{it.name}"
        for it in fleet.table.nodes
        if it.robot == name
    }
    for (owner, node), edges in fleet.edges.items():
        if owner == name:
            known = facts.get(node)
            said = _as_given(known, _given(files, full[node]), edges) if known else edges
            yield from (
                SentTransform(it, node, full.get(node, "")) for it in said if it not in tree
            )


def _as_given(node: NodeFacts, given: Mapping[str, Any], edges: Iterable[Edge]) -> list[Edge]:
    """What a node sends with these parameters."""
    if any(given.get(it) is False for it in SWITCHES):
        return []
    defaults = list(edges)
    pairs = node.sends
    if WORLD in given and given[WORLD] == given.get(MAP):
        pairs = ((MAP, ODOM),)
    if len(pairs) != len(defaults):
        return defaults
    return [
        Edge(str(given.get(above, it.parent)), str(given.get(below, it.child)), it.static)
        for (above, below), it in zip(pairs, defaults, strict=True)
    ]


def _given(files: Parsed, full: str) -> dict[str, Any]:
    """The parameters of a node."""
    found: dict[str, Any] = {}
    for _, document in files:
        # What rcl does not read, and what is said of it, is another step's.
        with suppress(InputError):
            found.update(node_parameters(document, full))
    return found


def _between(plan: FleetPlan, fleet: Fleet) -> Iterator[Finding]:
    """Frames of all robots that more than one robot sends, where all hear one topic."""
    naming = fleet.naming
    first: dict[tuple[str, str], str] = {}
    told: set[str] = set()
    specs = {it.spec.namespace: it.spec for it in plan.robots}
    # A description may begin with the world, and what moves the robot is then taken to move it.
    links = {link for it in plan.robots for link in it.member.inventory.declared["link"]}
    for (robot, node), edges in fleet.edges.items():
        for edge in edges:
            other = first.setdefault((tf_topic(robot, naming), edge.child), robot)
            if other == robot or edge.child in told or edge.child in links:
                continue
            told.add(edge.child)
            message = (
                f"frame {edge.child} is sent by robots {other} and {robot} ({node}) on one topic"
            )
            hint = "take it out of shared_frames, or choose a layout with a tf topic per robot"
            spec = specs[robot]
            yield Finding("MF607", ERROR, message, hint, spec.file, spec.line, 1)
