# SPDX-License-Identifier: Apache-2.0
"""Robots that are joined of parts: one description, SRDF and parameter file each, made before all else.

They are texts of files that are on no disk; what reads a file of a robot takes them by their paths.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence

from multibot_rewrite.base.findings.finding import NOTE, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.companions.join import Joined, join_plain
from multibot_rewrite.companions.kinds import MOVEIT, PARAMS, RVIZ
from multibot_rewrite.description.joining.part import Part
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.sources.own_names import filled
from multibot_rewrite.description.sources.read import JOIN, is_xacro
from multibot_rewrite.fleet.file.fleet_file import FleetFile
from multibot_rewrite.fleet.file.robot_spec import RobotSpec

ABOUT_PARTS = declare("MF848", "joined-parts", NOTE, formats=("fleet",))


def with_joined(file: FleetFile, trust: bool) -> tuple[FleetFile, Mapping[str, Sequence[Finding]]]:
    """The fleet with the descriptions of robots that have parts, and what a person should know of the
    first robot of each kind; raises InputError as ``join_plain``."""
    found: dict[str, Joined] = {}
    notes: dict[str, Sequence[Finding]] = {}
    robots = []
    for it in file.robots:
        if not it.parts or it.description in dict(it.filled):
            robots.append(it)
            continue
        given = tuple(_with_arguments(part, it) for part in it.parts)
        key = repr(given)
        if key not in found:
            tree = builtin_tree(file.vocabulary, file.distro)
            found[key] = join_plain(given, f"{it.file}:{it.line}", tree, trust)
            notes[it.name] = [_note(it, text) for text in found[key].notes]
        robots.append(_with_files(it, found[key]))
    return file._replace(robots=tuple(robots)), notes


def _with_arguments(part: Part, robot: RobotSpec) -> Part:
    """The part with the arguments of its robot besides its own, if it is a xacro."""
    if not is_xacro(str(part.description)):
        return part
    given = {**filled(robot.arguments, robot.name), **part.xacro_args}
    return part._replace(xacro_args=given)


def _with_files(robot: RobotSpec, made: Joined) -> RobotSpec:
    """The robot with its texts; an SRDF of its own is taken instead of the parts'."""
    folder, name = os.path.split(robot.description)
    below = robot.description if name.endswith(JOIN) else folder
    stem = os.path.join(below, name.removesuffix(JOIN).removesuffix(".urdf"))
    beside = {f"{stem}_controllers.yaml": made.controllers} if made.controllers else {}
    moveit = {os.path.join(below, it): data for it, data in made.moveit.items()}
    window = {f"{stem}.rviz": made.rviz} if made.rviz else {}
    texts = {robot.description: made.data, **beside, **moveit, **window}
    if made.srdf and not robot.srdf:
        robot = robot._replace(srdf=f"{stem}.srdf")
        texts[robot.srdf] = made.srdf
    companions = dict(robot.companions)
    for kind, more in ((PARAMS, beside), (MOVEIT, moveit), (RVIZ, window)):
        if more:
            companions[kind] = (*more, *companions.get(kind, ()))
    filled_in = ((path, data.decode()) for path, data in texts.items())
    return robot._replace(companions=companions, filled=(*robot.filled, *filled_in))


def _note(robot: RobotSpec, text: str) -> Finding:
    message = f"robot {robot.name!r} is joined of parts: {text}"
    hint = "see what it means for the robot; multibot join shows the files"
    return ABOUT_PARTS.finding(message, hint, file=robot.file, line=robot.line)
