"""Companion files of robots that share everything but their names: each is read and planned once."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from multibot_rewrite.companions.behavior_tree import rewrite_behavior_tree
from multibot_rewrite.companions.context import Companion, Context, make_context
from multibot_rewrite.companions.lua import rewrite_lua
from multibot_rewrite.companions.moveit.rewrite import x
from multibot_rewrite.companions.moveit.rewrite import with_srdf
from multibot_rewrite.companions.params import rewrite as ros_params
from multibot_rewrite.companions.params.known_nodes import load_known_nodes
from multibot_rewrite.companions.yaml_text import read_yaml
from multibot_rewrite.fleets.fleet import facts_of
from multibot_rewrite.fleets.fleet_plan import FleetPlan
from multibot_rewrite.fleets.rewritten_robots import RewrittenRobot
from multibot_rewrite.model import InputError
from multibot_rewrite.remap.records import NodeFacts
from multibot_rewrite.sources.read import read_file


class RobotGroup(NamedTuple):
    """Robots of one description, with the same nodes and companion files."""

    robots: tuple[RewrittenRobot, ...]
    facts: tuple[NodeFacts, ...]
    context: Context


def group_robots(plan: FleetPlan) -> Iterator[RobotGroup]:
    """The groups of a fleet, in the order of their first robots."""
    groups: dict[object, list[RewrittenRobot]] = {}
    for robot in plan.robots:
        spec = robot.spec
        files = tuple(spec.companions.items())
        key = spec.description, spec.srdf, tuple(spec.arguments.items()), spec.stacks, files
        groups.setdefault(key, []).append(robot)
    for robots in groups.values():
        facts = facts_of(robots[0].spec.stacks, plan.file.nodes or None)
        declared, naming = robots[0].names.declared, plan.fleet.naming
        context = make_context(declared, naming, facts, plan.file.distro)
        context = with_srdf(context, robots[0].semantics)
        yield RobotGroup(tuple(robots), facts, context)


def params_template(plan: FleetPlan, kin: RobotGroup, path: str) -> Companion:
    """A ROS parameter file; what the others of the robot set is not inserted in it."""
    paths = kin.robots[0].spec.companions["params"]
    read = {it: read_yaml(read_file(it), it) for it in paths}
    beside = [document for it, document in read.items() if it != path]
    known = load_known_nodes(plan.file.parameters)
    words = {word for it in plan.robots for word in (it.spec.namespace, it.spec.spelled)}
    made = ros_params.params(read[path], kin.context, known, beside, kin.facts, sorted(words))
    if path != paths[0]:
        return made
    more = ros_params.without_sections(list(read.values()), kin.context, known)
    return made._replace(findings=(*made.findings, *more))


def moveit_template(plan: FleetPlan, kin: RobotGroup, path: str) -> Companion:
    """One of MoveIt's files."""
    return moveit_file(read_yaml(read_file(path), path), kin.context, kin.facts)


def behavior_tree_template(plan: FleetPlan, kin: RobotGroup, path: str) -> Companion:
    """A behavior tree of Nav2."""
    return rewrite_behavior_tree(read_file(path), path, kin.context)


def lua_template(plan: FleetPlan, kin: RobotGroup, path: str) -> Companion:
    """Cartographer's options: plain assignments are rewritten, all else is reported."""
    try:
        text = read_file(path).decode()
    except UnicodeDecodeError:
        raise InputError(f"{path}: it is not UTF-8; save it as UTF-8") from None
    return rewrite_lua(text, path, kin.context)
