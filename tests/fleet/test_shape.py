# SPDX-License-Identifier: Apache-2.0
"""Outputs in the place and the form that vendors' launch files take.

Expectations: the vendors' launch files, which ``tests/support/vendor_shapes.py`` runs with these
outputs where the sources are there: each node gets what was built for it.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
import yaml
from vendor_recipes import Recipe, read_recipes
from vendor_shapes import taken
from vendor_sources import VARIABLE, WITHOUT, sources_folder
from vendor_systems import missing, read_vendors

from multibot_rewrite import InputError, UsageError, load_fleet
from multibot_rewrite.base.naming import LAYOUTS
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.fleet.file.fleet_data import schema
from multibot_rewrite.fleet.file.shape import shapes
from multibot_rewrite.launch import missing as without_launch

ROBOT = """\
<robot name="r"><link name="base_link"><inertial><mass value="1"/>
  <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <gazebo><plugin name="gz::sim::systems::Imu" filename="gz-sim-imu-system"/></gazebo></robot>
"""
PARAMS = "{}: {{ros__parameters: {{frame: base_link}}}}\n"
NODES = (
    "controller_manager",
    "ekf_node",
    "controller_server",
    "amcl",
    "turtlebot4_node",
    "ekf_filter",
)


def fleet(folder: Path, shape: str, **keys: Any) -> dict[str, Any]:
    """Two robots with a parameter file for each of NODES, called as no vendor calls it."""
    (folder / "r.urdf").write_text(ROBOT)
    for it in NODES:
        (folder / f"my {it}.yaml").write_text(PARAMS.format(it))
    params = [str(folder / f"my {it}.yaml") for it in NODES]
    robots = [{"name": "robot1", "pose": {"x": 1.5}}, {"name": "robot2"}]
    usual = {"layout": shapes()[shape].layouts[0], "distro": "jazzy"} if shape else {}
    own = {"description": str(folder / "r.urdf"), "related_files": {"params": params}}
    both = {"shape": shape} if shape else {}
    return {**usual, **own, **both, "robots": robots, **keys}


def commands(folder: Path, shape: str, **keys: Any) -> list[str]:
    text = load_fleet(fleet(folder, shape, **keys)).text("commands.md")
    rest = text.partition("## robot1")[2].partition("## robot2")[0]
    return [
        it for it in rest.partition("vendor's")[2].splitlines() if it.startswith(("ros2", "ROBOT"))
    ]


def test_the_shapes_are_the_same_everywhere() -> None:
    assert schema()["properties"]["shape"]["enum"] == sorted(shapes())
    layouts = {it.name for it in LAYOUTS}
    for it in shapes().values():
        assert it.source and set(it.layouts) <= layouts
        assert {row.robots for row in it.launch} <= {"", "real", "simulated"}


@pytest.mark.more
def test_clearpath_has_a_setup_folder(tmp_path: Path) -> None:
    (tmp_path / "sensors/config").mkdir(parents=True)
    lidar = tmp_path / "sensors/config/lidar2d_0.yaml"
    lidar.write_text(PARAMS.format("urg_node"))
    (tmp_path / "robot.yaml").write_text("system: {ros2: {namespace: a200}}  # kept\n")
    keys = fleet(tmp_path, "clearpath")
    keys["related_files"]["params"].append(str(lidar))
    made = load_fleet(keys)
    own = {it.removeprefix("robot2/") for it in made.files if it.startswith("robot2/")}
    places = {"robot.urdf.xacro", "robot.yaml", "sensors/config/lidar2d_0.yaml"}
    places |= {f"platform/config/{it}.yaml" for it in ("control", "localization")}
    assert places <= own
    assert own.isdisjoint({"r.urdf", "my controller_manager.yaml", "lidar2d_0.yaml"})
    # What no launch file of the vendor looks for is where it always is.
    assert "my amcl.yaml" in own
    assert made.text("robot2/robot.yaml") == "system: {ros2: {namespace: robot2}}  # kept\n"
    # Whoever else names the files names them there.
    assert "text(f'{name}/robot.urdf.xacro')" in made.text("fleet.launch.py")
    assert "file(f'{name}/platform/config/control.yaml')" in made.text("fleet.launch.py")
    robot = made.robot("robot2")
    text = made.text("robot2/platform/config/control.yaml")
    assert robot.text("my controller_manager.yaml") == text
    assert robot.node_text("my controller_manager.yaml") == text
    assert list(yaml.safe_load(made.text("robot2/platform/config/localization.yaml"))) == [
        "/robot2/ekf_node"
    ]


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize(
    "text",
    [
        "a: 1\n",
        "- a\n",
        "",
        "system: {ros2: {namespace: {}}}\n",
        "system:\n  ros2:\n    namespace: |\n      a\n",
    ],
)
def test_a_vendors_file_without_a_namespace_is_refused(text: str, tmp_path: Path) -> None:
    (tmp_path / "robot.yaml").write_text(text)
    with pytest.raises(InputError, match=r"robot\.yaml: system\.ros2\.namespace is not one word"):
        load_fleet(fleet(tmp_path, "clearpath")).text("commands.md")


@pytest.mark.more
def test_clearpath_starts_a_bridge_for_each_sensor(tmp_path: Path) -> None:
    """clearpath_generator_gz launch/sensors.py: each gets the file of its sensor."""
    folder = tmp_path / "sensors/config"
    folder.mkdir(parents=True)
    types = "ros_type_name: sensor_msgs/msg/LaserScan, gz_type_name: gz.msgs.LaserScan"
    for it in ("lidar2d_0", "lidar2d_1"):
        row = f"- {{topic_name: {it}/scan, {types}, direction: GZ_TO_ROS}}\n"
        (folder / f"{it}.yaml").write_text(row)
    bridges = {"bridge": [str(it) for it in sorted(folder.iterdir())]}
    made = load_fleet(fleet(tmp_path, "clearpath", related_files=bridges))
    for it in ("lidar2d_0", "lidar2d_1"):
        (row,) = yaml.safe_load(made.text(f"robot2/sensors/config/{it}.yaml"))
        assert (
            row["ros_topic_name" if "ros_topic_name" in row else "topic_name"]
            == f"/robot2/{it}/scan"
        )
    assert len(yaml.safe_load(made.text("robot2/bridge.yaml"))) == 2
    plain = load_fleet(fleet(tmp_path, "", layout="tf-per-robot", related_files=bridges))
    assert not [it for it in plain.files if "lidar2d" in it]


@pytest.mark.more
@pytest.mark.parametrize(("simulator", "robot"), [("none", "robot"), ("gazebo", "gz")])
def test_clearpaths_generator_is_that_of_the_robot(
    simulator: str, robot: str, tmp_path: Path
) -> None:
    lines = commands(tmp_path, "clearpath", simulator=simulator)
    assert lines[0] == f"ros2 run clearpath_generator_{robot} generate_launch -s $PWD/robot1/"
    assert lines[1] == "ros2 launch $PWD/robot1/platform/launch/platform-service.launch.py"


@pytest.mark.more
def test_only_the_first_file_of_a_node_gets_its_place(tmp_path: Path) -> None:
    keys = fleet(tmp_path, "clearpath")
    (tmp_path / "more.yaml").write_text(PARAMS.format("controller_manager"))
    keys["related_files"]["params"].append(str(tmp_path / "more.yaml"))
    files = load_fleet(keys).files
    assert {"robot1/more.yaml", "robot1/platform/config/control.yaml"} <= set(files)


@pytest.mark.more
def test_a_file_in_a_folder_of_the_vendor_takes_no_other_place(tmp_path: Path) -> None:
    folder = tmp_path / "manipulators/config"
    folder.mkdir(parents=True)
    (folder / "control.yaml").write_text(PARAMS.format("controller_manager"))
    keys = fleet(tmp_path, "clearpath")
    keys["related_files"]["params"].insert(0, str(folder / "control.yaml"))
    files = set(load_fleet(keys).files)
    places = {f"robot1/{it}/config/control.yaml" for it in ("manipulators", "platform")}
    assert places <= files
    keys["related_files"]["params"] = [str(folder / "control.yaml")]
    assert set(load_fleet(keys).files) & places == {"robot1/manipulators/config/control.yaml"}


@pytest.mark.more
def test_the_fleet_file_says_that_hardware_is_simulated(tmp_path: Path) -> None:
    keys = fleet(tmp_path, "clearpath", simulator="gazebo")
    hardware = '<ros2_control name="s" type="system"><hardware><plugin>a/B</plugin></hardware>'
    text = ROBOT.partition("<gazebo>")[0] + hardware + "</ros2_control></robot>"
    (tmp_path / "r.urdf").write_text(text)
    assert "ros2 run clearpath_generator_gz" in load_fleet(keys).text("commands.md")


@pytest.mark.slow
def test_turtlebot4_as_it_is(tmp_path: Path) -> None:
    """standard.launch.py puts the file below the namespace, turtlebot4_spawn.launch.py does not."""
    node = "robot1/my turtlebot4_node.yaml"
    real = load_fleet(fleet(tmp_path, "turtlebot4", simulator="none"))
    assert list(yaml.safe_load(real.text(node))) == ["turtlebot4_node"]
    made = load_fleet(fleet(tmp_path, "turtlebot4", simulator="gazebo"))
    assert list(yaml.safe_load(made.text(node))) == ["/robot1/turtlebot4_node"]
    assert list(yaml.safe_load(made.text("robot1/my ekf_node.yaml"))) == ["ekf_node"]
    first = commands(tmp_path, "turtlebot4", simulator="none")[0]
    robot = "ROBOT_NAMESPACE=robot1 ros2 launch turtlebot4_bringup standard.launch.py"
    assert first == f"{robot} param_file:=$PWD/'{node}'"
    for distro, package in {"humble": "ignition", "jazzy": "gz", "lyrical": "gz"}.items():
        spawn = f"turtlebot4_{package}_bringup turtlebot4_spawn.launch.py namespace:=robot1 x:=1.5"
        first = commands(tmp_path, "turtlebot4", simulator="gazebo", distro=distro)[0]
        assert first == f"ros2 launch {spawn} param_file:=$PWD/'{node}'"


@pytest.mark.more
def test_husarion_gets_its_bridge_file(tmp_path: Path) -> None:
    row = "topic_name: imu, ros_type_name: sensor_msgs/msg/Imu, gz_type_name: gz.msgs.IMU"
    (tmp_path / "b.yaml").write_text(f"- {{{row}, direction: GZ_TO_ROS}}\n")
    keys = fleet(tmp_path, "husarion")["related_files"] | {"bridge": str(tmp_path / "b.yaml")}
    (line,) = commands(tmp_path, "husarion", simulator="gazebo", related_files=keys)
    assert line.startswith("ros2 launch husarion_ugv_gazebo simulate_robot.launch.py")
    assert line.endswith(" gz_bridge_config_path:=$PWD/robot1/bridge.yaml")
    assert " localization_config_path:=$PWD/'robot1/my ekf_filter.yaml' " in line


def test_a_command_without_files_is_left_out(tmp_path: Path) -> None:
    assert commands(tmp_path, "nav2", related_files={}) == []


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        (
            {"layout": "frames-per-robot"},
            "do not start layout frames-per-robot; use tf-per-robot or",
        ),
        ({"params_style": "full"}, "do not take params_style full; leave it out, or write bringup"),
    ],
)
def test_what_the_vendor_cannot_start_is_refused(
    keys: dict[str, Any], message: str, tmp_path: Path
) -> None:
    with pytest.raises(UsageError, match=f"shape nav2: the vendor's launch files {message}"):
        load_fleet(fleet(tmp_path, "nav2", **keys))


@pytest.mark.slow
def test_another_shape_leaves_nothing_of_the_one_before(tmp_path: Path) -> None:
    file, out = tmp_path / "fleet.json.yaml", str(tmp_path / "out")
    for shape, there in (("clearpath", True), ("nav2", False)):
        file.write_text(json.dumps(fleet(tmp_path, shape)))
        assert main(["build", str(file), "-o", out, "-q"]) == 0
        assert (tmp_path / "out/robot1/platform/config/control.yaml").is_file() is there
    assert not (tmp_path / "out/robot1/platform").exists()


# Recipe or system, shape, simulator -> nodes that get what was built.
VENDORS = {
    ("clearpath_husky", "clearpath", "none"): (
        *("robot_state_publisher description", "controller_manager", "ekf_node", "twist_mux"),
        *("joy_node", "teleop_twist_joy_node", "twist_server_node", "sensors/lidar2d_0/urg_node"),
    ),
    ("husarion_ugv", "husarion", "none"): ("controller_manager", "system_monitor", "ekf_filter"),
    ("husarion_ugv", "husarion", "gazebo"): ("ekf_filter",),
    ("Nav2 tb3", "nav2", "gazebo"): (
        *("amcl", "controller_server", "local_costmap/local_costmap", "planner_server"),
        *("global_costmap/global_costmap", "behavior_server", "bt_navigator", "docking_server"),
        *("velocity_smoother", "collision_monitor", "waypoint_follower", "route_server"),
    ),
    ("turtlebot4", "turtlebot4", "none"): (
        *("turtlebot4_node", "turtlebot4_base_node", "teleop_twist_joy_node", "oakd"),
    ),
    ("turtlebot4_simulator", "turtlebot4", "gazebo"): (
        *("turtlebot4_node", "amcl", "map_server", "controller_server", "bt_navigator"),
        *("local_costmap/local_costmap", "global_costmap/global_costmap", "velocity_smoother"),
    ),
}
# Its launch file says it.
BY_LAUNCH = {"yaml_filename"}


@pytest.mark.deep
@pytest.mark.parametrize(("name", "shape", "simulator"), VENDORS)
def test_a_vendors_launch_takes_what_is_built(name: str, shape: str, simulator: str) -> None:
    vendors, folder = read_vendors(), sources_folder()
    if folder is None or without_launch():
        pytest.skip(without_launch() or WITHOUT)
    recipe = read_recipes().get(name) or Recipe(name, name, "", ("tf-per-robot",))
    lacking = missing(vendors.systems[recipe.system], folder)
    if lacking:
        pytest.skip(f"{VARIABLE} lacks {', '.join(lacking)}")
    found = taken(recipe, shape, simulator, vendors, folder)[1]
    ours = {it.removeprefix("/robot2/"): got for it, got in found.items() if got.is_ours}
    assert set(VENDORS[name, shape, simulator]) <= set(ours)
    wrong = {it: got.differences for it, got in ours.items() if got.differences.keys() - BY_LAUNCH}
    assert wrong == {}
