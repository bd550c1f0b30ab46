# SPDX-License-Identifier: Apache-2.0
"""Nodes with the parameters that they get. What runs then is said here from the nodes' sources:
robot_localization ros_filter.cpp, nav2_costmap_2d obstacle_layer.cpp, twist_mux.cpp."""

from __future__ import annotations

import pytest
from given_parameters import given_in
from paths import fixture_text

from multibot_rewrite.base.model import InputError
from multibot_rewrite.knowledge.node_sets import load_node_set, load_nodes
from multibot_rewrite.knowledge.programs import program_of
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts
from multibot_rewrite.producers.evidence.filling import filled
from multibot_rewrite.producers.evidence.nodes import nodes_of


def run(known: str, text: str, release: str = "jazzy") -> NodeFacts:
    return filled(load_nodes(release)[known], given_in(text)[0])


def names(node: NodeFacts, role: str) -> set[str]:
    return {it.name for it in node.endpoints if it.role == role and not it.when}


EKF = """\
ekf_node:
  ros__parameters:
    odom0: wheel/odometry
    odom1: /visual/odometry
    imu0: imu/data
    publish_acceleration: true
    base_link_frame: base_footprint
    world_frame: odom
"""


def test_a_filter_reads_what_its_parameters_name() -> None:
    node = run("ekf_filter_node", EKF)
    assert node.name == "ekf_node"
    assert names(node, "subscribes") >= {"wheel/odometry", "/visual/odometry", "imu/data"}
    assert not any("<" in it.name for it in node.endpoints)
    assert "accel/filtered" in names(node, "publishes")
    assert "cmd_vel" not in names(node, "subscribes")
    assert [it[:2] for it in node.sends] == [("odom_frame", "base_link_frame")]
    assert {it.parameter: it.default for it in node.frames}["base_link_frame"] == "base_footprint"
    assert str(node.origin) == "params.yaml:1"


def test_a_filter_in_the_map_sends_another_transform() -> None:
    node = run("ekf_filter_node", EKF.replace("world_frame: odom", "world_frame: map"))
    assert [it[:2] for it in node.sends] == [("map_frame", "odom_frame")]


def test_a_filter_that_sends_nothing() -> None:
    node = run("ekf_filter_node", EKF + "    publish_tf: false\n")
    assert node.sends == ()


COSTMAP = fixture_text("filling_costmap.txt")


def test_a_costmap_has_the_layers_of_its_list() -> None:
    node = run("local_costmap/local_costmap", COSTMAP)
    assert names(node, "subscribes") >= {"/front/scan", "scan_back", "keepout_info"}
    assert "/old" not in {it.name for it in node.endpoints}
    # No static layer: no node reads a map.
    assert "/map" not in names(node, "subscribes")
    assert {"obstacles", "obstacles_raw", "voxel_grid"} <= names(node, "publishes")
    assert "keepout/toggle_filter" in names(node, "serves")
    # Each of these names can be remapped, now that it is known.
    assert not [it.name for it in node.endpoints if it.fixed and "mask" not in it.name]


def test_costmaps_resolve_topics_below_the_robot_from_kilted_on() -> None:
    node = run("local_costmap/local_costmap", COSTMAP, "kilted")
    assert names(node, "subscribes") >= {"/front/scan", "/scan_back", "/keepout_info"}


def test_a_twist_mux_reads_its_topics_and_locks() -> None:
    text = """\
twist_mux:
  ros__parameters:
    topics:
      joystick: {topic: joy_teleop/cmd_vel, timeout: 0.5, priority: 10}
      nav: {topic: nav/cmd_vel, timeout: 0.5, priority: 1}
    locks:
      stop: {topic: e_stop, timeout: 0.0, priority: 255}
"""
    assert names(run("twist_mux", text), "subscribes") >= {
        "joy_teleop/cmd_vel",
        "nav/cmd_vel",
        "e_stop",
    }


CONTROLLERS = """\
/**/controller_manager:
  ros__parameters:
    update_rate: 50
    joint_state_broadcaster: {type: joint_state_broadcaster/JointStateBroadcaster}
    platform_velocity_controller:
      type: diff_drive_controller/DiffDriveController
    arm.type: acme/ArmController
/**/platform_velocity_controller:
  ros__parameters:
    enable_odom_tf: false
    base_frame_id: base_footprint
"""


def test_controllers_are_those_that_the_files_declare() -> None:
    found = nodes_of(
        load_node_set("ros2_control", "jazzy"),
        given_in(CONTROLLERS, file="c.yaml"),
        load_nodes("jazzy"),
    )
    by_name = {it.name: it for it in found.nodes}
    assert "diff_drive_controller" not in by_name
    drive = by_name["platform_velocity_controller"]
    assert (drive.host, str(drive.origin), drive.sends) == ("controller_manager", "c.yaml:6", ())
    assert "~/odom" in names(drive, "publishes")
    assert by_name["arm"].package == "acme"
    assert [(it.code, it.line) for it in found.findings] == [("MF802", 7)]


def test_a_controller_that_a_file_declares_needs_no_hardware_of_a_node_set() -> None:
    text = "controller_manager:\n  ros__parameters:\n    joint_trajectory_controller:\n"
    text += "      type: joint_trajectory_controller/JointTrajectoryController\n"
    found = nodes_of(load_node_set("ros2_control", "jazzy"), given_in(text), load_nodes("jazzy"))
    assert {it.name: it.when for it in found.nodes}["joint_trajectory_controller"] == ""


def test_a_helper_of_a_navigator_serves_no_action() -> None:
    """nav2_util simple_action_server.hpp (Humble): a node for the callbacks of the other's action."""
    helper = "bt_navigator_navigate_to_pose_rclcpp_node"
    body = ":\n  ros__parameters: {use_sim_time: true}\n"
    found = given_in(f"bt_navigator{body}{helper}{body}")
    assert [it.name for it in found] == ["bt_navigator"]


def test_a_node_of_a_file_may_run_and_then_sends_only_what_no_other_sends() -> None:
    amcl = "amcl:\n  ros__parameters: {base_frame_id: base_link}\n"
    beside = nodes_of(load_node_set("slam_toolbox", "jazzy"), given_in(amcl), load_nodes("jazzy"))
    assert next(it for it in beside.nodes if it.name == "amcl").sends == ()
    alone = nodes_of((), given_in(amcl), load_nodes("jazzy"))
    assert len(next(it for it in alone.nodes if it.name == "amcl").sends) == 1
    assert all(it.when for it in alone.nodes)


def test_a_node_of_the_node_set_under_another_name_is_not_there_twice() -> None:
    found = nodes_of((load_nodes("jazzy")["ekf_filter_node"],), given_in(EKF), load_nodes("jazzy"))
    assert [it.name for it in found.nodes] == ["ekf_node"]
    assert [it.when for it in found.nodes] == [""]
    # A node that is not it does not make doubtful which one is meant.
    beside = given_in(f"{EKF}navsat_transform_node:\n  ros__parameters: {{}}\n")
    found = nodes_of((load_nodes("jazzy")["ekf_filter_node"],), beside, load_nodes("jazzy"))
    assert {it.name: bool(it.when) for it in found.nodes} == {
        "ekf_node": False,
        "navsat_transform_node": True,
    }


def test_another_filter_of_the_package_is_the_one_of_the_node_set() -> None:
    """ukf_node of robot_localization sends what ekf_node sends (ros_filter.cpp is of both)."""
    known = load_nodes("jazzy")
    node_set = (known["ekf_filter_node"],)
    for name in ("ukf_filter_node", "ukf_node"):
        (node,) = nodes_of(node_set, given_in(EKF.replace("ekf_node", name)), known).nodes
        program = program_of(node, "jazzy")
        assert program and (node.name, program.executable, node.when) == (name, "ukf_node", "")
    beside = EKF + EKF.replace("ekf_node", "ukf_node")
    # Which of two is not known: with both there are rules that the node set does not have.
    both = nodes_of(node_set, given_in(beside), known).nodes
    assert {it.name for it in both if it.when} == {"ekf_node", "ukf_node"}
    # navsat_transform_node is of the package, and no filter.
    other = nodes_of(node_set, given_in("navsat_transform_node:\n  ros__parameters: {}\n"), known)
    assert {it.name: bool(it.when) for it in other.nodes} == {
        "ekf_filter_node": False,
        "navsat_transform_node": True,
    }


def test_a_name_of_before_humble_is_of_no_node() -> None:
    """Galactic's recoveries_server is behavior_server since Humble (nav2_behaviors)."""
    text = "recoveries_server:\n  ros__parameters: {costmap_topic: a}\n"
    known = load_nodes("humble")
    found = nodes_of((known["behavior_server"],), given_in(text), known)
    assert [(it.name, it.when) for it in found.nodes] == [("behavior_server", "")]


def test_a_section_below_a_namespace_is_for_the_node_of_the_node_set() -> None:
    text = "/r1/amcl:\n  ros__parameters: {scan_topic: front}\n"
    found = nodes_of(load_node_set("localization", "jazzy"), given_in(text), load_nodes("jazzy"))
    (amcl,) = (it for it in found.nodes if it.name.endswith("amcl"))
    assert amcl.name == "amcl"
    assert "front" in names(amcl, "subscribes")


def test_a_layer_whose_sources_are_in_another_file_may_read_any() -> None:
    text = COSTMAP.replace("        observation_sources: front back\n", "").replace(
        'observation_sources: "", ', ""
    )
    old = "      # No layer of this costmap.\n"
    node = run("local_costmap/local_costmap", text.partition(old)[0])
    assert {it.name for it in node.endpoints if it.when} >= {"<source>"}


def test_what_no_rule_reaches_is_fixed_unless_a_parameter_could_name_it() -> None:
    known = load_nodes("jazzy")["ekf_filter_node"]
    named = Endpoint(
        "topic", "publishes", "a", parameter="a_topic", fixed="made absolute", condition="wanted"
    )
    bare = named._replace(name="b", parameter="")
    node = known._replace(endpoints=(named, bare))
    found = filled(node, given_in("ekf_filter_node:\n  ros__parameters: {wanted: true}\n")[0])
    assert [(it.name, it.fixed) for it in found.endpoints] == [("a", ""), ("b", "made absolute")]


def test_a_topic_that_is_made_of_a_parameter_keeps_its_ending() -> None:
    text = "smoother_server:\n  ros__parameters: {costmap_topic: /global_costmap/raw}\n"
    heard = names(run("smoother_server", text), "subscribes")
    assert {"/global_costmap/raw", "/global_costmap/raw_updates"} <= heard


ONE_LAYER = """\
local_costmap/local_costmap:
  ros__parameters:
    plugins: [front]
    front:
      plugin: nav2_costmap_2d::ObstacleLayer
      observation_sources: SOURCE
      SOURCE: {data_type: TYPE}
"""


@pytest.mark.parametrize(
    ("data_type", "type_"),
    # obstacle_layer.cpp: a LaserScan unless the parameter says PointCloud2.
    [("PointCloud2", "PointCloud2"), ("LaserScan", "LaserScan"), ("''", "LaserScan")],
)
def test_the_type_that_a_parameter_chooses(data_type: str, type_: str) -> None:
    text = ONE_LAYER.replace("SOURCE", "lidar").replace("TYPE", data_type)
    node = run("local_costmap/local_costmap", text)
    (it,) = (it for it in node.endpoints if it.name == "lidar")
    assert (it.type, it.also) == (f"sensor_msgs/msg/{type_}", ())


def test_a_source_whose_topic_no_node_can_have() -> None:
    text = ONE_LAYER.replace("SOURCE", "3").replace("TYPE", "LaserScan")
    with pytest.raises(InputError, match=r"params\.yaml:6: topic '3' .* set front\.3\.topic"):
        run("local_costmap/local_costmap", text)
    named = text.replace("{data_type", "{topic: scan, data_type")
    assert "scan" in names(run("local_costmap/local_costmap", named), "subscribes")


CAMERA = """\
camera:
  ros__parameters:
    enable_color: false
    pointcloud.enable: true
"""


def test_a_camera_has_the_streams_that_are_enabled() -> None:
    """realsense2_camera src/profile_manager.cpp: enable_<stream> of each stream of the device, true by
    default; filters are off."""
    node = run("camera", CAMERA)
    published = {it.name: it.when for it in node.endpoints if it.role == "publishes"}
    assert published["~/depth/color/points"] == ""
    assert "open: device" in published["~/depth/image_rect_raw"]
    assert not published.keys() & {"~/color/image_raw", "~/rgbd", "~/imu"}


DOCKS = """\
docking_server:
  ros__parameters:
    dock_plugins: [charger, pallet]
    charger:
      plugin: opennav_docking::SimpleChargingDock
      use_external_detection_pose: true
      subscribe_toggle: true
    pallet: {plugin: "opennav_docking::SimpleNonChargingDock", use_stall_detection: false}
"""


def test_docks_read_what_their_plugins_are_told_to() -> None:
    """opennav_docking src/simple_charging_dock.cpp configure(): with subscribe_toggle it subscribes to
    the dock's pose while it docks."""
    node = run("docking_server", DOCKS)
    read = {it.name: bool(it.when) for it in node.endpoints if it.role == "subscribes"}
    assert (read["battery_state"], read["detected_dock_pose"]) == (False, True)
    assert "joint_states" not in read
    assert "battery_state" not in names(
        run("docking_server", DOCKS.replace("[charger, pallet]", "[pallet]")), "subscribes"
    )


ROUTE = """\
route_server:
  ros__parameters:
    operations: [slow, again]
    slow: {plugin: "nav2_route::AdjustSpeedLimit", speed_limit_topic: limit}
    again: {plugin: "nav2_route::ReroutingService"}
    edge_cost_functions: [DistanceScorer]
    DistanceScorer: {plugin: "nav2_route::DistanceScorer"}
"""


def test_a_route_server_has_the_names_of_its_plugins() -> None:
    node = run("route_server", ROUTE, "kilted")
    assert "limit" in names(node, "publishes")
    assert "~/again/reroute" in names(node, "serves")
    assert "~/slow/reroute" not in names(node, "serves")
    assert not [it.name for it in node.endpoints if "costmap" in it.name]


def test_a_section_with_a_name_of_before_is_of_no_node() -> None:
    """nav2_behaviors' server is called behavior_server since Humble, whatever a file has."""
    text = "recoveries_server: {ros__parameters: {costmap_topic: local_costmap/costmap_raw}}\n"
    node_set = load_node_set("nav2", "jazzy")
    found = nodes_of(node_set, given_in(text), load_nodes("jazzy"))
    assert [it.name for it in found.nodes] == [it.name for it in node_set]
