# SPDX-License-Identifier: Apache-2.0
"""Which launch file ``multibot init`` takes, with which arguments, and what it reads."""

from __future__ import annotations

import shlex
import shutil
from pathlib import Path
from typing import Any

import pytest
import yaml
from rule_examples import DESCRIPTION

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.producers.launch import child
from multibot_rewrite.proposal.bringup import Robot, bringup_of

IMPORTS = "; ".join(
    f"from {it} import *"
    for it in ("launch", "launch.actions", "launch.conditions", "launch.substitutions",
               "launch.launch_description_sources", "launch_ros.actions", "launch_ros.substitutions")
)  # fmt: skip
RSP = "Node(package='robot_state_publisher', executable='robot_state_publisher'{})"
PUBLISHER = RSP.format("")
READ = RSP.format(", parameters=[{{'robot_description': open('{}').read()}}]")
DRIVER = "Node(package='acme', executable='driver')"
LIDAR = "Node(package='acme', executable='lidar')"
GZ = "Node(package='ros_gz_sim', executable='create', arguments=['-topic', 'robot_description'])"
BRIDGE = "Node(package='ros_gz_bridge', executable='parameter_bridge')"
MUJOCO = "Node(package='acme', executable='mujoco')"
GUI = "Node(package='joint_state_publisher_gui', executable='joint_state_publisher_gui')"
RVIZ = "Node(package='rviz2', executable='rviz2')"
SWITCH = "DeclareLaunchArgument('use_sim', default_value='false')"
ASKED = f"GroupAction([{GZ}], condition=IfCondition(LaunchConfiguration('use_sim')))"
UNASKED = f"GroupAction([{DRIVER}], condition=UnlessCondition(LaunchConfiguration('use_sim')))"
BOTH = f"{SWITCH}; {PUBLISHER}; {ASKED}; {UNASKED}"
MODE = "DeclareLaunchArgument('hw_mode', default_value='real', choices=['real', 'gazebo'])"
SIM = "PythonExpression([repr('gazebo'), ' == ', repr('gazebo')])"
FAILS = "1 / 0"


def include(name: str, given: str = "") -> str:
    """Return an include of a launch file beside this one."""
    return f"IncludeLaunchDescription('FOLDER/{name}.launch.py', launch_arguments=[{given}])"


def write(folder: Path, files: dict[str, str]) -> list[str]:
    """Write launch files of actions; return their paths."""
    paths = []
    for name, actions in files.items():
        path = folder / f"{name}.launch.py"
        listed = ", ".join(actions.replace("FOLDER", str(folder)).split("; "))
        path.write_text(
            f"{IMPORTS}\ndef generate_launch_description(): return LaunchDescription([{listed}])\n"
        )
        paths.append(str(path))
    return paths


# What launch files start, whether the description has a simulator, what was asked for, which is taken.
ROWS: dict[str, tuple[dict[str, str], bool, str, str]] = {
    "the publisher's": ({"a": LIDAR, "b": f"{PUBLISHER}; {DRIVER}"}, False, "", "b"),
    "the spawner's": ({"a": LIDAR, "b": f"{GZ}"}, True, "", "b"),
    "no other includes it": (
        {"a": f"{PUBLISHER}; {DRIVER}", "b": f"{include('a')}; {LIDAR}"}, False, "", "b",
    ),
    "that of the simulator": (
        {"a": f"{PUBLISHER}; {DRIVER}", "b": f"{PUBLISHER}; {GZ}"}, True, "", "b",
    ),
    "that of the real robot": (
        {"a": f"{PUBLISHER}; {DRIVER}", "b": f"{PUBLISHER}; {GZ}"}, True, "none", "a",
    ),
    "a bridge is of a simulator": (
        {"a": f"{PUBLISHER}; {DRIVER}", "b": f"{PUBLISHER}; {BRIDGE}"}, True, "", "b",
    ),
    "with its switch": ({"a": BOTH}, True, "", "a use_sim:=true"),
    "without its switch": ({"a": BOTH}, True, "none", "a"),
    "the value that a file passes": (
        {"a": f"DeclareLaunchArgument('sim_kind', default_value='off'); {PUBLISHER}; {DRIVER}; "
              "GroupAction([" + GZ + "], condition=LaunchConfigurationEquals('sim_kind', 'gz')); "
              + LIDAR,
         "b": include("a", "('sim_kind', 'gz')"), "c": include("a")},
        True, "", "b",
    ),
    "a file that the simulator's includes": (
        {"a": BOTH, "b": include("a", "('use_sim', 'true')")}, True, "none", "a",
    ),
    "no simulator, nobody asked": ({"a": f"{PUBLISHER}; {DRIVER}"}, True, "", "a"),
    "no simulator, it was asked for": ({"a": f"{PUBLISHER}; {DRIVER}"}, True, "gazebo", ""),
    "a simulator beside a description without one": ({"a": f"{PUBLISHER}; {GZ}"}, False, "", "a"),
    "the most processes": (
        {"a": f"{PUBLISHER}; {DRIVER}", "b": f"{PUBLISHER}; {DRIVER}; {LIDAR}"}, False, "", "b",
    ),
    "windows do not count": (
        {"a": f"{PUBLISHER}; {DRIVER}; {RVIZ}; {RVIZ}", "b": f"{PUBLISHER}; {DRIVER}; {LIDAR}"},
        False, "", "b",
    ),
    "a trial comes last": (
        {"up": f"{PUBLISHER}; {DRIVER}", "demo": f"{PUBLISHER}; {DRIVER}; {LIDAR}"}, False, "", "up",
    ),
    "another simulator's is not real": (
        {"up": f"{PUBLISHER}; {DRIVER}", "my_sim": f"{PUBLISHER}; {MUJOCO}; {LIDAR}"}, False, "", "up",
    ),
    "what only shows it": ({"a": f"{PUBLISHER}; {GUI}; {RVIZ}"}, False, "", ""),
    "two robots": (
        {"a": "; ".join(RSP.format(f", namespace='{it}'") for it in "ab") + f"; {GZ}"}, True, "", "",
    ),
    "another description's": ({"a": f"{READ.format('FOLDER/other.urdf')}; {DRIVER}"}, False, "", ""),
    "its own": (
        {"a": f"{READ.format('FOLDER/other.urdf')}; {DRIVER}; {LIDAR}",
         "b": f"{READ.format('FOLDER/robot.urdf')}; {DRIVER}"}, False, "", "b",
    ),
    "what surely reads it": (
        {"a": f"{PUBLISHER}; {DRIVER}; {LIDAR}", "b": f"{READ.format('FOLDER/robot.urdf')}; {DRIVER}"},
        False, "", "b",
    ),
    "one beside it": ({"a": DRIVER}, False, "", "a"),
    "several beside it": ({"a": DRIVER, "b": LIDAR}, False, "", ""),
    "one that fails": ({"a": f"{PUBLISHER}; {FAILS}", "b": f"{PUBLISHER}; {DRIVER}"}, False, "", "b"),
    "a ring": ({"a": include("b"), "b": include("a"), "c": f"{PUBLISHER}; {DRIVER}"}, False, "", "c"),
    "nothing": ({}, False, "", ""),
}  # fmt: skip


@pytest.mark.parametrize("kind", ROWS)
def test_the_launch_file_that_is_taken(kind: str, tmp_path: Path) -> None:
    files, has_simulator, simulator, taken = ROWS[kind]
    for name in ("robot", "other"):
        (tmp_path / f"{name}.urdf").write_text(DESCRIPTION)
    own, others = (frozenset((str(tmp_path / f"{it}.urdf"),)) for it in ("robot", "other"))
    found = bringup_of(
        Robot(own, others, simulator, has_simulator), write(tmp_path, files), trust=False
    )
    assert bool(found) == bool(taken)
    if found:
        words = (found.name.partition(".")[0], *(f"{a}:={b}" for a, b in found.order.arguments))
        assert " ".join(words) == taken


def test_a_controller_manager_is_started_by_no_launch_file_beside_it(tmp_path: Path) -> None:
    """Nothing would spawn its controllers."""
    launch = write(tmp_path, {"a": DRIVER})
    robot = Robot(frozenset(), frozenset(), "", True, has_control=True)
    assert bringup_of(robot, launch, trust=False) is None


XACRO = """\
<robot name="rover" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="sim" default="false"/><xacro:arg name="wheel" default="big"/>
  <xacro:arg name="prefix" default=""/><xacro:arg name="file" default=""/>
  <xacro:property name="mass"><inertial><mass value="1"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></xacro:property>
  <link name="$(arg prefix)base_link"><xacro:insert_block name="mass"/></link>
  <link name="$(arg prefix)$(arg wheel)"><xacro:insert_block name="mass"/></link>
  <joint name="$(arg prefix)j" type="continuous">
    <parent link="$(arg prefix)base_link"/><child link="$(arg prefix)$(arg wheel)"/>
  </joint>
  <gazebo>
    <plugin filename="$(arg sim)-system" name="acme::Sim"><file>$(arg file)</file></plugin>
  </gazebo>
</robot>
"""
GIVEN = "sim:=true wheel:=big prefix:=front_ file:={}/config/control.yaml"


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """Return a package with a xacro."""
    folder = tmp_path / "rover"
    for name, text in {
        "package.xml": "<package><name>rover</name></package>",
        "urdf/rover.urdf.xacro": XACRO,
        "config/control.yaml": "driver: {ros__parameters: {a: 1}}\n",
        "config/unread.yaml": "amcl: {ros__parameters: {alpha1: 0.2}}\n",
        "config/bridge.yaml": "- ros_topic_name: scan\n  gz_topic_name: scan\n",
        "config/unread_bridge.yaml": "- ros_topic_name: imu\n  gz_topic_name: imu\n",
        "rviz/rover.rviz": "Visualization Manager: {}\n",
        "rviz/a.rviz": "Visualization Manager: {}\n",
        "launch/.keep": "",
    }.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    return folder


def fleet_of(folder: Path, *words: str, code: int = 0) -> Any:
    """Return the fleet file of a folder, which builds."""
    file = folder.parent / "fleet.yaml"
    assert main(["init", str(folder), "--yes", "-q", "--force", "-o", str(file), *words]) == code
    if code == 0:
        assert main(["build", str(file), "-o", str(folder.parent / "out"), "-q"]) == 0
    return yaml.safe_load(file.read_text()) if file.exists() else None


PATH = "PathJoinSubstitution([FindPackageShare('rover'), '{}'])"
DESCRIBED = RSP.format(
    ", parameters=[{'robot_description': Command(['xacro ', "
    + PATH.format("urdf/rover.urdf.xacro") + ", ' " + GIVEN.format("', FindPackageShare('rover'), '")
    + "'])}]"
)  # fmt: skip
PROCESSED = (
    RSP.format(
        ", parameters=[{'robot_description': __import__('xacro').process_file(str(__import__('pathlib')"
        ".Path(__file__).parent.parent / 'urdf/rover.urdf.xacro'), mappings={'sim': 'true'}).toxml()}]"
    )
)  # fmt: skip


def test_the_arguments_that_a_launch_file_gives_a_xacro_are_the_robots(package: Path) -> None:
    """Not those that are the default; the name of a robot is each one's own; a path is relative."""
    write(package / "launch", {"up": f"{DESCRIBED}; {GZ}"})
    fleet = fleet_of(package)
    assert fleet["launch"] == "rover/launch/up.launch.py"
    assert fleet["arguments"] == {
        "sim": "true",
        "file": "../config/control.yaml",
        "prefix": "{robot}_",
    }
    assert fleet_of(package, "sim:=maybe")["arguments"]["sim"] == "maybe"


def test_a_xacro_that_a_launch_file_expands_itself(package: Path) -> None:
    write(package / "launch", {"up": f"{PROCESSED}; {GZ}"})
    assert fleet_of(package)["arguments"] == {"sim": "true", "prefix": "{robot}_"}


SWITCHED = """\
<robot name="rover" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="use_sim" default="false"/>
  <xacro:property name="mass"><inertial><mass value="1"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></xacro:property>
  <link name="base_link"><xacro:insert_block name="mass"/></link>
  <link name="tip"><xacro:insert_block name="mass"/></link>
  <joint name="j" type="revolute"><parent link="base_link"/><child link="tip"/>
    <limit lower="0" upper="1" effort="1" velocity="1"/></joint>
  <ros2_control name="a" type="system"><hardware>
    <xacro:if value="$(arg use_sim)"><plugin>ign_ros2_control/IgnitionSystem</plugin></xacro:if>
    <xacro:unless value="$(arg use_sim)"><plugin>acme/System</plugin></xacro:unless></hardware>
    <joint name="j"><command_interface name="position"/></joint></ros2_control>
  <xacro:if value="$(arg use_sim)"><gazebo>
    <plugin filename="libign_ros2_control-system.so" name="ign_ros2_control::Plugin"/>
  </gazebo></xacro:if></robot>
"""
LOADED = DESCRIBED.replace(GIVEN.format("', FindPackageShare('rover'), '"), "use_sim:={}")


@pytest.mark.parametrize(
    ("given", "words", "simulator", "use_sim"),
    [
        # Another launch file starts the simulator that this description is for.
        ("true", [], "gazebo", "true"),
        ("false", [], "none", None),
        ("true", ["--simulator", "none"], "none", "false"),
    ],
)
def test_the_description_says_what_the_launch_file_that_is_named_is_for(
    given: str, words: list[str], simulator: str, use_sim: str | None, package: Path
) -> None:
    (package / "urdf/rover.urdf.xacro").write_text(SWITCHED)
    write(package / "launch", {"up": f"{LOADED.replace('{}', given)}; {DRIVER}"})
    launch = ["--launch", str(package / "launch/up.launch.py")]
    fleet = fleet_of(package, "--distro", "humble", *launch, *words)
    assert fleet["launch"] == "rover/launch/up.launch.py"
    assert fleet["simulator"] == simulator
    assert fleet.get("arguments", {}).get("use_sim") == use_sim
    said = (package.parent / "fleet.yaml").read_text()
    assert ("up.launch.py is for a simulator" in said) is (simulator == "gazebo")


SHOWN = RVIZ[:-1] + f", arguments=['-d', {PATH.format('rviz/rover.rviz')}])"
BRIDGED = BRIDGE[:-1] + f", parameters=[{{'config_file': {PATH.format('config/bridge.yaml')}}}])"
CONTROLLED = DRIVER[:-1] + f", name='driver', parameters=[{PATH.format('config/control.yaml')}])"
SCRIPT = "ExecuteProcess(cmd=['python3', '/opt/wave.py', '2'])"


def test_a_window_that_the_fleet_file_gives_each_robot(package: Path) -> None:
    write(package / "launch", {"up": f"{PUBLISHER}; {GZ}; {SHOWN}"})
    fleet_of(package)
    assert not (package.parent / "out/robot1/rover.rviz").exists()
    file = package.parent / "fleet.yaml"
    file.write_text(file.read_text() + "own_nodes: [rviz2]\n")
    assert main(["build", str(file), "-o", str(package.parent / "out"), "-q", "--force"]) == 0
    assert (package.parent / "out/robot2/rover.rviz").exists()


def test_cartographer_has_the_options_and_the_arguments_of_its_launch_file(package: Path) -> None:
    (package / "config/slam.lua").write_text('options = {map_frame = "map", odom_frame = "odom"}\n')
    words = (
        "['-configuration_directory', 'FOLDER/../config', '-configuration_basename', 'slam.lua', "
    )
    words += "'-load_state_filename', 'hall.pbstream']"
    node = f"Node(package='cartographer_ros', executable='cartographer_node', arguments={words})"
    write(package / "launch", {"up": f"{PUBLISHER}; {DRIVER}; {node}"})
    assert fleet_of(package)["related_files"]["lua"] == ["rover/config/slam.lua"]
    text = (package.parent / "out/fleet.launch.py").read_text()
    assert "'-load_state_filename', 'hall.pbstream'" in text
    assert "'-configuration_directory', file(name)" in text
    assert text.count("-configuration_basename") == 1
    file = package.parent / "fleet.yaml"
    data = yaml.safe_load(file.read_text())
    del data["related_files"]
    file.write_text(yaml.safe_dump(data))
    assert main(["build", str(file), "-o", str(package.parent / "out"), "-q", "--force"]) == 0
    assert "'slam.lua'" in (package.parent / "out/fleet.launch.py").read_text()


def test_only_files_that_a_node_reads_are_taken(package: Path) -> None:
    """The parameter files of nodes are in the build without a word in the fleet file."""
    other = SHOWN.replace("rover.rviz", "a.rviz")
    write(package / "launch", {"up": f"{PUBLISHER}; {GZ}; {SHOWN}; {other}; {SHOWN}"})
    windows = fleet_of(package)["related_files"]["rviz"]
    assert sorted(windows) == ["rover/rviz/a.rviz", "rover/rviz/rover.rviz"]
    text = (package.parent / "out/fleet.launch.py").read_text()
    assert text.count("executable='rviz2'") == 2
    write(
        package / "launch", {"up": f"{PUBLISHER}; {GZ}; {SHOWN}; {BRIDGED}; {CONTROLLED}; {SCRIPT}"}
    )
    fleet = fleet_of(package)
    assert "node_sets" not in fleet
    assert fleet["related_files"] == {
        "rviz": "rover/rviz/rover.rviz",
        "bridge": ["rover/config/bridge.yaml"],
    }
    assert (package.parent / "out/robot1/control.yaml").exists()
    text = (package.parent / "fleet.yaml").read_text()
    shown = text.partition("What up.launch.py starts for each robot:\n")[2].partition("launch:")[0]
    assert [it.removeprefix("#").strip() for it in shown.splitlines()] == [
        "robot_state_publisher robot_state_publisher",
        "ros_gz_sim create",
        "ros_gz_bridge parameter_bridge: config_file",
        "driver (acme driver)",
        "wave.py (python3)",
        "Once for all robots; `own_nodes: [NAME]` gives each its own:",
        "rviz2 rviz2, since it only shows data or forwards an operator's commands",
    ]
    assert "unread" not in text


def test_a_window_that_commands_one_robot_is_each_ones_own(package: Path) -> None:
    (package / "rviz/rover.rviz").write_text(
        "Visualization Manager:\n  Tools:\n    - Class: nav2_rviz_plugins/GoalTool\n"
    )
    write(package / "launch", {"up": f"{PUBLISHER}; {GZ}; {SHOWN}"})
    fleet_of(package)
    text = (package.parent / "fleet.yaml").read_text()
    each, _, once = text.partition("What up.launch.py starts")[2].partition("Once for all")
    assert "rviz2 rviz2, since panels or displays in it work for one robot alone" in each
    assert "rviz2" not in once.partition("launch:")[0]


CALLED = (
    "DeclareLaunchArgument('{0}'); "
    + DRIVER[:-1]
    + (
        ", namespace=LaunchConfiguration('{0}'), parameters=[{{'who': LaunchConfiguration('{0}')}}])"
    )
)
CHOSEN = (
    "DeclareLaunchArgument('robot_name'); "
    "Node(package='acme', executable=[LaunchConfiguration('robot_name'), '_driver'])"
)


@pytest.mark.parametrize(
    ("actions", "given", "written"),
    [
        (CALLED.format("vehicle_name"), "vehicle_name:=hippo", "'vehicle_name:={robot}'"),
        (CALLED.format("namespace"), "namespace:=/hippo", "'namespace:=/{robot}'"),
        # It says what is started, or is no name of a robot.
        (CHOSEN, "robot_name:=hippo", "robot_name:=hippo"),
        (CALLED.format("side"), "side:=hippo", "side:=hippo"),
    ],
)
def test_the_name_of_the_vendors_robot_is_that_of_each(
    actions: str, given: str, written: str, package: Path
) -> None:
    write(package / "launch", {"up": f"{PUBLISHER}; {actions}"})
    file = str(package / "launch/up.launch.py")
    fleet = fleet_of(package, "--simulator", "none", "--launch", file, given)
    assert fleet["launch"] == f"rover/launch/up.launch.py {written}"
    launch = (package.parent / "out/fleet.launch.py").read_text().splitlines()
    told = [it for it in launch if "'who': " in it]
    assert all(("name" in it) is ("{robot}" in written) for it in told)
    assert bool(told) is ("who" in actions)
    said = "each robot has its own" in (package.parent / "fleet.yaml").read_text()
    assert said is ("{robot}" in written)


NAV2 = (
    "IncludeLaunchDescription([FindPackageShare('nav2_bringup'), '/launch/localization_launch.py'], "
    f"launch_arguments=[('params_file', {PATH.format('config/unread.yaml')})])"
)


def test_a_file_that_goes_to_what_is_not_installed_is_taken(package: Path) -> None:
    """The vendor's include is started as it is: no node set stands for it."""
    write(package / "launch", {"up": f"{PUBLISHER}; {DRIVER}; {NAV2}"})
    fleet = fleet_of(package, "--simulator", "none")
    assert "node_sets" not in fleet
    assert fleet["related_files"] == {"params": ["rover/config/unread.yaml"]}


SRDF = '<robot name="rover"><group name="arm"><joint name="j"/></group></robot>'
MAKES = "__import__('moveit_configs_utils').launches.generate_move_group_launch('rover')"
MOVES = "Node(package='moveit_ros_move_group', executable='move_group')"


@pytest.mark.parametrize(
    ("starts", "node_set"), [(MAKES, ["moveit"]), (MOVES, None), (LIDAR, None)]
)
def test_moveit_has_its_files_where_it_is_started(
    starts: str, node_set: list[str] | None, package: Path
) -> None:
    (package / "config/rover.srdf").write_text(SRDF)
    (package / "config/kinematics.yaml").write_text("arm: {kinematics_solver: a/A}\n")
    write(package / "launch", {"up": f"{PUBLISHER}; {DRIVER}; {starts}"})
    fleet = fleet_of(package, "--simulator", "none")
    assert fleet.get("node_sets") == node_set
    files = {"moveit": ["rover/config/kinematics.yaml"]} if starts != LIDAR else None
    assert fleet.get("related_files") == files
    assert fleet.get("srdf") == (files and "rover/config/rover.srdf")


def test_a_node_set_that_is_asked_for_is_beside_the_launch_file(package: Path) -> None:
    write(package / "launch", {"up": f"{PUBLISHER}; {DRIVER}"})
    fleet = fleet_of(package, "--node-set", "localization")
    assert fleet["launch"] and fleet["node_sets"] == ["localization"]
    assert fleet["related_files"]["params"] == ["rover/config/unread.yaml"]
    assert "simulator: none" in (package.parent / "fleet.yaml").read_text()


def test_another_launch_file_is_one_command_away(package: Path, capsys: Any) -> None:
    one, two = f"{PUBLISHER}; {DRIVER}", f"{PUBLISHER}; {DRIVER}; {LIDAR}"
    paths = write(package / "launch", {"one": one, "two": two})
    file = package.parent / "fleet.yaml"
    assert main(["init", str(package), "--yes", "-o", str(file)]) == 0
    said = capsys.readouterr().err
    (command,) = [
        it for it in said.splitlines() if "two.launch.py starts most of 2 launch files" in it
    ]
    words = command.rpartition("multibot ")[2].split()
    assert main([*words, "--yes", "-q", "--force", "-o", str(file)]) == 0
    assert yaml.safe_load(file.read_text())["launch"] == "rover/launch/one.launch.py"
    assert "two.launch.py" not in file.read_text(), "it was named"
    assert paths[0].endswith("one.launch.py")


@pytest.mark.parametrize(
    ("words", "launch"),
    [
        (["FOLDER/launch/two.launch.py"], "rover/launch/two.launch.py"),
        (
            ["FOLDER/launch/up.launch.py", "use_sim:=true"],
            "rover/launch/up.launch.py use_sim:=true",
        ),
        (["FOLDER/launch/up.launch.py use_sim:=true"], "rover/launch/up.launch.py use_sim:=true"),
        (["rover", "two.launch.py"], "rover/launch/two.launch.py"),
        (["none"], None),
    ],
)
def test_the_launch_file_is_named(words: list[str], launch: str | None, package: Path) -> None:
    write(package / "launch", {"up": BOTH, "two": f"{PUBLISHER}; {DRIVER}"})
    given = [it.replace("FOLDER", str(package)) for it in words]
    assert fleet_of(package, "--launch", *given, code=0).get("launch") == launch


LONG = "\n".join(f"x{at} = {at}" for at in range(10_000))
BAD = {
    "it raises": ("x = 1 / 0", "ZeroDivisionError"),
    "it raises while it is launched": (
        "x = GroupAction([Node(package='a', executable='b'),"
        " OpaqueFunction(function=lambda context: 1 / 0)])", "the launch ends here: ZeroDivisionError",
    ),
    "it has no such key while it is launched": (
        "x = GroupAction([Node(package='a', executable='b'),"
        " OpaqueFunction(function=lambda context: {}['MODEL'])])", "ends here: KeyError: 'MODEL'",
    ),
    "it ends itself while it is launched": (
        "x = GroupAction([Node(package='a', executable='b'),"
        " OpaqueFunction(function=lambda context: __import__('sys').exit(3))])", "it ends itself",
    ),
    "it needs an argument": (
        "x = DeclareLaunchArgument('ip')", "it has to be given ip; write ip:=VALUE after it",
    ),
    "it includes itself": ("x = IncludeLaunchDescription(__file__)", "without an end"),
    "it includes itself after a node": (
        "x = GroupAction([Node(package='a', executable='b'), IncludeLaunchDescription(__file__)])",
        "without an end",
    ),
    "it starts too much": (
        "x = GroupAction([Node(package='a', executable='b')] * 1001)", "starts 1001 processes",
    ),
    "it imports what is not here": (
        "import acme_tools; x = LogInfo(msg='a')", "it imports the Python package 'acme_tools'",
    ),
    "it writes": ("x = open('FOLDER/made', 'w')", "give --trust"),
    "it starts nothing": ("x = LogInfo(msg='a')", "starts no node with these arguments"),
    "it is no Python": (")", "SyntaxError"),
}  # fmt: skip


@pytest.mark.parametrize("kind", BAD)
def test_a_bad_launch_file_that_is_named_is_one_line(kind: str, package: Path, capsys: Any) -> None:
    line, said = BAD[kind]
    bad = package / "launch" / "bad.launch.py"
    bad.write_text(
        f"{IMPORTS}\n{line.replace('FOLDER', str(package))}\n"
        "def generate_launch_description(): return LaunchDescription([x])\n"
    )
    assert fleet_of(package, "--launch", str(bad), code=2) is None
    error = capsys.readouterr().err
    assert len(error.splitlines()) == 1 and said in error and f"/launch/{bad.name}: " in error
    assert not (package / "made").exists()


def test_a_description_of_what_an_argument_keeps_off_is_not_the_robots(package: Path) -> None:
    robot, other = (package / "urdf" / it for it in ("rover.urdf.xacro", "other.urdf.xacro"))
    other.write_text(XACRO.replace("</robot>", '<link name="more"/></robot>'))
    given = ", parameters=[{{'robot_description': Command(['xacro ', '{}'])}}]"
    off = RSP.format(
        given.format(other) + ", condition=IfCondition(LaunchConfiguration('use_sim'))"
    )
    (file,) = write(
        package / "launch", {"up": f"{SWITCH}; {off}; {RSP.format(given.format(robot))}"}
    )
    assert fleet_of(package, "--launch", file)["description"] == "rover/urdf/rover.urdf.xacro"


def test_a_bad_launch_file_is_named_in_the_fleet_file(package: Path) -> None:
    """The others are read all the same."""
    write(package / "launch", {"up": f"{PUBLISHER}; {DRIVER}"})
    (package / "launch/bad.launch.py").write_text("raise ValueError('no')\n")
    assert fleet_of(package)["launch"] == "rover/launch/up.launch.py"
    assert (
        "rover/launch/bad.launch.py:1: ValueError: no"
        in (package.parent / "fleet.yaml").read_text()
    )


def test_a_long_launch_file_and_one_that_imports_what_is_not_here(
    package: Path, capsys: Any
) -> None:
    """What gives a launch file nothing but parameters may be missing; another one is named."""
    (path,) = write(package / "launch", {"up": f"{PUBLISHER}; {DRIVER}"})
    text = f"{LONG}\n{Path(path).read_text()}"
    Path(path).write_text(f"import moveit_configs_utils\n{text}")
    made = fleet_of(package)
    assert made["launch"] == "rover/launch/up.launch.py"
    Path(path).write_text(f"import acme_tools\n{text}")
    assert "launch" not in fleet_of(package)
    named = (package.parent / "fleet.yaml").read_text()
    assert "up.launch.py:1: package 'acme_tools' is not installed here" in named
    row = f"layout: frames-per-robot\ndescription: rover/urdf/rover.urdf.xacro\nlaunch: {path}\n"
    (package.parent / "own.yaml").write_text(f"{row}robots: [{{name: a}}, {{name: b}}]\n")
    capsys.readouterr()
    out = package.parent / "own"
    assert main(["build", str(package.parent / "own.yaml"), "-o", str(out)]) == 2
    error = capsys.readouterr().err
    assert len(error.splitlines()) == 1 and "'acme_tools', which is not here" in error
    assert not out.exists()


def test_a_launch_file_is_for_one_description(package: Path, capsys: Any) -> None:
    write(package / "launch", {"up": f"{PUBLISHER}; {DRIVER}"})
    shutil.copy(package / "urdf/rover.urdf.xacro", package / "urdf/b.urdf.xacro")
    both = [str(package / "urdf" / it) for it in ("rover.urdf.xacro", "b.urdf.xacro")]
    words = ["--launch", str(package / "launch/up.launch.py")]
    assert main(["init", *both, "--yes", "-o", "-", *words]) == 2
    assert "--launch is for one description" in capsys.readouterr().err
    assert main(["init", both[0], "--yes", "-o", "-", "--launch", "no.launch.py"]) == 2
    assert "no.launch.py: there is no such launch file; correct" in capsys.readouterr().err


MODEL = """<sdf version="1.9"><model name="{0}"><link name="{0}_base"/><link name="{0}_wheel"/>
<joint name="{0}_turn" type="revolute"><parent>{0}_base</parent><child>{0}_wheel</child>
<axis><xyz>0 1 0</xyz></axis></joint>
<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive"/></model></sdf>
"""
WORLD = '<sdf version="1.9"><world name="w"><include><uri>model://{}</uri></include></world></sdf>'
BROKEN = (
    '<robot name="example" xmlns:xacro="x"><xacro:include filename="$(find gone)/a.xacro"/></robot>'
)
READS = (
    "Node(package='robot_state_publisher', executable='robot_state_publisher', parameters=[{{"
    "'robot_description': Command(['xacro ', PathJoinSubstitution([FindPackageShare('{0}'), 'urdf', "
    "'{1}'])])}}])"
)  # fmt: skip
SPAWNS = (
    "Node(package='ros_ign_gazebo', executable='create', arguments=['-file', "
    + PATH.format("{0}/model.sdf")
    + "])"
)
PLAYS = "ExecuteProcess(cmd=['gz', 'sim', " + PATH.format("worlds/yard.sdf") + "])"


@pytest.fixture
def robots(package: Path) -> Path:
    """Return a workspace of several robots, of which nothing but a launch file says which is meant."""
    for name, text in {
        "rover/dolly/model.sdf": MODEL.format("dolly"),
        "rover/cart/model.sdf": MODEL.format("cart"),
        "rover/worlds/yard.sdf": WORLD.format("cart"),
        "other/package.xml": "<package><name>other</name></package>",
        "other/urdf/other.urdf.xacro": XACRO.replace("rover", "other"),
        "other/urdf/example.urdf.xacro": BROKEN,
        "other/launch/other.launch.py": "x = 'other.urdf.xacro', 'example.urdf.xacro'\n",
    }.items():
        file = package.parent / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    return package.parent


@pytest.mark.parametrize(
    ("actions", "description"),
    [
        (READS.format("rover", "rover.urdf.xacro"), "rover/urdf/rover.urdf.xacro"),
        (READS.format("other", "other.urdf.xacro"), "other/urdf/other.urdf.xacro"),
        (SPAWNS.format("dolly"), "rover/dolly/model.sdf"),
        (SPAWNS.format("cart"), "rover/cart/model.sdf"),
        (PLAYS, "rover/cart/model.sdf"),
        (READS.format("other", "other.urdf.xacro").replace("'xacro '", "'ros2 run own make -i '"),
         "other/urdf/other.urdf.xacro"),
        (RSP.format(f", arguments=[{PATH.format('urdf/rover.urdf.xacro')}]"),
         "rover/urdf/rover.urdf.xacro"),
    ],
)  # fmt: skip
def test_the_launch_file_that_is_named_says_which_description(
    actions: str, description: str, robots: Path, capsys: Any
) -> None:
    """No other one is looked at: one that cannot be read stops nothing, and none is offered."""
    (file,) = write(robots / "rover/launch", {"up": f"{actions}; {DRIVER}"})
    out = robots / "fleet.yaml"
    assert main(["init", "--launch", file, str(robots), "--yes", "-o", str(out)]) == 0
    fleet = yaml.safe_load(out.read_text())
    assert (fleet["description"], fleet["launch"]) == (description, "rover/launch/up.launch.py")
    assert "descriptions" not in capsys.readouterr().err
    assert "example.urdf.xacro" not in out.read_text()


def test_a_description_is_not_guessed_where_a_launch_file_loads_one_that_is_not_known(
    robots: Path, capsys: Any
) -> None:
    publisher = RSP.format(", parameters=[{'robot_description': open(SHARE).read()}]")
    share = "FindPackageShare('gone').perform(_) + '/a.urdf'"
    function = f"OpaqueFunction(function=lambda _: [{publisher.replace('SHARE', share)}])"
    (file,) = write(robots / "rover/launch", {"up": f"{function}; {DRIVER}"})
    assert main(["init", str(robots), "--launch", file, "--yes", "-o", "-"]) == 2
    said = capsys.readouterr().err
    assert len(said.splitlines()) == 1 and "a fleet has none of up.launch.py: driver, " in said
    assert "descriptions it loads is not known: package 'gone' is not installed here" in said


def test_its_own_description_that_cannot_be_read_is_one_line(robots: Path, capsys: Any) -> None:
    """The command for another one keeps the launch file."""
    (file,) = write(robots / "rover/launch", {"up": READS.format("other", "example.urdf.xacro")})
    assert main(["init", str(robots), "--launch", file, "--yes", "-o", "-"]) == 2
    said = capsys.readouterr().err
    assert len(said.splitlines()) == 1 and "package 'gone' is not found" in said


def test_what_a_launch_file_starts_is_named_where_its_description_cannot_be_read(
    robots: Path, capsys: Any
) -> None:
    """In the one line: processes, and what of it could not be read."""
    spawner = (
        "Node(package='controller_manager', executable='spawner', arguments=['left', 'right'])"
    )
    fails = (
        "OpaqueFunction(function=lambda _: [Node(package=open('/x').read(), executable='hidden')])"
    )
    actions = f"{READS.format('other', 'example.urdf.xacro')}; {DRIVER}; {spawner}; {fails}"
    (file,) = write(robots / "other/launch", {"up": actions})
    assert main(["init", str(robots), "--yes", "--launch", file, "-o", str(robots / "f.yaml")]) == 2
    (said,) = capsys.readouterr().err.splitlines()
    for word in (
        ": robot_state_publisher, driver, ",
        "spawner left right, ",
        " hidden",
    ):
        assert word in said
    assert not (robots / "f.yaml").exists()


def test_a_launch_file_that_cannot_be_read_says_what_its_text_starts(
    robots: Path, capsys: Any
) -> None:
    (file,) = write(robots / "other/launch", {"up": f"{DRIVER}; 1 / 0"})
    assert main(["init", str(robots), "--yes", "--launch", file, "-o", str(robots / "f.yaml")]) == 2
    (said,) = capsys.readouterr().err.splitlines()
    assert "ZeroDivisionError" in said and "by its text it starts driver" in said


TYPED = """<robot name="rover" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:arg name="kind" default=""/>
<xacro:include filename="$(arg kind).xacro"/><link name="base_link"/><link name="wheel"/>
<joint name="j" type="continuous"><parent link="base_link"/><child link="wheel"/></joint></robot>"""


@pytest.mark.parametrize("named", [True, False])
def test_a_description_that_needs_a_value_has_that_of_a_launch_file(
    named: bool, package: Path
) -> None:
    """By its own default it does not expand."""
    (package / "urdf/rover.urdf.xacro").write_text(TYPED)
    (package / "urdf/big.xacro").write_text('<robot xmlns:xacro="x"/>')
    write(package / "launch", {"up": f"{LOADED.replace('use_sim:={}', 'kind:=big')}; {DRIVER}"})
    words = ["--launch", str(package / "launch/up.launch.py")] if named else []
    assert fleet_of(package, "--simulator", "none", *words)["arguments"] == {"kind": "big"}


def test_a_question_about_files_keeps_the_launch_file(robots: Path, capsys: Any) -> None:
    """The launch file says nothing of the description, and the answer is about this launch file."""
    (file,) = write(robots / "rover/launch", {"one's own": f"{PUBLISHER}; {DRIVER}"})
    (robots / "other/urdf/example.urdf.xacro").unlink()
    shutil.rmtree(robots / "rover/dolly")
    shutil.rmtree(robots / "rover/cart")
    words = ["init", str(robots), "--launch", file, "sim:=true", "--yes", "--simulator", "none"]
    assert main([*words, "-o", "-"]) == 2
    said = capsys.readouterr().err
    command = shlex.split(said.strip().rpartition("name one: multibot ")[2])
    assert "2 descriptions are as likely to be the robot" in said
    out = robots / "fleet.yaml"
    assert main([*command, "--yes", "--simulator", "none", "-o", str(out)]) == 0
    fleet = yaml.safe_load(out.read_text())
    assert fleet["launch"] == "'rover/launch/one'\"'\"'s own.launch.py' sim:=true"


def test_of_several_robots_the_launch_file_that_starts_most_says_which(robots: Path) -> None:
    write(robots / "rover/launch", {"up": f"{SPAWNS.format('dolly')}; {DRIVER}"})
    (file,) = write(
        robots / "rover/launch", {"more": f"{SPAWNS.format('cart')}; {DRIVER}; {LIDAR}"}
    )
    out = robots / "fleet.yaml"
    for name in ("cart", "dolly"):
        assert main(["init", str(robots), "--yes", "--force", "-o", str(out)]) == 0
        assert yaml.safe_load(out.read_text())["description"] == f"rover/{name}/model.sdf"
        # A trial is behind.
        file = str(Path(file).rename(Path(file).with_name("demo.launch.py")))


def test_many_launch_files_that_cannot_be_read_are_one_line(package: Path, capsys: Any) -> None:
    """Why of each is said where it is asked for; a path has blanks."""
    write(package / "launch", {"up it": f"{PUBLISHER}; {DRIVER}"})
    for at in range(5):
        (package / f"launch/bad{at}.launch.py").write_text(f"raise ValueError('no{at}')\n")
    assert fleet_of(package)["launch"] == "'rover/launch/up it.launch.py'"
    text = (package.parent / "fleet.yaml").read_text()
    said = (
        "# 5 launch files could not be read: rover/launch/bad0.launch.py and 4 more; init --verbose"
    )
    assert said in text and "no3" not in text
    assert "no3" not in capsys.readouterr().err
    up = str(package / "launch/up it.launch.py")
    words = ["init", str(package), "-o", str(package.parent / "fleet.yaml"), "--force", "--yes"]
    assert main([*words, "--verbose"]) == 0
    why = capsys.readouterr().err
    assert all(f"bad{at}.launch.py:1: ValueError: no{at}" in why for at in range(5))
    # The one that is named is the only one that counts.
    assert main([*words, "--verbose", "--launch", up]) == 0
    assert "no3" not in capsys.readouterr().err
    fleet = yaml.safe_load((package.parent / "fleet.yaml").read_text())
    assert fleet["launch"] == "'rover/launch/up it.launch.py'"


def test_what_the_launch_file_asks_of_the_machine_is_named(package: Path) -> None:
    (path,) = write(package / "launch", {"up": f"{PUBLISHER}; {DRIVER}"})
    head, _, body = Path(path).read_text().partition("\n")
    Path(path).write_text(f"{head}\nimport os; PORTS = os.listdir('/dev')\n{body}")
    fleet_of(package, "--launch", path)
    text = (package.parent / "fleet.yaml").read_text()
    assert "#   rover/launch/up.launch.py:1: it looks at /dev of the machine" in text


def test_a_launch_file_that_is_taken_is_not_read_again_to_be_tried(
    package: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each reading starts a process: one for all launch files, one for those that may be it."""
    write(package / "launch", {"up": f"{PUBLISHER}; {DRIVER}", "other": DRIVER})
    started: list[int] = []
    popen = child.subprocess.Popen

    def counted(*words: Any, **options: Any) -> Any:
        started.append(1)
        return popen(*words, **options)

    monkeypatch.setattr(child.subprocess, "Popen", counted)
    file = package.parent / "fleet.yaml"
    assert main(["init", str(package), "--yes", "-q", "--force", "-o", str(file)]) == 0
    assert yaml.safe_load(file.read_text())["launch"] == "rover/launch/up.launch.py"
    assert len(started) == 2


SPACED = """\
<robot name="rover"><link name="base_link"/><link name="lidar"/>
<joint name="mount" type="fixed"><parent link="base_link"/><child link="lidar"/></joint>
<gazebo reference="lidar"><sensor name="lidar" type="gpu_lidar"><topic>{}scan</topic></sensor></gazebo>
</robot>
"""
ROW = (
    "- {ros_topic_name: scan, gz_topic_name: <inside>scan, gz_type_name: gz.msgs.LaserScan, "
    "ros_type_name: sensor_msgs/msg/LaserScan, direction: GZ_TO_ROS}\n"
)
IN_SPACE = """
def up(context):
    space = SPACE
    bridge = ReplaceString(PATH_OF('bridge.yaml'), {'<inside>': 'INSIDE'})
    slam = RewrittenYaml(PATH_OF('slam.yaml'), {}, root_key=space)
    text = open(PATH_OF('rover.urdf')).read()
    return [GroupAction([
        PushRosNamespace(space),
        Node(package='robot_state_publisher', executable='robot_state_publisher',
             parameters=[{'robot_description': text, 'frame_prefix': space + '/'}]),
        Node(package='ros_gz_sim', executable='create', arguments=['-topic', 'robot_description']),
        Node(package='ros_gz_bridge', executable='parameter_bridge', name='bridge',
             parameters=[{'config_file': bridge}]),
        Node(package='slam_toolbox', executable='async_slam_toolbox_node', name='slam_toolbox',
             parameters=[slam]),
    ])]
"""


@pytest.mark.parametrize(
    ("space", "argument", "inside"),
    [
        ("LaunchConfiguration('namespace').perform(context)", "namespace:={robot}", ""),
        ("'tb'", "", "tb/"),
    ],
)
def test_a_bringup_in_a_namespace_of_its_own(
    space: str, argument: str, inside: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Its argument gets each robot's name; the files that it makes of others are as it makes them."""
    folder = tmp_path / "rover"
    folder.mkdir()
    made = {
        "package.xml": "<package><name>rover</name></package>",
        "rover.urdf": SPACED.format(inside),
        "bridge.yaml": ROW,
        "slam.yaml": "slam_toolbox:\n  ros__parameters: {odom_frame: odom, scan_topic: scan}\n",
        "up.launch.py": IMPORTS.replace("; ", "\n")
        + "\nfrom nav2_common.launch import ReplaceString, RewrittenYaml\nimport os"
        + "\nPATH_OF = lambda it: os.path.join(os.path.dirname(__file__), it)\n"
        + IN_SPACE.replace("SPACE", space).replace("INSIDE", inside)
        + "\ndef generate_launch_description():\n    return LaunchDescription([\n"
        + "        DeclareLaunchArgument('namespace', default_value='tb'),\n"
        + "        OpaqueFunction(function=up)])\n",
    }
    for name, text in made.items():
        (folder / name).write_text(text)
    fleet = tmp_path / "fleet.yaml"
    assert main(["init", str(folder), "-o", str(fleet), "--distro", "jazzy", "--yes"]) == 0
    assert main(["build", str(fleet), "-o", str(tmp_path / "out")]) == 0
    said = capsys.readouterr().err
    assert not [it for it in ("does not build", "config_file", "MB244", "MB879") if it in said]
    assert yaml.safe_load(fleet.read_text())["launch"] == shlex.join(
        filter(None, ("rover/up.launch.py", argument))
    )
    for robot in ("robot1", "robot2"):
        (row, *_) = yaml.safe_load((tmp_path / "out" / robot / "bridge.yaml").read_text())
        assert row["ros_topic_name"] == row["gz_topic_name"] == f"/{robot}/{inside}scan"
        sections = str(yaml.safe_load((tmp_path / "out" / robot / "slam.yaml").read_text()))
        above = f"'/{robot}/tb': {{'slam_toolbox'" if inside else f"'/{robot}/slam_toolbox'"
        assert above in sections
