# SPDX-License-Identifier: Apache-2.0
"""What controllers claim, from their parameters. Expectations are from the sources of the controllers:
command_interface_configuration, state_interface_configuration and the names that on_configure makes."""

from __future__ import annotations

import pytest
from given_parameters import given_in

from multibot_rewrite.knowledge.node_sets import load_nodes
from multibot_rewrite.knowledge.records import Claim
from multibot_rewrite.planning.records import Given
from multibot_rewrite.producers.evidence.hardware import Claimed, claimed, claimed_twice, claims_of
from multibot_rewrite.system.records import Place

HERE = Place("c.yaml", 1)


def claims(type_: str, parameters: str, release: str = "jazzy") -> set[str]:
    """``command elbow/position``, ``state ...``: what a controller of this type claims."""
    text = (
        f"controller_manager:\n  ros__parameters:\n    it: {{type: {type_}}}\n"
        f"it:\n  ros__parameters: {{{parameters}}}\n"
    )
    given = given_in(text, release, "c.yaml")
    (it,) = (node for node in given if node.host_name)
    node = load_nodes(release)[it.fact.known]
    return {f"{found.kind} {found.name}" for found in claims_of(node.claims, it)}


def command(*names: str) -> set[str]:
    return {f"command {it}" for it in names}


def state(*names: str) -> set[str]:
    return {f"state {it}" for it in names}


XYZ, XYZW = ("x", "y", "z"), ("x", "y", "z", "w")


def of(owner: str, *interfaces: str) -> tuple[str, ...]:
    return tuple(f"{owner}/{it}" for it in interfaces)


ROS2_CONTROLLERS = [
    ("joint_state_broadcaster/JointStateBroadcaster", "", set()),
    ("joint_state_broadcaster/JointStateBroadcaster", "joints: [a], interfaces: []", set()),
    (
        "joint_state_broadcaster/JointStateBroadcaster",
        "joints: [a, b], interfaces: [position]",
        state("a/position", "b/position"),
    ),
    (
        "joint_trajectory_controller/JointTrajectoryController",
        "joints: [a], command_interfaces: [position], state_interfaces: [position, velocity]",
        command("a/position") | state("a/position", "a/velocity"),
    ),
    (
        "joint_trajectory_controller/JointTrajectoryController",
        "joints: [a], command_joints: [pid/a], command_interfaces: [velocity], "
        "state_interfaces: [position], "
        "speed_scaling: {state_interface: scale/factor, command_interface: scale/cmd}",
        command("pid/a/velocity", "scale/cmd") | state("a/position", "scale/factor"),
    ),
    (
        "forward_command_controller/ForwardCommandController",
        "joints: [a, b], interface_name: velocity",
        command("a/velocity", "b/velocity"),
    ),
    (
        "forward_command_controller/MultiInterfaceForwardCommandController",
        "joint: a, interface_names: [kp, kd]",
        command("a/kp", "a/kd"),
    ),
    ("position_controllers/JointGroupPositionController", "joints: [a]", command("a/position")),
    ("velocity_controllers/JointGroupVelocityController", "joints: [a]", command("a/velocity")),
    ("effort_controllers/JointGroupEffortController", "joints: [a]", command("a/effort")),
    (
        "diff_drive_controller/DiffDriveController",
        "left_wheel_names: [l], right_wheel_names: [r]",
        command("l/velocity", "r/velocity") | state("l/position", "r/position"),
    ),
    (
        "diff_drive_controller/DiffDriveController",
        "left_wheel_names: [l], right_wheel_names: [r], position_feedback: false",
        command("l/velocity", "r/velocity") | state("l/velocity", "r/velocity"),
    ),
    (
        "diff_drive_controller/DiffDriveController",
        "left_wheel_names: [l], right_wheel_names: [r], open_loop: true",
        command("l/velocity", "r/velocity"),
    ),
    (
        "tricycle_controller/TricycleController",
        "traction_joint_name: t, steering_joint_name: s",
        command("t/velocity", "s/position") | state("t/velocity", "s/position"),
    ),
    (
        "ackermann_steering_controller/AckermannSteeringController",
        "traction_joints_names: [t], steering_joints_names: [s], position_feedback: true",
        command("t/velocity", "s/position") | state("t/position", "s/position"),
    ),
    (
        "bicycle_steering_controller/BicycleSteeringController",
        "rear_wheels_names: [t], front_wheels_names: [s]",
        command("t/velocity", "s/position") | state("t/velocity", "s/position"),
    ),
    (
        "tricycle_steering_controller/TricycleSteeringController",
        "front_steering: false, rear_wheels_names: [s], front_wheels_names: [t], "
        "front_wheels_state_names: [tt], rear_wheels_state_names: [ss]",
        command("t/velocity", "s/position") | state("tt/velocity", "ss/position"),
    ),
    (
        "mecanum_drive_controller/MecanumDriveController",
        "front_left_wheel_command_joint_name: a, front_right_wheel_command_joint_name: b, "
        "rear_right_wheel_command_joint_name: c, rear_left_wheel_command_joint_name: d, "
        "rear_left_wheel_state_joint_name: dd",
        command("a/velocity", "b/velocity", "c/velocity", "d/velocity")
        | state("a/velocity", "b/velocity", "c/velocity", "dd/velocity"),
    ),
    (
        "omni_wheel_drive_controller/OmniWheelDriveController",
        "wheel_names: [a, b, c], position_feedback: false",
        command("a/velocity", "b/velocity", "c/velocity")
        | state("a/velocity", "b/velocity", "c/velocity"),
    ),
    (
        "imu_sensor_broadcaster/IMUSensorBroadcaster",
        "sensor_name: imu",
        state(
            *(f"imu/orientation.{it}" for it in XYZW),
            *(f"imu/angular_velocity.{it}" for it in XYZ),
            *(f"imu/linear_acceleration.{it}" for it in XYZ),
        ),
    ),
    (
        "force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster",
        "sensor_name: ft",
        state(*(f"ft/{it}.{axis}" for it in ("force", "torque") for axis in XYZ)),
    ),
    (
        "force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster",
        "interface_names: {force: {z: ft/fz}, torque: {x: ft/tx}}",
        state("ft/fz", "ft/tx"),
    ),
    ("range_sensor_broadcaster/RangeSensorBroadcaster", "sensor_name: r", state("r/range")),
    (
        "magnetometer_broadcaster/MagnetometerBroadcaster",
        "sensor_name: m",
        state(*(f"m/magnetic_field.{it}" for it in XYZ)),
    ),
    (
        "gps_sensor_broadcaster/GPSSensorBroadcaster",
        "sensor_name: g, read_covariance_from_interface: true",
        state(
            *of("g", "status", "service", "latitude", "longitude", "altitude"),
            *(f"g/{it}_covariance" for it in ("latitude", "longitude", "altitude")),
        ),
    ),
    (
        "pose_broadcaster/PoseBroadcaster",
        "pose_name: p",
        state(*(f"p/position.{it}" for it in XYZ), *(f"p/orientation.{it}" for it in XYZW)),
    ),
    (
        "battery_state_broadcaster/BatteryStateBroadcaster",
        "batteries: [a, b], interfaces: {a: {battery_current: true}, b: {battery_current: false}}",
        state("a/battery_voltage", "b/battery_voltage", "a/battery_current"),
    ),
    ("battery_state_broadcaster/BatteryStateBroadcaster", "sensor_name: a", state("a/voltage")),
    (
        "position_controllers/GripperActionController",
        "joint: g",
        command("g/position") | state("g/position", "g/velocity"),
    ),
    (
        "effort_controllers/GripperActionController",
        "joint: g",
        command("g/effort") | state("g/position", "g/velocity"),
    ),
    (
        "parallel_gripper_action_controller/GripperActionController",
        "joint: g, max_effort_interface: g/set_effort",
        command("g/position", "g/set_effort") | state("g/position", "g/velocity"),
    ),
    (
        "pid_controller/PidController",
        "dof_names: [a], command_interface: effort, "
        "reference_and_state_interfaces: [position, velocity]",
        command("a/effort") | state("a/position", "a/velocity"),
    ),
    (
        "pid_controller/PidController",
        "dof_names: [a], command_interface: effort, reference_and_state_interfaces: [position], "
        "use_external_measured_states: true",
        command("a/effort"),
    ),
    (
        "admittance_controller/AdmittanceController",
        "joints: [a], command_interfaces: [position], state_interfaces: [position], "
        "ft_sensor: {name: ft}",
        command("a/position")
        | state("a/position", *(f"ft/{it}.{axis}" for it in ("force", "torque") for axis in XYZ)),
    ),
    (
        "gpio_controllers/GpioCommandController",
        "gpios: [in, out], command_interfaces: {out: {interfaces: [a, b]}}, "
        "state_interfaces: {in: {interfaces: [c]}, out: {interfaces: [a]}}",
        command("out/a", "out/b") | state("in/c", "out/a"),
    ),
    (
        "state_interfaces_broadcaster/StateInterfacesBroadcaster",
        "interfaces: [a/position, io/x]",
        state("a/position", "io/x"),
    ),
    ("chained_filter_controller/ChainedFilter", "input_interfaces: [a/effort]", state("a/effort")),
]


@pytest.mark.parametrize(("type_", "parameters", "expected"), ROS2_CONTROLLERS)
def test_what_controllers_of_ros2_controllers_claim(
    type_: str, parameters: str, expected: set[str]
) -> None:
    assert claims(type_, parameters) == expected


def test_a_release_may_claim_more() -> None:
    """Humble's diff drive claims the wheels' states in an open loop, too."""
    wheels = "left_wheel_names: [l], right_wheel_names: [r], open_loop: true"
    found = claims("diff_drive_controller/DiffDriveController", wheels, "humble")
    assert found == command("l/velocity", "r/velocity") | state("l/position", "r/position")


RPY = ("x", "y", "z", "rx", "ry", "rz")
PASSED = ("positions", "velocities", "accelerations")
POSE = tuple(str(it) for it in range(16))
ARM = tuple(f"joint{it}" for it in range(1, 8))
VENDORS = [
    (
        "ur_controllers/SpeedScalingStateBroadcaster",
        "tf_prefix: l_",
        state("l_speed_scaling/speed_scaling_factor"),
    ),
    (
        "ur_controllers/ForceModeController",
        'tf_prefix: ""',
        command(
            *(
                f"force_mode/{it}_{axis}"
                for it in ("task_frame", "selection_vector", "wrench", "limits")
                for axis in RPY
            ),
            *of("force_mode", "type", "force_mode_async_success", "disable_cmd", "damping"),
            "force_mode/gain_scaling",
        )
        | state("system_interface/initialized"),
    ),
    (
        "ur_controllers/FrictionModelController",
        "",
        command(
            *(f"friction_model/{it}_{at}" for it in ("viscous", "coulomb") for at in range(6)),
            "friction_model/async_success",
        ),
    ),
    (
        "ur_controllers/FreedriveModeController",
        "",
        command(*of("freedrive_mode", "async_success", "enable", "abort")),
    ),
    (
        "ur_controllers/PassthroughTrajectoryController",
        "tf_prefix: l_, joints: [l_a], state_interfaces: [position], "
        "speed_scaling_interface_name: l_speed_scaling/speed_scaling_factor",
        command(
            *(f"l_trajectory_passthrough/setpoint_{it}_{at}" for it in PASSED for at in range(6)),
            *of("l_trajectory_passthrough", "abort", "transfer_state", "time_from_start"),
            "l_trajectory_passthrough/trajectory_size",
        )
        | state("l_a/position", "l_speed_scaling/speed_scaling_factor"),
    ),
    (
        "ur_controllers/ToolContactController",
        "",
        command("tool_contact/tool_contact_set_state")
        | state(*of("tool_contact", "tool_contact_result", "tool_contact_state"))
        | state("get_robot_software_version/get_version_major"),
    ),
    (
        "ur_controllers/URConfigurationController",
        "",
        state(
            *(
                f"get_robot_software_version/get_version_{it}"
                for it in ("major", "minor", "build", "bugfix")
            )
        ),
    ),
    (
        "ur_controllers/GravityUpdateController",
        "tf_prefix: l_",
        command(*of("l_gravity", "x", "y", "z", "gravity_async_success")),
    ),
    (
        "ur_controllers/ScaledJointTrajectoryController",
        "joints: [a], command_interfaces: [position], state_interfaces: [velocity]",
        command("a/position") | state("a/velocity", "speed_scaling/speed_scaling_factor"),
    ),
    (
        "franka_robot_state_broadcaster/FrankaRobotStateBroadcaster",
        "arm_prefix: left, robot_type: fp3",
        state("left_fp3/robot_state"),
    ),
    (
        "franka_robot_state_broadcaster/FrankaRobotStateBroadcaster",
        'arm_prefix: ""',
        state("fr3/robot_state"),
    ),
    (
        "franka_example_controllers/CartesianPoseExampleController",
        "arm_prefix: left",
        command(*(f"left_{it}/cartesian_pose_command" for it in POSE))
        | state(*(f"left_{it}/cartesian_pose_state" for it in POSE)),
    ),
    (
        "franka_example_controllers/ElbowExampleController",
        "",
        command(*(f"{it}/cartesian_velocity" for it in ("vx", "vy", "vz", "wx", "wy", "wz")))
        | command("joint_3_position/elbow_command", "joint_4_sign/elbow_command")
        | state("joint_3_position/elbow_state", "joint_4_sign/elbow_state"),
    ),
    (
        "franka_example_controllers/MoveToStartExampleController",
        "robot_type: fer",
        command(*(f"fer_{it}/effort" for it in ARM))
        | state(*(f"fer_{it}/{of_}" for it in ARM for of_ in ("position", "velocity"))),
    ),
    ("franka_example_controllers/JointImpedanceExampleController", "", set()),
    (
        "franka_example_controllers/ModelExampleController",
        "",
        state("fr3/robot_model", "fr3/robot_state"),
    ),
    (
        "franka_mobile/SwerveIKController",
        "prefix: tmr_",
        command("tmr_joint_0/position", "tmr_joint_1/velocity")
        | command("tmr_joint_2/position", "tmr_joint_3/velocity")
        | state("tmr_joint_0/position", "tmr_joint_1/velocity")
        | state("tmr_joint_2/position", "tmr_joint_3/velocity"),
    ),
    (
        "picknik_twist_controller/PicknikTwistController",
        "joint: tcp, interface_names: [twist.linear.x]",
        command("tcp/twist.linear.x"),
    ),
    (
        "picknik_reset_fault_controller/PicknikResetFaultController",
        "",
        command("reset_fault/command", "reset_fault/async_success")
        | state("reset_fault/internal_fault"),
    ),
    (
        "robotiq_controllers/RobotiqActivationController",
        "default: true",
        command(*of("reactivate_gripper", "reactivate_gripper_cmd", "reactivate_gripper_response")),
    ),
    (
        "twist_mux_controller/TwistMuxController",
        "holonomic: false, command_interface_linear_x: drive/linear/velocity, "
        "command_interface_angular_z: drive/angular/velocity",
        command("drive/linear/velocity", "drive/angular/velocity"),
    ),
    (
        "husarion_mecanum_drive_controller/MecanumDriveController",
        "front_left_wheel_name: a, front_right_wheel_name: b, rear_left_wheel_name: c, "
        "rear_right_wheel_name: d, position_feedback: false",
        command(*(f"{it}/velocity" for it in "abcd")) | state(*(f"{it}/velocity" for it in "abcd")),
    ),
    (
        "low_pass_filter/LowPassFilter",
        "state_interface_prefix: imu, state_interface_names: [a, b]",
        state("imu/a", "imu/b"),
    ),
]


@pytest.mark.parametrize(("type_", "parameters", "expected"), VENDORS)
def test_what_controllers_of_vendors_claim(type_: str, parameters: str, expected: set[str]) -> None:
    assert claims(type_, parameters) == expected


def test_the_status_controller_of_ur_claims_what_its_loops_count() -> None:
    """gpio_controller.cpp: loops of 18 and 2 and 23 names; of 18, 18, 2, 2, 4, 2, 2, 4, 11 and 18."""
    found = claims("ur_controllers/GPIOController", "tf_prefix: l_")
    assert len([it for it in found if it.startswith("command")]) == 18 + 2 + 23
    assert len([it for it in found if it.startswith("state")]) == 36 + 4 + 4 + 4 + 4 + 11 + 18
    assert "command l_gpio/standard_digital_output_cmd_17" in found
    assert not any("_cmd_18" in it or "bit_11" in it for it in found)


def test_motion_primitives_have_25_commands() -> None:
    """motion_primitives_base_controller.cpp reserves 25 and 2."""
    found = claims(
        "motion_primitives_controllers/MotionPrimitivesForwardController", "tf_prefix: a_"
    )
    assert len([it for it in found if it.startswith("command")]) == 25
    assert found >= command("a_motion_primitive/pos_via_qw", "a_motion_primitive/move_time")
    assert {it for it in found if it.startswith("state")} == state(
        "a_motion_primitive/execution_status", "a_motion_primitive/ready_for_new_primitive"
    )


def names(template: str, condition: str = "", **values: object) -> list[str]:
    given = {name: Given(value, HERE) for name, value in values.items()}  # type: ignore[arg-type]
    return [it.name for it in claimed([Claim("state", template, condition)], given)]


def test_the_words_of_templates() -> None:
    assert names("<a|b>/x", a="", b="j") == ["j/x"]
    assert names("<a=>x") == ["x"]
    assert names("<a+_=>x") == ["x"]
    assert names("<a+_=>x", a="left") == ["left_x"]
    assert names("<a>/x") == []
    assert names("[1..3]") == ["1", "2", "3"]
    assert names("<a=p,q>/[x,y]") == ["p/x", "p/y", "q/x", "q/y"]
    assert names("<a>/<{a}.b>", a=["p", "q"], **{"p.b": "x", "q.b": "y"}) == ["p/x", "q/y"]
    assert names("<a>/x", "{a}.on", a=["p", "q"], **{"q.on": True}) == ["q/x"]


def test_an_empty_text_is_a_value_and_no_default() -> None:
    """scaled_joint_trajectory_controller.cpp leaves out an empty speed_scaling_interface_name."""
    assert names("<speed=a/b>") == ["a/b"]
    assert names("<speed=a/b>", speed="") == []
    assert names("<type=fr3>/state", type="") == ["/state"]
    assert names("j/<interfaces=position>", interfaces=[]) == []


def test_a_command_that_two_parameters_name_is_told_with_both_places() -> None:
    """A state may be claimed by several (hardware_interface resource_manager.cpp)."""
    text = (
        "controller_manager:\n  ros__parameters:\n"
        "    it: {type: diff_drive_controller/DiffDriveController}\n"
        "it:\n  ros__parameters:\n    left_wheel_names: [w]\n    right_wheel_names: [w]\n"
    )
    given = given_in(text, file="c.yaml")
    (it,) = (node for node in given if node.host_name)
    found = [*claimed_twice(load_nodes("jazzy")[it.fact.known].claims, it)]
    assert found == [(Claimed("command", "w/velocity", Place("c.yaml", 7)), Place("c.yaml", 6))]
