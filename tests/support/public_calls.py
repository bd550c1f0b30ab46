# SPDX-License-Identifier: Apache-2.0
"""What the tests of the public calls give to them."""

from __future__ import annotations

from paths import FIXTURES

ROVER = FIXTURES / "robots" / "rover.urdf"
SMALL = '<robot name="rover"><link name="base"/></robot>'
TWICE = '<robot name="rover"><link name="base"/><link name="base"/></robot>'
DOUBTFUL = SMALL.replace("</robot>", '<x y="base"/></robot>')
FLEET = """\
layout: frames-per-robot
affix: prefix
node_sets: [nav2, robot_state]
robots:
  - {name: robot1, description: rover.urdf, pose: {x: 1.0}}
  - {name: robot2, description: rover.urdf, pose: {x: 2.0}}
related_files: {params: [params.yaml]}
"""
PARAMS = "amcl:\n  ros__parameters: {base_frame_id: base_footprint}\n"
