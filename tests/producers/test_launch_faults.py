# SPDX-License-Identifier: Apache-2.0
"""Faults planted in a healthy fleet of two in Gazebo, and what check-launch says of them.

Expectations: what the programs do with it, by their sources (the rules name them).
"""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import NamedTuple

import pytest
from paths import ROOT

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.producers.launch import source_packages

LAUNCH, BRIDGE = "fleet.launch.py", "robot2/bridge.yaml"
ROVER, WORLD = "robot2/rover.urdf", "world.sdf"
# What is given to robot2 alone.
SYSTEM = '<plugin filename="gz-sim-{}-system" name="gz::sim::systems::{}"'


class Fault(NamedTuple):
    """A text of a built file that is changed, the code of the finding and the file that it is in."""

    file: str
    old: str
    new: str
    code: str
    place: str = LAUNCH
    level: str = "error"


def for_two(old: str, new: str) -> tuple[str, str]:
    """Return a text of the function, for robot2 another one."""
    return old, f"{new} if name == 'robot2' else {old}"


pytestmark = pytest.mark.more
FAULTS = {
    "the other robot's description": Fault(
        LAUNCH, *for_two("text(f'{name}/rover.urdf')", "text('robot1/rover.urdf')"), "MG703"
    ),
    "spawned from the other's topic": Fault(
        LAUNCH,
        *for_two("f'/{name}/robot_description'", "'/robot1/robot_description'"),
        "MG703",
    ),
    "one model name": Fault(LAUNCH, "'-name', name,", "'-name', 'robot1',", "MG701"),
    "one place": Fault(LAUNCH, "'robot2', x=3.0", "'robot2', x=1.0", "MG702"),
    "all at the origin": Fault(LAUNCH, "'-x', str(x),", "'-x', '0',", "MG702", level="warning"),
    "commands the wrong way": Fault(BRIDGE, "ROS_TO_GZ", "GZ_TO_ROS", "MG704"),
    "a row of another type": Fault(BRIDGE, "gz.msgs.Twist", "gz.msgs.Pose", "MB879", BRIDGE),
    "types that are not converted": Fault(
        BRIDGE, "gz.msgs.LaserScan", "gz.msgs.IMU", "MB874", BRIDGE
    ),
    "a scan that nothing sends": Fault(BRIDGE, '"/robot2/scan"', '"/robot2/scn"', "MB879", BRIDGE),
    "commands into the other robot": Fault(
        BRIDGE, 'gz_topic_name: "/robot2/cmd_vel"', 'gz_topic_name: "/robot1/cmd_vel"', "MG705"
    ),
    "commands of no robot": Fault(
        BRIDGE, 'ros_topic_name: "/robot2/cmd_vel"', 'ros_topic_name: "/cmd_vel"', "MG705"
    ),
    "a bridge file that is lost": Fault(
        LAUNCH, *for_two("file(f'{name}/bridge.yaml')", "file('robot2/bridges.yaml')"), "MG713"
    ),
    "a namespace twice": Fault(
        LAUNCH, *for_two("f'/{name}/robot_description'", "'/robot2/robot2/robot_description'"), "MG724"
    ),
    "a description that is a path": Fault(
        LAUNCH, *for_two("text(f'{name}/rover.urdf')", "file(f'{name}/rover.urdf')"), "MG729"
    ),
    "no description": Fault(
        LAUNCH, "{'robot_description': text(f'{name}/rover.urdf')},",
        "*([] if name == 'robot2' else [{'robot_description': text(f'{name}/rover.urdf')}]),", "MG729",
    ),
    "a name with a dash": Fault(LAUNCH, "name='start_pose'", "name='start-pose'", "MG729"),
    "a pose that is a word": Fault(LAUNCH, "'-x', str(x)", "'-x', 'near'", "MG729"),
    "a spawner that is misspelt": Fault(LAUNCH, "executable='create'", "executable='creat'", "MG714"),
    "odometry that only the other robot has": Fault(
        BRIDGE, 'ros_topic_name: "/robot2/odom"\n  gz_topic_name: "/robot2/odom"',
        'ros_topic_name: "/elsewhere"\n  gz_topic_name: "/elsewhere"', "MG707",
    ),
    "a quaternion of zeros": Fault(
        LAUNCH, "'--roll', '0.0',\n                '--pitch', '0.0',\n                '--yaw', '0.0',",
        "'--qx', '0', '--qy', '0', '--qz', '0', '--qw', '0',", "MG711",
    ),
    "a direction that no bridge has": Fault(BRIDGE, "ROS_TO_GZ", "ROS_TO_GAZEBO", "MB855", BRIDGE),
    "an angle in degrees": Fault(LAUNCH, "'--yaw', '0.0'", "'--yaw', '90'", "MG711"),
    "a frame above itself": Fault(LAUNCH, "f'{name}/odom'", "'map'", "MG711"),
    "a program that is misspelt": Fault(
        LAUNCH, "executable='robot_state_publisher'", "executable='robot_state_publish'", "MG714"
    ),
    "a launch that ends": Fault(LAUNCH, "/rover.urdf'", "/rover.xml'", "MG721"),
    "a rule that matches nothing": Fault(
        LAUNCH, "name='joint_state_publisher',",
        "name='joint_state_publisher', remappings=[('joint_stats', 'a')],", "MR103",
        level="warning",
    ),
    "a parameter that is misspelt": Fault(
        LAUNCH, "{'robot_description'", "{'frame_prefixx': 'a', 'robot_description'", "MB110",
        level="warning",
    ),
    "no time": Fault(
        LAUNCH, "name='joint_state_publisher',\n            parameters=[CLOCK]",
        "name='joint_state_publisher',\n            parameters=[CLOCK] if name == 'robot1' else []",
        "MG514", level="warning",
    ),
    "odometry of the other robot": Fault(
        ROVER, "robot2/odom</frame_id>", "robot1/odom</frame_id>", "MG414"
    ),
    "a wheel without mass": Fault(ROVER, '<mass value="0.5"/>', '<mass value="0"/>', "MB603", ROVER),
    "a mass below nothing": Fault(
        ROVER, '<mass value="0.5"/>', '<mass value="-0.5"/>', "MB125", ROVER
    ),
    "a robot without mass": Fault(ROVER, "<mass value=", "<mass kg=", "MB115", ROVER),
    "a joint of the other robot": Fault(
        ROVER, "<left_joint>robot2", "<left_joint>robot1", "MB211", ROVER
    ),
    "what is left of a xacro": Fault(
        ROVER, 'link name="robot2/base_link"', 'link name="${ns}base_link"', "MB202", ROVER
    ),
    "joints that only the other robot has": Fault(
        LAUNCH, "executable='joint_state_publisher',",
        "executable='joint_state_publisher', "
        "condition=IfCondition('false' if name == 'robot2' else 'true'),", "MG316",
    ),
    "a model that nobody describes": Fault(
        LAUNCH, "executable='robot_state_publisher',",
        "executable='robot_state_publisher', "
        "condition=IfCondition('false' if name == 'robot2' else 'true'),", "MG724",
    ),
    "a start in a frame that is misspelt": Fault(
        LAUNCH, *for_two("f'{name}/odom'", "'robot2/odm'"), "MG406"
    ),
    "a package that is misspelt": Fault(
        LAUNCH, "package='ros_gz_sim',\n", "package='ros_gz_simm',\n", "MG714", level="note"
    ),
    "a type that is misspelt": Fault(
        BRIDGE, "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/LaserScn", "MB874", BRIDGE
    ),
    "an argument of an include that is misspelt": Fault(
        LAUNCH, "launch_arguments=[", "launch_arguments=[('gz_argss', 'x'), ", "MG715",
        level="warning",
    ),
    "a world without sensors": Fault(
        WORLD, SYSTEM.format("sensors", "Sensors"), SYSTEM.format("label", "Label"), "MG706"
    ),
    "a world that spawns nothing": Fault(
        WORLD, SYSTEM.format("user-commands", "UserCommands"), SYSTEM.format("label", "Label"), "MG706"
    ),
    "a world without physics": Fault(
        WORLD, SYSTEM.format("physics", "Physics"), SYSTEM.format("label", "Label"), "MG706"
    ),
}  # fmt: skip


@pytest.fixture(scope="module")
def healthy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("healthy") / "out"
    fleet = ROOT / "examples" / "launch_tutorial" / "fleet.yaml"
    assert main(["build", str(fleet), "-o", str(out), "-q"]) == 0
    return out


def found_in(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> tuple[int, list[dict[str, object]]]:
    code = main(["check-launch", str(folder / LAUNCH), "--format", "json"])
    return code, json.loads(capsys.readouterr().out)["findings"]


def test_the_healthy_fleet_has_none(healthy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    capsys.readouterr()
    assert found_in(healthy, capsys) == (0, [])


def test_an_include_of_the_simulator_takes_all_that_its_launch_files_declare(
    healthy: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """ros_gz_sim gz_sim.launch.py of Humble and later."""
    folder, words = tmp_path / "out", ("gz_version", "ign_version", "debugger", "on_exit_shutdown")
    shutil.copytree(healthy, folder)
    text, old = (folder / LAUNCH).read_text(), "launch_arguments=["
    more = "".join(f"('{it}', 'false'), " for it in words)
    (folder / LAUNCH).write_text(text.replace(old, old + more))
    capsys.readouterr()
    assert old in text and found_in(folder, capsys) == (0, [])


@pytest.mark.sample(12)
@pytest.mark.parametrize("name", FAULTS)
def test_a_planted_fault_is_found_at_its_place(
    name: str, healthy: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    it, folder = FAULTS[name], tmp_path / "out"
    shutil.copytree(healthy, folder)
    text = (folder / it.file).read_text()
    assert it.old in text
    (folder / it.file).write_text(text.replace(it.old, it.new))
    capsys.readouterr()
    code, found = found_in(folder, capsys)
    own = [one for one in found if one["code"] == it.code]
    assert own, found
    assert {one["level"] for one in own} == {it.level}
    assert all(str(one["file"]).endswith(it.place) and one["line"] for one in own)
    # Of a package that nobody knows it is not known what it starts.
    assert code == {"error": 1, "warning": 0, "note": 3}[it.level]


def test_two_launch_files_are_one_system(
    healthy: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The clock of a launch file may be in another one."""
    (tmp_path / "robot.launch.py").write_text(ONE.format(NODE))
    (tmp_path / "clock.launch.py").write_text(ONE.format(CLOCK))
    files = [str(tmp_path / it) for it in ("robot.launch.py", "clock.launch.py")]
    assert main(["check-launch", files[0]]) == 1
    assert "MG501" in capsys.readouterr().out
    assert main(["check-launch", *files]) == 0


ONE = """\
from launch import LaunchDescription
from launch_ros.actions import Node
def generate_launch_description():
    return LaunchDescription([{}])
"""
NODE = "Node(package='robot_state_publisher', executable='robot_state_publisher', \
namespace='robot1', parameters=[{'use_sim_time': True, 'robot_description': \
'<robot name=\"r\"><link name=\"a\"/></robot>'}])"
CLOCK = "Node(package='ros_gz_bridge', executable='parameter_bridge', \
arguments=['/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock'])"


SPAWN = """\
from pathlib import Path
from launch import LaunchDescription
from launch_ros.actions import Node
def one(name, x):
    file = str(Path(__file__).parent / f"{name}.urdf")
    return Node(package="ros_gz_sim", executable="create",
                arguments=["-name", name, "-file", file, "-x", x])
def generate_launch_description():
    return LaunchDescription([one("r1", "1"), one("r2", "3")])
"""
ROBOT = """<robot name="{}"><link name="a"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0"
iyy="1" iyz="0" izz="1"/></inertial></link><gazebo>{}</gazebo></robot>"""


@pytest.mark.parametrize("loading", [(), ("r2",), ("r1", "r2")])
def test_a_system_of_the_world_in_two_models(
    loading: tuple[str, ...], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """gz-sim makes one for each (SystemManager.cc): two of Sensors end it, one is as it should be."""
    plugin = SYSTEM.format("sensors", "Sensors") + "/>"
    for name in ("r1", "r2"):
        text = ROBOT.format(name, plugin if name in loading else "")
        (tmp_path / f"{name}.urdf").write_text(text)
    (tmp_path / LAUNCH).write_text(SPAWN)
    _, found = found_in(tmp_path, capsys)
    assert any(it["code"] == "MB416" for it in found) is (len(loading) > 1)


@pytest.mark.parametrize("bridged", ["pose", "tf"])
def test_what_another_kind_of_robot_sends_need_not_be_bridged(
    bridged: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """multirobotplayground/Jazzy-Multi-Robot-Sandbox: the poses of a drone, and a base's tf, which a
    node of its own sends; of two bases both are brought."""
    drive, poses = (
        SYSTEM.format("diff-drive", "DiffDrive"),
        SYSTEM.format("pose-publisher", "PosePublisher"),
    )
    last = drive if bridged == "tf" else poses
    (tmp_path / "r1.urdf").write_text(ROBOT.format("r1", f"{drive}/>"))
    (tmp_path / "r2.urdf").write_text(
        ROBOT.format("r2", f"{last}><publish_link_pose>true</publish_link_pose></plugin>")
    )
    row = f"/model/r2/{bridged}@tf2_msgs/msg/TFMessage[gz.msgs.Pose_V"
    bridge = f'Node(package="ros_gz_bridge", executable="parameter_bridge", arguments=["{row}"])'
    (tmp_path / LAUNCH).write_text(SPAWN.replace('one("r2", "3")', f'one("r2", "3"), {bridge}'))
    _, found = found_in(tmp_path, capsys)
    assert ("/model/r1/tf" in str([it for it in found if it["code"] == "MG707"])) is (
        bridged == "tf"
    )


STATE = """\
from launch import LaunchDescription
from launch.substitutions import Command
from launch_ros.actions import Node
def generate_launch_description():
    return LaunchDescription([Node(package="robot_state_publisher",
        executable="robot_state_publisher", parameters=[{}])])
"""


@pytest.mark.parametrize(
    ("given", "wrong"),
    [
        ("{'rate': 5}", True),
        ("{'robot_description': Command(['made_by_a_program ', 'x'])}", False),
        ("{'robot_description': Command(['xacro ', '/nowhere.xacro'])}", False),
        # ECUST-Origin-Sentry-Team/gazebo_simulator_origin: a Python package that is not here makes it.
        ("{'robot_description': __import__('made_elsewhere').Macro().to_string()}", False),
        ("{'robot_description': {'xml': __import__('made_elsewhere').MACRO}}", True),
        ("{'rate': __import__('made_elsewhere').rate()}", True),
        ("__import__('made_elsewhere').builder().to_dict()", False),
        ("dict(**__import__('made_elsewhere').VALUES)", False),
        ("{'robot_description': '<robot name=\"r\"><link name=\"a\"/></robot>'}", False),
        ("{'robot_description': '/opt/r.urdf'}", True),
        ("'/opt/not/here.yaml'", False),
    ],
)
def test_a_state_publisher_without_a_description(
    given: str, wrong: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """What only a run tells is no fault."""
    (tmp_path / LAUNCH).write_text(
        STATE.format(given) if "{}" not in given else STATE.replace("[{}]", f"[{given}]")
    )
    _, found = found_in(tmp_path, capsys)
    assert any(it["code"] == "MG729" for it in found) is wrong


CLOCKS = """\
from launch import LaunchDescription
from launch.substitutions import Command
from launch_ros.actions import Node
def generate_launch_description():
    return LaunchDescription([
        Node(package="nav2_amcl", executable="amcl", namespace="r1", name="amcl",
             parameters=[{"use_sim_time": True}]),
        Node(package="nav2_map_server", executable="map_server", namespace="r1", name="map_server",
             parameters=[{"use_sim_time": GIVEN}]),
        Node(package="ros_gz_bridge", executable="parameter_bridge", namespace="r1", name="mine",
             arguments=["/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock"]),
    ])
"""


@pytest.mark.parametrize(
    ("given", "differs"),
    [
        ("True", False),
        ("False", True),
        ("__import__('made_elsewhere').time", False),
        ("Command(['which_time'])", False),
    ],
)
def test_a_time_that_only_a_run_tells_differs_from_none(
    given: str, differs: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Nor does the bridge, which stamps nothing."""
    (tmp_path / LAUNCH).write_text(CLOCKS.replace("GIVEN", given))
    _, found = found_in(tmp_path, capsys)
    assert any(it["code"] in ("MG503", "MG514") for it in found) is differs


def of_nodes(folder: Path, *nodes: str, head: str = "") -> None:
    lines = "".join(f"        {it},\n" for it in nodes)
    text = "from launch import LaunchDescription\nfrom launch_ros.actions import Node\n" + head
    text += "def generate_launch_description():\n    return LaunchDescription([\n"
    (folder / LAUNCH).write_text(f"{text}{lines}    ])\n")


def test_a_variable_that_is_not_set_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("TURTLEBOT3_MODEL", raising=False)
    of_nodes(tmp_path, head="import os\nMODEL = os.environ['TURTLEBOT3_MODEL']\n")
    assert main(["check-launch", str(tmp_path / LAUNCH)]) == 2
    said = "the environment variable TURTLEBOT3_MODEL is not set here; set it as for ros2 launch"
    assert said in capsys.readouterr().err
    of_nodes(tmp_path, head="import os\nMODEL = {}['TURTLEBOT3_MODEL']\n")
    main(["check-launch", str(tmp_path / LAUNCH)])
    assert "environment variable" not in capsys.readouterr().err


def test_a_file_that_is_lost_is_found_behind_the_error_of_launch(tmp_path: Path) -> None:
    lost = tmp_path / source_packages.NOT_INSTALLED / "share" / "acme" / "a.yaml"
    outer = RuntimeError("Caught exception when trying to load file of format [py]")
    outer.__cause__ = FileNotFoundError(2, "No such file", str(lost))
    assert source_packages.add_file(outer, str(tmp_path))
    assert lost.read_bytes() == b""
    assert not source_packages.add_file(RuntimeError("other"), str(tmp_path))


_HEAD = """\
from pathlib import Path
from launch.actions import *
from launch.substitutions import LaunchConfiguration
HERE = Path(__file__).parent
"""
_CHILD = """\
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
def late(context):
    name = LaunchConfiguration("robot").perform(context)
    return [Node(package="nav2_amcl", executable="amcl", name="amcl", namespace=name)]
def generate_launch_description():
    return LaunchDescription([CONTENT])
"""
_NEEDS = _CHILD.replace("CONTENT", 'DeclareLaunchArgument("robot"), OpaqueFunction(function=late)')
_LATE = _CHILD.replace("CONTENT", "OpaqueFunction(function=late)")
_INCLUDE = 'IncludeLaunchDescription(str(HERE / "child.launch.py"){})'
_GIVEN = ', launch_arguments=[("robot", "r1")]'
_GZ = 'IncludeLaunchDescription("/opt/share/ros_gz_sim/launch/gz_sim.launch.py", launch_arguments=[{}])'
_STATE = (
    'Node(package="robot_state_publisher", executable="robot_state_publisher", namespace="{0}", '
    'remappings=[("/tf", "tf"), ("/tf_static", "tf_static")], parameters=[{{"robot_description": '
    "\"<robot name='r'><link name='a'/><link name='b'/><joint name='j' type='fixed'><parent link='a'/>"
    "<child link='b'/></joint></robot>\"}}])"
)
_STATIC = (
    'Node(package="tf2_ros", executable="static_transform_publisher", {}arguments=["--frame-id", '
    '"r1/map", "--child-frame-id", "r1/odom"])'
)
_SLAM = (
    'Node(package="slam_toolbox", executable="async_slam_toolbox_node", name="slam_toolbox", '
    'parameters=[{{"resolution": 0.05, "{}": 0.1}}])'
)
_TIMED = (
    'Node(package="nav2_map_server", executable="map_server", name="map_server", '
    'parameters=[{"use_sim_time": True}])'
)
_MIXED = (
    *(
        f'Node(package="nav2_{it}", executable="{program}", namespace="r1", name="{program}", '
        f'parameters=[{{"use_sim_time": {timed}}}])'
        for it, program, timed in (("amcl", "amcl", True), ("map_server", "map_server", False))
    ),
    'Node(package="ros_gz_bridge", executable="parameter_bridge", '
    'arguments=["/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock"])',
)
_ROW = 'Node(package="ros_gz_bridge", executable="parameter_bridge", arguments=["{}"])'
_RVIZ, _POSES = (
    'Node(package="rviz2", executable="rviz2")',
    "@tf2_msgs/msg/TFMessage[gz.msgs.Pose_V",
)
_DRIVER = 'Node(package="acme", executable="driver", name="driver")'
_GAZEBO = 'ExecuteProcess(cmd=["gzserver", {}"-s", "libgazebo_ros_factory.so"])'
_AMCL = (
    'Node(package="nav2_amcl", executable="amcl", name="amcl", namespace="r1", '
    'remappings=[("/tf", "tf"), ("/tf_static", "tf_static")])'
)
_CLOCK = "/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock"
_GROUP = f"GroupAction([{_DRIVER}], condition={{}})"
_SPAWN = 'Node(package="ros_gz_sim", executable="create", arguments=["-file", {}])'
_R = "\"<robot name='r'><link name='a'/></robot>\""
_SPAWN_BY = _SPAWN.replace('arguments=["-file", {}]', "parameters=[{}]")
_SPAWN_AS = _SPAWN.replace('"-file", {}', f'"{{}}", "--string", {_R}')
_TURNED = _STATIC.replace(
    '"r1/odom"', '"r1/odom", "--qx", "0", "--qy", "{}", "--qz", "0", "--qw", "0"'
)
_TURNED = _TURNED.replace("{}arg", "arg")
_BASE = _STATE.format("r1").replace("'a'", "'base_link'")
# The code, whether it is found, a child that is included, and what the file starts.
SEEN: dict[str, tuple[str, bool, str, tuple[str, ...]]] = {
    # launch jazzy include_launch_description.py, declare_launch_argument.py, launch_configuration.py
    "without what it has to be given": ("MG721", True, _NEEDS, (_INCLUDE.format(""),)),
    "with it": ("MG721", False, _NEEDS, (_INCLUDE.format(_GIVEN),)),
    "late, and not given": ("MG721", True, _LATE, (_INCLUDE.format(""),)),
    "late, and given": ("MG721", False, _LATE, (_INCLUDE.format(_GIVEN),)),
    "late, and set before": (
        *("MG721", False, _LATE),
        ('DeclareLaunchArgument("robot", default_value="r1")', _INCLUDE.format("")),
    ),
    # launch rolling normalize_to_list_of_substitutions_impl.py: a path is a text since humble 1.0.14,
    # jazzy 3.4.10 and kilted 3.8.7; a number is none.
    "a path": ("MG721", False, "", (_GZ.format('("gz_args", ["-r ", HERE])'),)),
    "a number": ("MG721", True, "", (_GZ.format('("gz_args", ["-r ", 5])'),)),
    "its text": ("MG721", False, "", (_GZ.format('("gz_args", ["-r ", str(HERE)])'),)),
    # ros_gz jazzy gz_sim.launch.py.in has six arguments.
    "no argument": ("MG715", True, "", (_GZ.format('("render_engine", "ogre2")'),)),
    "an argument": ("MG715", False, "", (_GZ.format('("on_exit_shutdown", "true")'),)),
    "a tree beside": ("MG405", True, "", (_STATE.format("r1"), _STATIC.format(""))),
    "a tree of its own": (
        *("MG405", False, ""),
        (_STATE.format("r1"), _STATIC.format('remappings=[("/tf_static", "/r1/tf_static")], ')),
    ),
    # totwjfakd/multi_robot_sim: poses of the world, from which a node of its own makes tf.
    "what is not called tf": ("MG405", False, "", (_RVIZ, _ROW.format("/world_poses" + _POSES))),
    "tf of a robot": ("MG405", True, "", (_RVIZ, _ROW.format("/r1/tf" + _POSES))),
    "one tree": ("MG405", False, "", (_STATIC.format(""),)),
    # slam_toolbox jazzy src/*.cpp
    "a parameter that it has not": ("MB111", True, "", (_SLAM.format("position_threshold"),)),
    "a parameter that it has": ("MB111", False, "", (_SLAM.format("minimum_time_interval"),)),
    # ros_gz_bridge jazzy parameter_bridge.cpp prints its usage, and ends.
    "a row without a type of Gazebo": (
        *("MG729", True, ""),
        (_ROW.format("/odom@nav_msgs/msg/Odometry"),),
    ),
    "a row": ("MG729", False, "", (_ROW.format("/odom@nav_msgs/msg/Odometry[gz.msgs.Odometry"),)),
    "a service": ("MG729", False, "", (_ROW.format("/w/c@ros_gz_interfaces/srv/ControlWorld"),)),
    "types that no bridge converts": (
        *("MB874", True, ""),
        (_ROW.format("/odom@nav_msgs/msg/Odometry[gz.msgs.IMU"),),
    ),
    "a type of Gazebo that is misspelt": (
        *("MB874", True, ""),
        (_ROW.format("/odom@nav_msgs/msg/Odometry[gz.msgs.Odometri"),),
    ),
    # ros_gz_sim jazzy create.cpp reads its words by gflags.
    "one name, by two dashes": ("MG701", True, "", (_SPAWN_AS.format("--name=a"),) * 2),
    "one name, by parameters": (
        *("MG701", True, ""),
        (_SPAWN_BY.format('{"name": "a", "string": ' + _R + "}"),) * 2,
    ),
    "one name, of the description": ("MG701", True, "", (_SPAWN_AS.format("--z=0"),) * 2),
    # All four of a quaternion count.
    "half a turn": ("MG711", False, "", (_TURNED.format(1),)),
    "no turn": ("MG711", True, "", (_TURNED.format(0),)),
    "two names, by two dashes": (
        *("MG701", False, ""),
        (_SPAWN_AS.format("--name=a"), _SPAWN_AS.format("--name=b")),
    ),
    # gazebo_ros src/gazebo_ros_init.cpp has the clock.
    "no plugin with the clock": ("MG501", True, "", (_TIMED, _GAZEBO.format(""))),
    # clearpath_simulator clearpath_gz/launch/robot_spawn.launch.py: one has ended before.
    "one name after the other": (
        *("MG301", False, ""),
        (_DRIVER[:-1] + ', on_exit=[Node(package="acme", executable="two", name="driver")])',),
    ),
    "one name at once": ("MG301", True, "", (_DRIVER, _DRIVER.replace('"acme"', '"other"'))),
    # Deamon-l/jaka_zu3_ros2_gazebo: the other one bridges no clock.
    "a clock of one of two bridges": (
        *("MG502", False, ""),
        (_ROW.format(_CLOCK), _ROW.format("/i@sensor_msgs/msg/CameraInfo[gz.msgs.CameraInfo")),
    ),
    "a clock of both": ("MG502", True, "", (_ROW.format(_CLOCK), _ROW.format(_CLOCK))),
    # launch jazzy action.py: Ast4r/Ros2_Navigation.
    "a condition that is none": (
        *("MG721", True, ""),
        ('SetLaunchConfiguration("a", "1")', _GROUP.format('LaunchConfiguration("a")')),
    ),
    "a condition that is a text": ("MG721", True, "", (_GROUP.format('"true"'),)),
    "no condition": ("MG721", False, "", (_GROUP.format("None"),)),
    # mokh94519/new_mobile_manipulator: xacro of the launch itself writes it.
    "what a program may write": ("MG713", False, "", (_SPAWN.format('"/tmp/not_made_yet.urdf"'),)),
    "what nobody installs": ("MG713", True, "", (_SPAWN.format('str(HERE / "lost.urdf")'),)),
    "no odometry": ("MG406", True, "", (_AMCL, _BASE, _SPAWN_AS.format("--z=0"))),
    "no odometry of a real robot": ("MG406", False, "", (_AMCL, _BASE)),
    "no odometry, beside a driver": ("MG406", False, "", (_AMCL, _BASE, _DRIVER)),
    # Nothing that is not known changes what a parameter says.
    "a time of its own, beside what is not known": ("MG503", True, "", (*_MIXED, _DRIVER)),
    "the plugin with the clock": (
        *("MG501", False, ""),
        (_TIMED, _GAZEBO.format('"-s", "libgazebo_ros_init.so", ')),
    ),
}


@pytest.mark.sample(4)
@pytest.mark.parametrize("name", SEEN)
def test_what_public_bringups_showed(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code, wrong, child, actions = SEEN[name]
    if child:
        (tmp_path / "child.launch.py").write_text(child)
    of_nodes(tmp_path, *actions, head=_HEAD)
    _, found = found_in(tmp_path, capsys)
    told = [it for it in found if it["code"] == code and it["level"] in ("error", "warning")]
    assert bool(told) is wrong, found


def test_a_file_that_includes_itself_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    of_nodes(tmp_path, "IncludeLaunchDescription(__file__)", head=_HEAD)
    assert main(["check-launch", str(tmp_path / LAUNCH)]) == 2
    assert "it includes or calls itself without an end" in capsys.readouterr().err


def test_a_link_to_itself_in_the_folder_is_passed_over(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "loop.yaml").symlink_to("loop.yaml")
    of_nodes(tmp_path, _AMCL, _BASE, head=_HEAD)
    assert main(["check-launch", str(tmp_path / LAUNCH)]) == 0
    assert "cannot be read" not in capsys.readouterr().err


def test_a_file_says_what_it_has_to_be_given(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """An argument, or a launch configuration; given, the file is read."""
    (tmp_path / LAUNCH).write_text(_NEEDS)
    assert main(["check-launch", str(tmp_path / LAUNCH)]) == 2
    said = "it has to be given robot; write robot:=VALUE after it; by its text it starts amcl\n"
    assert said in capsys.readouterr().err
    (tmp_path / LAUNCH).write_text(_LATE)
    assert main(["check-launch", str(tmp_path / LAUNCH)]) == 3
    assert "'robot' is not set; give it with robot:=VALUE" in capsys.readouterr().err
    main(["check-launch", str(tmp_path / LAUNCH), "robot:=r1"])
    assert "is not set" not in capsys.readouterr().err


def test_what_is_not_known_is_in_json_with_its_place(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    of_nodes(tmp_path, _DRIVER, 'SetLaunchConfiguration("a", LaunchConfiguration("b"))', head=_HEAD)
    code, found = found_in(tmp_path, capsys)
    (told,) = (it for it in found if it["code"] == "MF823")
    line = (tmp_path / LAUNCH).read_text().splitlines()[int(str(told["line"])) - 1]
    assert (code, told["level"]) == (3, "inconclusive") and "SetLaunchConfiguration" in line


def test_files_that_a_package_of_sources_lacks(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "package.xml").write_text("<package><name>acme</name></package>")
    head = "from ament_index_python import get_package_share_directory\n" + _HEAD
    bridge = _ROW.replace('arguments=["{}"]', 'parameters=[{"config_file": SHARE + "/a.yaml"}]')
    of_nodes(
        tmp_path,
        'IncludeLaunchDescription(SHARE + "/a.launch.py")',
        bridge,
        head=head + 'SHARE = get_package_share_directory("acme")\n',
    )
    _, found = found_in(tmp_path, capsys)
    told = {str(it["code"]): f"{it['level']} {it['message']}" for it in found}
    for code, name in (("MG721", "a.launch.py"), ("MG713", "a.yaml")):
        assert told[code].startswith("error ") and str(tmp_path / name) in told[code]
