"""Parameter files that a description itself loads: they are rewritten as the files of ``params`` are.

A plugin with a controller manager names one in ``<parameters>``; ``controller_files`` then has each
robot's description load its own.
"""

from __future__ import annotations

import os
from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import NOTE, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.description.sources.packages import package_folder
from multibot_rewrite.fleet.outputs.controller_files import (
    IN_PACKAGE,
    is_same,
    loaded_files,
    named_alike,
)
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot, at_robot

PARAMS = "params"
_ARM = """\
<robot name="arm">
  <link name="base_link"/>
  <gazebo>
    <plugin name="gz_ros2_control::GazeboSimROS2ControlPlugin" filename="gz_ros2_control-system">
      <parameters>controllers.yaml</parameters>
    </plugin>
  </gazebo>
</robot>
"""
_FLEET = "layout: both\nrobots:\n  - {name: robot1, description: arm.urdf}\n"
NOT_FOLLOWED = declare(
    "MF834",
    "loaded-file-not-found",
    NOTE,
    what="A description loads a parameter file that is not there.",
    why="Nothing is known of its controllers, and no robot gets its own: all "
    "robots would read the same names of nodes and joints.",
    fix="Source the workspace that has it, or list the file under `params`.",
    bad=_FLEET,
    good=f"{_FLEET}companions: {{params: config/controllers.yaml}}\n",
    line=3,
    formats=("fleet",),
    beside={
        "arm.urdf": _ARM,
        "config/controllers.yaml": "controller_manager: {ros__parameters: {update_rate: 100}}\n",
    },
)


def with_loaded_files(robot: RewrittenRobot) -> RewrittenRobot:
    """The robot with the files that its description loads among its parameter files.

    One that has the name of a listed file is left out: ``OTHER_CONTROLLER_FILE`` says so. A real robot
    loads none.
    """
    spec = robot.spec
    file, params = spec.simulated or spec.description, spec.companions.get(PARAMS, ())
    more: list[str] = []
    findings: list[Finding] = []
    for path, _ in loaded_files(robot):
        if any(is_same(path, it, file) or named_alike(path, it) for it in params):
            continue
        found = next(_found(path, file), "")
        if not found:
            findings.append(_unknown(robot, path))
        elif not any(named_alike(found, it) for it in more):
            more.append(found)
    companions = {**spec.companions, PARAMS: (*params, *more)} if more else spec.companions
    said = (*robot.findings, *findings)
    return robot._replace(spec=spec._replace(companions=companions), findings=said)


def _found(path: str, description: str) -> Iterator[str]:
    """The file that a description names, where it can be."""
    plain = path.removeprefix("file://")
    match = IN_PACKAGE.fullmatch(plain)
    if match:
        *names, rest = match.groups()
        folder = package_folder(next(filter(None, names), ""), description, ())
        if folder and os.path.isfile(os.path.join(folder, rest)):
            yield os.path.join(folder, rest)
    for it in (plain, os.path.join(os.path.dirname(description), plain)):
        if os.path.isfile(it):
            yield it


def _unknown(robot: RewrittenRobot, path: str) -> Finding:
    message = f"robot {robot.spec.name!r}: its description loads {path!r}, which is not there"
    hint = "list the file under params, or source the workspace that has it"
    return at_robot(NOT_FOLLOWED, robot, message, hint)
