# SPDX-License-Identifier: Apache-2.0
"""Launch files with a fleet file: substitutions, and actions for each robot.

``load_fleet`` is enough for plain launch scripts and does not need launch. This room is for values that
are known only while a launch file runs, such as a LaunchConfiguration; ``launch.frontend`` offers it to
XML and YAML. launch and launch_ros come through ``launch.door``, when needed. A robot or fleet that is
not given is that of the enclosing group (``each_robot``). Files for nodes are in a folder that is
removed at the end of the launch. Source: launch, launch_ros jazzy.
"""

from __future__ import annotations

from multibot_rewrite.launch.actions import composable_node as composable_node
from multibot_rewrite.launch.actions import container as container
from multibot_rewrite.launch.actions import each_robot as each_robot
from multibot_rewrite.launch.actions import lifecycle_node as lifecycle_node
from multibot_rewrite.launch.actions import node as node
from multibot_rewrite.launch.actions import place as place
from multibot_rewrite.launch.actions import spawn as spawn
from multibot_rewrite.launch.context import RobotRef as RobotRef
from multibot_rewrite.launch.context import file_of as file_of
from multibot_rewrite.launch.context import fleet_of as fleet_of
from multibot_rewrite.launch.context import perform as perform
from multibot_rewrite.launch.context import robot_of as robot_of
from multibot_rewrite.launch.substitutions import FILE as FILE
from multibot_rewrite.launch.substitutions import WORDS as WORDS
from multibot_rewrite.launch.substitutions import bridge_config as bridge_config
from multibot_rewrite.launch.substitutions import description as description
from multibot_rewrite.launch.substitutions import params_file as params_file
from multibot_rewrite.launch.substitutions import rviz_config as rviz_config
from multibot_rewrite.launch.substitutions import value as value
from multibot_rewrite.producers.launch.door import missing as missing
