# SPDX-License-Identifier: Apache-2.0
"""``world.sdf``: an empty world for gz-sim that runs the sensors of the robots.

Gazebo's own empty.sdf has physics, user commands, the scene and contacts; a lidar, a camera or an IMU
sends nothing in it. Source: gz-sim gz-sim8 examples/worlds/empty.sdf, sensors_demo.sdf, and the names
in src/systems (ign-gazebo6 of Humble calls the libraries ignition-gazebo-...).
"""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.releases import has_release
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.output_file import OutputFile
from multibot_rewrite.fleet.outputs.spawn import is_classic, is_simulated
from multibot_rewrite.knowledge.worlds import SYSTEMS

FILE = "world.sdf"
# The release whose Gazebo has libraries of the old name.
OLD_NAMES = "humble"
_ALWAYS = {
    "physics": "Physics",
    "user-commands": "UserCommands",
    "scene-broadcaster": "SceneBroadcaster",
    "contact": "Contact",
}
_PLACE = """\
    <!-- Where the world is on the earth, for GPS: change it. -->
    <spherical_coordinates>
      <surface_model>EARTH_WGS84</surface_model>
      <world_frame_orientation>ENU</world_frame_orientation>
      <latitude_deg>0</latitude_deg>
      <longitude_deg>0</longitude_deg>
      <elevation>0</elevation>
      <heading_deg>0</heading_deg>
    </spherical_coordinates>
"""
_WORLD = """\
<?xml version="1.0"?>
<!-- An empty world that runs the sensors of the robots; it is yours to edit. -->
<sdf version="1.8">
  <world name="empty">
{systems}{place}    <light type="directional" name="sun">
      <cast_shadows>true</cast_shadows>
      <pose>0 0 10 0 0 0</pose>
      <diffuse>0.8 0.8 0.8 1</diffuse>
      <specular>0.2 0.2 0.2 1</specular>
      <direction>-0.5 0.1 -0.9</direction>
    </light>
    <model name="ground_plane">
      <static>true</static>
      <link name="link">
        <collision name="collision">
          <geometry><plane><normal>0 0 1</normal><size>100 100</size></plane></geometry>
        </collision>
        <visual name="visual">
          <geometry><plane><normal>0 0 1</normal><size>100 100</size></plane></geometry>
          <material><ambient>0.8 0.8 0.8 1</ambient><diffuse>0.8 0.8 0.8 1</diffuse></material>
        </visual>
      </link>
    </model>
  </world>
</sdf>
"""


def world_file(plan: FleetPlan) -> Iterator[OutputFile]:
    """The world, where a robot in gz-sim has a sensor that the empty one does not run."""
    robots = [it for it in plan.robots if is_simulated(it) and not is_classic(it)]
    roots = [it.member.inventory.document.root for it in robots]
    types = {sensor.get("type", "") for root in roots for sensor in root.iter("sensor")}
    needed = dict(sorted(SYSTEMS[it] for it in types & SYSTEMS.keys()))
    # A robot that brings a system itself would run it twice.
    brought = [it.get("filename") or "" for root in roots for it in root.iter("plugin")]
    ours = {
        library: name
        for library, name in needed.items()
        if not any(f"-{library}-system" in it for it in brought)
    }
    if ours:
        kind = "ignition-gazebo" if has_release(OLD_NAMES, plan.file.distro) else "gz-sim"
        systems = "".join(_system(kind, *it) for it in {**_ALWAYS, **ours}.items())
        place = _PLACE if "navsat" in ours else ""
        yield OutputFile(FILE, _WORLD.format(systems=systems, place=place).encode())


def _system(kind: str, library: str, name: str) -> str:
    head = f'    <plugin filename="{kind}-{library}-system" name="gz::sim::systems::{name}"'
    if name != "Sensors":
        return f"{head}/>\n"
    return f"{head}>\n      <render_engine>ogre2</render_engine>\n    </plugin>\n"
