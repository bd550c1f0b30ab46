# SPDX-License-Identifier: Apache-2.0
"""``fleet.launch.py``: what it starts, without launch and in the real one."""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from built_launch import FLEETS, TWO, built
from launched_programs import launched
from paths import ROOT, SUPPORT
from told_nodes import nodes_of, words_of

from multibot_rewrite import launch, load_fleet
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.live.rehearsal import graph_of_stubs, isolated_environment, with_substitutes
from multibot_rewrite.planning.plan import read_plan
from multibot_rewrite.producers.launch.performed import Launching, performed
from multibot_rewrite.rules.check import check
from multibot_rewrite.system.records import doubts

LAYOUTS = ("tf-per-robot", "frames-per-robot", "both", "postfix")


def of_python(out: Path) -> list[tuple[Any, ...]]:
    """Return the processes: program, namespace, name, rules, number of files and of own words."""
    (done,) = performed(str(out / "fleet.launch.py"), [Launching({})])
    assert not done.error
    return sorted(
        (
            *(it["package"], it["executable"], it.get("namespace", ""), it.get("name", "")),
            tuple(map(tuple, it.get("remappings", ()))),
            sum(1 for one in it["parameters"] if isinstance(one, str)),
            len(it.get("arguments", ())),
        )
        for it in (action.values for action in done.actions)
        if "executable" in it
    )


@pytest.mark.more
def test_what_two_robots_of_gazebo_classic_are_started_with(tmp_path: Path) -> None:
    out = built(tmp_path, "classic", "tf-per-robot")
    tf = (("/tf", "tf"), ("/tf_static", "tf_static"))
    state = "robot_state_publisher"
    assert of_python(out) == [
        ("gazebo_ros", "spawn_entity.py", "", "", (), 0, 16),
        ("gazebo_ros", "spawn_entity.py", "", "", (), 0, 16),
        (state, state, "/robot1", state, tf, 0, 0),
        (state, state, "/robot2", state, tf, 0, 0),
        ("tf2_ros", "static_transform_publisher", "/robot1", "start_pose", tf[1:], 0, 16),
        ("tf2_ros", "static_transform_publisher", "/robot2", "start_pose", tf[1:], 0, 16),
    ]
    text = (out / "fleet.launch.py").read_text()
    assert "'robot_description': text(f'{name}/rover.urdf')" in text
    assert "FindPackageShare('gazebo_ros')" in text
    assert "ros2 run teleop_twist_keyboard" in text


@pytest.mark.deep
def test_the_nodes_of_nav2_with_their_lifecycle(tmp_path: Path) -> None:
    shutil.copytree(ROOT / "examples" / "namespace_and_prefix", tmp_path / "example")
    fleet, out = tmp_path / "example" / "nav2.yaml", tmp_path / "out"
    assert main(["build", str(fleet), "-o", str(out), "-q"]) == 0
    text = (out / "fleet.launch.py").read_text()
    assert "'node_names': ['map_server', 'amcl']" in text


@pytest.mark.more
@pytest.mark.parametrize(
    ("release", "library"), [("humble", "ignition-gazebo"), ("jazzy", "gz-sim")]
)
def test_the_world_runs_the_sensors_of_the_robots(
    release: str, library: str, tmp_path: Path
) -> None:
    """In Gazebo's empty.sdf neither a lidar nor an IMU sends; a system of a robot is moved there."""
    sensors = "".join(
        f'<sensor name="{it}" type="{it}"/>' for it in ("gpu_lidar", "imu", "altimeter")
    )
    name = f"{library.replace('-', '::')}::systems::Altimeter"
    plugin = f'<plugin filename="{library}-altimeter-system" name="{name}"/>'
    inertia = '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
    links = f'<link name="base_link"><inertial><mass value="1"/>{inertia}</inertial></link>'
    body = f'{links}<gazebo reference="base_link">{sensors}</gazebo><gazebo>{plugin}</gazebo>'
    (tmp_path / "r.urdf").write_text(f'<robot name="r">{body}</robot>')
    (tmp_path / "fleet.yaml").write_text(f"distro: {release}\ndescription: r.urdf\n{TWO}")
    out = tmp_path / "out"
    main(["build", str(tmp_path / "fleet.yaml"), "-o", str(out), "-q"])
    world = ElementTree.parse(out / "world.sdf").getroot()
    systems = {it.get("filename"): it.get("name") for it in world.iter("plugin")}
    empty = {"physics", "user-commands", "scene-broadcaster", "contact"}
    wanted = {f"{library}-{it}-system" for it in (*empty, "sensors", "imu", "altimeter")}
    assert systems.keys() == wanted
    assert systems[f"{library}-sensors-system"] == "gz::sim::systems::Sensors"
    text = " ".join((out / "fleet.launch.py").read_text().split())
    assert "DeclareLaunchArgument( 'world', default_value=file('world.sdf')" in text


@pytest.mark.more
def test_no_sensor_needs_no_world(tmp_path: Path) -> None:
    out = built(tmp_path, "kinds", "both")
    assert not (out / "world.sdf").exists(), "Gazebo Classic, and an arm without sensors"


@pytest.mark.more
def test_an_sdf_is_spawned_from_its_file(tmp_path: Path) -> None:
    folder = built(tmp_path, "sdf", "both")
    text, commands = ((folder / it).read_text() for it in ("fleet.launch.py", "commands.md"))
    assert "'-file', file(f'{name}/rover.sdf')" in text
    assert " -file robot1/rover.sdf " in commands
    assert "-topic" not in text + commands


@pytest.mark.more
def test_a_real_robot_needs_no_simulator(tmp_path: Path) -> None:
    text = (built(tmp_path, "real", "both") / "fleet.launch.py").read_text()
    assert "ros_gz_sim" not in text
    assert "DeclareLaunchArgument( 'use_sim_time', default_value='false'" in " ".join(text.split())
    assert "executable='joint_state_publisher'" in text, "nothing else sends its joint states"


def of_nav2(folder: Path, distro: str = "jazzy", **keys: str) -> str:
    """Return the file for two robots with Nav2's parameters and these keys."""
    for name in ("hexbase.urdf.xacro", "nav2_params.yaml"):
        shutil.copy(ROOT / "examples" / "namespace_and_prefix" / name, folder)
    more = "".join(f"{key}: {value}\n" for key, value in keys.items())
    (folder / "fleet.yaml").write_text(
        f"distro: {distro}\ndescription: hexbase.urdf.xacro\n{more}"
        f"related_files: {{params: nav2_params.yaml}}\n{TWO}"
    )
    out = folder / "out"
    assert main(["build", str(folder / "fleet.yaml"), "-o", str(out), "-q"]) == 0
    return (out / "fleet.launch.py").read_text()


CLASSIC = """\
<robot name="arm">
  <link name="base"><inertial><mass value="1"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="l1"><inertial><mass value="1"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="j1" type="revolute"><parent link="base"/><child link="l1"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <ros2_control name="s" type="system">
    <hardware><plugin>gazebo_ros2_control/GazeboSystem</plugin></hardware>
    <joint name="j1"><command_interface name="position"/><state_interface name="position"/></joint>
  </ros2_control>
  <gazebo><plugin filename="libgazebo_ros2_control.so" name="gazebo_ros2_control">
    <parameters>c.yaml</parameters></plugin></gazebo>
</robot>
"""


@pytest.mark.more
@pytest.mark.parametrize(("simulator", "program"), [("gazebo", False), ("none", True)])
def test_a_manager_in_a_plugin_is_not_started_besides(
    simulator: str, program: bool, tmp_path: Path
) -> None:
    """Without `node_sets`: gazebo_ros2_control_plugin.cpp makes the manager that the file sets."""
    hardware = "gazebo_ros2_control/GazeboSystem" if not program else "acme/Arm"
    (tmp_path / "arm.urdf").write_text(
        CLASSIC.replace("gazebo_ros2_control/GazeboSystem", hardware)
    )
    kind = "joint_trajectory_controller/JointTrajectoryController"
    (tmp_path / "c.yaml").write_text(
        f"controller_manager:\n  ros__parameters: {{jtc: {{type: {kind}}}}}\n"
        "jtc:\n  ros__parameters: {joints: [j1], command_interfaces: [position]}\n"
    )
    (tmp_path / "fleet.yaml").write_text(
        f"layout: tf-per-robot\ndistro: humble\nsimulator: {simulator}\ndescription: arm.urdf\n"
        f"related_files: {{params: c.yaml}}\n{TWO}"
    )
    assert main(["build", str(tmp_path / "fleet.yaml"), "-o", str(tmp_path / "out"), "-q"]) == 0
    python = (tmp_path / "out" / "fleet.launch.py").read_text()
    assert ("executable='ros2_control_node'" in python) == program
    # What ros2_control_node of Humble reads is below its name (ros2_control ros2_control_node.cpp).
    assert ("('~/robot_description', 'robot_description')" in python) == program
    assert "executable='spawner'" in python


@pytest.mark.slow
def test_slam_toolbox_is_left_to_a_manager_that_lists_it(tmp_path: Path) -> None:
    """Brought up twice, the second fails, and the manager gives all of its nodes up."""
    of_nav2 = "controller_server, smoother_server, planner_server, behavior_server, bt_navigator, "
    of_nav2 += "waypoint_follower, velocity_smoother, collision_monitor, docking_server"
    listed = f"ros__parameters: {{node_names: [{of_nav2}, slam_toolbox]}}"
    own = "ros__parameters: {use_lifecycle_manager: true}"
    both = f"lifecycle_manager_navigation:\n  {listed}\nslam_toolbox:\n  {own}\n"
    (tmp_path / "slam.yaml").write_text(both)
    (tmp_path / "fleet.yaml").write_text(
        "layout: tf-per-robot\ndistro: jazzy\ndescription: hexbase.urdf.xacro\n"
        f"node_sets: nav2_slam\nrelated_files: {{params: slam.yaml}}\n{TWO}"
    )
    shutil.copy(ROOT / "examples" / "namespace_and_prefix" / "hexbase.urdf.xacro", tmp_path)
    assert main(["build", str(tmp_path / "fleet.yaml"), "-o", str(tmp_path / "out"), "-q"]) == 0
    python = (tmp_path / "out" / "fleet.launch.py").read_text()
    assert "executable='sync_slam_toolbox_node'" in python
    assert "brought_up" not in python


@pytest.mark.slow
def test_relays_of_tf_are_started(tmp_path: Path) -> None:
    python = of_nav2(tmp_path, layout="both", affix="prefix", node_sets="nav2", relayed="true")
    told = "{'input_topic': f'/{name}/tf', 'output_topic': '/tf'}"
    assert told in python
    assert python.count("package='topic_tools'") == 2


@pytest.mark.slow
def test_nodes_of_bringup_are_left_to_it(tmp_path: Path) -> None:
    """Its parameter files have no namespaces, so a node in one would get nothing of them."""
    python = of_nav2(tmp_path, layout="tf-per-robot", node_sets="nav2", params_style="bringup")
    assert "# Not started: amcl (parameter files are in the form of nav2_bringup" in python
    assert "package='nav2_amcl'" not in python
    assert "package='robot_state_publisher'" in python


def test_a_component_needs_its_class_and_no_program(tmp_path: Path) -> None:
    """rclcpp_components loads a class; one that nobody tells is named in the file."""
    (tmp_path / "nodes.yaml").write_text(
        "nodes:\n"
        "  Camera: {package: acme, component: 'acme::Camera'}\n"
        "  lamp: {package: acme, programs: [lamp]}\n"
        "node_sets:\n"
        "  own: {container: nav2_container, nodes: [Camera, lamp]}\n"
    )
    shutil.copy(ROOT / "fixtures" / "robots" / "rover_gz.urdf", tmp_path)
    (tmp_path / "fleet.yaml").write_text(
        "distro: jazzy\nlayout: tf-per-robot\nsimulator: none\ndescription: rover_gz.urdf\n"
        "nodes: nodes.yaml\nnode_sets: [nav2_composed, own]\nrobots: [{name: r1}]\n"
    )
    out = tmp_path / "out"
    assert main(["build", str(tmp_path / "fleet.yaml"), "-o", str(out), "-q"]) == 0
    python = (out / "fleet.launch.py").read_text()
    assert "plugin='acme::Camera'" in python and "'lamp'" not in python
    reason = "# Not started: lamp (the class of package acme is not known; describe it in a file of"
    assert reason in python


REAL = pytest.mark.skipif(
    bool(launch.missing()),
    reason=f"not tried in the real launch, which is not here: {launch.missing()}",
)


def programs(out: Path) -> dict[str, str]:
    """Return the programs of the launch file with their packages."""
    text = (out / "fleet.launch.py").read_text()
    pairs = re.findall(r'package="(\w+)",\s+executable="([\w.]+)"', text)
    return {executable: package for package, executable in pairs}


@REAL
@pytest.mark.parametrize(
    ("words", "robot"), [("robots:=robot2", "robot2"), ("robots:=1", "robot1")]
)
def test_arguments_choose_robots_and_windows(words: str, robot: str, tmp_path: Path) -> None:
    out = built(tmp_path, "classic", "both")
    told, _ = launched(out / "fleet.launch.py", tmp_path, words, programs=programs(out))
    spaces = [word for it in told for word in words_of(it)[2] if word.startswith("__ns")]
    assert set(spaces) == {f"__ns:=/{robot}"}


@REAL
@pytest.mark.parametrize(
    ("words", "shown"),
    [("", ["robot1", "robot2"]), ("robots:=robot2", ["robot2"]), ("rviz:=false", [])],
)
def test_a_window_of_one_robot_opens_with_that_robot(
    words: str, shown: list[str], tmp_path: Path
) -> None:
    example, out = ROOT / "examples" / "two_robots_postfix", tmp_path / "out"
    assert main(["build", str(example / "fleet.yaml"), "-o", str(out), "-q"]) == 0
    given = [words] if words else []
    told, _ = launched(out / "fleet.launch.py", tmp_path, *given, programs=programs(out))
    opened = [it["words"] for it in told if it["words"][0].endswith("/rviz2")]
    assert sorted(Path(it[2]).parent.name for it in opened) == shown


@REAL
@pytest.mark.parametrize("installed", [True, False])
def test_tf_is_bridged_where_the_bridge_is_installed(installed: bool, tmp_path: Path) -> None:
    out = built(tmp_path, "real", "tf-per-robot\nrelayed: true")
    known = {
        name: package for name, package in programs(out).items() if installed or "tf_n" not in name
    }
    told, said = launched(out / "fleet.launch.py", tmp_path, programs=known)
    bridges = [it["words"][1:] for it in told if it["words"][0].endswith("/tf_namespace_bridge")]
    assert sorted(word for words in bridges for word in words if word.startswith("__ns")) == (
        ["__ns:=/robot1", "__ns:=/robot2"] if installed else []
    )
    worlds = [it["words"] for it in told if "__node:=bridged_world" in it["words"]]
    assert sorted(it[it.index("--child-frame-id") + 1] for it in worlds) == (
        ["robot1/map", "robot2/map"] if installed else []
    )
    line = "tf_namespace_bridge is not installed, so the tf of robot2 is not on /tf"
    assert (line in said) == (not installed)


def chosen(out: Path, text: str) -> list[str] | str:
    """Return the robots that are started for ``robots:=`` with this text, or why none is."""
    (done,) = performed(str(out / "fleet.launch.py"), [Launching({"robots": text})])
    spaces = (it.values.get("namespace", "/").strip("/") for it in done.actions)
    return done.error or [*dict.fromkeys(filter(None, spaces))]


@pytest.mark.slow
def test_so_many_robots_are_started(tmp_path: Path) -> None:
    out = built(tmp_path, "ten", "both")
    assert chosen(out, "3") == ["robot1", "robot2", "robot3"]
    assert chosen(out, "robot9, robot2") == ["robot9", "robot2"]
    assert len(chosen(out, "")) == 10
    assert "10 robots were built; for more: multibot build" in chosen(out, "12")
    assert "robots:=0" in chosen(out, "0")


@pytest.mark.more
def test_more_robots_than_the_file_has_are_built(tmp_path: Path) -> None:
    """No file is edited: the third one stands as far from the second as that from the first."""
    built(tmp_path, "classic", "both")
    fleet, out = tmp_path / "fleet.yaml", tmp_path / "more"
    before = fleet.read_text()
    assert main(["build", str(fleet), "-o", str(out), "-q", "--count", "3"]) == 0
    assert fleet.read_text() == before
    assert (out / "robot3" / "rover.urdf").exists()
    text = (out / "fleet.launch.py").read_text()
    assert "'robot3': partial(start, 'robot3', x=5.0)," in text


@REAL
@pytest.mark.live
def test_slam_toolbox_is_active_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("rclpy", reason="no rclpy: pip install '.[ros]'")
    of_nav2(tmp_path, layout="tf-per-robot", node_sets="slam_toolbox")
    for name, value in isolated_environment(None).items():
        monkeypatch.setenv(name, value)
    out, real = tmp_path / "out", {"sync_slam_toolbox_node": SUPPORT / "lifecycle_stand_in.py"}
    words = ("robots:=robot2", "simulator:=false")
    told, _ = launched(out / "fleet.launch.py", tmp_path, *words, programs=programs(out), real=real)
    (slam,) = (it for it in told if "state" in it)
    assert "__ns:=/robot2" in slam["words"]
    # lifecycle_msgs Transition: configure is 1, activate 3.
    assert (slam["state"], slam["asked"]) == ("active", [1, 3])


def runs() -> Iterator[Any]:
    for kind in FLEETS:
        for layout in LAYOUTS:
            deep = () if (kind, layout) == ("gz", "both") else (pytest.mark.deep,)
            yield pytest.param(kind, layout, marks=deep)


@REAL
@pytest.mark.live
@pytest.mark.parametrize(("kind", "layout"), list(runs()))
def test_what_is_started_is_as_planned(kind: str, layout: str, tmp_path: Path) -> None:
    pytest.importorskip("rclpy", reason="no rclpy: pip install '.[ros]'")
    out = built(tmp_path, kind, layout)
    fleet = load_fleet(tmp_path / "fleet.yaml")
    told, _ = launched(out / "fleet.launch.py", tmp_path, "rviz:=false", programs=programs(out))
    plan = read_plan((out / "plan.yaml").read_bytes(), "plan.yaml")
    graph, replaced = graph_of_stubs(nodes_of(told, fleet), isolated_environment(None), 40.0)
    assert doubts(graph) == ()
    assert [it.message for it in check(with_substitutes(plan, replaced), graph)] == []
