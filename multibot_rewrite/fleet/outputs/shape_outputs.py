# SPDX-License-Identifier: Apache-2.0
"""What a vendor's launch files want besides the robot's outputs: commands, copied files."""

from __future__ import annotations

import os
import shlex
from collections.abc import Iterator

import yaml

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.releases import has_release
from multibot_rewrite.fleet.file.robot_spec import Pose
from multibot_rewrite.fleet.file.shape import REAL, SIMULATED, TakingCommand, name_of, shapes
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.output_file import OutputFile, placed_path, yaml_of
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.fleet.robots.simulators import is_simulated
from multibot_rewrite.related_files.yaml_text import pairs, replaced, spliced


def vendor_commands(plan: FleetPlan) -> Iterator[str]:
    """Yield the vendor's commands that take the files of the one robot of a plan."""
    (robot,) = plan.robots
    for it in _launch_commands(plan, robot):
        given = {**it.takes, **it.as_it_is}
        files = {argument: name_of(robot, what) for argument, what in given.items()}
        if given and not any(files.values()):
            continue
        paths = {key: shlex.quote(placed_path(robot, name)) for key, name in files.items() if name}
        words = (f"{argument}:=$PWD/{path}" for argument, path in paths.items())
        spec, pose = robot.spec, (robot.spec.pose or Pose())._asdict()
        clock = str(is_simulated(robot)).lower()
        command = it.command.format(
            namespace=spec.namespace, folder=f"$PWD/{spec.name}", clock=clock
        )
        placed = (f"{name}:={pose[name]}" for name in it.pose if pose[name])
        yield " ".join([command, *placed, *words])


def taken_as_they_are(plan: FleetPlan) -> set[str]:
    """Return the outputs that a vendor's launch file hands on to nodes unchanged."""
    return {
        placed_path(robot, name)
        for robot in plan.robots
        for it in _launch_commands(plan, robot)
        for what in it.as_it_is.values()
        if (name := name_of(robot, what))
    }


def copied(plan: FleetPlan) -> Iterator[OutputFile]:
    """Yield vendors' files with each robot's namespace; raises InputError if one has none."""
    wanted = shapes()[plan.file.shape].namespace_in if plan.file.shape else {}
    for robot in plan.robots:
        for name, keys in wanted.items():
            source = os.path.join(os.path.dirname(robot.spec.description), name)
            if not os.path.isfile(source):
                continue
            document = yaml_of(source)
            node = document.root
            for key in keys:
                node = next((value for name_, value in pairs(node) if name_.value == key), None)
            if not isinstance(node, yaml.ScalarNode) or node.style in ("|", ">"):
                what = f"{document.file}: {'.'.join(keys)} is not one word"
                raise InputError(f"{what}; write it: each robot gets its own namespace there")
            text = spliced(document, [replaced(node, robot.spec.namespace)])
            yield OutputFile(f"{robot.spec.name}/{name}", text.encode(), (source,))


def _launch_commands(plan: FleetPlan, robot: RewrittenRobot) -> Iterator[TakingCommand]:
    kind = SIMULATED if is_simulated(robot) else REAL
    for it in shapes()[plan.file.shape].launch if plan.file.shape else ():
        if it.robots in ("", kind) and (
            not it.releases or has_release(it.releases, plan.file.distro)
        ):
            yield it
