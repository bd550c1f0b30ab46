# SPDX-License-Identifier: Apache-2.0
"""Launch files with a fleet file: substitutions, and actions for each robot.

``load_fleet`` is enough for plain launch scripts and does not need launch. This package is for
values that are known only while a launch file runs, such as a LaunchConfiguration;
``launch.frontend`` offers it to XML and YAML. launch and launch_ros come through ``launch.door``,
when needed. A robot or fleet that is not given is that of the enclosing group (``each_robot``).
Files for nodes are in a folder that is removed at the end of the launch. Source: launch, launch_ros
jazzy."""

from __future__ import annotations

from multibot_rewrite.launch.actions import (
    composable_node as composable_node,
    container as container,
    each_robot as each_robot,
    lifecycle_node as lifecycle_node,
    node as node,
    place as place,
    spawn as spawn,
)
from multibot_rewrite.launch.context import (
    FILE as FILE,
    WORDS as WORDS,
    RobotRef as RobotRef,
    bridge_config as bridge_config,
    description as description,
    file_of as file_of,
    fleet_of as fleet_of,
    params_file as params_file,
    perform as perform,
    robot_of as robot_of,
    rviz_config as rviz_config,
    value as value,
)
from multibot_rewrite.producers.launch.door import missing as missing
