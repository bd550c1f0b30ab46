# SPDX-License-Identifier: Apache-2.0
"""A URDF for robot_state_publisher and an SDF for the simulator, from one entry of a fleet file.

As Nav2's tb3_simulation_launch.py has it: the URDF is published, gz_waffle.sdf.xacro is spawned.
"""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from fleet_folder import built_fleet, planned_fleet
from plans import robot_named

from multibot_rewrite import load_fleet
from multibot_rewrite.checks.build import Outputs

URDF = """\
<robot name="rover">
  <link name="base_link">
    <inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
  </link>
  <link name="lidar_link"/><link name="wheel"/>
  <joint name="wheel_joint" type="continuous"><parent link="base_link"/><child link="wheel"/></joint>
  <joint name="mast" type="fixed"><parent link="base_link"/><child link="lidar_link"/></joint>
</robot>
"""
SDF = """\
<sdf version="1.9" xmlns:xacro="http://ros.org/wiki/xacro"><xacro:arg name="namespace" default=""/>
<model name="rover">
  <link name="base_link">
    <sensor name="lidar" type="gpu_lidar"><topic>$(arg namespace)/scan</topic>
      <gz_frame_id>FRAME</gz_frame_id></sensor>
  </link>
  <link name="wheel"/>
  <joint name="JOINT" type="revolute"><parent>base_link</parent><child>wheel</child></joint>
  <plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
    <left_joint>JOINT</left_joint><right_joint>JOINT</right_joint>
    <topic>cmd_vel</topic><odom_topic>odom</odom_topic><tf_topic>tf</tf_topic>
    <frame_id>odom</frame_id><child_frame_id>base_link</child_frame_id>
  </plugin>
</model></sdf>
"""
FLEET = """\
layout: LAYOUT
affix: prefix
description: rover.urdf
simulated: rover.sdf.xacro
arguments: {namespace: "{robot}"}
robots:
  - {name: robot1, pose: {x: 1}}
  - {name: robot2, pose: {x: 3}}
"""


def written(
    folder: Path, layout: str, joint: str = "wheel_joint", frame: str = "lidar_link", more: str = ""
) -> str:
    (folder / "rover.urdf").write_text(URDF)
    text = SDF.replace("JOINT", joint).replace("FRAME", frame)
    (folder / "rover.sdf.xacro").write_text(text)
    (folder / "fleet.yaml").write_text(f"{FLEET.replace('LAYOUT', layout)}{more}")
    return str(folder / "fleet.yaml")


def made(folder: Path, layout: str, **changed: str) -> tuple[Outputs, dict[str, str]]:
    outputs = built_fleet(written(folder, layout, **changed))
    return outputs, {it.path: it.data.decode() for it in outputs.files}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("layout", "link", "frame"),
    [
        ("tf-per-robot", "lidar_link", "lidar_link"),
        ("frames-per-robot", "robot2/lidar_link", "robot2/lidar_link"),
        ("frame-prefix", "lidar_link", "robot2/lidar_link"),
    ],
)
def test_both_are_rewritten_and_the_model_is_spawned(
    layout: str, link: str, frame: str, tmp_path: Path
) -> None:
    outputs, text = made(tmp_path, layout)
    assert f'<link name="{link}"' in text["robot2/rover.urdf"]
    model = text["robot2/rover.sdf"]
    assert f"<gz_frame_id>{frame}</gz_frame_id>" in model
    # The argument has named the topic already.
    assert "<topic>robot2/scan</topic>" in model
    assert "<topic>robot2/cmd_vel</topic>" in model
    line = next(it for it in text["commands.md"].splitlines() if "ros_gz_sim create" in it)
    assert "-name robot1 -file robot1/rover.sdf" in line
    assert "file(f'{name}/rover.sdf')" in text["fleet.launch.py"]
    assert ("'frame_prefix': f'{name}/'" in text["fleet.launch.py"]) == (layout == "frame-prefix")
    rows = yaml.safe_load(text["robot2/bridge.yaml"])
    assert "/robot2/cmd_vel" in {it["ros_topic_name"] for it in rows}
    frames = robot_named(outputs.planned, "robot2").frames
    # lidar_link is in the URDF alone.
    assert frame in frames
    codes = {it.code for it in outputs.findings if it.level != "note"}
    assert codes & {"MF711", "MB863", "MB882", "MB106"} == set()


@pytest.mark.more
def test_tf_is_that_of_the_description(tmp_path: Path) -> None:
    """The model has no mast: robot_state_publisher reads the URDF."""
    plan = planned_fleet(written(tmp_path, "frames-per-robot"))
    sent = plan.fleet.edges["robot2", "robot_state_publisher"]
    assert ("robot2/base_link", "robot2/lidar_link") in {(it.parent, it.child) for it in sent}


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"joint": "axle"}, "no moving joint wheel_joint"),
        ({"frame": "mast_link"}, "its description has not: mast_link"),
    ],
)
def test_what_does_not_fit_is_said(changed: dict[str, str], said: str, tmp_path: Path) -> None:
    outputs, _ = made(tmp_path, "tf-per-robot", **changed)
    found = [it for it in outputs.findings if it.code == "MF711"]
    assert [(it.line, said in it.message) for it in found] == [(7, True)]


@pytest.mark.more
def test_a_fault_of_either_is_an_error(tmp_path: Path) -> None:
    """urdfdom takes no second root: robot_state_publisher would not start, whatever Gazebo gets."""
    path = written(tmp_path, "tf-per-robot", joint="wheel_joint")
    urdf, sdf = tmp_path / "rover.urdf", tmp_path / "rover.sdf.xacro"

    def wrong() -> set[tuple[str, str]]:
        problems = planned_fleet(path).fleet.table.problems
        found = (it for it in problems if it.level == "error")
        return {(it.code, Path(it.file).name.partition(" ")[0]) for it in found}

    assert wrong() == set()
    urdf.write_text(urdf.read_text().replace("</robot>", '<link name="loose"/></robot>'))
    assert wrong() == {("MB501", "rover.urdf")}
    sdf.write_text(sdf.read_text().replace('type="gpu_lidar"', 'type="no_lidar"'))
    assert wrong() == {("MB501", "rover.urdf"), ("MB124", "rover.sdf.xacro")}


@pytest.mark.more
def test_a_script_spawns_the_text(tmp_path: Path) -> None:
    robot = load_fleet(written(tmp_path, "L2")).robot("robot1")
    option, text = robot.spawn_arguments[2:4]
    assert option == "-string"
    assert '<link name="robot1/base_link">' in text
    assert robot.description.startswith("<robot")


@pytest.mark.parametrize("link", ["lidar_link", "wheel"])
def test_frames_that_only_the_description_has_meet_those_of_another_robot(
    link: str, tmp_path: Path
) -> None:
    """robot_state_publisher sends the description's frames, whatever the simulator gets: ``arm`` has
    ``left_LINK`` and ``arm_left`` has ``LINK``."""
    file = Path(written(tmp_path, "both"))
    (tmp_path / "left.urdf").write_text(URDF.replace(f'"{link}"', f'"left_{link}"'))
    fleet = yaml.safe_load(file.read_text()) | {"separators": {"link": "_"}}
    arm, left = fleet["robots"]
    arm |= {"name": "arm", "description": "left.urdf"}
    left |= {"name": "arm_left"}
    file.write_text(yaml.safe_dump(fleet))
    met = [it for it in planned_fleet(file).fleet.table.problems if it.code == "MG402"]
    assert [it.names for it in met] == [(f"arm_left_{link}",)]
    assert met[0].file.endswith("left.urdf")
    assert f"left_{link}" in (tmp_path / "left.urdf").read_text().splitlines()[met[0].line - 1]


@pytest.mark.more
def test_two_robots_of_one_model_and_of_none(tmp_path: Path) -> None:
    path = Path(written(tmp_path, "L2"))
    text = path.read_text().replace("simulated: rover.sdf.xacro\n", "")
    text = text.replace("x: 1}}", "x: 1}, simulated: rover.sdf.xacro}")
    path.write_text(text.replace('arguments: {namespace: "{robot}"}\n', ""))
    outputs = built_fleet(path)
    lines = b"".join(it.data for it in outputs.files if it.path == "commands.md").decode()
    assert "-name robot1 -file robot1/rover.sdf" in lines
    assert "-name robot2 -topic /robot2/robot_description" in lines


@pytest.mark.more
@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({}, []),
        ({"description": "rover.sdf.xacro", "simulated": ""}, ["base_link, wheel"]),
        (
            {
                "description": "rover.sdf.xacro",
                "simulated": "",
                "node_sets": ["no_robot_state_publisher", "slam_toolbox"],
            },
            [],
        ),
    ],
)
def test_an_sdf_alone_is_said(changed: dict[str, object], said: list[str], tmp_path: Path) -> None:
    """robot_state_publisher needs sdformat_urdf for it; where it does not run nothing is missing."""
    fleet = yaml.safe_load(Path(written(tmp_path, "tf-per-robot")).read_text())
    given = {key: it for key, it in {**fleet, **changed}.items() if it}
    (tmp_path / "fleet.yaml").write_text(yaml.safe_dump(given))
    outputs = built_fleet(tmp_path / "fleet.yaml", "jazzy")
    found = [it for it in outputs.findings if it.code == "MF712"]
    assert [text in it.message for it, text in zip(found, said, strict=True)] == [True] * len(said)
