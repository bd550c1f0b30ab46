# SPDX-License-Identifier: Apache-2.0
"""Topics that have a robot's name from an argument of its xacro, and once more from its namespace."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from multibot_rewrite.base.findings.finding import ERROR, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.description.sources.own_names import name_robot
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot, at_robot

_KINDS = ("topic", "service")
_XACRO = """\
<robot name="rover" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="tf_prefix" default=""/>
  <link name="$(arg tf_prefix)base_link"/>
  <gazebo>
    <plugin name="drive" filename="libgazebo_ros_planar_move.so">
      <ros><remapping>cmd_vel:=$(arg tf_prefix)cmd_vel</remapping></ros>
    </plugin>
  </gazebo>
</robot>
"""
_FLEET = """\
layout: frames-per-robot
affix: prefix
distro: humble
description: rover.urdf.xacro
{}robots:
  - {{name: robot1}}
"""
NAMED_TWICE = declare(
    "MF844",
    "robot-named-twice",
    ERROR,
    what="A topic or service has the robot's name twice: an argument of the xacro puts it before the "
    "name, and the robot's namespace before that.",
    why="No other node uses that name: commands on /robot1/cmd_vel do not reach a drive that listens "
    "to /robot1/robot1_cmd_vel.",
    fix="Write '' for the argument: links, joints and frames get the robot's name all the same.",
    bad=_FLEET.format("arguments: {tf_prefix: '{robot}_'}\n"),
    good=_FLEET.format("arguments: {tf_prefix: ''}\n"),
    line=7,
    formats=("fleet",),
    beside={"rover.urdf.xacro": _XACRO},
)


def named_twice(robots: Sequence[RewrittenRobot]) -> Iterator[Finding]:
    """Once for each description, with the first of its names."""
    told = set()
    for it in robots:
        name = next(_twice(it), "")
        if name and it.spec.description not in told:
            told.add(it.spec.description)
            given = it.spec.arguments
            which = [key for key, text in given.items() if name_robot({key: text}, [it.spec.name])]
            message = f"{name} has the name of robot {it.spec.name!r} twice"
            hint = f"write {' or '.join(which)}: '' under arguments"
            yield at_robot(NAMED_TWICE, it, message, hint)


def _twice(robot: RewrittenRobot) -> Iterator[str]:
    spec = robot.spec
    if not name_robot(spec.arguments, [spec.name]):
        return
    starts = tuple(f"/{spec.namespace}/{spec.name}{it}" for it in "/_")
    for it in robot.member.reading.names:
        if it.kind in _KINDS and it.name.startswith(starts):
            yield it.name
