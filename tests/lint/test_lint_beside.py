# SPDX-License-Identifier: Apache-2.0
"""Files beside a description: planted defects are found at their line, what is odd and healthy is not.

What a parameter is was read in the sources that the rows of declared.schema name.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from paths import FIXTURES, ROBOTS, fixture_text

from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.knowledge.declared import FILE, is_known
from multibot_rewrite.knowledge.nodl.lookup import INDEX
from multibot_rewrite.lint.check import lint_data, lint_file
from multibot_rewrite.related_files.named_file import (
    BRIDGE,
    MOVEIT,
    PARAMS,
    RVIZ,
    is_linted,
    kind_of,
)
from multibot_rewrite.rules.files.parameter_files import beyond
from multibot_rewrite.rules.settings import Settings
from tools.interfaces.declared_table import ID, plugin_owners, table
from tools.interfaces.parameter_facts import read_parameters
from tools.interfaces.table import read_packed

SHIPPED = Path(FILE)
CONTROLLERS = fixture_text("lint_beside_controllers.yaml")
NAV = fixture_text("lint_beside_nav.yaml")
PLUGINS = fixture_text("lint_beside_plugins.yaml")
MONITOR = """\
collision_monitor:
  ros__parameters:
    polygons: [Stop, Slow]
    Stop: {type: circle, radius: 0.3, action_type: stop}
    Slow: {type: polygon, slowdown_ratio: 0.3, acme: 1}
    observation_sources: [scan]
    scan: {type: scan, topic: scan, source_timeout: 1.0, obstacles_angle: 0.1}
"""
SHIM = fixture_text("lint_beside_shim.yaml")
VIEW = """\
Visualization Manager:
  Global Options:
    Fixed Frame: base_link
  Displays:
    - Class: rviz_default_plugins/Axes
      Reference Frame: lidar_link
"""
ROW = """\
- ros_topic_name: scan
  gz_topic_name: scan
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
  direction: GZ_TO_ROS
"""
MOVEIT_LIMITS = """\
joint_limits:
  left_wheel_joint:
    has_velocity_limits: true
    max_velocity: 1.0
  right_wheel_joint:
    has_velocity_limits: true
    max_velocity: 1.0
"""
COSTMAPS = fixture_text("lint_beside_costmaps.yaml")
DOCKS = """\
docking_server:
  ros__parameters:
    dock_plugins: [charger]
    charger: {plugin: "opennav_docking::SimpleChargingDock"}
    docks: [home]
    home: {type: charger, frame: map, pose: [0.0, 0.0, 0.0]}
"""
FORWARD = """\
controller_manager:
  ros__parameters:
    hand: {type: forward_command_controller/ForwardCommandController}
hand:
  ros__parameters:
    joints: [left_wheel_joint]
    interface_name: position
"""
# File, its text, what is put in place of what, and the codes and lines of it.
PLANTED = {
    "a frame's parameter": (CONTROLLERS, "base_frame_id", "base_frame_idd", "MB110:12"),
    "a wheel's parameter": (CONTROLLERS, "wheel_radius", "wheel_raduis", "MB110:11"),
    "a list's parameter": (CONTROLLERS, "left_wheel_names", "left_wheel_name", "MB110:8"),
    "a nested parameter": (CONTROLLERS, "max_acceleration", "max_accelaration", "MB110:16"),
    "a dotted parameter": (
        CONTROLLERS,
        "linear.x.max_velocity",
        "linear.x.max_velocty",
        "MB110:13",
    ),
    "a trajectory's parameter": (CONTROLLERS, "state_interfaces", "state_interface", "MB110:21"),
    "the manager's parameter": (CONTROLLERS, "update_rate", "updaet_rate", "MB110:3"),
    "a parameter of amcl": (NAV, "max_particles", "max_particels", "MB110:5"),
    "a plugin's parameter": (NAV, "desired_linear_vel", "desired_linaer_vel", "MB110:14"),
    "a parameter of DWB": (PLUGINS, "max_vel_x", "max_vel_xx", "MB110:6"),
    "a parameter of a critic of DWB": (PLUGINS, "scale: 24.0", "scael: 24.0", "MB110:10"),
    "a parameter of MPPI": (PLUGINS, "batch_size", "bach_size", "MB110:13"),
    "a parameter in a block of MPPI": (PLUGINS, "time_step", "time_stepp", "MB110:14"),
    "a parameter of a critic of MPPI": (PLUGINS, "critical_cost", "critcal_cost", "MB110:16"),
    "a parameter of a planner": (PLUGINS, "quantization", "quantisation", "MB110:22"),
    "a planner's smoother": (PLUGINS, "w_smooth", "w_smoth", "MB110:23"),
    "a layer's parameter": (PLUGINS, "z_voxels", "z_voxel", "MB110:30"),
    "a radius of inflation": (PLUGINS, "inflation_radius", "inflation_raduis", "MB110:35"),
    "a behavior's parameter": (PLUGINS, "acceleration_limit", "acceleration_limt", "MB110:38"),
    "a source's parameter": (PLUGINS, "raytrace_max_range", "raytrace_max_rnage", "MB110:32"),
    "a polygon's parameter": (MONITOR, "radius", "raduis", "MB110:4"),
    "a polygon's ratio": (MONITOR, "slowdown_ratio", "slowdown_raito", "MB110:5"),
    "an integer for a ratio": (MONITOR, "0.3, acme", "1, acme", "MB120:5"),
    "a parameter of the monitor's source": (MONITOR, "source_timeout", "source_timout", "MB110:7"),
    "an integer for a speed": (PLUGINS, "0.5", "1", "MB120:6"),
    "a double for a size": (PLUGINS, "2000", "2000.0", "MB120:13"),
    "an integer for a weight": (PLUGINS, "3.81", "4", "MB120:16"),
    "a text for a source's boolean": (PLUGINS, "marking: true", "marking: 'on'", "MB120:32"),
    "a parameter of a shim's controller": (SHIM, "max_vel_x", "max_vel_xx", "MB110:7"),
    "a parameter of a shim": (SHIM, "angular_dist", "anglar_dist", "MB110:6"),
    "a critic of a shim's controller": (SHIM, "GoalDist.scale", "GoalDist.scael", "MB110:9"),
    "a parameter that is not declared": (
        CONTROLLERS,
        "base_frame_id: base_link",
        "acme_extra: 1",
        "MB111:12",
    ),
    "a source without parameters": (PLUGINS, "scan: {", "front_scan: {", "MB115:31"),
    "an integer for a double": (CONTROLLERS, "0.34", "1", "MB120:10"),
    "a text for a double": (CONTROLLERS, "wheel_radius: 0.07", 'wheel_radius: "0.07"', "MB120:11"),
    "a number for a name": (
        CONTROLLERS,
        "base_frame_id: base_link",
        "base_frame_id: 1",
        "MB120:12",
    ),
    "a name for a list": (CONTROLLERS, "[position]", "position", "MB120:20"),
    "an integer in a nested double": (CONTROLLERS, "2.0", "2", "MB120:16"),
    "a double for an integer": (CONTROLLERS, "update_rate: 100", "update_rate: 100.5", "MB120:3"),
    "a text for a boolean": (NAV, "tf_broadcast: true", "tf_broadcast: 'true'", "MB120:6"),
    "an integer for a range": (NAV, "12.0", "12", "MB120:4"),
    "an integer for a frequency": (NAV, "20.0", "20", "MB120:10"),
    "a radius below 0": (CONTROLLERS, "0.07", "-0.07", "MB125:11"),
    "a separation of 0": (CONTROLLERS, "0.34", "0.0", "MB125:10"),
    "no wheels": (CONTROLLERS, "[left_wheel_joint]", '[""]', "MB125:8"),
    "an unknown interface": (CONTROLLERS, "[position, velocity]", "[position, speed]", "MB125:21"),
    "an acceleration below 0": (CONTROLLERS, "2.0", "-2.0", "MB125:16"),
    "a frame of amcl": (NAV, "base_footprint", "base_footprnt", "MB853:3"),
    "a frame of a controller": (CONTROLLERS, "base_link", "base_lnik", "MB853:12"),
    "the fixed frame of RViz": (VIEW, "base_link", "base_linkk", "MB853:3"),
    "a display's frame": (VIEW, "lidar_link", "lidra_link", "MB853:6"),
    "a wheel": (CONTROLLERS, "[left_wheel_joint]", "[left_whel_joint]", "MB854:8"),
    "a joint that is nowhere": (
        CONTROLLERS,
        "joints: [left_wheel_joint",
        "joints: [elbow",
        "MB854:19 MB111:22",
    ),
    "a joint of MoveIt": (MOVEIT_LIMITS, "left_wheel_joint", "left_wheel", "MB854:2"),
    "a separation of another robot": (CONTROLLERS, "0.34", "0.5", "MB856:10"),
    "a separation to the middle": (CONTROLLERS, "0.34", "0.17", "MB856:10"),
    "a diameter for a radius": (CONTROLLERS, "0.07", "0.14", "MB856:11"),
    "wheels that are swapped": (
        CONTROLLERS,
        "[left_wheel_joint]\n    right_wheel_names: [right_wheel_joint]",
        "[right_wheel_joint]\n    right_wheel_names: [left_wheel_joint]",
        "MB856:9",
    ),
    "a frame with a slash": (VIEW, "base_link", "/base_link", "MB301:3"),
    "a direction": (ROW, "GZ_TO_ROS", "GZ_TO_ROSS", "MB855:5"),
    "a direction in small letters": (ROW, "GZ_TO_ROS", "gz_to_ros", "MB855:5"),
    "a type's key": (ROW, "ros_type_name", "ros_type", "MB855:1 MB858:3"),
    "a topic twice": (
        ROW,
        "- ros_topic_name",
        "- topic_name: a\n  ros_topic_name",
        "MB855:2 MB855:3",
    ),
    "no type": (ROW, "  gz_type_name: gz.msgs.LaserScan\n", "", "MB855:1"),
    # diff_drive_controller_parameter.yaml: 0.0 by default, which has to be above 0.
    "no radius": (CONTROLLERS, "    wheel_radius: 0.07\n", "", "MB115:8"),
    # joint_trajectory_controller_parameters.yaml: [] by default, with a size above 0.
    "no joints": (
        CONTROLLERS,
        "    joints: [left_wheel_joint, right_wheel_joint]\n",
        "",
        "MB115:19",
    ),
    # controller_manager.cpp asks for NAME.type and NAME.params_file.
    "a parameter in the manager": (
        CONTROLLERS,
        "    arm: {type: joint_trajectory_controller/JointTrajectoryController}\n",
        "    arm: {type: joint_trajectory_controller/JointTrajectoryController, joints: [a]}\n",
        "MB111:5",
    ),
    "a class in the controller's section": (
        CONTROLLERS,
        "arm:\n  ros__parameters:\n",
        "spare:\n  ros__parameters:\n    type: diff_drive_controller/DiffDriveControler\narm:\n"
        "  ros__parameters:\n",
        "MB124:19",
    ),
    # parse.c of rcl_yaml_param_parser: Cannot have a value before ros__parameters.
    "a section without its mark": (NAV, "amcl:\n  ros__parameters:", "amcl:\n  own:", "MB120:3"),
    "a list without its mark": (NAV, "amcl:", "nodes: [amcl]\namcl:", "MB120:1"),
    "a mark that lacks a letter": (
        NAV,
        "amcl:\n  ros__parameters:",
        "amcl:\n  ros__paramters:",
        "MB110:2",
    ),
    # controller_server.cpp and parameter_handler.cpp ask for the list of them.
    "one goal checker": (
        NAV,
        "    controller_plugins",
        "    goal_checker_plugin: precise\n    controller_plugins",
        "MB894:11",
    ),
    # costmap_2d_ros.cpp asks for the class of each layer of that costmap.
    "a layer that another costmap has": (
        COSTMAPS,
        "plugins: [inflation_layer]",
        "plugins: [static_layer, inflation_layer]",
        "MB115:4",
    ),
    "a dock of another type": (DOCKS, "type: charger", "type: charging", "MB894:6"),
    # serialization.hpp of slam_toolbox adds the ending.
    "a map with its ending": (
        "slam_toolbox:\n  ros__parameters:\n    map_file_name: maps/hall\n",
        "hall",
        "hall.posegraph",
        "MB125:3",
    ),
    # ros_filter.cpp: without an input there is no measurement, and nothing is sent.
    "a filter without input": (
        "ekf_filter_node:\n  ros__parameters:\n    frequency: 30.0\n    odom0: odom\n",
        "    odom0: odom\n",
        "",
        "MB115:3",
    ),
    # forward_command_controller.cpp: 'interface_name' parameter was empty.
    "no interface": (FORWARD, "    interface_name: position\n", "", "MB115:6"),
}
# Notes about what a rewrite for several robots would leave as it is.
OF_REWRITES = ("MB901", "MB105")
HEALTHY = {
    "nothing": (CONTROLLERS, "", ""),
    "nothing of Nav2": (NAV, "", ""),
    "nothing of RViz": (VIEW, "", ""),
    "nothing of a bridge": (ROW, "", ""),
    "nothing of MoveIt": (MOVEIT_LIMITS, "", ""),
    "a controller of another package": (CONTROLLERS, "diff_drive_controller/Diff", "my_drive/Diff"),
    "another controller with a usual name": (
        "diffdrive_controller:\n  ros__parameters:\n    type: acme/Drive\n    wheel_raduis: 1\n",
        "",
        "",
    ),
    "a separation a little larger": (CONTROLLERS, "0.34", "0.36"),
    "the only goal checker by its default name": (
        NAV,
        "    controller_plugins",
        "    goal_checker_plugin: goal_checker\n    controller_plugins",
    ),
    "what another namespace is given": (
        FORWARD,
        "hand:\n  ros__parameters:\n    joints: [left_wheel_joint]\n",
        "front/hand:\n  ros__parameters:\n    joints: [left_wheel_joint]\nhand:\n  ros__parameters:\n",
    ),
    "a separation with its multiplier": (
        CONTROLLERS,
        "wheel_separation: 0.34",
        "wheel_separation: 0.2\n    wheel_separation_multiplier: 1.7",
    ),
    "wheels of another robot": (CONTROLLERS, "[right_wheel_joint]", "[$(var right)]"),
    "a placeholder": (CONTROLLERS, "0.34", "$(var separation)"),
    "a placeholder of a launch file": (NAV, "true", "TF_BROADCAST_ON"),
    "a section for all nodes": (NAV, "amcl:", "/**:"),
    "no limit": (CONTROLLERS, "max_velocity: 1.0", "max_velocity: .nan"),
    "an empty list": (
        CONTROLLERS,
        "command_interfaces: [position]",
        "command_interfaces: [position]\n    command_joints: []",
    ),
    "a number for rcl alone": (CONTROLLERS, "2.0", "2e0"),
    "an octal number": (CONTROLLERS, "update_rate: 100", "update_rate: 0100"),
    "a parameter of every node": (NAV, "scan_topic: scan", "use_sim_time: true"),
    "quality of service": (NAV, "scan_topic: scan", "qos_overrides./tf.publisher.depth: 3"),
    "a plugin's own parameter": (NAV, "desired_linear_vel: 0.5", "acme_velocity: 1"),
    "nothing of plugins": (PLUGINS, "", ""),
    "nothing of a shim": (SHIM, "", ""),
    "nothing of a monitor": (MONITOR, "", ""),
    "blocks of no list": (MONITOR, "[Stop, Slow]", "[Stop]"),
    "a plugin of another package": (PLUGINS, "dwb_core::DWBLocal", "acme::Local"),
    "a misspelt parameter of an unknown plugin": (
        PLUGINS,
        "plugin: nav2_costmap_2d::InflationLayer\n        inflation_radius",
        "plugin: acme::InflationLayer\n        inflaton_radius",
    ),
    "what a shim's unknown controller reads": (
        SHIM,
        "dwb_core::DWBLocalPlanner\n      angular_dist_threshold",
        "acme::Planner\n      angular_dis_threshold",
    ),
    "another type of an unknown plugin": (
        PLUGINS,
        "nav2_smac_planner::SmacPlannerHybrid\n      angle_quantization_bins: 72",
        "acme::Planner\n      angle_quantization_bins: 72.5",
    ),
    "critics of unknown namespaces": (
        PLUGINS,
        "critics: [BaseObstacle, GoalDist]\n      BaseObstacle.scale",
        "default_critic_namespaces: [acme]\n      critics: [BaseObstacle]\n      BaseObstacle.scal",
    ),
    "a critic's class": (
        PLUGINS,
        "GoalDist: {scale",
        "GoalDist: {class: acme_critics::Far, scael",
    ),
    "a critic of another package": (PLUGINS, "[CostCritic]", "[CostCritic, AcmeCritic]"),
    "another name of a source": (
        PLUGINS,
        "sources: scan\n        scan: {",
        "sources: front_scan\n        front_scan: {",
    ),
    "a planner's own parameter": (PLUGINS, "angle_quantization_bins", "acme_bins"),
    "a frame of another node": (NAV, "base_frame_id: base_footprint", "base_frame_id: gps_mast"),
    "a frame at run time": (VIEW, "base_link", "map"),
    "a frame of a robot": (VIEW, "base_link", "robot1/base_link"),
    "joints of another robot": (
        MOVEIT_LIMITS.replace("left_", "l_").replace("right_", "r_"),
        "",
        "",
    ),
    "one topic for both": (
        ROW.replace("- ros_topic_name: scan\n  gz_topic_name", "- topic_name"),
        "",
        "",
    ),
    "a bridged service": (
        ROW + "- service_name: /world/empty/control\n  ros_type_name: a/srv/B\n",
        "",
        "",
    ),
    "a lazy row": (ROW, "  direction: GZ_TO_ROS\n", "  lazy: true\n"),
}
NAMES = {CONTROLLERS: "controllers.yaml", VIEW: "view.rviz"}


def found(text: str, folder: Path, name: str = "") -> list[str]:
    """Codes and lines in a file of a package with the rover."""
    (folder / "package.xml").write_text("<package><name>rover_bringup</name></package>")
    (folder / "urdf").mkdir(exist_ok=True)
    (folder / "urdf/rover.urdf").write_text((ROBOTS / "rover_gz.urdf").read_text())
    file = folder / (name or "file.yaml")
    file.write_text(text)
    # Nav2 has primary_controller until kilted, and primary_controller.plugin from lyrical on.
    settings = Settings(distro="kilted") if "primary_controller:" in text else Settings()
    return [f"{it.code}:{it.line}" for it in lint_file(str(file), settings)]


def linted(case: tuple[str, str], folder: Path) -> set[str]:
    """Return what all rules find in a text, given with the name of its file."""
    return {it.partition(":")[0] for it in found(case[0], folder, case[1])}


def defects() -> Iterator[tuple[tuple[str, str], tuple[str, str], str]]:
    """Each planted defect, the file without it, and its code."""
    for text, old, new, expected in PLANTED.values():
        name = NAMES.get(text, "")
        yield (
            (text.replace(old, new, 1), name),
            (text if old else "", name),
            expected.partition(":")[0],
        )


@pytest.mark.more
@pytest.mark.parametrize("name", PLANTED)
def test_a_planted_defect_is_found(name: str, tmp_path: Path) -> None:
    text, old, new, expected = PLANTED[name]
    assert old in text
    assert found(text.replace(old, new, 1), tmp_path, NAMES.get(text, "")) == expected.split()


@pytest.mark.parametrize("name", HEALTHY)
def test_what_is_odd_and_healthy_is_left_alone(name: str, tmp_path: Path) -> None:
    text, old, new = HEALTHY[name]
    assert old in text
    said = found(text.replace(old, new, 1) if old else text, tmp_path, NAMES.get(text, ""))
    assert [it for it in said if it[:5] not in OF_REWRITES] == []


def test_sources_of_a_package_say_what_its_controllers_declare(tmp_path: Path) -> None:
    (tmp_path / "acme/src").mkdir(parents=True)
    (tmp_path / "acme/package.xml").write_text("<package><name>acme</name></package>")
    (tmp_path / "acme/src/drive_parameters.yaml").write_text(
        "drive:\n  gain: {type: double, default_value: 1.0, validation: {bounds<>: [0.0, 2.0]}}\n"
        "  __map_joints:\n    offset: {type: double}\n"
    )
    head = "controller_manager: {ros__parameters: {drive: {type: acme/Drive}}}\ndrive:\n"
    file = tmp_path / "acme/config.yaml"
    file.write_text(f"{head}  ros__parameters: {{gian: 1.0, gain: 3.0, elbow: {{offset: 1}}}}\n")
    codes = [it.code for it in lint_file(str(file), Settings())]
    assert codes == ["MB125", "MB120"]  # gain is said, so gian is not meant to be it
    file.write_text(f"{head}  ros__parameters: {{gian: 1.0}}\n")
    assert [it.code for it in lint_file(str(file), Settings())] == ["MB110"]


def test_an_installed_nodl_document_adds_to_what_is_known(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    index = tmp_path / "install" / INDEX
    index.mkdir(parents=True)
    (index / "nav2_amcl__amcl").write_text(
        "nodl_version: 2\nparameters:\n  acme_gain: {type: double}\n"
    )
    text = NAV.replace("scan_topic: scan", "acme_gian: 1.0")
    assert found(text, tmp_path) == []
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "install"))
    assert found(text, tmp_path) == ["MB110:7"]
    assert found(text.replace("acme_gian: 1.0", "acme_gain: 1"), tmp_path) == ["MB120:7"]
    (index / "nav2_amcl__amcl").write_text("parameters: [\n")
    assert found(text, tmp_path) == []


@pytest.mark.parametrize(
    ("check", "arguments", "value", "expected"),
    [
        ("gt", "[0.0]", 0.0, "above 0.0"),
        ("gt_eq", "[0.0]", 0.0, ""),
        ("lt", "[1]", 1, "below 1"),
        ("lt_eq", "[1]", 2, "at most 1"),
        ("lower_bounds", "[1]", 1, ""),
        ("lower_bounds", "[1]", 0, "at least 1"),
        ("upper_bounds", "[1]", 1, ""),
        ("upper_bounds", "[1]", 2, "at most 1"),
        ("upper_bounds_or_nan", "[1]", 2, "at most 1"),
        ("bounds", "[0, 1]", 1, ""),
        ("bounds", "[0, 1]", 2, "from 0 to 1"),
        ("control_filters::gt_eq_or_nan", "[0.0]", float("nan"), ""),
        ("control_filters::lt_eq_or_nan", "[0.0]", 1.0, "at most 0.0"),
        ("one_of", "[[a, b]]", "c", "one of a, b"),
        ("one_of", "[[a, b]]", "a", ""),
        ("subset_of", "[[a, b]]", ["a", "c"], "of a, b"),
        ("not_empty", "[]", [], "not empty"),
        ("fixed_size", "[6]", [1.0], "with a size of 6"),
        ("size_gt", "[0]", ["a"], ""),
        ("size_lt", "[2]", ["a", "b"], "with a size below 2"),
        ("unique", "", ["a", "a"], "without one twice"),
        ("acme::even", "[2]", 3, ""),
    ],
)
def test_what_a_check_takes(check: str, arguments: str, value: object, expected: str) -> None:
    assert beyond(check, arguments, value) == expected


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        (CONTROLLERS, PARAMS),
        (VIEW, RVIZ),
        (ROW, BRIDGE),
        (MOVEIT_LIMITS, MOVEIT),
        ("arm:\n  kinematics_solver: kdl/KDL\n", MOVEIT),
        ("image: map.pgm\nresolution: 0.05\n", ""),
        ("on: [push]\njobs: {}\n", ""),
        ("", ""),
    ],
)
def test_files_are_told_apart_by_their_text(text: str, kind: str) -> None:
    assert kind_of(text.encode()) == kind


def test_controllers_of_moveit_are_those_of_the_parameters_beside_them(tmp_path: Path) -> None:
    moveit = (
        "moveit_simple_controller_manager:\n  controller_names: [arm]\n"
        "  arm: {type: FollowJointTrajectory, action_ns: follow_joint_trajectory, joints: [JOINTS]}\n"
    )
    (tmp_path / "ros2_controllers.yaml").write_text(CONTROLLERS)
    right = moveit.replace("JOINTS", "left_wheel_joint, right_wheel_joint")
    assert found(right, tmp_path) == []
    assert found(right.replace("arm", "amr"), tmp_path) == ["MB857:3"]
    both = found(right.replace("left_wheel_joint", "elbow"), tmp_path)
    assert sorted(both) == ["MB854:3", "MB857:3"]
    assert found(right.replace("_trajectory,", "_trajectories,"), tmp_path) == ["MB857:3"]
    (tmp_path / "ros2_controllers.yaml").unlink()
    assert found(right.replace("arm", "amr"), tmp_path) == []


def test_sizes_are_those_of_one_of_several_descriptions(tmp_path: Path) -> None:
    (tmp_path / "urdf").mkdir()
    wide = (ROBOTS / "rover_gz.urdf").read_text().replace("0.17 0", "0.25 0")
    (tmp_path / "urdf/wide.urdf").write_text(wide)
    assert found(CONTROLLERS.replace("0.34", "0.5"), tmp_path) == []
    assert found(CONTROLLERS.replace("0.34", "0.8"), tmp_path) == ["MB856:10"]


@pytest.mark.slow
def test_the_known_parameters_are_those_of_the_sources() -> None:
    """After a change: python -m tools.interfaces.declared_table fixtures/interfaces"""
    assert SHIPPED.read_text() == table(FIXTURES / "interfaces")
    assert all(is_known(it) for it in plugin_owners().packages)


@pytest.mark.more
def test_every_class_of_a_package_with_plugins_has_a_plugin() -> None:
    """A class of which nobody knows whose parameters it declares would make a plugin look smaller."""
    known = plugin_owners()
    # They read the names of plugins, which every plugin has.
    servers = {"ControllerServer", "SmootherServer", "BehaviorServer", "Costmap2DROS"}
    # They read docks, scorers and layers of a container, whose names are not known.
    servers |= {"utils", "EdgeScorer", "OperationsManager", "RouteOperationClient"}
    servers |= {"PluginContainerLayer", "CollisionMonitor", "CollisionDetector", "ExclusionZone"}
    for release in RELEASES:
        text = read_packed(FIXTURES / f"interfaces/parameters_{release}.tsv.xz")
        for it in read_parameters(text):
            if it.package in known.packages.values() and it.path.startswith(ID):
                is_known = it.owner in servers or (it.package, it.owner) in known.owners
                assert is_known or it.path == "<id>.plugin", it


def test_a_plugin_is_judged_by_its_release(tmp_path: Path) -> None:
    """optimizer.cpp of MPPI has ``sgf_order`` from Lyrical on; another release's name is no typing
    mistake."""
    file = tmp_path / "nav.yaml"
    head = "controller_server:\n  ros__parameters:\n    A:\n      plugin: "
    file.write_text(f"{head}nav2_mppi_controller::MPPIController\n      sgf_oder: 2\n")
    codes = {it: lint_file(str(file), Settings(distro=it)) for it in ("jazzy", "lyrical")}
    assert [len(its) for its in codes.values()] == [0, 1]
    file.write_text(f"{head}nav2_mppi_controller::MPPIController\n      sgf_order: 2\n")
    (it,) = lint_file(str(file), Settings(distro="jazzy"))
    assert (it.code, it.level) == ("MB870", "note")


@pytest.mark.parametrize("release", ["humble", "jazzy"])
def test_a_trajectory_controller_without_joints_is_told_by_its_release(
    release: str, tmp_path: Path
) -> None:
    """Humble warns (joint_trajectory_controller.cpp:682); from Jazzy on the library refuses it."""
    file = tmp_path / "arm.yaml"
    file.write_text(CONTROLLERS.replace("    joints: [left_wheel_joint, right_wheel_joint]\n", ""))
    (it,) = lint_file(str(file), Settings(distro=release, select=("MB115",)))
    assert it.message == "arm: joints is missing"


def test_a_name_of_older_releases_is_told_with_the_new_one(tmp_path: Path) -> None:
    file = tmp_path / "nav.yaml"
    file.write_text(PLUGINS.replace("raytrace_max_range", "obstacle_range"))
    (it,) = lint_file(str(file), Settings())
    assert (it.code, it.hint) == ("MB110", "did you mean 'scan.obstacle_max_range'?")


@pytest.mark.parametrize(
    ("beside", "code", "hint"),
    [
        ("", "MB110", "did you mean 'enable_odom_tf'?"),
        # The right one is there: the other does nothing, whatever it is near to.
        ("    enable_odom_tf: true\n", "MB111", "nothing reads it; delete it, see "),
    ],
)
def test_a_drive_is_given_the_name_of_another_program(
    beside: str, code: str, hint: str, tmp_path: Path
) -> None:
    file = tmp_path / "drive.yaml"
    head = "controller_manager:\n  ros__parameters:\n    drive:\n      type: "
    own = f"drive:\n  ros__parameters:\n{beside}    publish_tf: false\n"
    file.write_text(f"{head}diff_drive_controller/DiffDriveController\n{own}")
    (it,) = lint_file(str(file), Settings(select=("MB110", "MB111"), distro="jazzy"))
    assert it.code == code
    assert (it.hint or "").startswith(hint)


def test_whoever_sends_a_twist_by_nav2_reads_its_parameter(tmp_path: Path) -> None:
    """nav2_util twist_publisher.hpp and twist_subscriber.hpp declare it on the node that has one."""
    file = tmp_path / "nav.yaml"
    nodes = "controller_server behavior_server velocity_smoother collision_monitor docking_server"
    sections = (
        f"{it}:\n  ros__parameters: {{enable_stamped_cmd_vel: false}}\n"
        for it in (*nodes.split(), "following_server", "loopback_simulator")
    )
    file.write_text("".join(sections))
    for distro in ("jazzy", "kilted", "lyrical"):
        found = lint_file(str(file), Settings(distro=distro))
        assert not [it for it in found if "enable_stamped_cmd_vel" in it.message]


def test_an_empty_name_in_a_list_is_told_for_what_it_is(tmp_path: Path) -> None:
    file = tmp_path / "drive.yaml"
    file.write_text(CONTROLLERS.replace("[left_wheel_joint]", '[left_wheel_joint, ""]', 1))
    (it,) = lint_file(str(file), Settings(select=("MB125",)))
    assert it.message.endswith("and has to be without an empty name")


@pytest.mark.slow
def test_a_tree_is_told_by_its_text_wherever_it_comes_from(tmp_path: Path) -> None:
    """Of all XML files only trees are looked at; Lua comments silence as those of YAML do."""
    tree = (
        '<root BTCPP_format="4">\n<BehaviorTree ID="M"><Go global_frame="/odom"/></BehaviorTree>\n'
    )
    text = f"{tree}</root>\n"
    assert found(text, tmp_path, "tree.xml") == ["MB301:2"]
    assert [it.code for it in lint_data("<stdin>", text.encode(), Settings())] == ["MB301"]
    (tmp_path / "display.launch.xml").write_text("<launch/>\n")
    files = {it.name for it in tmp_path.iterdir() if is_linted(str(it))}
    assert "tree.xml" in files and not files & {"package.xml", "display.launch.xml"}
    silenced = tree.replace("</B", "<!-- urdf-lint: ignore MB301 --></B")
    assert found(f"{silenced}</root>\n", tmp_path, "tree.xml") == []
    lua = 'options = {\n  map_frame = "map",\n  tracking_frame = "/base_link",COMMENT\n}\n'
    assert found(lua.replace("COMMENT", ""), tmp_path, "a.lua") == ["MB301:3"]
    assert found(lua.replace("COMMENT", " -- urdf-lint: ignore MB301"), tmp_path, "a.lua") == []


def test_a_file_that_its_reader_refuses_is_told(tmp_path: Path) -> None:
    """pluginlib of rviz2 has no class rviz/Grid (rviz_common display_factory.cpp)."""
    text = "Visualization Manager:\n  Displays:\n    - Class: rviz/Grid\n"
    assert found(text, tmp_path, "old.rviz") == ["MB101:3"]
    (it,) = lint_file(str(tmp_path / "old.rviz"), Settings())
    assert it.file == str(tmp_path / "old.rviz")


def test_what_stands_for_the_robot_is_left_where_a_description_is_named(tmp_path: Path) -> None:
    """A launch file fills it in, or the controller asks for a joint of that name."""
    (tmp_path / "arm.urdf").write_text(
        "<robot name='r'><link name='a'/><link name='b'/><joint name='j' type='continuous'>"
        "<parent link='a'/><child link='b'/></joint></robot>"
    )
    file = tmp_path / "c.yaml"
    text = "diff:\n  ros__parameters:\n    left_wheel_names: [MARKj, MARKj]\n    odom_frame_id: o\n"
    named = Settings(select=("MB105",), urdf=str(tmp_path / "arm.urdf"))
    for mark, told in (("<robot_namespace>", 1), ("$(var ns)/", 1), ("", 0)):
        file.write_text(text.replace("MARK", mark))
        assert [it.level for it in lint_file(str(file), named)] == ["note"] * told
        assert lint_file(str(file), Settings(select=("MB105",))) == []
