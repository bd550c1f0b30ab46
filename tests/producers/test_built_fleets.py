# SPDX-License-Identifier: Apache-2.0
"""The built launch file of every example: nothing is wrong with what it starts, and all is planned."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from paths import FIXTURES, ROOT
from plans import optional, own

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.planning.plan import read_plan

EXAMPLES = sorted((ROOT / "examples").rglob("fleet*.yaml"))


@pytest.mark.sample(4)
@pytest.mark.slow
@pytest.mark.parametrize("fleet", EXAMPLES, ids=lambda it: f"{it.parent.name}-{it.stem}")
def test_an_example_starts_as_planned(fleet: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert main(["build", str(fleet), "-o", str(out), "-q", "--trust"]) == 0
    launched = ["check-launch", str(out / "fleet.launch.py")]
    assert main(launched) == 0
    assert main([*launched, "--plan", str(out / "plan.yaml")]) == 0


def test_the_examples_are_there() -> None:
    assert len(EXAMPLES) > 7


ROBOTS = "robots: [{name: robot1, pose: {y: 0.0}}, {name: robot2, pose: {y: 3.0}}]"


CONTROLLED = """\
<robot name="arm">
  <link name="base_link">
    <inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
  </link>
  <link name="hand">
    <inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
  </link>
  <joint name="turn" type="continuous"><parent link="base_link"/><child link="hand"/></joint>
  <ros2_control name="arm" type="system">
    <hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>
    <joint name="turn"><command_interface name="position"/><state_interface name="position"/></joint>
  </ros2_control>
  <gazebo><plugin filename="gz_ros2_control-system" name="gz_ros2_control::GazeboSimROS2ControlPlugin">
    <parameters>control.yaml</parameters>
  </plugin></gazebo>
</robot>
"""
CLASSICS = {
    "gz_ros2_control/GazeboSimSystem": "gazebo_ros2_control/GazeboSystem",
    "gz_ros2_control-system": "libgazebo_ros2_control.so",
    "gz_ros2_control::GazeboSimROS2ControlPlugin": "control",
}
CONTROL = """\
controller_manager:
  ros__parameters: {joint_state_broadcaster: {type: joint_state_broadcaster/JointStateBroadcaster}}
"""


# gz_ros2_control_plugin.cpp (jazzy) makes gz_ros_control beside the controller manager.
@pytest.mark.sample(1)
# gazebo_ros2_control_plugin.cpp has a node of the plugin's name beside it.
@pytest.mark.parametrize(
    ("release", "node_set"),
    [
        ("humble", "gz_ros2_control"),
        ("jazzy", "gz_ros2_control"),
        ("lyrical", "gz_ros2_control"),
        ("humble", "gazebo_ros2_control"),
    ],
)
def test_controllers_in_gazebo_start_as_planned(
    release: str, node_set: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    of_classic = CONTROLLED
    for theirs, classic in CLASSICS.items():
        of_classic = of_classic.replace(theirs, classic)
    (tmp_path / "arm.urdf").write_text(CONTROLLED if node_set.startswith("gz") else of_classic)
    (tmp_path / "control.yaml").write_text(CONTROL)
    fleet, out = tmp_path / "fleet.yaml", tmp_path / "out"
    fleet.write_text(
        f"distro: {release}\nlayout: tf-per-robot\nsimulator: gazebo\nnode_sets: {node_set}\n"
        f"description: arm.urdf\nrelated_files: {{params: control.yaml}}\n{ROBOTS}\n"
    )
    assert main(["build", str(fleet), "-o", str(out), "-q"]) == 0
    launched = ["check-launch", str(out / "fleet.launch.py")]
    assert main([*launched, "--plan", str(out / "plan.yaml")]) == 0
    err = capsys.readouterr().err
    assert "multibot: 2 robots, " in err and "; 0 findings: as planned" in err


def rovers(folder: Path, text: str) -> list[str]:
    """Two rovers as a fleet of these lines, and how it is built."""
    fleet = folder / "fleet.yaml"
    rover = f"description: {FIXTURES / 'robots' / 'rover.urdf'}"
    fleet.write_text(f"layout: tf-per-robot\n{rover}\n{ROBOTS}\n{text}\n")
    return ["build", str(fleet), "-o", str(folder / "out"), "-q"]


@pytest.mark.parametrize("simulator", ["gazebo", "none"])
def test_what_sends_the_description_may_be_elsewhere(simulator: str, tmp_path: Path) -> None:
    """A simulated robot is spawned from its file: nothing may send the topic."""
    node_set = "distro: humble\nnode_sets: no_robot_state_publisher"
    assert main(rovers(tmp_path, f"{node_set}\nsimulator: {simulator}")) == 0
    out = tmp_path / "out"
    (launch,) = out.glob("*.launch.py")
    for file in (out / "commands.md", launch):
        text = file.read_text()
        assert "robot_description" not in text
        assert (" -file robot2/rover.urdf " in text) == (simulator == "gazebo" and file != launch)
    spawned = "'-file', file(f'{name}/rover.urdf')"
    assert (spawned in launch.read_text()) == (simulator == "gazebo")
    assert main(["check-launch", str(launch)]) == 0
    # By the plan its frames are in tf: whether something sends them is not known here.
    assert main(["check-launch", str(launch), "--plan", str(out / "plan.yaml")]) == 3


@pytest.mark.parametrize("robot", ["rover.urdf", "rover_gz.urdf"])
@pytest.mark.parametrize("simulator", ["gazebo", "none"])
def test_what_a_robot_has_not_is_not_planned(robot: str, simulator: str, tmp_path: Path) -> None:
    """The node of a plugin that it does not load, a bridge with nothing to bridge; RViz is optional."""
    node_sets = "distro: jazzy\nnode_sets: [gz_ros2_control, bridge_per_robot, rviz_nav2]"
    command = rovers(tmp_path, f"{node_sets}\nsimulator: {simulator}")
    fleet = tmp_path / "fleet.yaml"
    fleet.write_text(fleet.read_text().replace("rover.urdf", robot))
    # The spawner waits for the manager of a plugin that the description does not load.
    asked = [] if robot == "rover_gz.urdf" else ["--ignore", "MG723"]
    if (robot, simulator) == ("rover_gz.urdf", "none"):
        # The hardware of its description is a simulator's.
        asked = ["--ignore", "MF843"]
    assert main(command) == (1 if asked else 0)
    assert main([*command, *asked]) == 0
    out = tmp_path / "out"
    plan = read_plan((out / "plan.yaml").read_bytes(), "plan.yaml")
    runs = robot == "rover_gz.urdf" and simulator == "gazebo"
    names = {f"/robot2/{it}" for it in ("gz_ros_control", "ros_gz_bridge")}
    assert names & {*own(plan, "robot2")} == (names if runs else set())
    assert "/robot2/rviz2" in optional(plan, "robot2")
    launched = ["check-launch", str(out / "fleet.launch.py"), "--plan", str(out / "plan.yaml")]
    assert main([*launched, *asked]) in (0, 3)


def test_what_a_vendors_launch_files_start_is_left_to_them(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """With ``params_style: bringup`` they start Nav2: of its nodes the folder alone proves nothing."""
    example = ROOT / "examples" / "two_robots_nav2" / "fleet.yaml"
    text = example.read_text().replace("../", f"{example.parent.parent}/")
    fleet, out = tmp_path / "fleet.yaml", tmp_path / "out"
    fleet.write_text(f"params_style: bringup\n{text}")
    assert main(["build", str(fleet), "-o", str(out), "-q"]) == 0
    launched = ["check-launch", str(out / "fleet.launch.py"), "--plan", str(out / "plan.yaml")]
    assert main(launched) == 3
    assert "error: MG101" not in capsys.readouterr().out


@pytest.mark.parametrize("affix", ["prefix", "postfix"])
def test_a_built_folder_says_whose_each_name_is(
    affix: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The plan beside the launch file knows the robots that no namespace shows."""
    (tmp_path / "arm.urdf").write_text('<robot name="arm"><link name="base_link"/></robot>')
    fleet = tmp_path / "fleet.yaml"
    head = f"layout: postfix\naffix: {affix}\ndistro: jazzy\ndescription: {tmp_path}/arm.urdf\n"
    fleet.write_text(f"{head}robots: [{{name: left}}, {{name: right}}]\n")
    assert main(["build", str(fleet), "-o", str(tmp_path / "out"), "-q"]) == 0
    assert main(["check-launch", str(tmp_path / "out/fleet.launch.py")]) == 0
    told = capsys.readouterr().err
    assert "2 robots by the plan in its folder: left, right; layout: postfix" in told
    assert "2 robots, 1 node each: all known" in told


BASE = """<link name="base_link">
<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
</link>"""
WHEEL = """<link name="{0}_link">
<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
<joint name="{0}" type="continuous">
<parent link="base_link"/><child link="{0}_link"/><axis xyz="0 1 0"/></joint>"""
LOST_ODOMETRY = f"""<robot name="rover">
{BASE}
{WHEEL.format("l")}{WHEEL.format("r")}
<gazebo><plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
<left_joint>l</left_joint><right_joint>r</right_joint><topic>cmd_vel</topic>
<frame_id>odom</frame_id><child_frame_id>other_base</child_frame_id></plugin></gazebo></robot>"""


@pytest.mark.parametrize(("stack", "level"), [("", "warning"), ("slam_toolbox", "error")])
def test_a_tree_in_pieces_is_one_line_of_one_level(
    stack: str, level: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A drive whose frame the description lacks: an error only where something localizes the robot."""
    (tmp_path / "rover.urdf").write_text(LOST_ODOMETRY)
    fleet, out = tmp_path / "fleet.yaml", tmp_path / "out"
    robot = f"name: one, namespace: x/y, pose: {{x: 1.0}}, stack: [{stack}]"
    fleet.write_text(
        f"distro: jazzy\ndescription: rover.urdf\nlayout: both\nrobots: [{{{robot}}}]\n"
    )
    launched = ["check-launch", str(out / "fleet.launch.py")]
    for command in (
        ["build", str(fleet), "-o", str(out)], launched, [*launched, "--plan", str(out / "plan.yaml")]
    ):  # fmt: skip
        ended = main([*command, "--format", "json"])
        found = json.loads(capsys.readouterr().out)["findings"]
        told = [(it["level"], it["robot"]) for it in found if it["code"] == "MG406"]
        assert (ended, told) == (int(level == "error"), [(level, "one")])
        if level == "error":
            return


REAL = """<robot name="rover"><link name="base_link"/><link name="laser"/>
<joint name="j" type="fixed"><parent link="base_link"/><child link="laser"/></joint></robot>"""
LACKING = "amcl:\n  ros__parameters: {base_frame_id: base_footprint}\n"
OF_NOBODY = "camera:\n  ros__parameters: {fps: 30}\n"


@pytest.mark.parametrize(
    ("node_set", "layout", "params", "codes"),
    [
        # The driver of a real robot sends its odometry.
        ("localization", "tf-per-robot", "", {"MG406 note"}),
        ("localization", "postfix", LACKING, {"MG406 note", "MG413 note"}),
        # Nothing is bridged for real robots.
        ("bridge", "tf-per-robot", "", set()),
        # None of the nodes that the file is for is started.
        ("perception", "postfix", "", set()),
        ("robot_state", "tf-per-robot", OF_NOBODY, set()),
        # Rules for what is switched off.
        ("rtabmap", "postfix", "", {"MG406 note"}),
    ],
)
def test_a_built_folder_of_real_robots_is_called_what_the_build_calls_it(
    node_set: str, layout: str, params: str, codes: set[str],
    tmp_path: Path, capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    """With the plan, too, and each cause in one line."""
    (tmp_path / "rover.urdf").write_text(REAL)
    (tmp_path / "p.yaml").write_text(params)
    fleet, out = tmp_path / "fleet.yaml", tmp_path / "out"
    fleet.write_text(
        f"distro: jazzy\nsimulator: none\nlayout: {layout}\nnode_sets: [{node_set}]\n"
        f"description: rover.urdf\nrobots: [{{name: one}}, {{name: two}}]\n"
        + "related_files: {params: p.yaml}\n"
        * bool(params)
    )
    launched = ["check-launch", str(out / "fleet.launch.py")]
    told = []
    for command in (
        ["build", str(fleet), "-o", str(out)], launched, [*launched, "--plan", str(out / "plan.yaml")]
    ):  # fmt: skip
        assert main([*command, "--format", "json"]) == 0
        found = json.loads(capsys.readouterr().out)["findings"]
        of_launch = [it for it in found if it["code"] not in ("MG316", "MF857", "MF858", "MB853")]
        told.append(of_launch)
    assert [{f"{it['code']} {it['level']}" for it in its} for its in told] == [codes] * 3
    lines = [[it["code"] for it in its if it["code"] == "MG413"] for its in told[1:]]
    assert lines[0] == lines[1]
