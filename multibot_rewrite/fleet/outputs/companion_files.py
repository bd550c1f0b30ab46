"""Parameter files, MoveIt files, behavior trees and Lua files of a fleet: one for each robot."""

from __future__ import annotations

from collections.abc import Callable

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import InputError
from multibot_rewrite.companions.behavior_tree.rewrite import rewrite_behavior_tree
from multibot_rewrite.companions.companion import Companion
from multibot_rewrite.companions.lua import rewrite_lua
from multibot_rewrite.companions.moveit.rewrite import rewrite_moveit
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.params.rewrite import nodes_without_section, rewrite_params
from multibot_rewrite.companions.template import NAMESPACE_SLOT, TAG_SLOT, fill_template
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.output_file import (
    FilesAndFindings,
    OutputFile,
    params_of,
    path_for,
    yaml_of,
)
from multibot_rewrite.fleet.robots.prefix_parameters import at_run_time
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.fleet.robots.robot_groups import RobotGroup, group_robots
from multibot_rewrite.fleet.robots.robot_nodes import node_sources
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.producers.evidence.nodes import children_of
from multibot_rewrite.rules.files.judge import judged_once


def companion_files(plan: FleetPlan) -> FilesAndFindings:
    """Every companion file that is one text with slots for the robot.

    Raises InputError for a file that cannot be read or rewritten.
    """
    for kind, rewrite in _KINDS.items():
        for group in group_robots(plan):
            for path in group.companions.get(kind, ()):
                made = rewrite(plan, group, path)
                found = (*made.findings, *judged_once(of_fleet(plan, made.file)))
                yield from (_with_names_of(group.robots[0], it) for it in found)
                for robot in group.robots:
                    text = fill_template(made.template, robot.spec.namespace, robot.spec.tag)
                    yield OutputFile(path_for(robot, path), text.encode(), (path,))


def of_fleet(plan: FleetPlan, file: NamedFile) -> NamedFile:
    """A file with what a fleet knows: the words for its robots, and frames that its nodes send."""
    known = load_known_nodes(plan.file.nodes, plan.file.distro)
    words = {name for it in plan.robots for name in (it.spec.namespace, it.spec.tag)}
    return file._replace(robots=frozenset(words), sent=file.sent | known.sent)


def _with_names_of(robot: RewrittenRobot, finding: Finding) -> Finding:
    """A finding about a file for any robot, with the names of this robot in its slots."""
    message, hint = finding.message, finding.hint
    for slot, name in {NAMESPACE_SLOT: robot.spec.namespace, TAG_SLOT: robot.spec.tag}.items():
        message, hint = message.replace(slot, name), hint.replace(slot, name)
    return finding._replace(message=message, hint=hint)


def _params(plan: FleetPlan, group: RobotGroup, path: str) -> Companion:
    """A ROS parameter file; what the robot's other parameter files set is not inserted in it."""
    read = params_of(group.robots[0].spec)
    others = [document for it, document in read.items() if it != path]
    known = load_known_nodes(plan.file.nodes, plan.file.distro)
    evidence = plan.evidence[node_sources(group.robots[0].spec)]
    nodes = evidence.nodes
    bare = at_run_time(plan.fleet.naming, evidence.given, known)
    known = known._replace(sent=known.sent | {it for node in nodes for it in children_of(node)})
    own = group.robots[0].spec.words if len(group.robots) == 1 else ()
    made = rewrite_params(
        read[path],
        group.context,
        known,
        others,
        group.facts,
        own,
        bare,
        group.robots[0].spec.use_sim_time,
    )
    if path != next(iter(read)):
        return made
    more = nodes_without_section(list(read.values()), group.context, known, own)
    return made._replace(findings=(*made.findings, *more))


def _moveit(plan: FleetPlan, group: RobotGroup, path: str) -> Companion:
    return rewrite_moveit(yaml_of(path), group.context, group.facts)


def _behavior_tree(plan: FleetPlan, group: RobotGroup, path: str) -> Companion:
    return rewrite_behavior_tree(read_file(path), path, group.context)


def _lua(plan: FleetPlan, group: RobotGroup, path: str) -> Companion:
    try:
        text = read_file(path).decode()
    except UnicodeDecodeError:
        raise InputError(f"{path}: it is not UTF-8; save it as UTF-8") from None
    return rewrite_lua(text, path, group.context)


_KINDS: dict[str, Callable[[FleetPlan, RobotGroup, str], Companion]] = {
    "params": _params,
    "moveit": _moveit,
    "behavior_trees": _behavior_tree,
    "lua": _lua,
}
