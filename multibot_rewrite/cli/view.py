# SPDX-License-Identifier: Apache-2.0
"""``multibot view``: the rewritten robots in 3D, as one HTML file."""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator, Sequence
from typing import Any

from multibot_rewrite.base.model import InputError, MultibotError, UsageError
from multibot_rewrite.base.wording import SEVERAL, plural, shorten
from multibot_rewrite.checks.judged_plan import plan_fleet
from multibot_rewrite.cli.fleet import FLEET_FILES, check_own, check_use
from multibot_rewrite.cli.output import deliver, goes_to_file, note, status
from multibot_rewrite.cli.process import DONE
from multibot_rewrite.cli.usage import asked_number, check_xacro, policy, robots, xacro_args
from multibot_rewrite.cli.walk import check_target
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.fleet.file.fleet_data import without_place
from multibot_rewrite.fleet.file.fleet_file import input_files, read_fleet
from multibot_rewrite.fleet.file.robot_choice import Choice
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.manifest import hash_of, inputs_of
from multibot_rewrite.pages.page import Framed
from multibot_rewrite.pages.view.page import (
    Meshes,
    meshes_of,
    remark_if_empty,
    title_of,
    to_frame,
    to_html,
)
from multibot_rewrite.pages.view.scene import ShownScene, ViewedRobot, moved_links, scene_of
from multibot_rewrite.planning.plan import is_fleet
from multibot_rewrite.producers.bags.read import read_bag
from multibot_rewrite.producers.bags.recording import as_snapshot
from multibot_rewrite.producers.snapshot_file import read_snapshots
from multibot_rewrite.system.records import System


def run(options: argparse.Namespace) -> int:
    """Rewrite, load, write the page; returns the exit code."""
    check_use(options, "view", printed=not goes_to_file(options))
    plan = _plan_of(options)
    check_target(options.output, [*input_files(plan.file), *options.snapshot])
    scene = scene_of(plan, _given_graph(options))
    meshes = _meshes(scene)
    page = to_html(scene, meshes, title_of(scene.robots, plan.fleet.naming.layout.name))
    for it in _scene_notes(scene.robots, meshes):
        note(options, f"note: {it}")
    deliver(options, page)
    size = f"{len(page) / 1e6:.1f} MB"
    note(
        options,
        f"wrote {options.output}: {plural(len(scene.robots), 'robot')}, {size}; open it in a browser",
    )
    return DONE


def _given_graph(options: argparse.Namespace) -> System | None:
    """Return the saved or recorded graph with tf, or None without one."""
    if options.zenoh:
        raise UsageError("view shows what was saved or recorded: save it with multibot snapshot")
    if options.bag:
        return as_snapshot(read_bag(options.bag))
    return read_snapshots(options.snapshot) if options.snapshot else None


def _scene_notes(robots: Sequence[ViewedRobot], meshes: Meshes) -> Iterator[str]:
    """Yield notes: meshes that are missing or unreadable, robots without a shape, differing tf."""
    shapes = (it for one in robots for its in one.model.links.values() for it in its)
    unread = (why for why in meshes.values() if isinstance(why, str))
    for missing in sorted({*(it.missing for it in shapes if it.missing), *unread}):
        yield f"{missing}, it is shown as a box"
    for robot in robots:
        if nothing := remark_if_empty(robot.model):
            yield f"{robot.name}: {nothing}"
        if off := list(moved_links(robot.model.joints, robot.transforms)):
            yield (
                f"{robot.name}: on tf, fixed joints are not as in the description"
                f" ({shorten(off, SEVERAL)}): robot_state_publisher has another description, or another"
                " node sends them"
            )


def framed(options: argparse.Namespace, graph: System) -> Framed | None:
    """Return the robots for the head of a report, with their frames from the graph.

    None, with a note, if they cannot be shown, and if the command has no description.
    """
    given = vars(options)
    try:
        file = _fleet_file(options.plan) if given.get("plan") else ""
        if not (file or given.get("input")):
            return None
        plan = _planned_fleet(options, file) if file else _plan_of(options)
        scene = scene_of(plan, graph)
        title = title_of(scene.robots, plan.fleet.naming.layout.name)
        return to_frame(scene, _meshes(scene), title)
    except MultibotError as error:
        note(options, f"note: the report does not show the robots in 3D: {error}")
        return None


def _meshes(scene: ShownScene) -> Meshes:
    """Return the meshes of a scene, with progress on the terminal."""
    show = status()
    try:
        return meshes_of(scene, show)
    finally:
        show("")


def _fleet_file(path: str) -> str:
    """Return this file, or the unchanged fleet file that was built into its folder."""
    if is_fleet(read_file(path)):
        return path
    for name, hash_ in inputs_of(os.path.dirname(path)).items():
        if name.endswith((".yaml", ".yml")) and os.path.isfile(name):
            data = read_file(name)
            if hash_of(data) == hash_ and is_fleet(data):
                return name
    return ""


def _plan_of(options: argparse.Namespace) -> FleetPlan:
    """Return the fleet of a fleet file, or of a description and names of robots."""
    first: str = options.input
    if first.endswith(FLEET_FILES):
        check_own(options)
        return _planned_fleet(options, first)
    check_xacro(options, [first])
    read_file(first)
    names, arguments = robots(options) or ["robot1"], xacro_args(options)
    data = {
        **policy(options),
        "description": first,
        "arguments": arguments,
        "robots": [{"name": name, "pose": {"y": 1.5 * at}} for at, name in enumerate(names)],
    }
    try:
        return _planned_fleet(options, {key: value for key, value in data.items() if value})
    except InputError as error:
        raise InputError(without_place(str(error))) from None


def _planned_fleet(options: argparse.Namespace, source: str | dict[str, Any]) -> FleetPlan:
    choice = Choice(number=asked_number(options) if isinstance(source, str) else 0)
    file = read_fleet(source, options.distro or "", os.environ, choice)
    return plan_fleet(file, trust=options.trust)
