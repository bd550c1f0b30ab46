# SPDX-License-Identifier: Apache-2.0
"""How a rule about a launch file is declared, and what its examples are made of."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, TypeVar

from multibot_rewrite.base.findings.finding import ERROR, Finding
from multibot_rewrite.base.findings.rule import Rule, rule
from multibot_rewrite.system.records import Place

LAUNCH = "launch"
_Check = TypeVar("_Check", bound=Callable[..., Any])
_HEAD = """\
from pathlib import Path
from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription, LogInfo, OpaqueFunction
from launch_ros.actions import Node
HERE = Path(__file__).parent
def generate_launch_description():
    return LaunchDescription([
"""
# The line of an example's first action.
FIRST = _HEAD.count("\n") + 1
_ROVER = """\
<robot name="{0}">
  <link name="{0}_base"><inertial><mass value="1"/></inertial></link>
  <link name="{0}_wheel"><inertial><mass value="1"/></inertial></link>
  <joint name="{0}_joint" type="continuous">
    <parent link="{0}_base"/><child link="{0}_wheel"/>
  </joint>
  <gazebo>
    <plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
      <left_joint>{0}_joint</left_joint><right_joint>{0}_joint</right_joint>
      <topic>{0}/cmd_vel</topic>
    </plugin>
  </gazebo>
</robot>
"""
# What stands beside an example: the descriptions of two robots.
ROVERS = {f"{it}.urdf": _ROVER.format(it) for it in ("robot1", "robot2")}


def launch_rule(
    code: str, name: str, *, level: str = ERROR, line: int = 0, **words: Any
) -> Callable[[_Check], Rule]:
    """Makes a function a rule about what a launch starts: it gets a ``Launched`` and yields findings.
    The other ``words`` are those of ``findings.rule.declare``; ``line`` counts the actions of the bad
    example from 0, which ``launch_of`` makes."""
    return rule(code, name, level, formats=(LAUNCH,), line=FIRST + line, **words)


def launch_of(*actions: str) -> str:
    """A launch file with an action a line."""
    return _HEAD + "".join(f"        {it},\n" for it in actions) + "    ])\n"


def node_of(package: str, executable: str, arguments: Iterable[str] = (), **options: Any) -> str:
    """An action that starts a node; options are as they stand in the file."""
    given = f", arguments={list(arguments)!r}" if arguments else ""
    more = "".join(f", {key}={value}" for key, value in options.items())
    return f'Node(package="{package}", executable="{executable}"{given}{more})'


def create_of(robot: str, *words: str, model: str = "") -> str:
    """An action that spawns a robot of ``ROVERS`` in Gazebo."""
    given = ", ".join(f'"{it}"' for it in ("-name", model or robot, *words))
    file = f'str(HERE / "{robot}.urdf")'
    return f'Node(package="ros_gz_sim", executable="create", arguments=["-file", {file}, {given}])'


def bridge_of(*rows: str) -> str:
    """An action that starts a bridge with rows as arguments."""
    return node_of("ros_gz_bridge", "parameter_bridge", rows, name=f'"bridge{len(rows)}"')


def at(rule_: Rule, place: Place, message: str, hint: str, **more: Any) -> Finding:
    """A finding of a rule at a place."""
    own = {"file": place.file, "line": place.line, "column": place.column or 1}
    return rule_.finding(message, hint, **own, **more)
