# SPDX-License-Identifier: Apache-2.0
"""A folder with a fleet: two kinds of robots, related files, and the fleet file that names them."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping
from pathlib import Path

from paths import fixture_text, write_files

from multibot_rewrite.checks.build import Outputs, make_outputs
from multibot_rewrite.checks.judged_plan import plan_fleet
from multibot_rewrite.fleet.file.fleet_data import FleetSource
from multibot_rewrite.fleet.file.fleet_file import read_fleet
from multibot_rewrite.fleet.file.robot_choice import ALL, Choice
from multibot_rewrite.fleet.fleet_plan import FleetPlan

MASS = (
    '<inertial><mass value="1"/>'
    '<inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial>'
)
ROVER = f"""\
<robot name="rover">
  <!-- kept -->
  <link name="base_link">{MASS}</link>
  <link name="lidar_link"/>
  <joint name="lidar_joint" type="fixed"><parent link="base_link"/><child link="lidar_link"/></joint>
</robot>
"""
ARM = fixture_text("fleet_folder_arm.urdf")
ARM_SRDF = """\
<robot name="arm"><group name="all"><joint name="elbow"/></group></robot>
"""
PARAMS = """\
# of one robot
amcl:
  ros__parameters:
    base_frame_id: base_link  # its base
    odom_frame_id: odom
    scan_topic: scan
"""
RVIZ = fixture_text("fleet_folder_rviz.txt")
BRIDGE = """\
- ros_topic_name: scan
  gz_topic_name: /model/rover/scan
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
  direction: GZ_TO_ROS
"""
LIMITS = "joint_limits:\n  elbow:\n    has_velocity_limits: true\n    max_velocity: 1.0\n"
SMALL = fixture_text("fleet_folder_small.yaml")
MIXED = fixture_text("fleet_folder_mixed.yaml")
FILES = {
    "rover.urdf": ROVER,
    "arm.urdf.xacro": ARM,
    "arm.srdf": ARM_SRDF,
    "params.yaml": PARAMS,
    "one_robot.rviz": RVIZ,
    "bridge.yaml": BRIDGE,
    "limits.yaml": LIMITS,
}


def fleet_folder(folder: Path, fleet: str = SMALL, **files: str) -> Path:
    """Write the files and the fleet file; gives the path of the latter."""
    write_files(folder, FILES)
    for name, text in files.items():
        (folder / name.replace("__", ".")).write_text(textwrap.dedent(text))
    path = folder / "fleet.yaml"
    path.write_text(fleet)
    return path


def mixed(layout: str = "L2", affix: str = "prefix") -> str:
    """Robots of two kinds and three sets of nodes, one with three words that differ."""
    return MIXED.replace("LAYOUT", layout).replace("AFFIX", affix)


def planned_fleet(
    source: Path | FleetSource,
    release: str = "",
    around: Mapping[str, str] | None = None,
    choice: Choice = ALL,
    trust: bool = False,
) -> FleetPlan:
    """Read and plan a fleet file, or the same as data; raises as the commands do."""
    given = str(source) if isinstance(source, Path) else source
    return plan_fleet(read_fleet(given, release, around or {}, choice), trust=trust)


def built_fleet(
    source: Path | FleetSource,
    release: str = "",
    around: Mapping[str, str] | None = None,
    choice: Choice = ALL,
) -> Outputs:
    """Everything that a build of the fleet writes and says."""
    return make_outputs(planned_fleet(source, release, around, choice))
