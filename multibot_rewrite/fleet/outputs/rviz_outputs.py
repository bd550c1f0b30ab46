# SPDX-License-Identifier: Apache-2.0
"""The RViz configs of a fleet: what each window shows, and the command that opens it."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from contextlib import suppress
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.model import MultibotError
from multibot_rewrite.base.naming import find_layout
from multibot_rewrite.companions.names.robot_topics import fleet_topics
from multibot_rewrite.companions.rviz.display_groups import is_for_one, shown_in
from multibot_rewrite.companions.rviz.of_plan import bridged_window, windows_of_plan
from multibot_rewrite.companions.rviz.read_config import RvizRobot, read_config
from multibot_rewrite.companions.rviz.rewrite import RvizText, read_for, rewrite_rviz
from multibot_rewrite.companions.rviz.window_checks import ONE_TF_TOPIC
from multibot_rewrite.fleet.checks.written_files import wrong_in_file
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.cell_outputs import cell_window, parameters_path
from multibot_rewrite.fleet.outputs.moveit_parameters import FILE, has_moveit
from multibot_rewrite.fleet.outputs.output_file import (
    FilesAndFindings,
    OutputFile,
    name_among,
    own_yaml,
    path_for,
    yaml_of,
)
from multibot_rewrite.fleet.robots.robot_groups import split_per_robot
from multibot_rewrite.fleet.robots.start_poses import world_of
from multibot_rewrite.spelling.start import File, Start
from multibot_rewrite.system.records import System

RVIZ = "rviz2"
# What stands for the config of a fleet that names none: a path of no file.
USUAL = "/fleet.rviz"


class RvizOutput(NamedTuple):
    """The results of one RViz config, whose path is ``source``; ``name`` is that of a window for
    several robots."""

    source: str
    windows: tuple[RvizText, ...]
    findings: tuple[Finding, ...]
    name: str

    def path(self, window: RvizText) -> str:
        """Return where the config of one of its windows goes."""
        return f"{window.robot}/{os.path.basename(self.source)}" if window.robot else self.name


def rviz_outputs(plan: FleetPlan, each: Iterable[FleetPlan]) -> Iterator[RvizOutput]:
    """Yield the windows by the config they are made from; ``each`` is every robot as its own fleet.
    Raises InputError for a config that cannot be read or rewritten."""
    robots_of = lists_by_key(
        (path, it) for it in plan.robots for path in it.spec.companions.get("rviz", ())
    )
    own = {it.robots[0].spec.name: it for it in each}
    world = world_of(plan.file, plan.fleet.naming)
    for path, robots in robots_of.items():
        document = own_yaml(robots[0].spec, path)
        shown = [_as_rviz_robot(own[robot.spec.name]) for robot in robots]
        relayed = plan.file.relayed
        texts, found = rewrite_rviz(document, shown, world=world, relayed=relayed)
        if plan.file.cell:
            made = cell_window(document, plan.file.cell, robots[0], world)
            texts = (*(it for it in texts if not (it.robot and made)), *filter(None, [made]))
        if relayed and not plan.fleet.naming.layout.frames:
            window, bare = bridged_window(document, shown, world)
            texts, found = (window, *texts), (*found, *bare)
        found = (*found, *wrong_in_file(plan, read_for(document, shown, plan.file.distro), robots))
        done = ONE_TF_TOPIC.code if relayed else ""
        left = tuple(it for it in found if it.code != done)
        yield RvizOutput(path, texts, left, name_among(path, robots_of).replace("/", "_"))


def usual_windows(plan: FleetPlan, planned: System) -> list[RvizOutput]:
    """Return the windows of a fleet that names no config of RViz."""
    made = windows_of_plan(planned, plan.file.relayed)
    return [RvizOutput(USUAL, made, (), os.path.basename(USUAL))] if plan.robots else []


def robot_windows(plan: FleetPlan, each: bool) -> list[tuple[str, RvizText]]:
    """Return the windows of a fleet with the names of their files, or with ``each`` one for each
    robot. Raises as ``rviz_outputs``."""
    apart = list(split_per_robot(plan))
    made = [rviz_outputs(one, [one]) for one in apart] if each else [rviz_outputs(plan, apart)]
    found = (it for outputs in made for it in outputs)
    return [(os.path.basename(it.source), window) for it in found for window in it.windows]


def _as_rviz_robot(plan: FleetPlan) -> RvizRobot:
    """Return the one robot of a plan as RViz shows it."""
    (robot,) = plan.robots
    spec = robot.spec
    names = robot.names._replace(robot=spec.tag)
    topics = robot.topics._replace(robot=spec.namespace)
    known = fleet_topics(plan.fleet.table, plan.fleet.facts, spec.namespace)
    # The name and the rules of an rviz2 that the robot's stacks start.
    own = next((it for it in plan.fleet.table.runs if it.robot and it.node == RVIZ), None)
    rules = own.rules if own else ()
    if own and not plan.fleet.naming.layout.namespaced:
        rules = (("__node", own.name), *rules)
    prefix = spec.tag if names.naming.layout.at_run_time else ""
    return RvizRobot(spec.name, names, topics, spec.colour, known, prefix, rules)


def rviz_files(configs: Iterable[RvizOutput]) -> FilesAndFindings:
    """Yield the files of the windows, and the findings."""
    for config in configs:
        yield from config.findings
        read = () if config.source == USUAL else (config.source,)
        yield from (OutputFile(config.path(it), it.text.encode(), read) for it in config.windows)


def window_start(window: RvizText, file: str, parameters: str = "") -> Start:
    """Return what opens a window whose config is a ``file``."""
    given = (File(parameters),) if parameters else ()
    return Start(RVIZ, RVIZ, window.namespace, "", given, window.remaps, ("-d", File(file)))


def opened_of(plan: FleetPlan, configs: Iterable[RvizOutput]) -> list[RvizOutput]:
    """Return the windows that open by themselves. A launch file that starts RViz opens one window for a
    robot: where the config has windows for robots these are it, and the one for all is left out."""
    if not any(it.spec.launch for it in plan.robots):
        return [*configs]
    of_robots = ((it, tuple(one for one in it.windows if one.robot)) for it in configs)
    return [it._replace(windows=own or it.windows) for it, own in of_robots]


def why_for_each(path: str, layout: str) -> str:
    """Return why each robot has a window of its own of a config; empty where one shows all robots, or
    the config cannot be read."""
    chosen = find_layout(layout)
    if chosen.tf_per_robot:
        return "each robot has its own tf topic, and one rviz2 reads one"
    with suppress(MultibotError):
        if chosen.namespaced and any(map(is_for_one, shown_in(read_config(yaml_of(path))))):
            return "panels or displays in it work for one robot alone"
    return ""


def windows(plan: FleetPlan, configs: Iterable[RvizOutput]) -> list[tuple[str, Start]]:
    """Return what opens the windows, each with the one robot that it shows, or "" for all.

    MoveIt's displays read the parameters of their process.
    """
    given = {it.spec.name: path_for(it, FILE) for it in plan.robots if has_moveit(it)}
    if cell := plan.file.cell:
        given[cell.name] = parameters_path(cell)
    return [
        (it.robot, window_start(it, config.path(it), given.get(it.robot, "")))
        for config in configs
        for it in config.windows
    ]
