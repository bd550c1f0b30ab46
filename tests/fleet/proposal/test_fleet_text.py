# SPDX-License-Identifier: Apache-2.0
"""The text of a proposed fleet, whole and by hand."""

from __future__ import annotations

from typing import Any

import pytest
import yaml

from multibot_rewrite.base.naming import LAYOUTS
from multibot_rewrite.proposal.fleet_text import text_of
from multibot_rewrite.proposal.looking import Looked
from multibot_rewrite.proposal.propose import Choice, Member, Proposal
from multibot_rewrite.proposal.related_files import RelatedFiles

BESIDE = RelatedFiles(
    {"params": ("w/p.yaml", "w/q.yaml"), "rviz": ("w/v.rviz",)},
    "w/r.srdf",
    {"nav2": "p.yaml has parameters of amcl", "moveit": "there is r.srdf"},
    {"w/a/b/o.yaml": "why\n  two", "w/c.yaml": "why"},
)
ROVER = Looked(
    "w/r.urdf.xacro", "r", "robot", 2, arguments=(("prefix", "{robot}_"), ("x", "1"), ("sim", "on")),
    switch="sim", needed=("x", "none"), model="w/r.sdf",
)  # fmt: skip
KEYS = {
    "layout": Choice("tf-per-robot", "plugins send tf"),
    "distro": Choice("jazzy", "the newest"),
}
ONE = Proposal(
    KEYS,
    [Member(ROVER, BESIDE, ("robot1", "robot2"), 0.5)],
    {"robot1": {"x": 0.0, "y": 0.0}},
    ("A note",),
    ("first.urdf", "w/more.urdf"),
    {"w/z/bad.yaml": "it is bad"},
    (("w/a.launch.py", 7, "amcl: y"),),
    (("w/b.launch.py", 1, "it fails"),),
)
COMMON: dict[str, Any] = {
    "description": "r.urdf.xacro",
    "simulated": "r.sdf",
    "arguments": {"prefix": "{robot}_", "x": "1", "sim": "on"},
    "srdf": "r.srdf",
    "node_sets": ["nav2", "moveit"],
    "related_files": {"params": ["p.yaml", "q.yaml"], "rviz": "v.rviz"},
}
OTHERS = "".join(f"#   {it.name}: {it.about}\n" for it in LAYOUTS if it.name != "tf-per-robot")
TEXT = f"""\
# A fleet of robots, for multibot_rewrite. Change what you like, then:
#   multibot build fleet.yaml -o out/     writes everything that the robots need
#   multibot rehearse fleet.yaml          tries the plan on a real ROS graph, no simulator
# A note

# Plugins send tf
# The other layouts:
{OTHERS}layout: tf-per-robot

# The newest
distro: jazzy

# The description has 2 links
description: r.urdf.xacro

# The same robot as the simulator gets it
simulated: r.sdf

# Arguments of the xacro: {{robot}} stands for the robot's name
# sim is the switch between the simulated and the real robot
# It needs x; init chose a value: is it right?
arguments:
  prefix: '{{robot}}_'
  x: '1'
  sim: 'on'

# The planning groups of MoveIt
srdf: r.srdf

# nav2: p.yaml has parameters of amcl
# moveit: there is r.srdf
# Nav2 waits for a map: write its yaml_filename for map_server into a parameter file
node_sets: [nav2, moveit]

# Files for one robot; the build writes one of each for every robot
related_files:
  params: [p.yaml, q.yaml]
  rviz: v.rviz

# Other files in these folders, not taken:
#   z/bad.yaml: it is bad
#   a/b/o.yaml: why two
#   c.yaml: why
#   more.urdf: another description
#   ../first.urdf: another description

# No launch file is taken: none, or no single one, starts this robot. What they start;
# to say which: multibot init r.urdf.xacro --launch FILE NAME:=VALUE
#   a.launch.py:7: amcl: y

# Of launch files could not be read:
#   b.launch.py:1: it fails

# Start poses in metres and radians: x, y, z, roll, pitch, yaw
robots:
  - {{name: robot1, pose: {{x: 0.0, y: 0.0}}}}
  - {{name: robot2}}
"""


def test_the_whole_text_of_one_description() -> None:
    assert text_of(ONE, "w/fleet.yaml") == TEXT
    assert yaml.safe_load(TEXT) == {
        "layout": "tf-per-robot", "distro": "jazzy", **COMMON, "robots": [
        {"name": "robot1", "pose": {"x": 0, "y": 0}}, {"name": "robot2"},
    ]}  # fmt: skip


@pytest.mark.parametrize(("count", "more"), [(10, ""), (12, "#   and 2 more\n")])
def test_of_many_that_are_left_ten_are_named(count: int, more: str) -> None:
    many = ONE._replace(others=tuple(f"w/o{at:02}.urdf" for at in range(count)), refused={})
    none = [it._replace(related_files=BESIDE._replace(left={})) for it in ONE.members]
    text = text_of(many._replace(members=none), "w/f")
    rows = "".join(f"#   o{at:02}.urdf: another description\n" for at in range(10))
    assert f"not taken:\n{rows}{more}\n" in text
