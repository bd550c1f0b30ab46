# SPDX-License-Identifier: Apache-2.0
"""Robots that would be spawned into each other, and how far a robot reaches."""

from __future__ import annotations

from math import hypot
from pathlib import Path

import pytest
from lxml import etree

from multibot_rewrite.checks.build import make_outputs
from multibot_rewrite.checks.judged_plan import plan_fleet
from multibot_rewrite.description.checks.shapes import filled_by
from multibot_rewrite.fleet.file.fleet_file import read_fleet

CART = """\
<robot name="cart">
  <link name="base"><collision><geometry><box size="0.6 0.4 0.2"/></geometry></collision></link>
  <link name="mast"><collision><origin xyz="0.1 0 0"/>
    <geometry><cylinder radius="0.05" length="1"/></geometry></collision></link>
  <joint name="up" type="fixed"><origin xyz="0.5 0 0.5" rpy="0 0 1.5707963267948966"/>
    <parent link="base"/><child link="mast"/></joint>
  <gazebo><plugin name="d" filename="libgazebo_ros_diff_drive.so"/></gazebo>
</robot>
"""


SDF = """\
<sdf version="1.9"><model name="cart"><pose>7 0 0 0 0 0</pose>
  <link name="base"><collision name="b"><geometry><box><size>0.6 0.4 0.2</size></box></geometry>
  </collision></link>
  <link name="mast"><pose>0.5 0 0.5 0 0 1.5707963267948966</pose>
    <collision name="m"><pose>0.1 0 0 0 0 0</pose><geometry><cylinder><radius>0.05</radius>
    <length>1</length></cylinder></geometry></collision></link>
  <link name="arm"><pose relative_to="mast">9 0 0 0 0 0</pose><collision name="a"><geometry>
    <sphere><radius>1</radius></sphere></geometry></collision></link>
</model></sdf>
"""


def test_a_model_in_sdf_fills_what_its_urdf_fills(tmp_path: Path) -> None:
    """A spawner's pose takes the place of the model's; a link in another frame counts not."""
    assert filled_by(etree.fromstring(SDF)) == pytest.approx(hypot(0.55, 0.15) / 2)
    (tmp_path / "cart.sdf").write_text(SDF)
    near = "  - {name: a, pose: {x: 1}}\n  - {name: b, pose: {x: 1.3}}\n"
    more = "simulator: gazebo\ndistro: jazzy\n"
    said = found(tmp_path, near, more, description="cart.sdf")
    assert said == ["robot 'b' starts 0.30 m from robot 'a'; their shapes need 0.57 m"]
    assert found(tmp_path, near.replace("1.3", "1.7"), more, description="cart.sdf") == []


def found(
    folder: Path, robots: str, more: str = "", code: str = "MG702", description: str = "cart.urdf"
) -> list[str]:
    (folder / "cart.urdf").write_text(CART)
    file = folder / "fleet.yaml"
    file.write_text(f"layout: both\ndescription: {description}\n{more}robots:\n{robots}")
    made = make_outputs(plan_fleet(read_fleet(str(file), "", {})))
    return [it.message for it in made.findings if it.code == code]


@pytest.mark.more
def test_a_robot_without_a_pose_is_at_the_origin(tmp_path: Path) -> None:
    robots = "  - {name: a}\n  - {name: b, pose: {x: 0.1}}\n"
    assert len(found(tmp_path, robots)) == 1
    assert found(tmp_path, robots, "simulator: none\n") == []


@pytest.mark.deep
def test_neighbours_of_a_large_fleet(tmp_path: Path) -> None:
    robots = "  - {name: r, count: 450, pose: {x: 0}, step: {y: 0.4}}\n"
    assert len(found(tmp_path, robots)) > 0


@pytest.mark.more
@pytest.mark.parametrize(
    ("more", "told"),
    [("simulator: gazebo\n", True), ("", True), ("simulator: none\n", False)],
)
def test_robots_in_a_simulator_without_any_pose(more: str, told: bool, tmp_path: Path) -> None:
    """The launch file that is written spawns them, and check-launch tells it of that file."""
    said = found(tmp_path, "  - {name: a}\n  - {name: b}\n", more, "MG702")
    assert said == (["the 2 robots are spawned at the origin, in each other"] if told else [])
    zero = "  - {name: a, pose: {x: 0}}\n  - {name: b, pose: {yaw: 1}}\n"
    assert found(tmp_path, zero, more, "MG702") == said
    posed = "  - {name: a}\n  - {name: b, pose: {y: 2}}\n"
    assert found(tmp_path, posed, more, "MG702") == []
    assert found(tmp_path, "  - {name: a}\n", more, "MG702") == []
