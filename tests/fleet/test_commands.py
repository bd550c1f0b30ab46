# SPDX-License-Identifier: Apache-2.0
"""``commands.md``: the lines that load each robot's controllers, and what is written beside them."""

from __future__ import annotations

import shlex
from pathlib import Path

import pytest
from paths import ROBOTS

from multibot_rewrite import load_fleet
from multibot_rewrite.planning.plan import read_plan

FLEET = """\
distro: {release}
layout: tf-per-robot
node_sets: gz_ros2_control
robots:
  - {{name: robot1, description: {robot}}}
  - {{name: robot2, description: {robot}}}
"""


def outputs(folder: Path, release: str) -> dict[str, str]:
    file = folder / "fleet.yaml"
    file.write_text(FLEET.format(release=release, robot=ROBOTS / "rover_gz.urdf"))
    return {path: it.data.decode() for path, it in load_fleet(file).files.items()}


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("release", "rules"),
    [
        ("humble", []),
        ("jazzy", ["--controller-ros-args", "-r /tf:=tf"]),
        ("lyrical", ["--controller-ros-args", "-r /tf:=tf"]),
    ],
)
def test_each_controller_of_each_robot_has_its_line(
    release: str, rules: list[str], tmp_path: Path
) -> None:
    rows = outputs(tmp_path, release)["commands.md"].splitlines()
    lines = [shlex.split(it, comments=True) for it in rows if " spawner " in it]
    spawner = ["ros2", "run", "controller_manager", "spawner"]
    for robot in ("robot1", "robot2"):
        placed = ["--ros-args", "-r", f"__ns:=/{robot}"]
        assert [*spawner, "diff_drive_controller", *rules, *placed] in lines
        assert [*spawner, "joint_state_broadcaster", *placed] in lines
    assert len(lines) == 8
    assert any(it.endswith("  # only where you start it") for it in rows)


MASS = """\
<link name="tool">
  <inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
</link>
<joint name="mount" type="fixed"><parent link="base_link"/><child link="tool"/></joint>
"""
HARDWARE = """\
<ros2_control name="arm" type="system">
  <hardware><plugin>acme_driver/Arm</plugin></hardware>
</ros2_control>
"""


@pytest.mark.parametrize(
    ("said", "inside", "spawned", "told"),
    [
        ("", "", False, True),
        ("", MASS, True, False),
        ("", HARDWARE, False, True),
        ("", f"{MASS}{HARDWARE}", False, False),
        ("simulator: gazebo\n", f"{MASS}{HARDWARE}", True, False),
        ("simulator: none\n", "", False, False),
        ("simulator: none\n", MASS, False, False),
    ],
)
def test_the_fleet_file_says_whether_a_robot_is_spawned_or_its_description_does(
    said: str, inside: str, spawned: bool, told: bool, tmp_path: Path
) -> None:
    """Gazebo spawns nothing of a robot without mass, and one that nobody simulates has a driver."""
    (tmp_path / "arm.urdf").write_text(
        f'<robot name="arm"><link name="base_link"/>{inside}</robot>'
    )
    (tmp_path / "fleet.yaml").write_text(f"{said}robots: [{{name: r1, description: arm.urdf}}]\n")
    made = load_fleet(tmp_path / "fleet.yaml").made
    text = next(it for it in made.files if it.path == "fleet.launch.py").data.decode()
    assert ("executable='create'" in text) == spawned
    notes = [it for it in made.findings if it.code == "MF828"]
    assert ["'r1' has no mass" in it.message for it in notes] == [True] * told


MODEL = """\
structure:
  nodes:
    /one: {pkg: controller_manager, exec: spawner, args: [drive, --inactive, -p, drive.yaml]}
    /two: {pkg: controller_manager, exec: spawner, args: [joint_state_broadcaster]}
    /controller_manager: {pkg: controller_manager, exec: ros2_control_node}
"""
OWN_TYPE = "drive:\n  ros__parameters: {type: diff_drive_controller/DiffDriveController}\n"


def test_controllers_are_spawned_as_the_launch_file_does(tmp_path: Path) -> None:
    (tmp_path / "arm.urdf").write_text('<robot name="arm"><link name="base_link"/></robot>')
    (tmp_path / "model.yaml").write_text(MODEL)
    (tmp_path / "drive.yaml").write_text(OWN_TYPE)
    (tmp_path / "fleet.yaml").write_text(
        "layout: tf-per-robot\nlaunch: model.yaml\nrobots: [{name: robot1, description: arm.urdf}]\n"
    )
    rows = load_fleet(tmp_path / "fleet.yaml").files["commands.md"].data.decode().splitlines()
    lines = {it.split()[4]: it for it in rows if " spawner " in it}
    assert "spawner drive " in lines["drive"]
    assert " --param-file robot1/drive.yaml --inactive --ros-args " in lines["drive"]
    assert not {"--param-file", "--inactive"} & set(lines["joint_state_broadcaster"].split())


@pytest.mark.slow
@pytest.mark.parametrize(("told", "wanted"), [("true", "true"), ("false", "false"), ("", "")])
def test_all_nodes_have_the_clock_of_the_fleet_file(told: str, wanted: str, tmp_path: Path) -> None:
    robot = ROBOTS / "rover_gz.urdf"
    key = f"use_sim_time: {told}\n" if told else ""
    text = (
        f"{key}layout: tf-per-robot\nnode_sets: robot_state\nrobots:\n"
        f"  - {{name: robot1, description: {robot}, pose: {{x: 1.0}}}}\n"
        f"  - {{name: robot2, description: {robot}, use_sim_time: true}}\n"
    )
    (tmp_path / "fleet.yaml").write_text(text)
    fleet = load_fleet(tmp_path / "fleet.yaml")
    of_robots, _, windows = fleet.text("commands.md").partition("## RViz")
    # A window has the clock of all robots, if they have one.
    assert windows.count(" -p use_sim_time:=true\n") == windows.count("rviz2 -d") * (told == "true")
    first, second = of_robots.split("## robot2")
    lines = [it for it in first.splitlines() if "teleop" in it or "static_transform" in it]
    assert lines
    clocks = [it.rpartition(" -p use_sim_time:=")[2] if " -p use" in it else "" for it in lines]
    assert clocks == [wanted] * len(lines)
    assert second.count("-p use_sim_time:=true") == 1
    plan = read_plan(fleet.text("plan.yaml").encode(), "plan.yaml")
    planned = {it.node: (it.name, it.value) for it in plan.parameters}
    own = planned.get("/robot1/robot_state_publisher", ())
    assert own == (("use_sim_time", wanted) if wanted else ())
    assert planned["/robot2/robot_state_publisher"] == ("use_sim_time", "true")
    # The plugins have the simulator's.
    assert not [it for it in planned if it.endswith("controller_manager")]
    node = fleet.robot("robot1").node("robot_state_publisher")
    assert node["parameters"] == ([{"use_sim_time": wanted == "true"}] if wanted else [])
    assert fleet.robot("robot2").node("robot_state_publisher")["parameters"] == [
        {"use_sim_time": True}
    ]


@pytest.mark.more
@pytest.mark.parametrize("own", [False, True])
def test_a_twist_mux_that_no_file_tells_its_topics_gets_those_of_its_package(
    own: bool, tmp_path: Path
) -> None:
    """twist_mux.cpp subscribes to what ``topics`` has, and to nothing else (twist_mux_topics.yaml)."""
    (tmp_path / "mux.yaml").write_text(
        "twist_mux:\n  ros__parameters:\n    topics:\n"
        "      pad: {topic: joy_vel, timeout: 0.5, priority: 1}\n"
        "      keys: {topic: key_vel, timeout: 0.5, priority: 2}\n"
    )
    text = f"description: {ROBOTS / 'rover.urdf'}\nlayout: both\nnode_sets: teleop\n"
    text += "robots: [{name: robot1}, {name: robot2}]\n"
    text += "related_files: {params: mux.yaml}\n" if own else ""
    (tmp_path / "fleet.yaml").write_text(text)
    made = load_fleet(tmp_path / "fleet.yaml")
    launch = made.text("fleet.launch.py")
    # Locks as well: a file with the node's section and without locks has none.
    assert ("robot1/pause_navigation" in made.text("plan.yaml")) is not own
    assert ("'topics.joystick.topic': 'joy_vel'" in launch.replace('"', "'")) is not own


@pytest.mark.more
@pytest.mark.parametrize(
    ("layout", "name", "static"),
    [
        ("tf-per-robot", "platform", "/platform/tf_static"), ("tf-per-robot", "tf", "/tf/tf_static"),
        ("both", "tf_bot", "/tf_bot/tf_static"), ("postfix", "platform", "/tf_static/platform"),
        ("postfix", "tf", "/tf_static/tf"),
    ],
)  # fmt: skip
def test_a_robot_may_have_tf_in_its_name(
    layout: str, name: str, static: str, tmp_path: Path
) -> None:
    (tmp_path / "fleet.yaml").write_text(
        f"layout: {layout}\ndescription: {ROBOTS / 'rover.urdf'}\n"
        f"robots: [{{name: {name}}}, {{name: other, pose: {{x: 3}}}}]\n"
    )
    rows = load_fleet(tmp_path / "fleet.yaml").files["commands.md"].data.decode().splitlines()
    (line,) = (it for it in rows if it.startswith(f"rviz2 -d {name}/"))
    assert f" -r /tf_static:={static}" in line
