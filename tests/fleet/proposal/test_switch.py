# SPDX-License-Identifier: Apache-2.0
"""The argument that switches a xacro between the simulated and the real robot."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml
from paths import fixture_text

from multibot_rewrite.cli.multibot import main

pytestmark = pytest.mark.slow

ROVER = fixture_text("switch_rover.urdf")
CONTROL = """\
controller_manager:
  ros__parameters:
    update_rate: 50
    joint_state_broadcaster: {type: joint_state_broadcaster/JointStateBroadcaster}
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "package.xml").write_text("<package><name>rover</name></package>")
    (tmp_path / "control.yaml").write_text(CONTROL)
    return tmp_path


def write(folder: Path, switch: str, default: str) -> None:
    text = ROVER.format(switch=switch, default=default)
    (folder / "rover.urdf.xacro").write_text(text)


def fleet_of(folder: Path, *words: str) -> Any:
    file = folder / "fleet.yaml"
    assert main(["init", str(folder), "-n", "2", "--yes", "--force", "-o", str(file), *words]) == 0
    return yaml.safe_load(file.read_text())


@pytest.mark.parametrize("switch", ["sim_mode", "use_sim", "use_gazebo", "sim_gazebo", "gz"])
def test_the_simulators_switch_is_set(switch: str, folder: Path) -> None:
    write(folder, switch, "false")
    fleet = fleet_of(folder)
    assert fleet["simulator"] == "gazebo"
    assert fleet["arguments"] == {switch: "true"}
    said = f"# {switch} is the switch between the simulated and the real robot"
    assert said in (folder / "fleet.yaml").read_text()


@pytest.mark.parametrize(("default", "arguments"), [("false", {"use_sim": "true"}), ("true", None)])
def test_hardware_without_a_class_is_of_the_other_world(
    default: str, arguments: dict[str, str] | None, folder: Path
) -> None:
    write(folder, "use_sim", default)
    file = folder / "rover.urdf.xacro"
    of_real = '<xacro:unless value="$(arg use_sim)"><plugin>acme/Driver</plugin></xacro:unless>'
    text = file.read_text()
    assert of_real in text
    plugin = '<plugin filename="gz-sim-imu-system" name="gz::sim::systems::Imu"/>'
    at, end = text.index("<gazebo>"), text.index("</gazebo>")
    file.write_text(f"{text[:at]}<gazebo>{plugin}{text[end:]}".replace(of_real, ""))
    assert fleet_of(folder).get("arguments") == arguments


@pytest.mark.parametrize(
    ("simulator", "value", "says"),
    [
        ("gazebo", "false", "MF843 acme/Driver is no simulator's, and robot 'robot1' is"),
        ("none", "true", "MF843 gz_ros2_control/GazeboSimSystem is a simulator's, and robot"),
    ],
)
def test_hardware_of_the_other_world_stops_the_build(
    simulator: str, value: str, says: str, folder: Path, capsys: Any
) -> None:
    write(folder, "use_sim", value)
    file = folder / "fleet.yaml"
    node_set = "ros2_control" if simulator == "none" else "gz_ros2_control"
    file.write_text(
        f"layout: tf-per-robot\ndistro: jazzy\nsimulator: {simulator}\n"
        f"description: rover.urdf.xacro\nnode_sets: [{node_set}]\n"
        "robots:\n  - {name: robot1}\n  - {name: robot2}\n"
    )
    assert main(["build", str(file), "-o", str(folder / "out")]) == 1
    said = capsys.readouterr().err
    other = "true" if value == "false" else "false"
    assert says in said and f"give the argument use_sim: '{other}'" in said
    assert said.count("MF843") == 1
    assert not (folder / "out").exists()


IF, UNLESS = '<xacro:if value="$(arg {switch})">', '<xacro:unless value="$(arg {switch})">'


@pytest.mark.parametrize("word", ["gazebo", "sim"])
def test_a_word_that_a_xacro_compares_is_a_switch(word: str, folder: Path) -> None:
    """lbr_description has mode: mock, gazebo or hardware."""
    made = '<xacro:property name="mode" value="$(arg mode)"/>\n  <xacro:property name="mass">'
    text = ROVER.replace('<xacro:property name="mass">', made)
    text = text.replace(IF, f"<xacro:if value=\"${{{{mode == '{word}'}}}}\">")
    text = text.replace(UNLESS, f"<xacro:unless value=\"${{{{mode == '{word}'}}}}\">")
    text = text.format(switch="mode", default="mock")
    (folder / "rover.urdf.xacro").write_text(text)
    assert fleet_of(folder)["arguments"] == {"mode": word}


@pytest.mark.parametrize(
    ("plugin", "hardware"),
    [
        ("gz_ros2_control-system", "gz_ros2_control/GazeboSimSystem"),
        ("libgazebo_ros2_control.so", "gazebo_ros2_control/GazeboSystem"),
    ],
)
def test_a_hardware_class_that_is_an_argument(plugin: str, hardware: str, folder: Path) -> None:
    """xarm_description: ros2_control_plugin is the class; a plugin loads those of its own package."""
    head, _, rest = ROVER.partition("      " + IF)
    text = f"{head}      <plugin>$(arg driver)</plugin>\n{rest.partition('</xacro:unless>')[2]}"
    text = text.format(switch="driver", default="acme_hardware/AcmeSystemHardware")
    text = text.replace("gz_ros2_control-system", plugin)
    text = text.replace("gz_ros2_control::GazeboSimROS2ControlPlugin", "control")
    (folder / "rover.urdf.xacro").write_text(text)
    assert fleet_of(folder)["arguments"] == {"driver": hardware}


def test_a_file_of_controllers_that_launch_files_give_is_given(folder: Path) -> None:
    """What a launch file beside the description starts is named: it does not spawn the controllers."""
    write(folder, "use_sim", "true")
    xacro = folder / "rover.urdf.xacro"
    declared = '<xacro:arg name="simple" default="true"/><xacro:arg name="controllers" default=""/>'
    text = xacro.read_text().replace('<xacro:arg name="simple" default="true"/>', declared)
    xacro.write_text(text.replace("$(find rover)/control.yaml", "$(arg controllers)"))
    ekf = "ekf_filter_node: {ros__parameters: {base_link_frame: base_link}}\n"
    (folder / "ekf.yaml").write_text(ekf)
    ekf_node = "package='robot_localization', executable='ekf_node', name='ekf_filter_node'"
    node = f"Node({ekf_node}, parameters=[{{'frequency': 20.0}}])"
    (folder / "up.launch.py").write_text(
        "from launch import LaunchDescription; from launch_ros.actions import Node\n"
        f"def generate_launch_description(): return LaunchDescription([{node}])\n"
    )
    fleet = fleet_of(folder)
    assert fleet["arguments"] == {"controllers": "control.yaml"}
    node = "ekf_filter_node (robot_localization ekf_node): frequency"
    assert f"#   up.launch.py:2: {node}\n" in (folder / "fleet.yaml").read_text()
    assert main(["build", str(folder / "fleet.yaml"), "-o", str(folder / "out")]) == 0
    loaded = f"<parameters>{folder}/out/robot1/control.yaml</parameters>"
    assert loaded in (folder / "out" / "robot1" / "rover.urdf").read_text()
