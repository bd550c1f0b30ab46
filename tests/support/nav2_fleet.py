# SPDX-License-Identifier: Apache-2.0
"""A fleet of two rovers with the files beside it that nav2.launch.py starts."""

from __future__ import annotations

from pathlib import Path

from paths import ROBOTS, ROOT

FILE = ROOT / "share" / "launch" / "nav2.launch.py"
PARAMS = """\
amcl:
  ros__parameters: {base_frame_id: base_link, odom_frame_id: odom}
local_costmap:
  local_costmap:
    ros__parameters:
      global_frame: odom
      plugins: [keepout]
      keepout: {plugin: "nav2_costmap_2d::KeepoutFilter"}
"""
RVIZ = "Visualization Manager:\n  Displays: []\n  Global Options: {Fixed Frame: map}\n"
FLEET = """\
layout: {layout}
distro: {distro}
node_sets: [{node_set}, robot_state_publisher]
{more}
robots:
  - {{name: robot1, description: %s, pose: {{x: 1.0}}}}
  - {{name: robot2, description: %s, pose: {{x: 3.0}}}}
related_files: {{params: params.yaml, rviz: one.rviz}}
"""
FLEET = FLEET.replace("%s", str(ROBOTS / "rover.urdf"))


def written(folder: Path, **words: str) -> Path:
    """Return the folder, with fleet.yaml and what it names."""
    given = {"layout": "postfix", "distro": "jazzy", "node_set": "nav2", "more": "", **words}
    (folder / "fleet.yaml").write_text(FLEET.format(**given))
    (folder / "params.yaml").write_text(PARAMS)
    (folder / "one.rviz").write_text(RVIZ)
    return folder
