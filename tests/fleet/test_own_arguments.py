# SPDX-License-Identifier: Apache-2.0
"""Fleets whose xacro names its robots by arguments: all files of a robot have the same names."""

from __future__ import annotations

import pickle
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest
import yaml
from fleet_folder import built_fleet
from lxml import etree
from named_ends import named_ends
from paths import FIXTURES

from multibot_rewrite import InputError, load_fleet
from multibot_rewrite.base.findings.finding import NOTE, Finding
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.description.sources import job
from multibot_rewrite.description.sources.job import read_whole
from multibot_rewrite.description.sources.read import SourceText
from multibot_rewrite.fleet.file.fleet_file import read_fleet
from multibot_rewrite.fleet.robots.rewritten_robots import read_jobs

XACROS = FIXTURES / "xacros"
SRDF = """\
<robot name="arm">
  <group name="arm"><chain base_link="base_link" tip_link="tool0"/></group>
  <disable_collisions link1="base_link" link2="camera_link" reason="Never"/>
</robot>
"""
PARAMETERS = """\
controller_manager:
  ros__parameters:
    arm_controller: {type: joint_trajectory_controller/JointTrajectoryController}
arm_controller:
  ros__parameters:
    joints: [elbow]
    command_interfaces: [position]
    state_interfaces: [position]
"""
LIMITS = "joint_limits:\n  elbow: {has_velocity_limits: true, max_velocity: 1.0}\n"
FLEET = f"""\
layout: frames-per-robot
affix: prefix
separators: {{link: _}}
description: {XACROS / "arm.urdf.xacro"}
srdf: arm.srdf
related_files: {{params: controllers.yaml, moveit: [limits.yaml]}}
"""
BY_PLACEHOLDER = """\
arguments: {tf_prefix: '{robot}_'}
robots:
  - {name: left, pose: {y: 1}}
  - {name: right, pose: {y: -1}}
"""
BY_VALUE = """\
robots:
  - {name: left, pose: {y: 1}, arguments: {tf_prefix: left_}}
  - {name: right, pose: {y: -1}, arguments: {tf_prefix: right_}}
"""


def fleet(folder: Path, text: str) -> Path:
    (folder / "arm.srdf").write_text(SRDF)
    (folder / "controllers.yaml").write_text(PARAMETERS)
    (folder / "limits.yaml").write_text(LIMITS)
    (folder / "fleet.yaml").write_text(text)
    return folder / "fleet.yaml"


def worth_a_look(findings: Iterable[Finding]) -> list[str]:
    """Return the codes of findings above notes: these robots have no drivers."""
    return [it.code for it in findings if it.level != NOTE]


def links(text: str) -> list[str | None]:
    return [it.get("name") for it in etree.fromstring(text.encode()).findall("link")]


@pytest.mark.slow
@pytest.mark.parametrize("robots", [BY_PLACEHOLDER, BY_VALUE])
@pytest.mark.parametrize("name", ["left", "right"])
def test_all_files_of_a_robot_agree(tmp_path: Path, robots: str, name: str) -> None:
    made = load_fleet(fleet(tmp_path, FLEET + robots))
    text = {path: made.text(path) for path in made.files}
    own = next(it for path, it in text.items() if path.startswith(name) and path.endswith(".urdf"))
    own_links = [f"{name}_{it}" for it in ("base_link", "tool0", "gripper", "camera_link")]
    assert links(own) == own_links
    srdf = etree.fromstring(text[f"{name}/arm.srdf"].encode())
    assert dict(srdf.find("group/chain").attrib) == {  # type: ignore[union-attr]
        "base_link": f"{name}_base_link",
        "tip_link": f"{name}_tool0",
    }
    controllers = yaml.safe_load(text[f"{name}/controllers.yaml"])
    parameters = controllers[f"/{name}/arm_controller"]["ros__parameters"]
    assert parameters["joints"] == [f"{name}_elbow"]
    assert list(yaml.safe_load(text[f"{name}/limits.yaml"])["joint_limits"]) == [f"{name}_elbow"]
    assert worth_a_look(made.made.findings) == []


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize("key", ["prefix", "namespace"])
def test_a_name_of_its_own_beside_another_prefix_or_namespace(tmp_path: Path, key: str) -> None:
    text = (FLEET + BY_PLACEHOLDER).replace("name: left", f"name: left, {key}: l1")
    made = load_fleet(fleet(tmp_path, text))
    camera = "l1_camera_link" if key == "prefix" else "left_camera_link"
    assert links(made.robot("left").description) == [
        "left_base_link",
        "left_tool0",
        "left_gripper",
        camera,
    ]
    assert "joints: [left_elbow]" in made.text("left/controllers.yaml")
    srdf = made.text("left/arm.srdf")
    assert 'base_link="left_base_link" tip_link="left_tool0"' in srdf
    assert f'link2="{camera}"' in srdf
    assert worth_a_look((*made.findings, *made.made.findings)) == []


@pytest.mark.more
def test_an_argument_with_the_namespace_of_a_robot(tmp_path: Path) -> None:
    text = f"""\
layout: tf-per-robot
description: {XACROS / "base.urdf.xacro"}
robots:
  - {{name: one, namespace: fleet_a, arguments: {{namespace: fleet_a}}, pose: {{x: 1}}}}
  - {{name: two, namespace: fleet_b, arguments: {{namespace: fleet_b}}, pose: {{x: 2}}}}
"""
    made = load_fleet(fleet(tmp_path, text))
    root = etree.fromstring(made.robot("two").description.encode())
    assert [it.text for it in root.iter("namespace")] == ["fleet_b", "/fleet_b"]
    assert worth_a_look((*made.findings, *made.made.findings)) == []
    assert [it.shared for robot in made.plan.robots for it in [robot.member]] == [(), ()]


@pytest.mark.more
def test_a_further_robot_is_one_more_expansion(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    read: list[str] = []

    def counted(source: str, args: Any, trust: bool) -> SourceText:
        read.append(str(source))
        return read_whole(source, args, trust)

    monkeypatch.setattr(job, "read_whole", counted)
    text = FLEET.replace("srdf: arm.srdf\n", "") + "arguments: {tf_prefix: '{robot}_'}\nrobots:\n"
    robots = [f"  - {{name: r{at}, pose: {{y: {at}}}}}\n" for at in range(5)]
    file = read_fleet(str(fleet(tmp_path, text + "".join(robots))), "", {})
    read_jobs(file.robots, make_naming(), (), False, file.distro)
    # One for each robot, one for a robot of another name, one without the argument.
    assert len(read) == 5 + 2


@pytest.mark.slow
def test_one_value_for_several_robots_is_refused(tmp_path: Path) -> None:
    text = FLEET + BY_PLACEHOLDER.replace("{robot}_", "left_")
    with pytest.raises(InputError) as refused:
        load_fleet(fleet(tmp_path, text))
    assert str(refused.value).endswith(
        "fleet.yaml:10: 'right' has the arguments of 'left', which put that name into names;"
        " write {robot} in its place"
    )


def test_an_unknown_placeholder_has_its_line(tmp_path: Path) -> None:
    path = fleet(tmp_path, FLEET + BY_PLACEHOLDER.replace("{robot}", "{tf}"))
    with pytest.raises(InputError, match=r"fleet\.yaml:9: 'left': tf_prefix:=\{tf\}_: unknown"):
        read_fleet(str(path), "", {})


@pytest.mark.slow
def test_a_fleet_with_own_arguments_can_be_pickled(tmp_path: Path) -> None:
    made = load_fleet(fleet(tmp_path, FLEET + BY_PLACEHOLDER))
    copy = pickle.loads(pickle.dumps(made))
    assert copy.text("left/controllers.yaml") == made.text("left/controllers.yaml")


@pytest.mark.more
def test_two_arguments_of_which_one_has_no_default(tmp_path: Path) -> None:
    """As UR's macro, which needs ``name`` and ``tf_prefix``: the related_files' names follow both."""
    text = (
        '<robot name="$(arg name)" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        '<xacro:arg name="tf_prefix" default=""/>'
        '<link name="$(arg tf_prefix)base"/><link name="$(arg tf_prefix)hand"/>'
        '<joint name="$(arg tf_prefix)elbow" type="continuous"><parent link="$(arg tf_prefix)base"/>'
        '<child link="$(arg tf_prefix)hand"/></joint>'
        '<ros2_control name="$(arg name)" type="system"><hardware><plugin>a/B</plugin></hardware>'
        '<joint name="$(arg tf_prefix)elbow"><command_interface name="position"/>'
        '<state_interface name="position"/></joint></ros2_control></robot>'
    )
    (tmp_path / "arm.urdf.xacro").write_text(text)
    (tmp_path / "controllers.yaml").write_text(PARAMETERS)
    fleet = {
        "layout": "frames-per-robot", "affix": "prefix", "distro": "jazzy",
        "description": "arm.urdf.xacro",
        "arguments": {"name": "{robot}", "tf_prefix": "{robot}_"},
        "related_files": {"params": ["controllers.yaml"]},
        "robots": [{"name": "left"}, {"name": "right"}],
    }  # fmt: skip
    file = tmp_path / "fleet.yaml"
    file.write_text(yaml.safe_dump(fleet))
    assert main(["build", str(file), "-o", str(tmp_path / "out"), "-q"]) == 0
    written = yaml.safe_load((tmp_path / "out/left/controllers.yaml").read_text())
    assert written["/left/arm_controller"]["ros__parameters"]["joints"] == ["left_elbow"]


LBR = """\
<robot name="lbr" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="robot_name" default="lbr"/>
  <link name="$(arg robot_name)_link_0"/><link name="$(arg robot_name)_link_1"/>
  <joint name="$(arg robot_name)_A1" type="continuous">
    <parent link="$(arg robot_name)_link_0"/><child link="$(arg robot_name)_link_1"/>
  </joint>
  <ros2_control name="sys" type="system">
    <hardware><plugin>mock_components/GenericSystem</plugin></hardware>
    <joint name="$(arg robot_name)_A1">
      <command_interface name="position"/><state_interface name="position"/>
    </joint>
  </ros2_control>
</robot>
"""
LBR_CONTROLLERS = """\
controller_manager:
  ros__parameters:
    jtc: {type: joint_trajectory_controller/JointTrajectoryController}
jtc:
  ros__parameters:
    joints: [JOINT]
    command_interfaces: [position]
    state_interfaces: [position]
"""


@pytest.mark.more
@pytest.mark.parametrize("joint", ["lbr_A1", "$(var robot_name)_A1"])
def test_a_default_that_is_not_empty_is_known_in_files(joint: str, tmp_path: Path) -> None:
    """LBR's: the argument stands in YAML, too, or its default does."""
    (tmp_path / "lbr.urdf.xacro").write_text(LBR)
    (tmp_path / "controllers.yaml").write_text(LBR_CONTROLLERS.replace("JOINT", joint))
    data = {
        "layout": "frames-per-robot",
        "simulator": "none",
        "description": str(tmp_path / "lbr.urdf.xacro"),
        "arguments": {"robot_name": "{robot}"},
        "related_files": {"params": str(tmp_path / "controllers.yaml")},
        "robots": [{"name": "robot1"}, {"name": "robot2"}],
    }
    made = built_fleet(data, "jazzy")
    assert {it.code for it in made.findings} & {"MB229", "MB854"} == set()
    text = {it.path: it.data.decode() for it in made.files}["robot2/controllers.yaml"]
    assert "joints: [robot2_A1]" in text


LIDAR = """\
<robot name="bot" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="own" default="{default}"/>
  <link name="base_link">
    <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <gazebo reference="base_link">
    <sensor name="lidar" type="gpu_lidar"><topic>{topic}</topic></sensor>
  </gazebo>
</robot>
"""
AMCL = """\
amcl:
  ros__parameters: {{scan_topic: {0}, base_frame_id: base_link}}
local_costmap:
  local_costmap:
    ros__parameters:
      plugins: [layer]
      layer:
        plugin: "nav2_costmap_2d::ObstacleLayer"
        observation_sources: scan
        scan: {{topic: {0}, data_type: LaserScan}}
"""


@pytest.mark.slow
@pytest.mark.parametrize("layout", ["frames-per-robot", "both"])
@pytest.mark.parametrize(
    ("topic", "default", "value", "named", "wanted"),
    [
        ("$(arg own)/scan", "bot", "{robot}", "scan", "/r1/scan"),
        ("$(arg own)/scan", "bot", "{robot}", "bot/scan", "/r1/scan"),
        ("/$(arg own)/scan", "", "{robot}", "scan", "/r1/scan"),
        ("$(arg own)scan", "", "{robot}/", "/scan", "/r1/scan"),
        # Names that the robot's namespace does not make.
        ("$(arg own)scan", "", "{robot}_", "scan", "/r1_scan"),
        ("$(arg own)scan", "", "{robot}_", "/scan", "/r1_scan"),
        ("lidar/$(arg own)/scan", "bot", "{robot}", "lidar/bot/scan", "/lidar/r1/scan"),
        # No argument: the rewrite makes it the robot's.
        ("scan", "", "", "scan", "/r1/scan"),
    ],
)
def test_a_topic_that_an_argument_has_made_the_robots(
    topic: str, default: str, value: str, named: str, wanted: str, layout: str, tmp_path: Path
) -> None:
    """A topic of gz has no namespace, and amcl has one: what it reads is what the bridge sends."""
    (tmp_path / "bot.urdf.xacro").write_text(LIDAR.format(topic=topic, default=default))
    (tmp_path / "nav2.yaml").write_text(AMCL.format(named))
    given = f"arguments: {{own: '{value}'}}\n" if value else ""
    (tmp_path / "fleet.yaml").write_text(
        f"layout: {layout}\naffix: prefix\ndistro: jazzy\ndescription: bot.urdf.xacro\n{given}"
        "node_sets: localization\nrelated_files: {params: nav2.yaml}\n"
        "robots: [{name: r1}, {name: r2}]\n"
    )
    made = load_fleet(tmp_path / "fleet.yaml")
    rows = yaml.safe_load(made.text("r1/bridge.yaml"))
    assert wanted in {it["ros_topic_name"] for it in rows}
    table = made.plan.fleet.table
    heard = {it.name for it in named_ends(table) if it.node == "/r1/amcl" and it.endpoint.parameter}
    assert wanted in heard
    read = yaml.safe_load(made.node_text("r1/nav2.yaml"))["/r1/amcl"]["ros__parameters"][
        "scan_topic"
    ]
    assert (read if read.startswith("/") else f"/r1/{read}") == wanted
    assert f"scan: {{topic: {wanted}, " in made.text("r1/nav2.yaml")
    assert not {it.code for it in made.made.findings} & {"MG102", "MG303", "MR101"}
