# SPDX-License-Identifier: Apache-2.0
"""``multibot init``: from descriptions and folders to a fleet file that builds."""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path
from typing import Any

import closed_robot
import pytest
import yaml
from paths import ROBOTS, ROOT

from multibot_rewrite.base.rosnames import check_robot_names
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.fleet.file.fleet_data import FleetText
from multibot_rewrite.proposal import trying
from multibot_rewrite.proposal.propose import names_of

TOOL = '<robot name="tool" xmlns:xacro="http://www.ros.org/wiki/xacro"/>'


def init(*words: object) -> int:
    return main(["init", *map(str, words)])


def made(folder: Path, *words: object, code: int = 0) -> Mapping[str, Any]:
    """Return the fleet file for these words, which also builds."""
    file = folder / "fleet.yaml"
    assert init(*words, "-o", file) == code
    found = yaml.safe_load(file.read_text())
    assert isinstance(found, dict)
    if code == 0:
        assert main(["build", str(file), "-o", str(folder / "out"), "-q"]) == 0
    return found


@pytest.mark.slow
def test_so_many_robots_apart_from_each_other(tmp_path: Path) -> None:
    shutil.copy(ROBOTS / "rover.urdf", tmp_path)
    fleet = made(tmp_path, tmp_path, "-n", 4, "--layout", "L4", "--distro", "jazzy")
    assert fleet["layout"] == "postfix"
    assert fleet["distro"] == "jazzy"
    places = [it["pose"]["y"] for it in fleet["robots"]]
    assert len(places) == 4
    assert all(b - a >= 0.5 for a, b in pairwise(places))


@pytest.mark.slow
def test_files_of_another_robot_of_the_package_are_its_own(tmp_path: Path) -> None:
    """A package with examples: each has a robot and files beside it; what is above them is for all."""
    (tmp_path / "package.xml").write_text("<package><name>many</name></package>")
    for name in ("left", "right"):
        (tmp_path / name / "config").mkdir(parents=True)
        shutil.copy(ROBOTS / "rover.urdf", tmp_path / name / f"{name}.urdf")
        section = f"{name}_node: {{ros__parameters: {{rate: 1}}}}\n"
        (tmp_path / name / "config" / f"{name}.yaml").write_text(section)
    (tmp_path / "config").mkdir()
    (tmp_path / "config" / "all.yaml").write_text("every_node: {ros__parameters: {rate: 1}}\n")
    fleet = made(tmp_path, tmp_path / "left" / "left.urdf")
    assert set(fleet["related_files"]["params"]) == {"config/all.yaml", "left/config/left.yaml"}


@pytest.mark.more
@pytest.mark.sample(2)
@pytest.mark.parametrize(
    "name", ["launch_tutorial/rover.urdf", "two_robots_postfix/scout.urdf.xacro"]
)
def test_a_robot_of_the_examples_has_the_files_of_its_folder(name: str, tmp_path: Path) -> None:
    fleet = made(tmp_path, ROOT / "examples" / name)
    files = [
        it
        for its in fleet["related_files"].values()
        for it in ([its] if isinstance(its, str) else its)
    ]
    assert files and all(f"examples/{Path(name).parent}/" in it for it in files)
    assert "srdf" not in fleet and "node_sets" not in fleet


@pytest.mark.more
def test_ros2_control_and_a_real_robot(tmp_path: Path) -> None:
    shutil.copy(ROBOTS / "rover_gz.urdf", tmp_path)
    assert made(tmp_path, tmp_path)["node_sets"] == ["gz_ros2_control"]


@pytest.mark.slow
def test_a_fault_of_the_files_is_told_and_changes_no_choice(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """No other layout mends it, and without its file the robot is another one."""
    for name, text in closed_robot.FILES.items():
        if not name.startswith(("fleet", "nodes", "moveit")):
            (tmp_path / name).write_text(
                text.replace("enable_odom_tf: false", "publish_rate: 50.0")
            )
    made(tmp_path, tmp_path, code=1)
    said, text = capsys.readouterr().err, (tmp_path / "fleet.yaml").read_text()
    assert "It does not build yet: MG408 several nodes send " in said
    assert "does not work for" not in text and "not taken" not in text


@pytest.mark.more
def test_different_robots_have_names_of_their_own(tmp_path: Path) -> None:
    for name in ("rover.urdf", "two_finger_arm.urdf"):
        shutil.copy(ROBOTS / name, tmp_path)
    fleet = made(tmp_path, tmp_path / "rover.urdf", tmp_path / "two_finger_arm.urdf", "-n", 1)
    robots = {it["name"]: it["description"] for it in fleet["robots"]}
    assert robots == {"rover1": "rover.urdf", "two_finger_arm1": "two_finger_arm.urdf"}


@pytest.mark.parametrize(
    "models", [("mp_400", "mp_500"), ("a - b", "c__d"), ("Bücker", "400"), ("ö", "_")]
)
def test_names_made_of_any_models_are_names_of_robots(models: tuple[str, str]) -> None:
    assert check_robot_names(sum(names_of(models, 2), ()))


@pytest.mark.more
def test_a_layout_that_does_not_work_is_replaced(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def errors(source: FleetText, *_: object) -> list[tuple[str, str]]:
        return [] if "\nlayout: both\n" in source.text else [("", "MG320 they would meet")]

    monkeypatch.setattr(trying, "errors_of", errors)
    shutil.copy(ROBOTS / "rover.urdf", tmp_path)
    fleet = made(tmp_path, tmp_path / "rover.urdf")
    assert fleet["layout"] == "both"
    why = "# Layout frames-per-robot does not work for these files: MG320 they would meet"
    assert why in (tmp_path / "fleet.yaml").read_text()


@pytest.mark.more
@pytest.mark.parametrize(
    "plugin", ["", '<gazebo><plugin filename="libgz_x.so" name="a"/></gazebo>']
)
def test_a_real_arm_on_the_world_gets_a_world_of_its_own(plugin: str, tmp_path: Path) -> None:
    """It is real if that is said, whatever its description has for a simulator."""
    world = '<robot name="r"><link name="world"/><link name="a"/><joint name="j" type="fixed">'
    world += f'<parent link="world"/><child link="a"/></joint>{plugin}</robot>'
    (tmp_path / "r.urdf").write_text(world)
    fleet = made(tmp_path, tmp_path / "r.urdf", "--simulator", "none")
    assert fleet["shared_frames"] == ["map"], "each real robot stands on a world of its own"


def test_an_error_names_the_file_and_no_line_of_the_proposal(tmp_path: Path) -> None:
    rover = str(ROBOTS / "rover.urdf")
    lacking = str(tmp_path / "nav.yaml")
    fleet = {
        "description": rover,
        "robots": [{"name": "a"}],
        "related_files": {"params": [lacking]},
    }
    assert trying.errors_of(fleet) == [("", f"{lacking} does not exist; correct the path")]


def test_what_does_not_build_is_written_with_the_reason(tmp_path: Path, capsys: Any) -> None:
    (tmp_path / "r.urdf").write_text(
        '<robot name="r"><link name="a"/><link name="a_robot1"/></robot>'
    )
    made(tmp_path, tmp_path / "r.urdf", code=1)
    said = capsys.readouterr().err
    assert "It does not build yet" in said
    assert "# It does not build yet" in (tmp_path / "fleet.yaml").read_text()


@pytest.mark.slow
def test_a_file_that_does_not_go_with_the_robot_is_left_out(tmp_path: Path) -> None:
    """A config of ROS 1 would stop the build."""
    shutil.copy(ROBOTS / "rover.urdf", tmp_path)
    (tmp_path / "old.rviz").write_text("Visualization Manager:\n  Class: ''\n  Displays: []\n")
    (tmp_path / "a.yaml").write_text("/**:\n  ros__parameters: {rate: 1}\n")
    old = "Visualization Manager:\n  Displays:\n    - Class: rviz/Grid\n"
    (tmp_path / "old.rviz").write_text(old)
    fleet = made(tmp_path, tmp_path)
    assert "rviz" not in fleet.get("related_files", {})
    assert "#   old.rviz: this is a ROS 1 config" in (tmp_path / "fleet.yaml").read_text()


@pytest.mark.more
def test_another_description_is_taken_where_the_first_does_not_build(tmp_path: Path) -> None:
    """``a.urdf`` would come first: its path is shorter."""
    text = '<robot name="r"><link name="a"/><link name="a_robot1"/></robot>'
    (tmp_path / "a.urdf").write_text(text)
    joint = '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint></robot>'
    whole = text.replace("a_robot1", "b").replace("</robot>", joint)
    (tmp_path / "other.urdf").write_text(whole)
    fleet = made(tmp_path, tmp_path)
    assert fleet["description"] == "other.urdf"


def launched(folder: Path, actions: str) -> None:
    """Write a launch file of some actions."""
    names = ("launch", "launch.actions", "launch.substitutions", "launch_ros.actions")
    lines = [f"from {it} import *" for it in names]
    made = f"LaunchDescription([{actions}])".replace("FOLDER", str(folder))
    text = "\n".join((*lines, f"def generate_launch_description(): return {made}"))
    (folder / "r.launch.py").write_text(text)


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize(
    "launch",
    [
        "DeclareLaunchArgument('kind', default_value='small')",
        "DeclareLaunchArgument(\n'other', default_value='x'), DeclareLaunchArgument(\n"
        "    'kind', description='it', choices=['small', 'large'])",
        "Node(package='robot_state_publisher', executable='robot_state_publisher', parameters=["
        "{'robot_description': Command(['xacro FOLDER/r.urdf.xacro kind:=',"
        " LaunchConfiguration('kind', default='small')])}])",
    ],
)
def test_what_a_xacro_needs_is_as_its_launch_file_has_it(launch: str, tmp_path: Path) -> None:
    (tmp_path / "r.urdf.xacro").write_text(
        TOOL.replace("/>", '><link name="$(arg kind)"/></robot>')
    )
    launched(tmp_path, launch)
    fleet = made(tmp_path, tmp_path)
    assert fleet["arguments"] == {"kind": "small"}
    assert "# It needs kind; init chose a value" in (tmp_path / "fleet.yaml").read_text()


@pytest.mark.more
def test_a_default_that_is_no_value_is_chosen(tmp_path: Path) -> None:
    """As ``ur_type`` of Universal Robots, whose default is the name of no robot."""
    body = '<xacro:arg name="kind" default="none"/><xacro:include filename="$(arg kind).xacro"/>'
    robot = TOOL.replace("/>", f'>{body}<link name="a"/></robot>')
    (tmp_path / "r.urdf.xacro").write_text(robot)
    (tmp_path / "small.xacro").write_text(TOOL)
    launched(tmp_path, "DeclareLaunchArgument('kind', choices=['small'])")
    assert made(tmp_path, tmp_path)["arguments"] == {"kind": "small"}


@pytest.mark.slow
def test_classic_is_of_humble_and_its_plugin_has_the_manager(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As TurtleBot 4: a ros2_control_node beside the plugin would be a second manager."""
    monkeypatch.delenv("ROS_DISTRO", raising=False)
    text = (ROBOTS / "rover_gz.urdf").read_text()
    at, end = text.index("<gazebo>"), text.rindex("</gazebo>") + len("</gazebo>")
    plugin = '<gazebo><plugin name="gazebo_ros2_control" filename="libgazebo_ros2_control.so">'
    plugin += "<ros><namespace></namespace><remapping>/tf:=tf</remapping></ros>"
    plugin += "<parameters>c.yaml</parameters></plugin></gazebo>"
    text = text[:at] + plugin + text[end:]
    text = text.replace("gz_ros2_control/GazeboSimSystem", "gazebo_ros2_control/GazeboSystem")
    (tmp_path / "rover.urdf").write_text(text)
    fleet = made(tmp_path, tmp_path / "rover.urdf")
    assert fleet["node_sets"] == ["gazebo_ros2_control"]
    assert fleet["distro"] == "humble"
    assert fleet["layout"] == "tf-per-robot", "its plugin sends tf on a topic of each robot"
    assert "ros2_control_node" not in (tmp_path / "out" / "fleet.launch.py").read_text()
    assert "gz_ros_control" not in (tmp_path / "out" / "plan.yaml").read_text()


@pytest.mark.more
def test_the_hardware_of_the_real_robot_needs_no_manager_in_a_simulator(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As Andino: Classic's own plugin drives it, so controllers would wait for a manager for ever."""
    monkeypatch.delenv("ROS_DISTRO", raising=False)
    text = (ROBOTS / "rover_gz.urdf").read_text()
    at, end = text.index("<gazebo>"), text.rindex("</gazebo>") + len("</gazebo>")
    drive = '<gazebo><plugin name="drive" filename="libgazebo_ros_diff_drive.so"/></gazebo>'
    (tmp_path / "rover.urdf").write_text(text[:at] + drive + text[end:])
    assert "<ros2_control" in text
    (tmp_path / "control.yaml").write_text(
        "controller_manager:\n  ros__parameters:\n    update_rate: 50\n"
        "    joint_state_broadcaster: {type: joint_state_broadcaster/JointStateBroadcaster}\n"
    )
    fleet = made(tmp_path, tmp_path)
    assert "gazebo_ros2_control" not in fleet.get("node_sets", [])
    assert "ros2_control_node" not in (tmp_path / "out" / "fleet.launch.py").read_text()


@pytest.mark.slow
def test_names_of_the_robots_are_given(tmp_path: Path, capsys: Any) -> None:
    shutil.copy(ROBOTS / "rover.urdf", tmp_path)
    fleet = made(tmp_path, tmp_path, "--robots", "scout,carrier")
    assert [it["name"] for it in fleet["robots"]] == ["scout", "carrier"]
    two = (tmp_path / "rover.urdf", ROBOTS / "two_finger_arm.urdf")
    assert init(*two, "--robots", "a,b", "-o", "-") == 2
    assert "--robots is for one description" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["{there}"], "is there already; name another with -o"),
        (["nowhere", "-o", "-"], "there is no such file or folder; give a description or a folder"),
        (["kap", "-o", "-"], "there is no such file or folder; did you mean src/kap?"),
        (["{folder}/empty", "-o", "-"], "/empty: no description of a robot is there"),
        (["{folder}/notes.yaml", "-o", "-"], "/notes.yaml: no description of a robot is there"),
        (["{folder}/bad.urdf", "-o", "-"], "bad.urdf"),
        (["{folder}/part.xacro", "-o", "-"], "it has no link; give the file that has the robot"),
        (["{folder}/need.xacro", "-o", "-"], "give it as size:=VALUE"),
        (["-n", "0"], "a fleet has at least one robot"),
        (["--robots", "a,a"], "'a' is given twice"),
        (["--robots", "1bad"], "1bad"),
        (["--robots", "a,b", "-n", "3"], "give one of them"),
        (["--layout", "L9"], "--layout"),
    ],
)
def test_mistakes_are_one_line(words: list[str], says: str, here: Path, capsys: Any) -> None:
    (here / "empty").mkdir()
    (here / "src" / "kap").mkdir(parents=True)
    (here / "src" / "kap" / "package.xml").write_text("<package><name>kap</name></package>")
    (here / "notes.yaml").write_text("a: 1\n")
    (here / "bad.urdf").write_text("<robot")
    (here / "part.xacro").write_text(TOOL)
    (here / "need.xacro").write_text(TOOL.replace("/>", '><link name="$(arg size)"/></robot>'))
    there = here / "fleet.yaml"
    there.write_text("mine")
    given = [it.format(folder=here, there=ROBOTS / "rover.urdf") for it in words]
    more = [] if "-o" in given else ["-o", str(there)]
    try:
        code = init(*given, *more)
    except SystemExit as end:
        code = int(str(end.code))
    said = capsys.readouterr().err
    assert code == 2
    assert says in said
    assert len(said.splitlines()) == 1
    assert there.read_text() == "mine"


CRANE = """\
<robot name="crane">
  <link name="mast"/><link name="crane_hook"/><link name="crane_rope"/><link name="mast_top"/>
  <joint name="lift_joint" type="prismatic"><parent link="mast"/><child link="crane_hook"/>
    <limit lower="0" upper="1" effort="1" velocity="1"/></joint>
  <link name="hook"/><link name="map"/><link name="odom"/>
  <joint name="hook_joint" type="fixed"><parent link="crane_hook"/><child link="hook"/></joint>
  <joint name="map_joint" type="fixed"><parent link="mast"/><child link="map"/></joint>
  <joint name="odom_joint" type="fixed"><parent link="mast"/><child link="odom"/></joint>
  <joint name="rope_joint" type="fixed"><parent link="mast"/><child link="crane_rope"/></joint>
  <joint name="top_joint" type="fixed"><parent link="mast"/><child link="mast_top"/></joint>
</robot>
"""


@pytest.fixture
def yard(tmp_path: Path) -> Path:
    """Return a rover and a crane in one folder, with files for each in another one."""
    (tmp_path / "package.xml").write_text("<package><name>yard</name></package>")
    (tmp_path / "urdf").mkdir()
    (tmp_path / "config").mkdir()
    shutil.copy(ROBOTS / "rover.urdf", tmp_path / "urdf")
    (tmp_path / "urdf" / "crane.urdf").write_text(CRANE)
    return tmp_path


@pytest.mark.more
def test_a_part_of_another_robot_is_known_as_a_key_too(yard: Path) -> None:
    """``crane_hook`` is nothing but a part; ``hook`` and ``mast`` may be words of any node."""
    assert params_of(yard, some={"crane_hook": 1, "lift_joint": 2, "mast_top": 3}) == []


def params_of(yard: Path, **values: object) -> list[str]:
    """Which of these files, a section with these values each, go with the rover."""
    for name, value in values.items():
        text = yaml.safe_dump({f"{name}_node": {"ros__parameters": {"it": value}}})
        (yard / "config" / f"{name}.yaml").write_text(text)
    taken = made(yard, yard / "urdf" / "rover.urdf").get("related_files", {}).get("params", [])
    return [Path(it).stem for it in taken]


@pytest.mark.more
def test_files_that_name_joints_of_another_robot_are_its_own(yard: Path) -> None:
    rover, crane = ["lidar_link", "imu_link"], ["lift_joint", "crane_hook"]
    assert params_of(yard, wheels=rover, hook=crane) == ["wheels"]
    text = (yard / "fleet.yaml").read_text()
    assert "#   config/hook.yaml: it is for crane.urdf, which has crane_hook, lift_joint" in text


@pytest.mark.slow
@pytest.mark.sample(3)
@pytest.mark.parametrize(
    "named",
    [
        # What a copied file names, or names of all robots; a word that is a name, as a key.
        ["lift_joint"], ["map", "odom", "world"], {"mast": 1, "hook": 2}, 5,
        # A robot of both parts has more than the rover: the rover's part is the rover's.
        ["lidar_link", "imu_link", "crane_hook", "lift_joint", "mast_top", "crane_rope"],
    ],
)  # fmt: skip
def test_files_that_are_not_surely_of_another_robot_stay(yard: Path, named: object) -> None:
    assert params_of(yard, some=named) == ["some"]


@pytest.mark.more
def test_files_of_moveit_go_with_the_nearest_srdf(yard: Path) -> None:
    shutil.copy(ROBOTS / "rover.srdf", yard / "urdf")
    (yard / "crane_config").mkdir()
    group = '<group name="lift"><joint name="lift_joint"/></group>'
    (yard / "crane_config" / "crane.srdf").write_text(f'<robot name="crane">{group}</robot>')
    limits = "joint_limits: {lift_joint: {has_velocity_limits: true, max_velocity: 1.0}}\n"
    (yard / "crane_config" / "joint_limits.yaml").write_text(limits)
    fleet = made(yard, yard / "urdf" / "rover.urdf")
    assert (fleet["srdf"], fleet.get("related_files", {})) == ("urdf/rover.srdf", {})


@pytest.mark.more
def test_a_house_is_not_the_robot_of_a_folder(tmp_path: Path) -> None:
    walls = "".join(f'<link name="wall_{at}"/>' for at in range(3))
    (tmp_path / "a.sdf").write_text(f'<sdf version="1.9"><model name="a">{walls}</model></sdf>')
    (tmp_path / "the_crane.urdf").write_text(CRANE)
    assert made(tmp_path, tmp_path)["description"] == "the_crane.urdf"


STEERED = """\
<robot name="car">
  <link name="base_link">MASS</link><link name="rear">MASS</link><link name="front">MASS</link>
  <joint name="drive" type="continuous"><parent link="base_link"/><child link="rear"/></joint>
  <joint name="steer" type="continuous"><parent link="base_link"/><child link="front"/></joint>
  <ros2_control name="car" type="system">
    <hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>
    <joint name="drive"><command_interface name="velocity"/><state_interface name="velocity"/></joint>
    <joint name="steer"><command_interface name="position"/><state_interface name="position"/></joint>
  </ros2_control>
  <gazebo><plugin filename="gz_ros2_control-system" name="gz_ros2_control::GazeboSimROS2ControlPlugin">
    <parameters>control.yaml</parameters>
  </plugin></gazebo>
</robot>
"""
MASS = """\
<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>"""
STEERING = """\
controller_manager:
  ros__parameters:
    bicycle_steering_controller: {type: bicycle_steering_controller/BicycleSteeringController}
bicycle_steering_controller:
  ros__parameters: {rear_wheels_names: [drive], front_wheels_names: [steer], front_steering: true}
"""


def steered(folder: Path, rule: str = "") -> dict[str, Any]:
    """Return a fleet of two cars on Humble; ``rule`` is in the tag of the plugin."""
    tag = f"<ros><remapping>{rule}</remapping></ros></plugin>" if rule else "</plugin>"
    text = STEERED.replace("</parameters>\n  </plugin>", f"</parameters>\n  {tag}").replace(
        "MASS", MASS
    )
    (folder / "car.urdf").write_text(text)
    (folder / "control.yaml").write_text(STEERING)
    return {
        "layout": "tf-per-robot",
        "distro": "humble",
        "simulator": "gazebo",
        "node_sets": "gz_ros2_control",
        "description": str(folder / "car.urdf"),
        "related_files": {"params": [str(folder / "control.yaml")]},
        "robots": [{"name": "robot1"}, {"name": "robot2"}],
    }


# ros2_controllers 2.54.0 steering_controllers_library.cpp: tf goes to ~/tf_odometry. On Humble a
# controller in Gazebo has the rules of the process alone, which the plugin's tag sets.
def test_the_reason_names_the_node_and_what_to_do_once_for_all_robots(tmp_path: Path) -> None:
    said = (
        "/robot1/bicycle_steering_controller: MG102 should publish topic /robot1/tf, but does not; the "
        "same for robot2 (it publishes /robot1/bicycle_steering_controller/tf_odometry instead: the "
        "remap rule ~/tf_odometry:=tf is not applied; pass it in the description: "
        "<remapping>~/tf_odometry:=tf</remapping> in <ros> of the plugin of "
        "/robot1/controller_manager)"
    )
    assert [it for _, it in trying.errors_of(steered(tmp_path))] == [said]


def test_a_controller_that_a_vendor_spawns_has_no_rule_that_he_has_not(tmp_path: Path) -> None:
    """He has no odometry on tf for one robot either: that is no reason to refuse two."""
    (tmp_path / "go.launch.py").write_text(
        "from launch import LaunchDescription\nfrom launch_ros.actions import Node\n"
        "def generate_launch_description():\n    return LaunchDescription([Node(\n"
        "        package='controller_manager', executable='spawner',\n"
        "        arguments=['bicycle_steering_controller'])])\n"
    )
    fleet = steered(tmp_path) | {"launch": str(tmp_path / "go.launch.py")}
    assert [it for _, it in trying.errors_of(fleet) if "MG102" in it] == []
