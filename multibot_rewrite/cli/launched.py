# SPDX-License-Identifier: Apache-2.0
"""``multibot inspect FLEET``: each process that the launch files of a fleet start, for whom and why."""

import argparse
import os
from collections.abc import Iterator
from typing import NamedTuple

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.cli.output import deliver
from multibot_rewrite.cli.process import DONE
from multibot_rewrite.cli.tables import JSON, Grid, deliver_report, json_bytes
from multibot_rewrite.fleet.file.fleet_file import FleetFile, read_fleet
from multibot_rewrite.fleet.file.robot_spec import RobotSpec
from multibot_rewrite.fleet.launch.launched_robot import launch_of
from multibot_rewrite.fleet.robots.robot_nodes import RVIZ, why_for_each
from multibot_rewrite.producers.launch.programs import once_for_all
from multibot_rewrite.proposal.launches import said_of

_EACH = "each robot"


class _Row(NamedTuple):
    """A process: for whom, what, its place, its parameter files, and why it runs once or later."""

    whose: str
    process: str
    place: str
    files: tuple[str, ...]
    why: str


def run(options: argparse.Namespace, path: str) -> int:
    """Show the processes; returns the exit code. Raises UsageError for a fleet without launch files."""
    file = read_fleet(path, options.distro or "", os.environ)
    rows: list[_Row] = []
    # Robots with the same launch files have the processes in common, and all robots some once.
    for launch in dict.fromkeys(it.launch for it in file.robots if it.launch):
        robots = [it for it in file.robots if it.launch == launch]
        whose = _EACH if len(robots) == len(file.robots) else ", ".join(it.name for it in robots)
        rows += dict.fromkeys(_rows_of_robot(robots[0], whose, file, options.trust))
    if not rows:
        raise UsageError(f"{path}: no robot has a launch file; multibot plan {path} has its nodes")
    if options.output_kind == JSON:
        deliver(options, json_bytes({"processes": [it._asdict() for it in rows]}))
    else:
        shown = [(*it[:3], ", ".join(it.files), it.why) for it in rows]
        deliver_report(options, (Grid(("for", "process", "place", "files", "why"), shown),))
    return DONE


def _rows_of_robot(robot: RobotSpec, whose: str, file: FleetFile, trust: bool) -> Iterator[_Row]:
    orders = [it._replace(trusted=trust) for it in robot.launch]
    for it in launch_of(orders, robot.name).nodes:
        names = {it.name or it.executable, os.path.basename(it.executable)}
        shared = not names.isdisjoint(file.shared_nodes)
        why = "shared_nodes names it" if shared else once_for_all(it)
        why = why if names.isdisjoint(file.own_nodes) else ""
        config = next(iter(robot.related_files.get("rviz", ())), "")
        apart = (
            why_for_each(config, make_naming(**file.policy).layout.name) if RVIZ in names else ""
        )
        files = (os.path.relpath(one.source) for one in it.parameters if one.source)
        place = f"{os.path.relpath(it.place.file)}:{it.place.line}"
        reason = apart or why or it.later
        yield _Row(
            "all robots" if why and not apart else whose, said_of(it), place, (*files,), reason
        )
