# SPDX-License-Identifier: Apache-2.0
"""``join`` of a fleet file: a robot that is joined of parts.

What is expected is written by hand, or is what a fleet makes of the files of ``multibot join``.
"""

from __future__ import annotations

import json
import pickle
from pathlib import Path

import pytest
from fleet_folder import built_fleet
from lxml import etree

from multibot_rewrite import load_fleet
from multibot_rewrite.base.model import InputError
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.description.joining.from_file import _KEYS
from multibot_rewrite.fleet.file.fleet_data import schema
from multibot_rewrite.fleet.file.fleet_file import input_files, read_fleet

ARM = """\
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="robot_ip" default="none"/>
  <link name="base"/>
  <link name="tool"/>
  <joint name="turn" type="continuous">
    <parent link="base"/><child link="tool"/><axis xyz="0 0 1"/>
  </joint>
  <ros2_control name="driver" type="system">
    <hardware>
      <plugin>ur_robot_driver/URPositionHardwareInterface</plugin>
      <param name="robot_ip">$(arg robot_ip)</param>
    </hardware>
    <joint name="turn">
      <command_interface name="position"/><state_interface name="position"/>
    </joint>
  </ros2_control>
</robot>
"""
SRDF = '<robot name="arm"><group name="arm"><joint name="turn"/></group></robot>\n'
CONTROLLERS = """\
controller_manager:
  ros__parameters:
    update_rate: 100
    joint_state_broadcaster: {type: joint_state_broadcaster/JointStateBroadcaster}
    follow: {type: joint_trajectory_controller/JointTrajectoryController}
follow:
  ros__parameters: {joints: [turn], command_interfaces: [position], state_interfaces: [position]}
"""
PARTS = """\
join:
  - {description: parts/table.urdf}
  - description: parts/arm.urdf.xacro
    arguments: {robot_ip: 10.0.0.1}
    prefix: left_
    at: {parent: table, pose: {y: 0.5, yaw: 1}}
    srdf: parts/arm.srdf
    controllers: parts/controllers.yaml
  - description: parts/arm.urdf.xacro
    prefix: right_
    at: {parent: table, pose: {y: -0.5}}
    srdf: parts/arm.srdf
    controllers: [parts/controllers.yaml]
"""
KEYS = """\
distro: jazzy
layout: both
affix: prefix
separators: {link: _}
node_sets: ros2_control
simulator: none
"""
FLEET = f"{KEYS}{PARTS}robots: [{{name: cell1, arguments: {{robot_ip: 10.0.0.2}}}}]\n"


@pytest.fixture
def folder(here: Path) -> Path:
    """Return a working directory with the parts and their fleet file."""
    (here / "parts").mkdir()
    (here / "parts/table.urdf").write_text('<robot name="cell"><link name="table"/></robot>\n')
    (here / "parts/arm.urdf.xacro").write_text(ARM)
    (here / "parts/arm.srdf").write_text(SRDF)
    (here / "parts/controllers.yaml").write_text(CONTROLLERS)
    (here / "fleet.yaml").write_text(FLEET)
    return here


def outputs(path: str = "fleet.yaml") -> dict[str, bytes]:
    return {it.path: it.data for it in built_fleet(path).files}


def names(data: bytes, tag: str) -> list[str | None]:
    return [it.get("name") for it in etree.fromstring(data).iterchildren(tag)]


def test_arguments_of_the_robot_reach_parts_that_have_none_of_their_own(folder: Path) -> None:
    root = etree.fromstring(outputs()["cell1/robot.urdf"])
    assert [it.text for it in root.iter("param")] == ["10.0.0.1", "10.0.0.2"]


@pytest.mark.slow
def test_it_is_what_a_fleet_makes_of_the_joined_files(folder: Path) -> None:
    made = outputs()
    (folder / "robot.urdf.join").write_text(
        PARTS.replace("prefix: right_", "prefix: right_\n    arguments: {robot_ip: 10.0.0.2}")
    )
    assert main(["join", "robot.urdf.join", "-q", "-o", "by_hand/robot.urdf"]) == 0
    (folder / "by_hand/fleet.yaml").write_text(
        f"{KEYS}description: robot.urdf\nsrdf: robot.srdf\nrobots: [{{name: cell1}}]\n"
        "related_files: {params: robot_controllers.yaml}\n"
    )
    by_hand = outputs("by_hand/fleet.yaml")
    assert made.keys() == by_hand.keys()
    for path in ("cell1/robot.srdf", "cell1/robot_controllers.yaml", "fleet.launch.py"):
        assert made[path] == by_hand[path], path
    assert _elements(made["cell1/robot.urdf"]) == _elements(by_hand["cell1/robot.urdf"])


def _elements(data: bytes) -> list[tuple[str, dict[str, str]]]:
    return [(str(it.tag), dict(it.attrib)) for it in etree.fromstring(data).iter("*")]


@pytest.mark.slow
def test_a_file_that_lists_the_parts_does_the_same(folder: Path) -> None:
    made = outputs()
    (folder / "robot.urdf.join").write_text(PARTS)
    (folder / "fleet.yaml").write_text(FLEET.replace(PARTS, "description: robot.urdf.join\n"))
    assert outputs()["cell1/robot.srdf"] == made["cell1/robot.srdf"]
    assert outputs()["cell1/robot.urdf"] == made["cell1/robot.urdf"]


@pytest.mark.slow
def test_each_robot_may_have_a_list_of_its_own(folder: Path) -> None:
    own = "  - {{name: {}, join: [{{description: parts/table.urdf}}, {}]}}\n"
    arm = "{{description: parts/arm.urdf.xacro, prefix: {}, at: {{parent: table}}}}"
    robots = "".join(own.format(name, arm.format(f"{name}1_")) for name in "ab")
    (folder / "fleet.yaml").write_text(f"{KEYS}robots:\n{robots}")
    made = outputs()
    for it in "ab":
        links = [f"{it}_table", f"{it}_{it}1_base", f"{it}_{it}1_tool"]
        assert names(made[f"{it}/robot.urdf"], "link") == links


def test_an_srdf_of_the_robot_is_taken_instead_of_the_parts(folder: Path) -> None:
    (folder / "own.srdf").write_text('<robot name="cell"><group name="own"/></robot>')
    (folder / "fleet.yaml").write_text(FLEET.replace("robots:", "srdf: own.srdf\nrobots:"))
    made = outputs()
    assert names(made["cell1/own.srdf"], "group") == ["own"]
    assert "cell1/robot.srdf" not in made


@pytest.mark.slow
def test_a_build_knows_the_parts_as_its_inputs(folder: Path) -> None:
    assert main(["build", "fleet.yaml", "-o", "out", "-q"]) == 0
    read = json.loads(Path("out/manifest.json").read_text())["inputs"]
    parts = ("arm.urdf.xacro", "arm.srdf", "controllers.yaml", "table.urdf")
    assert set(read) == {"../fleet.yaml", *(f"../parts/{it}" for it in parts)}
    assert main(["build", "fleet.yaml", "-o", "out", "--check", "-q"]) == 0
    Path("parts/table.urdf").write_text('<robot name="other"><link name="table"/></robot>')
    assert main(["build", "fleet.yaml", "-o", "out", "--check", "-q"]) == 1


def test_every_part_is_an_input(folder: Path) -> None:
    found = set(input_files(read_fleet("fleet.yaml", "", {})))
    parts = ("arm.urdf.xacro", "arm.srdf", "controllers.yaml", "table.urdf")
    assert found == {"fleet.yaml", *(f"parts/{it}" for it in parts)}


@pytest.mark.slow
def test_a_launch_script_has_it_and_can_pickle_it(folder: Path) -> None:
    fleet = load_fleet("fleet.yaml")
    again = pickle.loads(pickle.dumps(fleet))
    Path("parts/arm.urdf.xacro").unlink()
    for it in (fleet, again):
        assert '<link name="cell1_right_tool"/>' in it.robots[0].description
        found = it.robots[0].params("robot_controllers.yaml", "left_follow")
        assert found["joints"] == ["cell1_left_turn"]


def test_the_list_and_the_schema_know_the_same_keys() -> None:
    assert set(schema()["$defs"]["parts"]["items"]["properties"]) == set(_KEYS)


@pytest.mark.parametrize(
    ("old", "new", "wanted"),
    [
        ("parent: table, pose: {y: 0.5", "parent: tabel, pose: {y: 0.5", "did you mean 'table'?"),
        ("prefix: right_", "prefix: left_", "two parts are called 'left'"),
        ("prefix: right_", "prefix: left_\n    name: other", "link 'left_base' is in"),
        ("table.urdf", "gone.urdf", "fleet.yaml:8: parts/gone.urdf does not exist"),
        ("srdf: parts/arm.srdf", "srdf: parts/no.srdf", "fleet.yaml:13: parts/no.srdf does not"),
        ("prefix: left_", "prefx: left_", "fleet.yaml:11: join[1]: unknown key 'prefx'"),
        ("parts/table.urdf}", "parts/table.urdf, at: {parent: x}}", "it is the first part"),
        ("y: 0.5", "y: .inf", "a pose is six numbers"),
        ("robots:", "description: parts/table.urdf\nrobots:", "join and description are both"),
        ("y: 0.5", "y: far", "fleet.yaml:12: join[1].at.pose.y: 'far' is not valid"),
    ],
)
def test_what_is_wrong_is_one_line(folder: Path, old: str, new: str, wanted: str) -> None:
    (folder / "fleet.yaml").write_text(FLEET.replace(old, new))
    with pytest.raises(InputError) as found:
        outputs()
    assert wanted in str(found.value)
    assert "\n" not in str(found.value)


def test_a_list_in_a_list_is_refused(folder: Path) -> None:
    (folder / "parts/table.urdf.join").write_text(PARTS)
    (folder / "fleet.yaml").write_text(FLEET.replace("table.urdf", "table.urdf.join"))
    with pytest.raises(
        InputError, match=r"fleet.yaml:20: parts/table.urdf.join is a list of parts"
    ):
        outputs()


@pytest.mark.slow
def test_configs_of_the_parts_are_one_of_the_robot(folder: Path) -> None:
    display = "- {Class: rviz_default_plugins/Axes, Name: axes, Reference Frame: tool}"
    config = f"Visualization Manager:\n  Displays:\n  {display}\n"
    (folder / "parts/arm.rviz").write_text(config)
    srdf = "    srdf: parts/arm.srdf\n"
    text = FLEET.replace(srdf, f"{srdf}    rviz: parts/arm.rviz\n")
    (folder / "fleet.yaml").write_text(text.replace("layout: both", "layout: frames-per-robot"))
    shown = outputs()["robot.rviz"].decode()
    assert "Reference Frame: cell1_left_tool" in shown
    assert "Reference Frame: cell1_right_tool" in shown
