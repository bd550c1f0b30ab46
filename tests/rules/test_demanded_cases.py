# SPDX-License-Identifier: Apache-2.0
"""What nodes demand of their parameters: each demand where it is not met, and beside it where it is.

The places of the demands in the nodes' sources are in ``knowledge/demanded.schema``.

Of ``rules/files``: declared, demands, given, missing, parameter_facts, plugin_names, plugins,
section_facts.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite.lint.check import lint_file
from multibot_rewrite.rules.settings import Settings

MPPI = "controller_plugins: [M], M.plugin: 'nav2_mppi_controller::MPPIController', "
DWB = "controller_plugins: [D], D.plugin: 'dwb_core::DWBLocalPlanner', "
TYPE = "controller_manager {arm.type: "
JTC = "joint_trajectory_controller {type: joint_trajectory_controller/JointTrajectoryController, "


def said(
    code: str, text: str, folder: Path, distro: str = "jazzy", hints: bool = False
) -> list[str]:
    """Return what is said of a file with a node in each line, its parameters in braces."""
    lines = [line.partition(" ") for line in text.splitlines()]
    file = folder / "a.yaml"
    file.write_text("".join(f"{node}:\n  ros__parameters: {its}\n" for node, _, its in lines))
    found = lint_file(str(file), Settings(select=tuple(code.split()), distro=distro))
    return [f"{it.level} {it.message}{f'; {it.hint}' * hints}" for it in found]


CONTRADICTIONS = {
    # bt_navigator.cpp:69 registers its own libraries besides those of the parameter.
    "bt_navigator {plugin_lib_names: [a_bt_node, nav2_wait_action_bt_node]}": (
        "warning bt_navigator: plugin_lib_names lists nav2_wait_action_bt_node, which is loaded "
        "without it, so it is registered twice"
    ),
    "diff_drive_controller {left_wheel_names: [a, b], right_wheel_names: [c]}": (
        "error diff_drive_controller: left_wheel_names has 2, and right_wheel_names 1: "
        "they go in pairs"
    ),
    "diff_drive_controller {left_wheel_names: [a, b], right_wheel_names: [c, d]}": "",
    # Both are the same where only one is given.
    "pid_controller {dof_names: [a, b]}": "",
    "pid_controller {dof_names: [a, b], reference_and_state_dof_names: [a]}": (
        "error pid_controller: dof_names has 2, and reference_and_state_dof_names 1: "
        "they go in pairs"
    ),
    "amcl {initial_pose.x: 1.0, set_initial_pose: false}": (
        "warning amcl: initial_pose.x has no effect with set_initial_pose: false"
    ),
    # The default, written down.
    "amcl {initial_pose.x: 0.0, set_initial_pose: false}": (
        "note amcl: initial_pose.x has no effect with set_initial_pose: false"
    ),
    "amcl {initial_pose.x: 1.0, set_initial_pose: true}": "",
    # A launch file may set the other.
    "amcl {initial_pose.x: 1.0}": "",
    "ekf_filter_node {imu0: imu, odom0_config: [true]}": (
        "warning ekf_filter_node: odom0_config has no effect without odom0"
    ),
    "ekf_filter_node {imu0: imu, odom0_config: []}": "",
    "ekf_filter_node {odom0: odom, odom0_config: [true]}": "",
    "ekf_filter_node {odom0: odom, odom0_relative: true, odom0_differential: true}": (
        "warning ekf_filter_node: odom0_relative cannot be true with odom0_differential: true"
    ),
    "ekf_filter_node {odom0: odom, odom0_relative: false, odom0_differential: true}": "",
    "ekf_filter_node {odom0: odom, odom0_relative: true, odom0_differential: false}": "",
    "ekf_filter_node {odom0: odom, odom0_relative: true}": "",
    "ekf_filter_node {odom0: odom, map_frame: odom}": (
        "warning ekf_filter_node: map_frame is 'odom', as odom_frame is; they have to differ"
    ),
    "ekf_filter_node {odom0: odom, map_frame: a, odom_frame: a}": (
        "warning ekf_filter_node: map_frame is 'a', as odom_frame is; they have to differ"
    ),
    "ekf_filter_node {odom0: odom, map_frame: odom, odom_frame: wheels}": "",
    "ekf_filter_node {odom0: odom, world_frame: world}": (
        "warning ekf_filter_node: world_frame is 'world', neither map_frame (map) nor odom_frame"
        " (odom)"
    ),
    "ekf_filter_node {odom0: odom, world_frame: earth, map_frame: earth}": "",
    "ekf_filter_node {odom0: odom, world_frame: map, map_frame: earth}": (
        "warning ekf_filter_node: world_frame is 'map', neither map_frame (earth) nor odom_frame"
        " (odom)"
    ),
    "bt_navigator {plugin_lib_names: [acme, nav2_wait_action_bt_node]}": (
        "warning bt_navigator: plugin_lib_names lists nav2_wait_action_bt_node, which is loaded"
        " without it, so it is registered twice"
    ),
    "bt_navigator {plugin_lib_names: [acme_bt_node, nav2_wait_bt_node_of_acme]}": "",
    "amcl {odom_alpha1: 0.1}": "warning amcl: odom_alpha1 is not read; the node reads alpha1",
    "amcl {odom_alpha1: 0.1, alpha1: 0.1}": "",
    "controller_server {goal_checker_plugin: precise}": (
        "warning controller_server: goal_checker_plugin is not read; the node reads"
        " goal_checker_plugins"
    ),
    "controller_server {goal_checker_plugin: goal_checker}": "",
    # A parameter cannot be a number and have others below it: the node ends.
    "teleop_twist_joy_node {axis_linear: 1}": (
        "error teleop_twist_joy_node: axis_linear is not read; the node reads axis_linear.x"
    ),
    "teleop_twist_joy_node {axis_linear.w: 1}": (
        "warning teleop_twist_joy_node: axis_linear.w is for 'w'; there are x, y, z"
    ),
    "teleop_twist_joy_node {axis_linear.y: 1}": "",
    JTC + "state_interfaces: [velocity]}": (
        "warning joint_trajectory_controller: state_interfaces has 'velocity' without 'position'"
    ),
    JTC + "state_interfaces: [position, acceleration]}": (
        "warning joint_trajectory_controller: state_interfaces has 'acceleration' without"
        " 'velocity'"
    ),
    JTC + "state_interfaces: [position, velocity]}": "",
    "slam_toolbox {map_start_at_dock: true, map_start_pose: [0.0, 0.0, 0.0]}": (
        "warning slam_toolbox: map_start_at_dock cannot be true with map_start_pose"
    ),
    "slam_toolbox {map_start_at_dock: false, map_start_pose: [0.0, 0.0, 0.0]}": "",
    "slam_toolbox {map_start_at_dock: true}": "",
    "controller_server {" + MPPI + "controller_frequency: 10.0, M.model_dt: 0.05}": (
        "error controller_server: M (nav2_mppi_controller::MPPIController): model_dt is 0.05,"
        " below the period of controller_frequency (10.0)"
    ),
    # Another file may have the frequency: with the default of 20 Hz it is too short.
    "controller_server {" + MPPI + "M.model_dt: 0.04}": (
        "warning controller_server: M (nav2_mppi_controller::MPPIController): model_dt is 0.04,"
        " below the period of controller_frequency (20.0)"
    ),
    "controller_server {" + MPPI + "M.model_dt: 0.05}": "",
    "controller_server {" + MPPI + "controller_frequency: 30.0, M.model_dt: 0.05}": "",
    "twist_mux {topics.a.topic: cmd, topics.b.topic: cmd}": (
        "warning twist_mux: topics.b.topic is 'cmd', as topics.a.topic is"
    ),
    "twist_mux {topics.a.topic: cmd, topics.b.topic: joy}": "",
    "twist_mux {topics.a.topic: cmd, locks.b.topic: cmd}": "",
    "lifecycle_manager {node_names: [recoveries_server]}": (
        "warning lifecycle_manager: node_names lists recoveries_server, which is called"
        " behavior_server since Humble"
    ),
    "lifecycle_manager {node_names: [behavior_server]}": "",
    "lifecycle_manager {node_names: [robot1/amcl]}": (
        "warning lifecycle_manager: node_names lists robot1/amcl, and waits for a bond of that name"
    ),
    "lifecycle_manager {node_names: [robot1/amcl], bond_timeout: 4.0}": (
        "warning lifecycle_manager: node_names lists robot1/amcl, and waits for a bond of that name"
    ),
    "lifecycle_manager {node_names: [robot1/amcl], bond_timeout: 0.0}": "",
    "lifecycle_manager {node_names: [map_sever]}\nmap_server {yaml_filename: a}": (
        "warning lifecycle_manager: node_names has 'map_sever', and lacks 'map_server'"
    ),
    "lifecycle_manager {node_names: [map_sever, map_server]}\nmap_server {yaml_filename: a}": "",
    "docking_server {dock_plugins: [a], a.plugin: x::Y, docks: [d], d.type: b}": (
        "warning docking_server: d.type has 'b', which dock_plugins has not"
    ),
    "docking_server {dock_plugins: [a], a.plugin: x::Y, docks: [d], d.type: a}": "",
    "docking_server {docks: [d], d.type: b}": "",
    "amcl {odom_frame_id: map}": "warning amcl: global_frame_id and odom_frame_id are both 'map'",
    "amcl {odom_frame_id: map, tf_broadcast: false}": "",
    "amcl {odom_frame_id: map, global_frame_id: earth}": "",
}


@pytest.mark.parametrize("text", CONTRADICTIONS)
def test_parameters_that_contradict_each_other(text: str, tmp_path: Path) -> None:
    expected = CONTRADICTIONS[text]
    assert said("MB894", text, tmp_path) == [expected] * bool(expected)


WORDS = {
    TYPE + "diff_drive_controller/DiffDriveControler}": (
        "error controller_manager: arm.type is 'diff_drive_controller/DiffDriveControler', which"
        " its package does not have; did you mean diff_drive_controller/DiffDriveController?"
    ),
    # An own class in the namespace of a package.
    TYPE + "diff_drive_controller/AcmeDrive}": (
        "note controller_manager: arm.type is 'diff_drive_controller/AcmeDrive', which its package"
        " does not have; see the plugins of its package"
    ),
    TYPE + "diff_drive_controler/DiffDriveController}": (
        "note controller_manager: arm.type is 'diff_drive_controler/DiffDriveController', a class of"
        " diff_drive_controler, which is not known; did you mean"
        " diff_drive_controller/DiffDriveController?"
    ),
    # A vendor's own package, whose name has that of a known one in it.
    TYPE + "clearpath_mecanum_drive_controller/MecanumDriveController}": (
        "note controller_manager: arm.type is"
        " 'clearpath_mecanum_drive_controller/MecanumDriveController', a class of"
        " clearpath_mecanum_drive_controller, which is not known; did you mean"
        " mecanum_drive_controller/MecanumDriveController?"
    ),
    TYPE + "acme/DiffDriveController}": "",
    TYPE + "'diff_drive_controller::DiffDriveController'}": (
        "warning controller_manager: arm.type is 'diff_drive_controller::DiffDriveController',"
        " which is written differently in jazzy; write diff_drive_controller/DiffDriveController"
    ),
    TYPE + "joint_state_controller/JointStateController}": (
        "error controller_manager: arm.type is 'joint_state_controller/JointStateController',"
        " which ROS 2 has under another name; write joint_state_broadcaster/JointStateBroadcaster"
    ),
    "controller_server {controller_plugins: [F], F.plugin: 'nav2_smac_planner::SmacPlanner2D'}": (
        "error controller_server: F.plugin is 'nav2_smac_planner::SmacPlanner2D', which is a"
        " nav2_core::GlobalPlanner, not a nav2_core::Controller; name a class of that kind"
    ),
    "controller_server {" + DWB + "D.critics: [GoalDits]}": (
        "error controller_server: D (dwb_core::DWBLocalPlanner): no critic of dwb_critics is called"
        " 'GoalDits'; did you mean GoalDist?"
    ),
    "controller_server {" + DWB + "D.critics: [GoalDist, GoalAlignCritic, 'acme::GoalDits']}": "",
    "controller_server {" + DWB + "D.critics: [GoalDits], D.GoalDits.class: acme::A}": "",
    "controller_server {" + DWB + "D.default_critic_namespaces: [a], D.critics: [GoalDits]}": "",
    "controller_server {" + MPPI + "M.critics: [CostCritc]}": (
        "error controller_server: M (nav2_mppi_controller::MPPIController): no critic of"
        " mppi::critics is called 'CostCritc'; did you mean CostCritic?"
    ),
    "controller_server {" + MPPI + "M.critics: [CostCritic]}": "",
    # The package is what is before the first sign.
    "arm {type: diff_drive_controller/drive/DiffDriveController}": (
        "error arm: type is 'diff_drive_controller/drive/DiffDriveController', which its package"
        " does not have; did you mean diff_drive_controller/DiffDriveController?"
    ),
}


@pytest.mark.parametrize("text", WORDS)
def test_classes_of_plugins(text: str, tmp_path: Path) -> None:
    assert said("MB124", text, tmp_path, hints=True) == [WORDS[text]] * bool(WORDS[text])


MISSING = {
    "twist_mux {use_stamped: true, topics.a: {topic: cmd, timeout: 0.5}}": (
        "warning twist_mux: topics.a.priority is missing"
    ),
    "twist_mux {use_stamped: true, topics.a: {topic: cmd, timeout: 0.5, priority: 9}}": "",
    "twist_mux {topics.a: {topic: cmd, timeout: 0.5, priority: 9}}": "",
    "ekf_filter_node {frequency: 30.0}": (
        "warning ekf_filter_node: none of these is set: odom0, pose0, twist0, imu0"
    ),
    "ekf_filter_node {twist0: twist}": "",
    "controller_server {controller_plugins: [Follow]}": (
        "warning controller_server: controller_plugins has Follow, which has no plugin"
    ),
    # The default of the list has a default class.
    "controller_server {controller_plugins: [FollowPath]}": "",
    "collision_monitor {observation_sources: [scan]}": (
        "warning collision_monitor: observation_sources has scan, which has no parameters"
    ),
    "collision_monitor {observation_sources: [scan], scan.topic: scan}": "",
    "controller_manager {arm: {params_file: a.yaml}}": (
        "warning controller_manager: controller arm has no type"
    ),
    "r/controller_manager {arm: {params_file: a.yaml}}": (
        "warning r/controller_manager: controller arm has no type"
    ),
    "controller_manager {arm: {params_file: a.yaml}}\nr/arm {type: acme/Arm}": "",
    "controller_manager {arm: {type: acme/Arm}}": "",
    "controller_manager {arm: {plugin: acme/Arm}}": "",
    "controller_manager {hardware_components_initial_state: {inactive: [arm]}}": "",
    "acme_manager {arm: {params_file: a.yaml}}": "",
}


@pytest.mark.parametrize("text", MISSING)
def test_parameters_that_are_missing(text: str, tmp_path: Path) -> None:
    assert said("MB115", text, tmp_path) == [MISSING[text]] * bool(MISSING[text])


BOUNDS = {
    "amcl {min_particles: 500, max_particles: 100}": (
        "warning amcl: min_particles is 500, above max_particles (100)"
    ),
    "amcl {min_particles: 100, max_particles: 100}": "",
    # No limit, or that of the sensor.
    "amcl {laser_min_range: 0.1, laser_max_range: -1.0}": "",
    "amcl {laser_min_range: 0.1, laser_max_range: 0.0}": (
        "warning amcl: laser_min_range is 0.1, above laser_max_range (0.0)"
    ),
}


@pytest.mark.parametrize("text", BOUNDS)
def test_ends_of_a_range(text: str, tmp_path: Path) -> None:
    assert said("MB125", text, tmp_path) == [BOUNDS[text]] * bool(BOUNDS[text])


@pytest.mark.parametrize(
    ("distro", "expected"),
    [
        ("jazzy", []),
        (
            "lyrical",
            ["warning controller_manager: arm.type is 'effort_controllers/GripperActionController',"
             " which is not in lyrical, only in humble, jazzy"],
        ),
    ],
)  # fmt: skip
def test_a_class_of_other_releases(distro: str, expected: list[str], tmp_path: Path) -> None:
    text = TYPE + "effort_controllers/GripperActionController}"
    assert said("MB124", text, tmp_path, distro) == expected


VOXELS = (
    "local_costmap/local_costmap {plugins: [v], v.plugin: 'nav2_costmap_2d::VoxelLayer',"
    " v.observation_sources: scan, "
)
OF_VOXELS = "local_costmap/local_costmap: v (nav2_costmap_2d::VoxelLayer)"
DIFF = "diff {type: diff_drive_controller/DiffDriveController, "
OF_MPPI = "controller_server: M (nav2_mppi_controller::MPPIController)"
THROWS = "rclcpp throws InvalidParameterTypeException, and the node does not come up"
# What generate_parameter_library's files and the code of each node declare.
DECLARED = {
    VOXELS + "v.scan.raytrace_max_rnge: 3.0}": (
        f"warning {OF_VOXELS} has no parameter 'scan.raytrace_max_rnge'; did you mean"
        " 'scan.raytrace_max_range'?"
    ),
    # In a block of a block it has none.
    VOXELS + "v.scan.a.raytrace_max_rnge: 3.0}": "",
    # The name of Foxy, unless that of today is there, too.
    VOXELS + "v.scan.obstacle_range: 3.0}": (
        f"warning {OF_VOXELS} has no parameter 'scan.obstacle_range'; did you mean"
        " 'scan.obstacle_max_range'?"
    ),
    VOXELS + "v.scan.obstacle_range: 3.0, v.scan.obstacle_max_range: 3.0}": "",
    VOXELS + "v.scan.clearing: 'true'}": (
        f"error {OF_VOXELS}: scan.clearing is a string, not a bool; {THROWS}"
    ),
    VOXELS + "v.z_voxels: 16.5}": f"error {OF_VOXELS}: z_voxels is a double, not an int; {THROWS}",
    "amcl {max_particels: 20}": (
        "warning amcl has no parameter 'max_particels'; did you mean 'max_particles'?"
    ),
    "amcl {max_particels: 20, max_particles: 30}": "",
    # Others may read it.
    "amcl {acme: 20}": "",
    "amcl {alpha1: 1}": "error amcl: alpha1 is an int, not a double; write 1.0",
    "amcl {alpha1: []}": "",
    "amcl {alpha1: ALPHA_ONE}": "",
    "amcl {tf_broadcast: 1}": f"error amcl: tf_broadcast is an int, not a bool; {THROWS}",
    JTC + "joints: j}": (
        f"error joint_trajectory_controller: joints is a string, not a string_array; {THROWS}"
    ),
    JTC + "joints: [1]}": (
        f"error joint_trajectory_controller: joints is an int_array, not a string_array; {THROWS}"
    ),
    JTC + "gains.j.p: 1}": (
        "error joint_trajectory_controller: gains.j.p is an int, not a double; write 1.0"
    ),
    JTC + "constraints.j.trajectory: 0.1, joints: [k]}": (
        "note joint_trajectory_controller: constraints.j.trajectory is for 'j', which is not in"
        " joints; nothing reads it"
    ),
    JTC + "constraints.k.trajectory: 0.1, joints: [k]}": "",
    JTC + "action_monitor_rate: 0}": (
        "error joint_trajectory_controller: action_monitor_rate is an int, not a double; write 0.0"
    ),
    # What every node has, whoever wrote it.
    "amcl {use_sim_time: 'true'}": f"error amcl: use_sim_time is a string, not a bool; {THROWS}",
    "acme {use_sim_time: 'true'}": f"error acme: use_sim_time is a string, not a bool; {THROWS}",
    "acme {use_sim_time: true}": "",
    # Whose section it is: by its type, its name, or all parameters that tell a controller.
    **{
        f"{it} action_monitor_rate: 1}}": (
            f"error {it.split()[0]}: action_monitor_rate is an int, not a double; write 1.0" * known
        )
        for it, known in (
            (
                "arm {joints: [a], command_interfaces: [position], state_interfaces: [position],",
                True,
            ),
            ("arm {joints: [a], command_interfaces: [position],", False),
            (
                "arm {type: acme/Arm, joints: [a], command_interfaces: [position],"
                " state_interfaces: [position],",
                False,
            ),
            ("joint_trajectory_controller {", True),
            ("my_joint_trajectory_controller {", False),
        )
    },
    DIFF + "wheel_radius: 0}": "error diff: wheel_radius is an int, not a double; write 0.0",
    DIFF + "publish_tf: true}": (
        "warning diff has no parameter 'publish_tf'; did you mean 'enable_odom_tf'?"
    ),
    DIFF + "linear.x.has_jerk: true}": (
        "warning diff has no parameter 'linear.x.has_jerk'; did you mean"
        " 'linear.x.has_jerk_limits'?"
    ),
    DIFF + "linear.x.max_velocty: 1.0}": (
        "warning diff has no parameter 'linear.x.max_velocty'; did you mean"
        " 'linear.x.max_velocity'?"
    ),
    DIFF + "pose_covariance_diagonal: [1, 2, 3, 4, 5, 6]}": (
        "error diff: pose_covariance_diagonal is an int_array, not a double_array; write [1.0, 2.0,"
        " 3.0, 4.0, 5.0, 6.0]"
    ),
    "controller_server {" + MPPI + "M.batch_siz: 1}": (
        f"warning {OF_MPPI} has no parameter 'batch_siz'; did you mean 'batch_size'?"
    ),
    "controller_server {" + MPPI + "M.acme: 1}": "",
    "controller_server {" + DWB + "D.critics: [GoalDist], D.GoalDist.scal: 1.0}": (
        "warning controller_server: D.GoalDist (dwb_critics::GoalDistCritic) has no parameter"
        " 'scal'; did you mean 'scale'?"
    ),
    TYPE + "joint_trajectory_controller/JointTrajectoryController, arm.joints: [a]}": (
        "warning controller_manager: arm.joints is a parameter of arm, and not read here; move it"
        " to arm: ros__parameters:"
    ),
    TYPE + "joint_trajectory_controller/JointTrajectoryController, arm.params_file: a}": "",
}


@pytest.mark.parametrize("text", DECLARED)
def test_parameters_that_a_node_does_not_declare_or_not_so(text: str, tmp_path: Path) -> None:
    found = said("MB110 MB111 MB120 MB125", text, tmp_path, hints=True)
    assert found == [DECLARED[text]] * bool(DECLARED[text])


BEYOND = {
    DIFF + "wheel_radius: 0.0}": "diff: wheel_radius is 0.0, and has to be above 0.0",
    # rcppmath rolling_mean_accumulator.hpp: the index modulo the size.
    DIFF + "velocity_rolling_window_size: 0}": (
        "diff: velocity_rolling_window_size is 0, and has to be above 0"
    ),
    DIFF + "wheel_radius: 0.1}": "",
    DIFF + "pose_covariance_diagonal: [1.0, 2.0]}": (
        "diff: pose_covariance_diagonal is [1.0, 2.0], and has to be with a size above 5"
    ),
    JTC + "action_monitor_rate: 0.0}": (
        "joint_trajectory_controller: action_monitor_rate is 0.0, and has to be at least 0.1"
    ),
    JTC + "command_interfaces: [posiion]}": (
        "joint_trajectory_controller: command_interfaces is ['posiion'], and has to be of position,"
        " velocity, acceleration, effort"
    ),
    "controller_server {" + MPPI + "M.batch_size: -1}": (
        f"{OF_MPPI}: batch_size is -1, and has to be above 0"
    ),
    "controller_server {controller_frequency: 0.0}": (
        "controller_server: controller_frequency is 0.0, and has to be above 0.0"
    ),
}


@pytest.mark.parametrize("text", BEYOND)
def test_values_that_a_node_refuses(text: str, tmp_path: Path) -> None:
    expected = [f"warning {BEYOND[text]}"] if BEYOND[text] else []
    assert said("MB120 MB125", text, tmp_path) == expected
