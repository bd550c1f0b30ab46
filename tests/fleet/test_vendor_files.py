# SPDX-License-Identifier: Apache-2.0
"""Files of vendors' robots, in small: what a healthy one of them must not be told."""

from __future__ import annotations

from pathlib import Path

import pytest
from fleet_folder import planned_fleet
from named_ends import named_ends

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.checks.build import make_outputs
from multibot_rewrite.fleet.fleet_plan import FleetPlan

SENSOR = """\
<robot name="r">
  <link name="base_link"/>
  <gazebo reference="base_link"><sensor name="lidar" type="gpu_lidar"/></gazebo>
</robot>
"""
# As Husarion's: the argument stands before names of ros2_control, which no node puts it before.
HARDWARE = """\
<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="namespace" default=""/>
  <link name="base_link"/>
  <ros2_control name="$(arg namespace)/imu" type="sensor">
    <hardware><plugin>acme/Imu</plugin></hardware>
    <sensor name="$(arg namespace)/imu">
      <state_interface name="orientation.x"/><state_interface name="orientation.y"/>
      <state_interface name="orientation.z"/><state_interface name="orientation.w"/>
      <state_interface name="angular_velocity.x"/><state_interface name="angular_velocity.y"/>
      <state_interface name="angular_velocity.z"/><state_interface name="linear_acceleration.x"/>
      <state_interface name="linear_acceleration.y"/><state_interface name="linear_acceleration.z"/>
    </sensor>
  </ros2_control>
</robot>
"""
IMU = """\
controller_manager:
  ros__parameters: {imu: {type: imu_sensor_broadcaster/IMUSensorBroadcaster}}
imu:
  ros__parameters: {sensor_name: SENSOR, frame_id: base_link}
"""


def plan(folder: Path, description: str, more: str = "", params: str = "") -> FleetPlan:
    name = "r.urdf.xacro" if "xacro" in description else "r.urdf"
    (folder / name).write_text(description)
    (folder / "p.yaml").write_text(params)
    fleet = folder / "fleet.yaml"
    own = "related_files: {params: p.yaml}\n" if params else ""
    head = f"description: {name}\nlayout: tf-per-robot\naffix: prefix\n{own}"
    fleet.write_text(f"{head}{more}robots: [{{name: robot1}}, {{name: robot2}}]\n")
    return planned_fleet(fleet, "jazzy")


def said(made: FleetPlan, code: str) -> list[Finding]:
    return [it for it in make_outputs(made).findings if it.code == code]


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ((), True),
        (("/world/w/model/r/link/base_link/sensor/lidar/scan@sensor_msgs/msg/LaserScan[x",), False),
        (("/world/w/model/r/link/base_link/sensor/other/scan@sensor_msgs/msg/LaserScan[x",), True),
    ],
)
def test_a_sensor_that_a_launched_bridge_carries_needs_no_topic(
    arguments: tuple[str, ...], told: bool, tmp_path: Path
) -> None:
    made = plan(tmp_path, SENSOR, "node_sets: bridge_per_robot\n")
    evidence = {key: it._replace(arguments=arguments) for key, it in made.evidence.items()}
    assert bool(said(made._replace(evidence=evidence), "MF509")) is told


@pytest.mark.slow
@pytest.mark.parametrize(("sensor", "open_"), [("imu", False), ("robot1/imu", False), ("x", True)])
def test_an_interface_is_found_whose_name_has_a_slash(
    sensor: str, open_: bool, tmp_path: Path
) -> None:
    more = "arguments: {namespace: '{robot}'}\nnode_sets: ros2_control\n"
    made = plan(tmp_path, HARDWARE, more, IMU.replace("SENSOR", sensor))
    found = [it for it in said(made, "MB229") if "of robot1 " in it.message]
    assert bool(found) is open_


def test_frames_that_a_node_puts_its_own_prefix_before_stay(tmp_path: Path) -> None:
    """turtlebot3_node src/odometry.cpp:74."""
    params = "ros__parameters: {odometry: {frame_id: odom, x_frame: odom}}"
    plan(tmp_path, SENSOR, "", f"diff_drive_controller:\n  {params}\n")
    (tmp_path / "fleet.yaml").write_text(
        (tmp_path / "fleet.yaml").read_text().replace("tf-per-robot", "frames-per-robot")
    )
    made = planned_fleet(tmp_path / "fleet.yaml", "jazzy")
    (text,) = (it.data for it in make_outputs(made).files if it.path == "robot1/p.yaml")
    assert b"{frame_id: odom, x_frame: robot1/odom}" in text


@pytest.mark.parametrize(("stamped", "type_"), [("true", "TwistStamped"), ("false", "Twist")])
def test_parameters_decide_whether_commands_are_stamped(
    stamped: str, type_: str, tmp_path: Path
) -> None:
    """twist_mux.cpp, use_stamped; the plan and a rehearsal have the one type."""
    values = f"{{use_stamped: {stamped}, topics.joy.topic: joy/cmd_vel}}"
    params = f"twist_mux:\n  ros__parameters: {values}\n"
    made = plan(tmp_path, SENSOR, "node_sets: twist_mux\n", params)
    types = {it.endpoint.name: it.endpoint.type for it in named_ends(made.fleet.table)}
    assert types["cmd_vel_out"] == f"geometry_msgs/msg/{type_}"
    assert types["joy/cmd_vel"] == f"geometry_msgs/msg/{type_}"


# As TurtleBot 4's: the rules stand for all controllers that the plugin loads.
DRIVE = """\
<robot name="r">
  <link name="base_link"/>
  <gazebo><plugin name="ign_ros2_control::IgnitionROS2ControlPlugin"
   filename="libign_ros2_control-system.so"><ros>
    <remapping>~/odom:=odom</remapping>
    <remapping>broad:~/odom:=nowhere</remapping>
    <remapping>/diagnostics:=diagnostics</remapping>
  </ros></plugin></gazebo>
</robot>
"""
LOADED = """\
controller_manager:
  ros__parameters: {base: {type: diff_drive_controller/DiffDriveController}}
base:
  ros__parameters: {odom_frame_id: odom, base_frame_id: base_link}
"""
OWN_MANAGER = """\
structure:
  nodes:
    /robot1/controller_manager:
      {pkg: controller_manager, exec: ros2_control_node, node_name: controller_manager}
"""


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("release", "started", "topic"),
    [
        ("humble", False, "/robot1/odom"),
        ("jazzy", False, "/robot1/odom"),
        ("lyrical", False, "/robot1/base/odom"),
        ("humble", True, "/robot1/base/odom"),
    ],
)
def test_rules_of_a_plugin_reach_its_controllers(
    release: str, started: bool, topic: str, tmp_path: Path
) -> None:
    (tmp_path / "system_model.yaml").write_text(OWN_MANAGER)
    more = "launch: system_model.yaml\n" if started else ""
    plan(tmp_path, DRIVE, f"distro: {release}\nnode_sets: gz_ros2_control\n{more}", LOADED)
    made = planned_fleet(tmp_path / "fleet.yaml")
    names = {
        it.endpoint.name: it.name for it in named_ends(made.fleet.table) if it.robot == "robot1"
    }
    assert names["~/odom"] == topic
    # No controller is called broad; another release's manager has /diagnostics.
    said = {it.message.partition(":=")[0] for it in made.fleet.table.problems if it.code == "MR103"}
    assert said - ({"~/odom"} if release == "lyrical" else set()) == {"broad:~/odom"}


@pytest.mark.more
def test_a_launch_file_is_named_alike_from_every_working_directory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "system_model.yaml").write_text(OWN_MANAGER)
    (tmp_path / "elsewhere").mkdir()
    made = plan(tmp_path, DRIVE, "launch: system_model.yaml\n")
    plans = []
    for folder in (tmp_path, tmp_path / "elsewhere"):
        monkeypatch.chdir(folder)
        plans += [it.data for it in make_outputs(made).files if it.path == "plan.yaml"]
    assert plans[0] == plans[1]
    assert b"place: system_model.yaml:" in plans[0]


STATE = """\
structure:
  nodes:
    /{robot}/robot_state_publisher:
      pkg: robot_state_publisher
      exec: robot_state_publisher
      node_name: robot_state_publisher
      params: {frame_prefix: PREFIX}
    /{robot}/dock_state_publisher:
      pkg: robot_state_publisher
      exec: robot_state_publisher
      node_name: dock_state_publisher
      params: {frame_prefix: dock/}
"""


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("layout", "prefix", "told"),
    [
        ("tf-per-robot", "robot1/", True),
        # Its frames are called so.
        ("frames-per-robot", "robot1/", False),
        ("frames-per-robot", "other/", True),
        # turtlebot3_state_publisher.launch.py without its argument; tf2 strips the slash.
        ("frames-per-robot", "/", False),
        ("frame-prefix", "robot1/", False),
        ("frame-prefix", "other/", True),
        ("frame-prefix", '""', True),
    ],
)
def test_a_launch_file_that_gives_the_state_publisher_a_prefix(
    layout: str, prefix: str, told: bool, tmp_path: Path
) -> None:
    text = STATE.replace("{robot}", "robot1").replace("PREFIX", prefix)
    (tmp_path / "system_model.yaml").write_text(text)
    plan(tmp_path, SENSOR, "launch: system_model.yaml\n")
    file = tmp_path / "fleet.yaml"
    file.write_text(file.read_text().replace("layout: tf-per-robot", f"layout: {layout}"))
    found = said(planned_fleet(file, "jazzy"), "MF841")
    assert [(Path(it.file).name, it.line) for it in found] == (
        [("system_model.yaml", 3)] if told else []
    )
