# SPDX-License-Identifier: Apache-2.0
"""Fleets of arms: names of planning groups, SRDFs with arguments, one device for two robots, mounting.

The shapes are those of vendors' files: an SRDF whose xacro spells its prefix without the separator that
the URDF has (franka_description 566ba44), one whose groups have the prefix (xarm_ros2 0417b0f), a joint
to world without arguments (Universal_Robots_ROS2_Description 2221ec0).
"""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from fleet_folder import built_fleet, planned_fleet
from lxml import etree
from paths import write_files

from multibot_rewrite.base.findings.finding import NOTE, WARNING, Finding
from multibot_rewrite.planning.way_checks import running_nodes

pytestmark = pytest.mark.slow

MOCK = "mock_components/GenericSystem"
FRANKA = "franka_hardware/FrankaHardwareInterface"
UR = "ur_robot_driver/URPositionHardwareInterface"
HEAD = '<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
URDF = f"""\
{HEAD}  <xacro:arg name="prefix" default=""/>
  <xacro:arg name="ip" default=""/>
  <xacro:property name="p" value="$(arg prefix)"/>
  <link name="world"/>
  <link name="${{p}}base"/>
  <link name="${{p}}upper"/>
  <link name="${{p}}hand"/>
  <joint name="${{p}}mount" type="fixed"><parent link="world"/><child link="${{p}}base"/></joint>
  <joint name="${{p}}elbow" type="revolute">
    <parent link="${{p}}base"/><child link="${{p}}upper"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
  <joint name="${{p}}wrist" type="fixed"><parent link="${{p}}upper"/><child link="${{p}}hand"/></joint>
  <ros2_control name="${{p}}arm" type="system">
    <hardware>
      <plugin>PLUGIN</plugin>
      <param name="robot_ip">$(arg ip)</param>
      <param name="kinematics/hash"> calib_1 </param>
      <param name="reverse_port">50001</param>
    </hardware>
    <joint name="${{p}}elbow">
      <command_interface name="position"/><state_interface name="position"/>
    </joint>
  </ros2_control>
</robot>
"""
SRDF = f"""\
{HEAD}  <xacro:arg name="prefix" default=""/>
  <xacro:property name="p" value="OWN"/>
  <group name="GROUP"><chain base_link="${{p}}base" tip_link="${{p}}hand"/></group>
  <group name="${{p}}hand"><link name="${{p}}hand"/></group>
  <disable_collisions link1="${{p}}base" link2="${{p}}upper" reason="Adjacent"/>
</robot>
"""
SOLVERS = "manipulator: {kinematics_solver: kdl_kinematics_plugin/KDLKinematicsPlugin}\n"
SERVO = "move_group_name: manipulator\nplanning_frame: base\n"
SENSORS = """\
sensors: [lidar]
lidar: {sensor_plugin: occupancy_map_monitor/PointCloudOctomapUpdater, point_cloud_topic: /points}
"""
RVIZ = """\
Visualization Manager:
  Class: ""
  Displays:
    - Class: moveit_rviz_plugin/MotionPlanning
      Name: MotionPlanning
      Move Group Namespace: ""
      Planned Path:
        Trajectory Topic: /display_planned_path
      Planning Request:
        Planning Group: manipulator
      Planning Scene Topic: monitored_planning_scene
      Robot Description: robot_description
  Global Options:
    Fixed Frame: world
"""
FLEET = """\
layout: LAYOUT
affix: prefix
distro: jazzy
description: arm.urdf.xacro
srdf: arm.srdf.xacro
node_sets: [ros2_control, moveit]
simulator: none
related_files: {moveit: [kinematics.yaml, servo.yaml, sensors_3d.yaml], rviz: moveit.rviz}
"""
TWO = "robots: [{name: left}, {name: right}]\n"
OWN = "arguments: {prefix: '{robot}_'}\n"


def built(
    folder: Path, more: str = TWO, layout: str = "both", **words: str
) -> tuple[dict[str, str], list[Finding]]:
    """Return the files of a fleet and its findings; ``words`` replace those of the sources."""
    plugin, own, group = (words.get(it, "") for it in ("plugin", "own", "group"))
    files = {
        "arm.urdf.xacro": URDF.replace("PLUGIN", plugin or MOCK),
        "arm.srdf.xacro": SRDF.replace("OWN", own).replace("GROUP", group or "manipulator"),
        "kinematics.yaml": words.get("kinematics", SOLVERS),
        "servo.yaml": SERVO,
        "sensors_3d.yaml": SENSORS,
        "moveit.rviz": RVIZ,
        "fleet.yaml": FLEET.replace("LAYOUT", layout) + more,
    }
    write_files(folder, files)
    made = built_fleet(folder / "fleet.yaml")
    return {it.path: it.data.decode() for it in made.files}, list(made.findings)


def displays(text: str) -> dict[str, object]:
    shown = yaml.safe_load(text)["Visualization Manager"]["Displays"]
    (found,) = (it for it in shown if it["Class"] == "moveit_rviz_plugin/MotionPlanning")
    return dict(found)


def errors(findings: list[Finding]) -> list[str]:
    return [f"{it.code} {it.message}" for it in findings if it.level == "error"]


@pytest.mark.parametrize("layout", ["tf-per-robot", "frames-per-robot", "both"])
def test_renamed_groups_have_one_name_everywhere(layout: str, tmp_path: Path) -> None:
    files, findings = built(tmp_path, f"groups: rename\n{TWO}", layout)
    assert errors(findings) == []
    group = "manipulator" if layout == "tf-per-robot" else "left_manipulator"
    named = etree.fromstring(files["left/arm.srdf"].encode()).find("group").get("name")
    shown = displays(files["left/moveit.rviz"])
    assert named == group
    assert list(yaml.safe_load(files["left/kinematics.yaml"])) == [group]
    assert yaml.safe_load(files["left/servo.yaml"])["move_group_name"] == group
    assert shown["Planning Request"] == {"Planning Group": group}
    # A group that is called as a link is.
    assert not [it for it in findings if it.code == "MB863"]


@pytest.mark.parametrize("layout", ["tf-per-robot", "frames-per-robot", "both"])
def test_each_robot_has_a_window_with_its_motion_planning(layout: str, tmp_path: Path) -> None:
    files, findings = built(tmp_path, layout=layout)
    for robot in ("left", "right"):
        shown = displays(files[f"{robot}/moveit.rviz"])
        assert shown["Planned Path"] == {"Trajectory Topic": f"/{robot}/display_planned_path"}
        assert f"rviz2 -d {robot}/moveit.rviz --ros-args -r __ns:=/{robot}" in files["commands.md"]
    assert not [it for it in findings if it.code == "MF202"]


def test_without_namespaces_a_window_has_the_rules_of_its_robot(tmp_path: Path) -> None:
    more = TWO.replace("[{name: left}", "[{name: left, node_sets: [moveit, rviz_moveit]}")
    files, findings = built(tmp_path, more, "postfix")
    lines = files["commands.md"].splitlines()
    (left, right) = (it for it in lines if it.startswith("rviz2"))
    assert "-r __node:=left_rviz2" in left
    assert "-r move_action/_action/send_goal:=left/move_action/_action/send_goal" in left
    assert "-r robot_description_semantic:=left/robot_description_semantic" in left
    assert displays(files["left/moveit.rviz"])["Planned Path"]
    starting = [it for it in lines if it.startswith("ros2 run moveit_ros_move_group move_group")]
    named = zip(starting, ("left", "right"), strict=True)
    assert all(f" -r __node:={robot}_move_group " in line for line, robot in named)
    # The other robot runs none: its window is without the display, and that is said.
    assert "__node" not in right
    assert "MotionPlanning" in next(it.message for it in findings if it.code == "MF202")


def test_an_srdf_whose_prefix_is_spelled_otherwise_follows_its_urdf(tmp_path: Path) -> None:
    """Franka's URDF makes left_base of arm_prefix, its SRDF leftbase."""
    own = "${'$(arg prefix)'.replace('_', '')}"
    files, findings = built(tmp_path, OWN + TWO, "frames-per-robot", own=own)
    chain = etree.fromstring(files["left/arm.srdf"].encode()).find("group/chain")
    assert dict(chain.attrib) == {"base_link": "left_base", "tip_link": "left_hand"}
    assert [it for it in findings if it.code.startswith("MB8")] == []
    assert errors(findings) == []


def test_an_srdf_of_another_robot_is_one_error(tmp_path: Path) -> None:
    _, findings = built(tmp_path, own="other_")
    assert errors(findings) == [
        "MB875 3 of the 3 links and joints that the SRDF names are not in the URDF: other_base, "
        "other_hand and others"
    ]
    assert not [it for it in findings if it.code in ("MB803", "MB804", "MB807")]


def test_a_moveit_file_of_another_robot_is_one_error(tmp_path: Path) -> None:
    solver = SOLVERS.replace("manipulator", "{}")[:-1] + "\n"
    text = "".join(solver.replace("{}", it, 1) for it in ("a", "b", "c", "manipulator"))
    _, findings = built(tmp_path, kinematics=text)
    (message,) = errors(findings)
    assert message == "MB875 3 of the 4 names in this file are in no description: a, b and others"
    # Two of three may be mistakes.
    text = "".join(solver.replace("{}", it, 1) for it in ("a", "b", "manipulator"))
    _, findings = built(tmp_path, kinematics=text)
    assert errors(findings) == []
    assert [it.code for it in findings].count("MB854") == 2


IPS = "robots: [{name: left, arguments: {ip: A}}, {name: right, arguments: {ip: B}}]\n"


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("plugin", "addresses", "said"),
    [
        # That both have one robot_ip is said of the description.
        (UR, ("10.0.0.1", "10.0.0.1"), ["kinematics/hash", "reverse_port"]),
        # It reads no reverse_port.
        (FRANKA, ("10.0.0.1", "10.0.0.2"), ["kinematics/hash"]),
        # No device is named, or none is there.
        (UR, ("0.0.0.0", "0.0.0.0"), []),
        (MOCK, ("10.0.0.1", "10.0.0.1"), []),
    ],
)
def test_one_device_of_two_robots(
    plugin: str, addresses: tuple[str, str], said: list[str], tmp_path: Path
) -> None:
    more = IPS.replace("A}", f"{addresses[0]}}}").replace("B}", f"{addresses[1]}}}")
    _, findings = built(tmp_path, more, plugin=plugin)
    found = [it for it in findings if it.code == "MB412"]
    assert sorted(it.message.rpartition(": ")[2].split()[0] for it in found) == sorted(said)
    assert {it.message.partition(":")[0] for it in found} <= {
        "/right/controller_manager has the same as /left/controller_manager"
    }
    # At the second robot, whose line in the fleet file is the last.
    last = (tmp_path / "fleet.yaml").read_text().count("\n")
    assert {(it.line, it.column) for it in found} <= {(last, 1)}
    # What is written for all of them, with its lines.
    lines = (tmp_path / "arm.urdf.xacro").read_text().splitlines()
    where = [at for at, it in enumerate(lines, 1) if any(word in it for word in said)]
    assert all(f"arm.urdf.xacro:{at}" in it.hint for it in found for at in where)
    # Robots may have computers of their own.
    assert {it.level for it in found if "reverse_port" in it.message} <= {NOTE}


@pytest.mark.parametrize("own", ["", OWN])
def test_two_arms_on_a_world_of_their_own_stand_where_their_poses_are(
    own: str, tmp_path: Path
) -> None:
    poses = "robots: [{name: left, pose: {y: 1}}, {name: right, pose: {y: -1}}]\n"
    _, findings = built(tmp_path, own + poses, "frames-per-robot")
    (found,) = [it for it in findings if it.code == "MF709"]
    assert found.robots == ("left", "right")
    assert "shared_frames: [map]" in found.hint
    files, findings = built(tmp_path, f"{own}shared_frames: [map]\n{poses}", "frames-per-robot")
    assert errors(findings) == []
    lines = [it for it in files["commands.md"].splitlines() if "static_transform" in it]
    assert ["--y 1.0" in lines[0], "--y -1.0" in lines[1]] == [True, True]
    assert "--frame-id map --child-frame-id right/world" in lines[1]
    assert "odom" not in files["commands.md"]
    assert "cmd_vel" not in files["commands.md"]


def test_a_simulated_arm_stays_on_the_world(tmp_path: Path) -> None:
    """sdformat fixes a robot to a link called world (parser_urdf.cc), to no other."""
    robots = "[{name: left}, {name: right, simulator: gazebo, pose: {y: 1}}]"
    more = f"shared_frames: [map]\nrobots: {robots}\n"
    files, findings = built(tmp_path, more, "frames-per-robot")
    assert errors(findings) == []
    assert [it.level for it in findings if it.code == "MF709"] == [WARNING]
    for robot in ("left", "right"):
        root = etree.fromstring(files[f"{robot}/arm.urdf"].encode())
        assert "world" in [it.get("name") for it in root.iter("link")]


@pytest.mark.sample(1)
@pytest.mark.parametrize("finger", ["left_finger", "{robot}_left_finger"])
def test_a_part_that_is_called_as_a_robot_is_no_name_of_it(finger: str, tmp_path: Path) -> None:
    """Kinova's gripper_joint_name is robotiq_85_left_knuckle_joint, also of the robot right."""
    for name in ("arm.urdf.xacro", "arm.srdf.xacro"):
        text = URDF if "urdf" in name else SRDF.replace("OWN", "").replace("GROUP", "arm")
        text = text.replace("PLUGIN", MOCK).replace("$(arg prefix)", "")
        (tmp_path / name).write_text(text.replace("${p}hand", "$(arg finger)"))
        head = (
            (tmp_path / name)
            .read_text()
            .replace(HEAD, HEAD + '<xacro:arg name="finger" default="f"/>')
        )
        (tmp_path / name).write_text(head)
    fleet = "layout: both\naffix: prefix\ndescription: arm.urdf.xacro\nsrdf: arm.srdf.xacro\n"
    more = f"arguments: {{finger: '{finger}'}}\n{TWO}"
    (tmp_path / "fleet.yaml").write_text(fleet + more)
    made = built_fleet(tmp_path / "fleet.yaml")
    files = {it.path: it.data.decode() for it in made.files}
    names = {"left_finger": "right/left_finger", "{robot}_left_finger": "right_left_finger"}
    for path in ("right/arm.urdf", "right/arm.srdf"):
        assert f'"{names[finger]}"' in files[path]
    assert errors(list(made.findings)) == []


CONTROLLERS = """\
controller_manager:
  ros__parameters:
    force_mode_controller: {type: ur_controllers/ForceModeController}
force_mode_controller:
  ros__parameters: {tf_prefix: ""}
"""


def test_a_listener_in_a_controllers_code_has_the_rules_of_its_process(tmp_path: Path) -> None:
    """ur_controllers force_mode_controller.cpp makes a tf2_ros::TransformListener of a buffer alone."""
    (tmp_path / "controllers.yaml").write_text(CONTROLLERS)
    more = f"{TWO}".replace(
        "{name: left}", "{name: left, related_files: {params: controllers.yaml}}"
    )
    files, _ = built(tmp_path, more)
    # One spawner loads it, with what its own node needs.
    lines = [it for it in files["commands.md"].splitlines() if "spawner force_mode" in it]
    assert len(lines) == 1
    table = planned_fleet(tmp_path / "fleet.yaml").fleet.table
    (node,) = (it for _, it in running_nodes(table) if it.node == "force_mode_controller")
    assert set(node.process_rules) >= {("/tf", "tf"), ("/tf_static", "tf_static")}


FILLED_BY_LAUNCH = """\
controller_manager:
  ros__parameters:
    arm_controller: {type: joint_trajectory_controller/JointTrajectoryController}
    io_controller: {type: ur_controllers/GPIOController}
arm_controller:
  ros__parameters:
    joints: [$(var tf_prefix)elbow]
    command_interfaces: [position]
    state_interfaces: [position]
    constraints:
      $(var tf_prefix)elbow: {trajectory: 0.2, goal: 0.1}
io_controller:
  ros__parameters: {tf_prefix: "$(var tf_prefix)"}
"""


@pytest.mark.sample(1)
@pytest.mark.parametrize("own", ["", OWN])
def test_a_controllers_file_that_a_launch_file_fills_is_taken_unedited(
    own: str, tmp_path: Path
) -> None:
    """ur_controllers.yaml has its prefix in keys, lists and alone."""
    (tmp_path / "controllers.yaml").write_text(FILLED_BY_LAUNCH)
    more = TWO.replace("{name: left}", "{name: left, related_files: {params: controllers.yaml}}")
    files, findings = built(tmp_path, own + more, "frames-per-robot")
    made = yaml.safe_load(files["left/controllers.yaml"])
    arm = made["/left/arm_controller"]["ros__parameters"]
    assert arm["joints"] == ["left_elbow"]
    assert arm["constraints"] == {"left_elbow": {"trajectory": 0.2, "goal": 0.1}}
    assert made["/left/io_controller"]["ros__parameters"] == {"tf_prefix": "left_"}
    # The mock lacks what io_controller claims; of the arm nothing is open, and its prefix is filled.
    assert {it.code for it in findings} <= {"MB229", "MF801", "MG316", "MF840"}
    assert "elbow" not in str([it.message for it in findings])


def test_move_group_is_started_with_what_the_files_say(tmp_path: Path) -> None:
    """As moveit_configs.py (to_dict) of moveit_configs_utils."""
    files, _ = built(tmp_path, f"groups: rename\n{TWO}")
    made = yaml.safe_load(files["left/moveit_parameters.yaml"])["/**"]["ros__parameters"]
    assert made["robot_description_semantic"] == files["left/arm.srdf"]
    assert list(made["robot_description_kinematics"]) == ["left_manipulator"]
    assert made["moveit_servo"]["move_group_name"] == "left_manipulator"
    assert made["sensors"] == ["lidar"]
    assert made["lidar"]["point_cloud_topic"] == "/left/points"
    assert made["planning_pipelines"] == ["ompl"]
    assert made["ompl"]["planning_plugins"] == ["ompl_interface/OMPLPlanner"]
    lines = files["commands.md"].splitlines()
    given = "--params-file left/moveit_parameters.yaml"
    for start in ("ros2 run moveit_ros_move_group move_group", "ros2 run moveit_servo", "rviz2 -d"):
        (line,) = (it for it in lines if it.startswith(start) and "/left" in it)
        assert line.endswith(given)
        assert "-r __ns:=/left" in line
    assert files["fleet.launch.py"].count("file(f'{name}/moveit_parameters.yaml')") >= 2


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("name", "text", "path"),
    [
        ("limits.yaml", "joint_limits: {elbow: {max_velocity: 1}}", "robot_description_planning"),
        (
            "controllers.yaml",
            "controller_names: [a]\na: {type: T}",
            "moveit_simple_controller_manager",
        ),
        ("moveit.yaml", "moveit_controller_manager: m/M", "moveit_controller_manager"),
        (
            "chomp_planning.yaml",
            "planning_plugins: [c/C]\nempty: []\nof: {empty1: [1, a], empty2: [[1]], empty3: }",
            "chomp",
        ),
    ],
)
def test_where_the_content_of_a_moveit_file_goes(
    name: str, text: str, path: str, tmp_path: Path
) -> None:
    (tmp_path / name).write_text(text)
    more = TWO.replace("{name: left}", f"{{name: left, related_files: {{moveit: {name}}}}}")
    files, _ = built(tmp_path, more)
    made = yaml.safe_load(files["left/moveit_parameters.yaml"])["/**"]["ros__parameters"]
    assert path in made
    # rcl takes no empty list, and none of several types.
    assert "empty" not in str(made)
    assert all(len({type(it) for it in one}) == 1 for one in made.values() if isinstance(one, list))
    assert ("ompl" in made) == (path != "chomp")
    assert made["default_planning_pipeline"] == ("chomp" if path == "chomp" else "ompl")
