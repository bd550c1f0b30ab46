# SPDX-License-Identifier: Apache-2.0
"""``commands.md``: commands to place, spawn and drive robots, and for controllers, RViz, MoveIt."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from multibot_rewrite.base.releases import facts_of_release
from multibot_rewrite.fleet.file.fleet_file import BRINGUP
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.launch.launch_actions import controller
from multibot_rewrite.fleet.outputs import spawn, teleop
from multibot_rewrite.fleet.outputs.moveit_parameters import cell_commands, moveit_commands
from multibot_rewrite.fleet.outputs.output_file import FilesAndFindings, OutputFile, path_for
from multibot_rewrite.fleet.outputs.relays import relays
from multibot_rewrite.fleet.outputs.shape_outputs import vendor_commands
from multibot_rewrite.fleet.robots.simulators import is_simulated
from multibot_rewrite.fleet.robots.start_poses import InitialPose, start_poses
from multibot_rewrite.knowledge.conditions import readable
from multibot_rewrite.planning.start import Start, shell_line
from multibot_rewrite.planning.transforms import STATE_PUBLISHER
from multibot_rewrite.planning.ways import started
from multibot_rewrite.system.records import SPAWNER

COMMANDS, START = "commands.md", "start_pose.yaml"
TAKING = "\nThe vendor's launch files take its files, in the folder of this file:\n\n```sh\n"


def commands_file(
    plan: FleetPlan, each: Iterable[FleetPlan], windows: Sequence[tuple[str, Start]]
) -> FilesAndFindings:
    """Yield the commands by robot, and amcl's start parameters; ``windows`` open RViz."""
    domains = plan.file.apart.numbers
    clocks: set[bool | None] = set()
    rows = [f"# Commands of this fleet{facts_of_release(plan.file.distro)}\n"]
    for one in each:
        (robot,) = one.robots
        poses = start_poses(one)
        _, findings = spawn.spawns(one)
        yield from (*poses.findings, *findings)
        rows.append(f"\n## {robot.spec.name}\n\n```sh\n")
        rows += [f"export ROS_DOMAIN_ID={domains[robot.spec.name]}\n"] if domains else []
        clock = robot.spec.use_sim_time
        clocks.add(clock)
        rows += _sh_lines((it.start for it in poses.transforms), clock)
        if is_simulated(robot) and not spawn.is_of_vendor(one.evidence_of(robot).placing):
            rows += [spawn.command_of(it, robot) for it in spawn.in_folder(one)]
        rows += _controllers(one)
        relayed = (it.start for it in relays(robot.spec.namespace, one.fleet.naming, one.file))
        driven = (it.start for it in teleop.teleops(one))
        rows += [*_sh_lines((*relayed, *moveit_commands(one), *driven), clock), "```\n"]
        if prefix := robot.frame_prefix:
            rows.append(
                f"\nStart its {STATE_PUBLISHER} with `-p frame_prefix:={prefix}` as well.\n"
            )
        if taking := list(vendor_commands(one)):
            rows += [TAKING, *(f"{it}\n" for it in taking), "```\n"]
        # nav2_bringup takes one file, which has them.
        for pose in poses.initial if one.file.params_style != BRINGUP else ():
            path = path_for(robot, START)
            rows.append(f"\nStart its {pose.node} with `--params-file {path}` as well.\n")
            yield OutputFile(path, _start_parameters(one, pose))
    rows += cell_commands(plan)
    both = clocks.pop() if len(clocks) == 1 else None
    if windows:
        there = (f"ROS_DOMAIN_ID={domains[it]} " if it in domains else "" for it, _ in windows)
        lines = map("".join, zip(there, _sh_lines((it for _, it in windows), both), strict=True))
        rows += ["\n## RViz\n\n```sh\n", *lines, "```\n"]
    yield OutputFile(COMMANDS, "".join(rows).encode())


def _sh_lines(starts: Iterable[Start], use_sim_time: bool | None) -> Iterator[str]:
    """Yield the lines that start processes, with the clock of the fleet file, if it sets one."""
    clock = () if use_sim_time is None else ({"use_sim_time": str(use_sim_time).lower()},)
    for it in starts:
        yield f"{shell_line(it._replace(parameters=(*it.parameters, *clock)))}\n"


def _controllers(plan: FleetPlan) -> Iterator[str]:
    """Yield the command that loads each controller, with the condition for having it."""
    (robot,) = plan.robots
    # What a launch file spawns is started, if later.
    spawned = plan.evidence_of(robot).spawned
    facts = (it for it in plan.fleet.facts if it.when and it.name not in spawned)
    when = {it.name: readable(it.when) for it in facts}
    for it in started(plan.fleet.table):
        if it.way == SPAWNER:
            condition = when.get(it.node.node, "")
            line = shell_line(controller(plan, it))
            yield f"{line}  # {condition}\n" if condition else f"{line}\n"


def _start_parameters(plan: FleetPlan, pose: InitialPose) -> bytes:
    import yaml

    tables = plan.fleet.table.runs
    node = next(it for it in tables if (it.robot, it.node) == (pose.robot, pose.node))
    data = {node.full_name: {"ros__parameters": dict(pose.values)}}
    dumper = getattr(yaml, "CSafeDumper", yaml.SafeDumper)
    return str(yaml.dump(data, None, dumper, sort_keys=False)).encode()
