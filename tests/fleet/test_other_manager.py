# SPDX-License-Identifier: Apache-2.0
"""The namespace of a plugin with a controller manager: an argument for it is the robot's whatever it is
by default; one that stays makes a manager that nobody asks.

Expectations: gz_ros2_control_plugin.cpp (the manager and the plugin's own node are in the namespace of
``<ros>``), controller_manager's spawner.py (it asks ``controller_manager`` in its own namespace).
"""

from __future__ import annotations

import textwrap
from pathlib import Path
from typing import Any

import pytest
from fleet_folder import planned_fleet

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.checks.build import make_outputs
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.description.reports.xacro_arguments import find_arguments
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.launch.launched_robot import NOT_SPAWNED

ROVER = """\
<robot name="rover" xmlns:xacro="http://www.ros.org/wiki/xacro">
  {}
  <link name="base_link"/><link name="wheel"/>
  <joint name="wheel_joint" type="continuous">
    <parent link="base_link"/><child link="wheel"/><axis xyz="0 1 0"/>
  </joint>
  <gazebo>{}</gazebo>
</robot>
"""
OF_GZ = 'filename="gz_ros2_control-system" name="gz_ros2_control::GazeboSimROS2ControlPlugin"'
OF_CLASSIC = 'filename="libgazebo_ros2_control.so" name="control"'
ARGUMENT = '<xacro:arg name="{}" default="{}"/>'
INSIDE = "<ros><namespace>{}</namespace></ros>"
LIDAR = """<gazebo reference="base_link"><sensor name="lidar" type="ray">
  <plugin name="lidar" filename="libgazebo_ros_ray_sensor.so">{}</plugin></sensor></gazebo>"""

CONTROLLED = """\
arm:
  controller_manager:
    ros__parameters: {drive: {type: diff_drive_controller/DiffDriveController}}
  drive:
    ros__parameters: {left_wheel_names: [wheel_joint], right_wheel_names: [wheel_joint]}
"""
LAUNCHED = """\
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        Node(package='robot_state_publisher', executable='robot_state_publisher', namespace='arm'),
        Node(package='ros_gz_sim', executable='create', arguments=['-topic', 'arm/robot_description']),
        Node(package='controller_manager', executable='spawner', namespace='arm', arguments=['drive'])])
"""


def xacro(folder: Path, argument: str, inside: str, plugin: str = OF_GZ) -> str:
    path = folder / "rover.urdf.xacro"
    path.write_text(ROVER.format(argument, f"<plugin {plugin}>{inside}</plugin>"))
    return str(path)


def planned(description: str, **keys: Any) -> FleetPlan:
    data = {
        "layout": "L3",
        "affix": "prefix",
        "simulator": "gazebo",
        "node_sets": "gz_ros2_control",
    }
    data |= {"description": description, "robots": [{"name": "robot1"}, {"name": "robot2"}]}
    return planned_fleet({**data, **keys}, "jazzy")


def said(plan: FleetPlan) -> list[Finding]:
    return [it for it in plan.fleet.table.problems if it.code == "MF850"]


@pytest.mark.parametrize(
    ("argument", "default", "inside", "value"),
    [
        ("namespace", "diffbot", INSIDE.format("/$(arg namespace)"), "{robot}"),
        ("ns", "diffbot", INSIDE.format("$(arg ns)"), "{robot}"),
        ("robotNamespace", "diffbot", INSIDE.format("$(arg robotNamespace)"), "{robot}"),
        ("robot_namespace", "", INSIDE.format("$(arg robot_namespace)"), "{robot}"),
        # That of a camera, of a place inside of the robot, of one plugin among others.
        ("camera_namespace", "camera", INSIDE.format("$(arg camera_namespace)"), ""),
        ("namespace", "arm", INSIDE.format("$(arg namespace)/inside"), ""),
        ("namespace", "arm", "", ""),
    ],
)
def test_which_namespace_is_the_robots(
    argument: str, default: str, inside: str, value: str, tmp_path: Path
) -> None:
    path = xacro(tmp_path, ARGUMENT.format(argument, default), inside)
    (found,) = find_arguments(path, {}, builtin_tree((), "jazzy")).arguments
    assert found.value == value


def test_that_of_one_plugin_of_two_stays(tmp_path: Path) -> None:
    own = INSIDE.format("$(arg namespace)")
    both = f"{ARGUMENT.format('namespace', 'diffbot')}{LIDAR.format(INSIDE.format('front'))}"
    (found,) = find_arguments(xacro(tmp_path, both, own), {}, builtin_tree((), "jazzy")).arguments
    assert [(it.names, it.total) for it in found.uses] == [(1, 2)]
    assert found.value == ""


def test_the_argument_is_filled_so_one_manager_is_there(tmp_path: Path) -> None:
    own = INSIDE.format("/$(arg namespace)")
    plan = planned(xacro(tmp_path, ARGUMENT.format("namespace", "diffbot"), own))
    assert said(plan) == []
    nodes = {it.full_name for it in plan.fleet.table.runs if "controller_manager" in it.name}
    assert nodes == {"/robot1/controller_manager", "/robot2/controller_manager"}
    (launch,) = (it.text for it in make_outputs(plan).files if it.path == "fleet.launch.py")
    assert "ros2_control_node" not in launch


def test_a_report_names_the_first_robot(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    xacro(tmp_path, "", INSIDE.format("diffbot"))
    robots = ", ".join(f"{{name: r{at}}}" for at in range(1, 7))
    fleet = tmp_path / "fleet.yaml"
    fleet.write_text(
        "layout: both\naffix: prefix\ndistro: jazzy\nsimulator: gazebo\nnode_sets: gz_ros2_control\n"
        f"description: rover.urdf.xacro\nrobots: [{robots}]\n"
    )
    assert main(["build", str(fleet), "-o", str(tmp_path / "out"), "-q"]) == 1
    (said,) = (it for it in capsys.readouterr().err.splitlines() if "MF850" in it)
    assert "ask /r1/controller_manager; the same for r2 and 4 more" in said


@pytest.mark.parametrize(
    ("namespace", "wrong"), [("", False), ("<ros><namespace>stick</namespace></ros>", True)]
)
def test_the_plugin_of_classic_is_a_node_besides_its_manager(
    namespace: str, wrong: bool, tmp_path: Path
) -> None:
    """gazebo_ros2_control_plugin.cpp: the node has the plugin's name, the manager its namespace."""
    path = xacro(tmp_path, "", namespace, OF_CLASSIC)
    found = said(planned(path, node_sets="gazebo_ros2_control", distro="humble"))
    wanted = {f"/robot{at}/stick/controller_manager" for at in (1, 2)} if wrong else set()
    assert {it.message.split()[3].rstrip(",") for it in found} == wanted


def test_the_manager_of_a_launch_file_in_the_plugins_namespace_is_one(tmp_path: Path) -> None:
    """A rule of the plugin in that namespace is for the controllers there (rcl remap.c)."""
    rule = "<ros><namespace>arm</namespace><remapping>/arm/drive/cmd_vel:=/arm/go</remapping></ros>"
    path = xacro(tmp_path, "", rule)
    (tmp_path / "control.yaml").write_text(CONTROLLED)
    (tmp_path / "up.launch.py").write_text(LAUNCHED)
    launch, files = str(tmp_path / "up.launch.py"), {"params": str(tmp_path / "control.yaml")}
    plan = planned(path, node_sets=[], launch=launch, related_files=files)
    assert said(plan) == []
    names = {name for run, _, name in plan.fleet.table.ends if run.node == "arm/drive"}
    assert {"/robot1/arm/go", "/robot2/arm/go"} <= names


def test_controllers_whose_spawners_a_condition_keeps_out_do_not_run(tmp_path: Path) -> None:
    """Also beside a launch file of a package that is not here, which starts something else."""
    path = xacro(tmp_path, "", "")
    (tmp_path / "control.yaml").write_text(textwrap.dedent(CONTROLLED.partition("\n")[2]))
    off = "from launch.conditions import IfCondition\n" + LAUNCHED.replace("'arm',", "'',").replace(
        "arguments=['drive'])", "arguments=['drive'], condition=IfCondition('false')), MORE"
    )
    more = "Node(package='acme', executable='driver')"
    (tmp_path / "up.launch.py").write_text(off.replace("MORE", more))
    launch, files = str(tmp_path / "up.launch.py"), {"params": str(tmp_path / "control.yaml")}
    plan = planned(path, node_sets=[], launch=launch, related_files=files)
    whens = {run.fact.when for run in plan.fleet.table.runs if run.node == "drive"}
    assert whens == {NOT_SPAWNED}
