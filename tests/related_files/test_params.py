# SPDX-License-Identifier: Apache-2.0
"""Parameter files: sections, names, defaults, and each pitfall of such files by its name."""

from __future__ import annotations

import re

import pytest
import yaml
from beside import findings_of
from hypothesis import given, strategies as st
from made_params import DECLARED, JOINTS, L1, L2, L3, L4, LINKS, codes, made, section, setting
from paths import ROOT
from related_file_calls import (
    NAMESPACE_SLOT,
    NEWEST_LTS,
    built_in,
    built_in_nodes,
    extend,
    fill_template,
    is_for,
    load_known_nodes,
    make_context,
    make_naming,
    nodes_of_set,
    read_yaml,
    rewrite_params,
)

from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.knowledge.node_entries import KINDS
from multibot_rewrite.lint import catalogue

INTERFACES = ("command_interfaces", "state_interfaces", "interfaces")


def value(node: str, line: str, policy: tuple[str, str] = L2, distro: str = "jazzy") -> str:
    """Return what becomes of one line of a node's section; the last line is never an inserted one."""
    text, _ = made(section(node, line), policy, distro)
    return text.splitlines()[-1].strip()


# ---------------------------------------------------------------- sections


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("policy", "old", "new"),
    [
        (L2, "planner_server", "/robot1/planner_server"),
        (L2, "/planner_server", "/robot1/planner_server"),
        (L1, "other", "/robot1/other"),
        (L4, "planner_server", "/robot1/planner_server"),
        (L4, "smoother_server", "/smoother_server_robot1"),
        (L4, "front/local_costmap/local_costmap", "/robot1/front/local_costmap/local_costmap"),
        (L4, "/other", "/other_robot1"),
        (L2, "/**", "/**"),
        (L4, "/**", "/**"),
        (L2, "/**/planner_server", "/**/planner_server"),
        (L4, "/**/planner_server", "/**/planner_server"),
        (L4, "/**/local_costmap", "/**/local_costmap"),
        (L4, "/**/smoother_server", "/**/smoother_server_robot1"),
        (L2, "/*", "/*"),
        (L2, "/*/planner_server", "/*/planner_server"),
        (L2, "/*/front/driver", "/*/front/driver"),
        (L4, "/*/smoother_server", "/*/smoother_server_robot1"),
        (L2, "front/driver", "/robot1/front/driver"),
        (L4, "front/driver", "/front/driver_robot1"),
        (L2, "<robot_namespace>/amcl_x", "/robot1/amcl_x"),
        (L2, "<area>/amcl_x", "<area>/amcl_x"),
        (L2, '"planner_server"', '"/robot1/planner_server"'),
        # Gazebo is everybody's.
        (L2, "gazebo", "gazebo"),
        (L4, "/gazebo", "/gazebo"),
    ],
)
def test_a_section_is_put_under_the_nodes_full_name(
    policy: tuple[str, str], old: str, new: str
) -> None:
    text, _ = made(section(old, "x: 1"), policy)
    assert text.splitlines()[0] == f"{new}:"


@pytest.mark.parametrize("key", ["robot1", "/robot1", "robot1/", "/"])
def test_the_namespace_of_the_robot_that_a_file_is_for_is_no_name_of_a_node(key: str) -> None:
    """Clearpath's generator writes a key with the namespace alone above the nodes."""
    source = f"{key}:\n  twist_server_node:\n    ros__parameters: {{a: 1}}\n"
    assert "MB312" not in codes(made(source, own=("robot1",))[1])
    wrong = source.replace("twist_server_node", "twist-server")
    assert "MB312" in codes(made(wrong, own=("robot1",))[1])


def test_a_node_for_all_robots_keeps_its_section() -> None:
    library = extend(
        built_in(NEWEST_LTS), "node_sets: {s: {nodes: [{node: map_server, shared: true}]}}", "n"
    )
    context = make_context(
        DECLARED, make_naming(layout="L2"), nodes_of_set(library, "s"), distro=NEWEST_LTS
    )  # type: ignore[arg-type]
    source = section("map_server", "topic_name: /map", "frame_id: base_link")
    related_file = rewrite_params(read_yaml((source * 2).encode(), "p"), context)
    assert fill_template(related_file.template, "robot1", "r1") == source * 2
    assert codes(findings_of(related_file)).count("MB886") == 1


def test_a_repeated_key_is_rewritten_twice() -> None:
    text, findings = made(section("amcl", "scan_topic: /a", "scan_topic: /b"))
    assert "scan_topic: /robot1/a" in text
    assert "scan_topic: /robot1/b" in text
    assert "MB859" in codes(findings)


# ---------------------------------------------------------------- names


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("policy", "node", "old", "new"),
    [
        (L2, "amcl", "base_frame_id: base_link", "base_frame_id: r1/base_link"),
        (L1, "amcl", "base_frame_id: base_link", "base_frame_id: base_link"),
        (L4, "amcl", "base_frame_id: 'base_link'", "base_frame_id: 'base_link/r1'"),
        (L2, "amcl", "global_frame_id: map", "global_frame_id: map"),
        (L2, "amcl", "base_frame_id: /base_link", "base_frame_id: r1/base_link"),
        (L2, "tricycle_controller", "base_frame_id: /base_link", "base_frame_id: /r1/base_link"),
        (L2, "amcl", "scan_topic: scan", "scan_topic: scan"),
        (L2, "amcl", "scan_topic: /scan", "scan_topic: /robot1/scan"),
        (L2, "amcl", "scan_topic: ~/scan", "scan_topic: ~/scan"),
        (L1, "amcl", "scan_topic: /scan", "scan_topic: /robot1/scan"),
        (L4, "amcl", "scan_topic: front/scan", "scan_topic: front/scan/robot1"),
        (L2, "other", "scan_topic: /clock", "scan_topic: /clock"),
        (L2, "other", "x_topic: $(var scan)", "x_topic: $(var scan)"),
        (L2, "other", "x_topic: <area>/scan", "x_topic: <area>/scan"),
        (L2, "other", 'x_topic: ""', 'x_topic: ""'),
        (L2, "ekf_filter_node", "odom0: /wheel/odom", "odom0: /robot1/wheel/odom"),
        (L2, "ekf_filter_node", "odom0_config: [true]", "odom0_config: [true]"),
        (L2, "ekf_filter_node", "odom12: /o", "odom12: /robot1/o"),
        (L2, "imu_filter_madgwick", "world_frame: enu", "world_frame: enu"),
        (L2, "other", "world_frame: enu", "world_frame: enu"),
        (L2, "other", "sensor_frame: laser", "sensor_frame: r1/laser"),
        (L2, "other", "joints: [shoulder, 'elbow']", "joints: [r1_shoulder, 'r1_elbow']"),
        (L2, "imu_sensor_broadcaster", "sensor_name: imu_sensor", "sensor_name: r1_imu_sensor"),
        (L2, "gpio_command_controller", "gpios: [io]", "gpios: [r1_io]"),
        (L2, "gpio_command_controller", "state_interfaces.io.interfaces: [a]",
         "state_interfaces.r1_io.interfaces: [a]"),
        (L2, "controller_manager", "hardware_components_initial_state.inactive: [arm]",
         "hardware_components_initial_state.inactive: [r1_arm]"),
        (L2, "move_group", "ompl.g.projection_evaluator: joints(shoulder,elbow)",
         'ompl.g.projection_evaluator: "joints(r1_shoulder,r1_elbow)"'),
        (L2, "lifecycle_manager", "node_names: [amcl]", "node_names: [amcl]"),
        (L4, "lifecycle_manager", "node_names: [amcl]", "node_names: [amcl_robot1]"),
        (L2, "state_interfaces_broadcaster", "interfaces: [elbow/position, io/a]",
         "interfaces: [r1_elbow/position, r1_io/a]"),
        (L2, "camera", "camera_name: front", "camera_name: r1/front"),
        (L2, "motion_primitives_forward_controller", 'tf_prefix: ""', 'tf_prefix: "r1_"'),
        (L2, "move_group", "ros_control_namespace: /", "ros_control_namespace: /robot1"),
        # Chained controllers keep their names in a namespace.
        (L2, "joint_trajectory_controller", "command_joints: [pid/elbow, a/b/elbow]",
         "command_joints: [pid/r1_elbow, a/b/r1_elbow]"),
        (L4, "joint_trajectory_controller", "command_joints: [pid/elbow, a/b/elbow]",
         "command_joints: [pid_robot1/elbow_r1, a_robot1/b_robot1/elbow_r1]"),
        # The mask's topic is resolved by whoever reads it.
        (L2, "costmap_filter_info_server", "mask_topic: keepout_mask",
         "mask_topic: /robot1/keepout_mask"),
        # The topics of a server in its robot's namespace are full names.
        (L4, "controller_server", "odom_topic: wheel_odom", "odom_topic: /wheel_odom/robot1"),
        (L4, "controller_server", "odom_topic: /wheel_odom", "odom_topic: /wheel_odom/robot1"),
        (L4, "bt_navigator", "odom_topic: wheel_odom", "odom_topic: wheel_odom/robot1"),
        # lifecycle_manager.cpp makes a Bond with the name, the node with its get_name().
        (L4, "lifecycle_manager_navigation", "node_names: [controller_server, smoother_server]",
         "node_names: [controller_server, smoother_server_robot1]"),
        # In L4 the table's rules move the default names, and all that nodes make of them: also
        # those of a section with a wildcard.
        (L4, "amcl", "scan_topic: scan", "scan_topic: scan"),
        (L4, "/**/amcl", "scan_topic: scan", "scan_topic: scan"),
        (L4, "ekf_filter_node", "odom0: odom", "odom0: odom/robot1"),
        (L4, "/**/ekf_filter_node", "odom0: odom", "odom0: odom/robot1"),
        (L4, "smoother_server", "costmap_topic: global_costmap/costmap_raw",
         "costmap_topic: global_costmap/costmap_raw"),
        (L4, "slam_toolbox", "scan_topic: /scan", "scan_topic: /scan"),
        # A name below another node follows that node.
        (L4, "other", "map_topic: map_server/x", "map_topic: map_server_robot1/x"),
        (L2, "other", "map_topic: map_server/x", "map_topic: map_server/x"),
        (L2, "joy_teleop", "walk.message_value.header-frame_id.value: base_link",
         "walk.message_value.header-frame_id.value: r1/base_link"),
        # What rcl reads as no string is no name.
        *((L2, "joint_trajectory_controller", *[f"joints: [{word}]"] * 2)
          for word in ("y", "n", "Y", "N", "yes", "on", "1", "1e-9", "1.0", "~", "null")),
        (L2, "usb_cam", "camera_info_url: package://p/<robot_namespace>/camera.yaml",
         'camera_info_url: "package://p/robot1/camera.yaml"'),
        (L2, "v4l2_camera", "camera_info_url: package://p/<robot_namespace>/camera.yaml",
         'camera_info_url: "package://p/robot1/camera.yaml"'),
        (L2, "usb_cam", "camera_info_url: package://base_link/camera.yaml",
         "camera_info_url: package://base_link/camera.yaml"),
        # test_controller_spawner_with_interfaces.yaml of ros2_control; a known one has [position].
        *((L2, "own_controller", f"{key}: [elbow/position, other/position]",
           f"{key}: [r1_elbow/position, other/position]") for key in INTERFACES),
        *((L2, "own_controller", *[f"{key}: [position]"] * 2) for key in INTERFACES),
    ],
)  # fmt: skip
def test_a_name_is_renamed_by_its_kind(
    policy: tuple[str, str], node: str, old: str, new: str
) -> None:
    assert value(node, old, policy) == new


@pytest.mark.parametrize(
    ("lines", "new"),
    [
        (
            ("gains:", "  elbow:", "    p: 1.0", "    i: 0.0"),
            ["  r1_elbow:", "    p: 1.0", "    i: 0.0"],
        ),
        (("gains.elbow.p: 1.0",), ["gains.r1_elbow.p: 1.0"]),
        (("gains:", "  elbow.p: 1.0"), ["gains:", "  r1_elbow.p: 1.0"]),
        (("gains.elbow:", "  {p: 1.0}"), ["gains.r1_elbow:", "  {p: 1.0}"]),
        (("constraints:", "  goal_time: 0.5"), ["constraints:", "  goal_time: 0.5"]),
        (("constraints: {elbow: {goal: 0.1}}",), ["constraints: {r1_elbow: {goal: 0.1}}"]),
    ],
)
def test_keys_that_are_joints_are_renamed_nested_and_dotted(
    lines: tuple[str, ...], new: list[str]
) -> None:
    text, findings = made(section("joint_trajectory_controller", *lines))
    assert [line[4:] for line in text.splitlines()][-len(new) :] == new
    assert not codes(findings)


@pytest.mark.parametrize("end", ["", "\n", "\n\n"])
@pytest.mark.parametrize("above", ["", "/**/", "/<robot_namespace>/"])
def test_a_controller_without_a_section_gets_one_behind_the_last_line(above: str, end: str) -> None:
    kind = "type: diff_drive_controller/DiffDriveController"
    manager = section("controller_manager", "wheels_x:", f"  {kind}").rstrip("\n")
    text, _ = made(f"{above}{manager}{end}")
    read = yaml.safe_load(text)
    key = "/**/wheels_x" if above == "/**/" else "/robot1/wheels_x"
    assert list(read)[1:] == [key]
    assert read[key]["ros__parameters"]["odom_frame_id"] == "r1/odom"
    assert text.count("\n\n") == len(end) // 2


@pytest.mark.parametrize("above", ["", "arm/", "/**/"])
def test_a_controller_with_a_section_in_any_namespace_gets_no_second_one(above: str) -> None:
    kind = "type: diff_drive_controller/DiffDriveController"
    manager = section(f"{above}controller_manager", "wheels_x:", f"  {kind}")
    text, _ = made(manager + section(f"{above}wheels_x", "a: 1"))
    assert len(yaml.safe_load(text)) == 2


# ---------------------------------------------------------------- topics


@pytest.mark.parametrize("written", ["scan", "/scan"])
@pytest.mark.parametrize(
    ("policy", "distro", "new"),
    [
        (L2, "jazzy", "/robot1/scan"),
        (L1, "humble", "/robot1/scan"),
        (L2, "kilted", "scan"),
        (L4, "jazzy", "/scan/robot1"),
        (L4, "kilted", "/scan/robot1"),
    ],
)
def test_topics_of_costmap_layers_leave_the_costmaps_namespace(
    written: str, policy: tuple[str, str], distro: str, new: str
) -> None:
    """nav2 #1433, #3772: below /robot1/local_costmap no node publishes."""
    line = f"layer: {{scan: {{topic: {written}}}}}"
    source = f"local_costmap:\n  local_costmap:\n    ros__parameters:\n      {line}\n"
    text, findings = made(source, policy, distro)
    got = re.findall(r"topic: ([^}]*)}", text)[0]
    lead = "/" if written.startswith("/") and not new.startswith("/") else ""
    assert got == ("/robot1/scan" if lead and policy == L2 else lead + new)
    assert ("MF121" in codes(findings)) == (written == "scan" and distro != "kilted")


@pytest.mark.parametrize("distro", ["jazzy", "kilted", "lyrical"])
def test_a_costmap_reads_the_mask_topic_in_the_namespace_of_its_server(distro: str) -> None:
    """Layout postfix: layer.cpp joins a relative name with the namespace above the costmap."""
    source = section("costmap_filter_info_server", "mask_topic: keepout_mask")
    assert "mask_topic: /keepout_mask/robot1" in made(source, L4, distro)[0]


def test_a_shared_topic_is_written_from_the_root() -> None:
    context = setting(L2, shared_topics=["/map"])
    source = section("amcl", "map_topic: map")
    related_file = rewrite_params(read_yaml(source.encode(), "p"), context)
    assert "map_topic: /map\n" in fill_template(related_file.template, "robot1", "r1")


# ---------------------------------------------------------------- lines that are missing


@pytest.mark.parametrize(
    "source",
    [
        section("/**", "base_frame_id: base_link", "odom_frame_id: odom") + section("amcl", "a: 1"),
        section("amcl", "base_frame_id: base_link") + section("amcl", "odom_frame_id: odom"),
        section("amcl", "base_frame_id: base_link", "odom_frame_id: odom")
        + section("/**/amcl", "a: 1"),
        section("amcl_rclcpp_node", "use_sim_time: true"),
    ],
)
def test_what_is_set_elsewhere_is_not_inserted(source: str) -> None:
    assert "multibot:" not in made(source)[0]


@pytest.mark.parametrize("policy", [L1, L2, L3, L4])
@pytest.mark.parametrize("line", ["publish_rate: 1.0", "tf_frame_prefix_enable: true"])
def test_no_controller_puts_its_namespace_before_frames(policy: tuple[str, str], line: str) -> None:
    """ros2_controllers #482, #1048: the default prefix is the namespace."""
    text, _ = made(section("diff_drive_controller", line), policy)
    assert text.count("tf_frame_prefix_enable: false") == 1
    assert "tf_frame_prefix_enable: true" not in text


def test_a_file_that_no_section_can_be_added_to_is_told() -> None:
    text, findings = made("{amcl: {ros__parameters: {}}}\n", is_first=True)
    assert "smoother_server" not in text
    said = {it.message for it in findings if it.code == "MF124"}
    assert (
        "/<robot>/smoother_server has no section: robot_base_frame: all robots would share the "
        "default, and no line can be inserted here"
    ) in said


# ---------------------------------------------------------------- what is told

NESTED = "{0}:\n  {0}:\n    ros__parameters:\n      robot_base_frame: map\n"
FRAMES = ("base_frame_id: base_link", "odom_frame_id: odom")
POSITION = "/**/setpoint_position"


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("policy", "source", "found"),
    [
        (L2, section("amcl", *FRAMES, "scan_topic: scan"), []),
        (L2, section("robot7/amcl", "x: 1"), ["MB883"]),
        (L2, section("/robot7/local_costmap/local_costmap", "x: 1"), ["MB883"]),
        (L2, section("/robot7/**", "x: 1"), ["MB883"]),
        (L2, section("abb/driver", "x: 1"), ["MB883"]),
        (L2, section("bad-name", "x: 1"), ["MB312"]),
        (L2, section("1node", "x: 1"), ["MB312"]),
        (L2, section("robot*", "x: 1"), ["MB312"]),
        (L2, section("<area>", "x: 1"), ["MB105"]),
        # A slash above a node is the root's namespace, alone it is no node.
        (L2, "/:\n  amcl:\n    ros__parameters: {base_frame_id: base_link}\n", []),
        (L2, "/:\n  ros__parameters: {a: 1}\n", ["MB312"]),
        # A wildcard behind an exact section wins.
        (L2, section("amcl", "alpha1: 0.1") + section("/**", "alpha1: 0.2"), ["MB867"]),
        (L2, section("/**", "alpha1: 0.2") + section("amcl", "alpha1: 0.1"), []),
        (L2, section("amcl", "alpha1: 0.1") + section("/**/other", "alpha1: 0.2"), []),
        *((L2, section("own_controller", f"{key}: [elbow/position, other/position]"),
           ["MB901", "MB854"]) for key in INTERFACES),
        # What is no interface of the robot.
        *((L2, section("other", f"what: [{word}]"), []) for word in
          ("wrist/position", "elbow/", "elbow_x/position", "/scan/elbow", "imu_sensor/data")),
        # Nothing can be inserted, or decided.
        (L2, section("diff_drive_controller", "tf_frame_prefix_enable: $(var p)"),
         ["MB105", "MF116"]),
        (L2, "smoother_server:\n  ros__parameters: !!map\n    x: 1\n", []),
        (L2, "smoother_server:\n  ros__parameters:\n    ? x\n    : 1\n", ["MF124"]),
        # A prefix cannot be a postfix.
        (L4, section("camera", "x: 1"), ["MB422"]),
        (L4, section("camera", "camera_name: front"), ["MB422"]),
        # mavros px4_config.yaml: it has a camera that is no realsense.
        (L4, section(POSITION, "mav_frame: LOCAL_NED") + section("/**/camera", "camera_name: eye"),
         ["MB422"]),
        (L4, section(POSITION, "mav_frame: LOCAL_NED")
         + section("/**/camera", "frame_id: base_link"), []),
        (L4, section(POSITION, "rate: 1.0") + section("/**/camera", "frame_id: base_link"),
         ["MB422"]),
        # mavros setpoint_position.cpp: mav_frame is one of MAV_FRAME.
        (L2, section(POSITION, "mav_frame: LOCAL_NED"), []),
        # Calibrations below a camera: spinnaker_camera_driver's node for several.
        (L2, section("driver", "cam_0: {camerainfo_url: 'file:///a.yaml'}"), ["MB412"]),
        (L2, section("driver", "cam_1.camerainfo_url: 'file:///a.yaml'"), ["MB412"]),
        (L2, section("driver", "cam_1.camerainfo_url: ''"), []),
    ],
)  # fmt: skip
def test_all_that_is_said_of_a_file(policy: tuple[str, str], source: str, found: list[str]) -> None:
    assert codes(made(source, policy)[1]) == found


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("policy", "source", "kept", "code"),
    [
        # Only tf takes a name with white space, for a frame that is the same for all robots.
        (L2, section("amcl", 'scan_topic: "scan "'), 'scan_topic: "scan "', "MB312"),
        (L2, section("amcl", 'odom_frame_id: "odom "'), 'odom_frame_id: "odom "', "MB865"),
        (L2, section("amcl", 'base_frame_id: "base link"'), 'base_frame_id: "base link"', "MB865"),
        (L2, section("amcl", "scan_topic: 1st/scan"), "scan_topic: 1st/scan", "MB312"),
        (L2, section("amcl", "scan_topic: a//scan"), "scan_topic: a//scan", "MB312"),
        (L2, section("amcl", f"scan_topic: {'s' * 999}"), f"scan_topic: {'s' * 999}", "MB312"),
        (L4, section("camera", "camera_name: front"), "camera_name: front", "MB422"),
        (L2, section(POSITION, "mav_frame: LOCAL_NED"), "mav_frame: LOCAL_NED", ""),
        # As rcl_yaml_param_parser reads it: the node is /amcl.
        (L2, "/:\n  amcl:\n    ros__parameters: {base_frame_id: base_link}\n",
         "/robot1:\n  amcl:", ""),
        (L2, "/:\n  amcl:\n    ros__parameters: {base_frame_id: base_link}\n", "r1/base_link", ""),
        # A costmap keeps its name: its code sets it (nav2_costmap_2d costmap_2d_ros.cpp).
        (L2, NESTED.format("local_costmap"), "/robot1/local_costmap:\n  local_costmap:", ""),
        (L4, NESTED.format("local_costmap"), "/robot1/local_costmap:\n  local_costmap:", ""),
        (L4, NESTED.format("front"), "/front:\n  front_robot1:", ""),
        # What the node would put before the robot's name.
        (L2, section("robot_state_publisher", "frame_prefix: a/"), 'frame_prefix: ""', "MB882"),
        # It is known by its parameters.
        (L2, section("rover_base", "left_wheel_names: [left_wheel]",
                     "right_wheel_names: [right_wheel]"), "tf_frame_prefix_enable: false", ""),
    ],
)  # fmt: skip
def test_what_is_in_the_text_and_said_of_it(
    policy: tuple[str, str], source: str, kept: str, code: str
) -> None:
    text, findings = made(source, policy)
    assert kept in text
    assert not code or code in codes(findings)


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("node", "line", "code", "words"),
    [
        ("joint_trajectory_controller", "joints: [elbov]", "MB854", "did you mean 'elbow'"),
        ("amcl", "base_frame_id: base_lnk", "MB853", "did you mean 'base_link'"),
        ("imu_sensor_broadcaster", "sensor_name: imu", "MB854", "is in no description"),
        ("other", "what: elbow", "MB901", "is a joint of the robot"),
        ("other", "elbow: 1.0", "MB901", "is a joint of the robot"),
        ("other", "what: [1st, base_link]", "MB901", "is a link of the robot"),
        ("other", "what: [elbow/position]", "MB901", "is an interface of the robot"),
        ("other", "what: chained/elbow/velocity", "MB901", "is an interface of the robot"),
        ("other", "what: imu_sensor/orientation.x", "MB901", "is an interface of the robot"),
        ("other", "x_topic: /x", "MB901", "guessed: x_topic"),
        ("foxglove_bridge", 'topic_whitelist: ["/scan.*"]', "MB881", "not rewritten"),
        ("robot_state_publisher", "frame_prefix: a/", "MB882", "already have"),
        ("rtabmap", "database_path: /tmp/x", "MB412", "the same for all robots"),
        ("amcl", "scan_topic: $(var s)", "MB105", "a launch file must replace it"),
        ("amcl", "scan_topic:", "MB868", "rcl rejects"),
        ("amcl", "base_frame_id: |\n      base_link", "MB876", "on one line"),
        ("amcl", "base_frame_id: >-\n      base_link", "MB876", "on one line"),
        *(
            ("own_controller", f"{key}: [elbow/position, other/position]", "MB854", "'other'")
            for key in INTERFACES
        ),
    ],
)
def test_mistakes_in_names_are_reported(node: str, line: str, code: str, words: str) -> None:
    _, findings = made(section(node, line))
    found = [str(it) for it in findings if it.code == code]
    assert found
    assert words in found[0]
    assert found[0].startswith("p.yaml:3:")


def test_one_key_cannot_be_two() -> None:
    text = "node_sets: {s: {nodes: [{node: local_costmap/local_costmap, shared: true}]}}"
    nodes = nodes_of_set(extend(built_in(NEWEST_LTS), text, "n"), "s")
    context = make_context(DECLARED, make_naming(layout="L2"), nodes, distro=NEWEST_LTS)  # type: ignore[arg-type]
    inner = "    ros__parameters: {use_sim_time: true}\n"
    source = f"local_costmap:\n  local_costmap:\n{inner}  local_costmap_client:\n{inner}"
    found = rewrite_params(read_yaml(source.encode(), "p"), context).findings
    assert ("MF101", "error") in [(it.code, it.level) for it in found]


def test_a_topic_with_a_wrong_target_by_a_rule_is_reported() -> None:
    """At the root ``/scan:=front`` takes the relative ``scan`` too, in a namespace it does not."""
    text = "node_sets: {s: {nodes: [{node: slam_toolbox, remaps: {/scan: front}}]}}"
    nodes = nodes_of_set(extend(built_in(NEWEST_LTS), text, "n"), "s")
    context = make_context(DECLARED, make_naming(layout="L2"), nodes, distro=NEWEST_LTS)  # type: ignore[arg-type]
    document = read_yaml(section("slam_toolbox", "scan_topic: scan").encode(), "p")
    found = rewrite_params(document, context, facts=nodes).findings
    assert [it.message for it in found if it.code == "MF120"] == [
        "scan_topic: remap rules turn scan into /<robot>/scan"
    ]


# ---------------------------------------------------------------- files that are refused


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "it is empty"),
        ("a: 1\n", "for ROS 1 or a node reads it directly"),
        ("- {topic_name: x}\n", "list it under bridge"),
        ("Panels: []\n", "an RViz config; list it under rviz"),
        ("image: m.pgm\nresolution: 0.1\n", "a map"),
        ("joint_limits: {a: {}}\n", "list it under moveit"),
        ("arm: {kinematics_solver: x}\n", "list it under moveit"),
        ("word\n", "a single value"),
        ("ros__parameters: {a: 1}\n", "has no node name above it"),
        ("a: {ros__parameters: 1}\n", "must hold names and values"),
        ("a: &x {ros__parameters: {b: 1}}\n", "anchors"),
        ("a:\n  ros__parameters:\n    b: &x 1\n    c: *x\n", "anchors"),
        ("a:\n\tros__parameters: {}\n", "a tab"),
        ("a: {ros__parameters: {[1]: 2}}\n", "a key is a mapping or a list"),
        ("[1]: {ros__parameters: {a: 2}}\n", "a key is a mapping or a list"),
        ("a: {ros__parameters: {b: 1}}\n---\nc: 1\n", "more than one document"),
        (f"a: {{ros__parameters: {{b: {NAMESPACE_SLOT}}}}}\n", "reserved for this tool"),
    ],
)
def test_a_file_that_is_none_is_refused_in_one_line(text: str, words: str) -> None:
    with pytest.raises(InputError, match=r"^p\.yaml") as error:
        made(text)
    assert words in str(error.value)
    assert "\n" not in str(error.value)


# ---------------------------------------------------------------- the data


def test_the_data_is_what_it_seems() -> None:
    known = built_in_nodes(NEWEST_LTS)
    assert len(known.nodes) > 90
    assert {it.kind for node in known.nodes.values() for it in node.params.values()} <= set(KINDS)
    assert set(known.types.values()) <= set(known.nodes)
    assert {"odom_frame_id", "joints"} <= set(known.anywhere.exact)
    assert "world_frame" not in known.anywhere.exact


@pytest.mark.more
def test_a_users_file_adds_to_what_is_known(tmp_path: object) -> None:
    path = f"{tmp_path}/more.yaml"
    text = "nodes:\n  rover:\n    params: {wheels: joint, mast.*: frame}\n"
    with open(path, "w") as file:
        file.write(text + "  amcl: {params: {extra: frame}}\n")
    source = section("rover", "wheels: [elbow]", "mast.a: tool0") + section("amcl", "extra: laser")
    text, findings = made(source, known=load_known_nodes(path, NEWEST_LTS))
    assert "wheels: [r1_elbow]" in text
    assert "mast.a: r1/tool0" in text
    assert "extra: r1/laser" in text
    assert "base_frame_id: r1/base_footprint" in text
    assert "MB901" not in codes(findings)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("nodes: {a: {params: {b: frme}}}", "did you mean 'frame'"),
        ("nodes: {a: {parms: {}}}", "did you mean 'params'"),
        ("nodes:\n  a:\n    params:\n      <jont>.b: keep", "did you mean 'joint'"),
        ("nodes: {a: {params: {b: {default: x}}}}", "has no kind"),
        ("nodes: {a: {params: {b: {kind: frame, releases: jazy}}}}", "did you mean 'jazzy'"),
        ("nodes: {a: {params: {b..c: frame}}}", "empty segment"),
        ("guesses: {frme: [x]}", "did you mean 'frame'"),
        ("nodes: [", "not valid YAML"),
    ],
)
def test_a_mistake_in_a_users_file_is_reported_with_its_line(
    tmp_path: object, text: str, words: str
) -> None:
    path = f"{tmp_path}/more.yaml"
    with open(path, "w") as file:
        file.write(text)
    with pytest.raises(UsageError, match=r"more\.yaml:\d") as error:
        load_known_nodes(path, NEWEST_LTS)
    assert words in str(error.value)


# ---------------------------------------------------------------- properties

_WORDS = st.text(st.characters(codec="utf-8", exclude_categories=["Cs", "Cc"]), max_size=12)
_SCALARS = st.one_of(
    _WORDS,
    st.sampled_from(
        [*LINKS, *JOINTS, "odom", "map", "/scan", "scan", "y", "1e-9", "elbow/position"]
    ),
    st.integers(),
    st.booleans(),
    st.floats(allow_nan=False, allow_infinity=False),
)
_NAMES = st.sampled_from(
    ["joints", "frame_id", "scan_topic", "elbow", "gains", "odom0", "x", "base_frame_id", "a.b"]
)
_TREES = st.dictionaries(
    _NAMES, st.recursive(_SCALARS, lambda inner: st.dictionaries(_NAMES, inner), max_leaves=5)
)
_FILES = st.dictionaries(
    st.sampled_from(["amcl", "/**", "other", "joint_trajectory_controller", "ekf_filter_node"]),
    _TREES,
    min_size=1,
)


@pytest.mark.slow
@given(_FILES, st.sampled_from([L1, L2, L3, L4]))
def test_structure_and_what_is_no_name_stay(
    files: dict[str, object], policy: tuple[str, str]
) -> None:
    source = yaml.safe_dump({name: {"ros__parameters": it} for name, it in files.items()})
    context = setting(policy)
    text = fill_template(
        rewrite_params(read_yaml(source.encode(), "p"), context).template, "robot1", "r1"
    )
    old = [it for it in leaves(yaml.safe_load(source)) if not isinstance(it, str)]
    new = [it for it in leaves(yaml.safe_load(text)) if not isinstance(it, str)]
    inserted = text.count("tf_frame_prefix_enable")
    assert len(new) == len(old) + inserted
    assert [it for it in old if it not in new] == []


def leaves(node: object) -> list[object]:
    if isinstance(node, dict):
        return [leaf for value in node.values() for leaf in leaves(value)]
    return [node]


@pytest.mark.slow
@given(st.sampled_from([L1, L2, L3, L4]), st.text("abc_1", min_size=1, max_size=5))
def test_robots_differ_in_their_names_alone(policy: tuple[str, str], robot: str) -> None:
    source = section("amcl", "scan_topic: /scan", "base_frame_id: base_link")
    template = rewrite_params(read_yaml(source.encode(), "p"), setting(policy)).template
    one, two = (
        fill_template(template, "robot1", "r1"),
        fill_template(template, f"g{robot}", f"s{robot}"),
    )
    assert one.replace("robot1", f"g{robot}").replace("r1", f"s{robot}") == two


# ---------------------------------------------------------------- the page


def test_the_page_has_codes_that_exist() -> None:
    text = (ROOT / "docs" / "related-files.md").read_text()
    codes_named = set(re.findall(r"MF1\d\d", text))
    assert codes_named
    assert codes_named <= set(catalogue.rules())


# The forms and variables that camera_info_manager.cpp reads.
@pytest.mark.parametrize(
    ("url", "shared"),
    [
        ("package://my_robot/config/camera.yaml", True),
        ("file:///opt/camera.yaml", True),
        ("FILE:///opt/${NAME}.yaml", True),
        ("file://${ROS_HOME}/camera_info/front.yaml", False),
        ("package://my_robot/config/<robot_namespace>/camera.yaml", False),
        ("''", False),
        ("flash:///calibration1", False),
    ],
)
@pytest.mark.parametrize("node", ["usb_cam", "/**", "v4l2_camera"])
def test_a_calibration_is_said_to_be_of_all_robots(node: str, url: str, shared: bool) -> None:
    text = section(node, f"camera_info_url: {url}")
    found = [(it.code, it.line) for it in made(text)[1] if it.code == "MB412"]
    assert found == ([("MB412", 3)] if shared else [])
    assert not [it for it in made(text, own=("robot1",))[1] if it.code == "MB412"]


# ---------------------------------------------------------------- nodes that are not known


@pytest.mark.parametrize(
    ("lines", "new"),
    [
        (("base_frame: base_link",), ("base_frame: r1/base_link",)),
        # What is at tf_root may be a frame as well: the tf of the node would be half the robot's.
        (
            ("base_frame: base_link", "tf_root: odom"),
            ("base_frame: base_link", "tf_root: odom"),
        ),
        (
            ("base_frame: base_link", "joints: [elbow]", "tf_root: base_link"),
            ("base_frame: base_link", "joints: [r1_elbow]", "tf_root: base_link"),
        ),
        (
            ("odom_frame: base_link", "world_frame: base_link"),
            ("odom_frame: r1/base_link", "world_frame: r1/base_link"),
        ),
        (
            ("base_frame: base_link", "joints: [elbow]", "tf_root: odom"),
            ("base_frame: base_link", "joints: [r1_elbow]", "tf_root: odom"),
        ),
        (
            ("base_frame: base_link", "tf_root: /base_link"),
            ("base_frame: base_link", "tf_root: /base_link"),
        ),
        # Alone ``odom`` may be a topic.
        (("joints: [elbow]", "tf_root: odom"), ("joints: [r1_elbow]", "tf_root: odom")),
        (("joints: [elbow]", "root: elbow"), ("joints: [elbow]", "root: elbow")),
        (
            ("wheel_1_link_name: base_link", "root: base_link"),
            ("wheel_1_link_name: base_link", "root: base_link"),
        ),
    ],
)
def test_names_of_an_unknown_node_change_all_or_none(
    lines: tuple[str, ...], new: tuple[str, ...]
) -> None:
    text, findings = made(section("acme_driver", *lines), L2)
    assert tuple(it.strip() for it in text.splitlines()[2:]) == new
    told = [it.message for it in findings if "acme_driver is not known" in it.message]
    assert any("stay as they are" in it for it in told) == (lines[0] == new[0])


@pytest.mark.parametrize(
    ("word", "told"), [("lbr", True), ("lbr_", True), ("link", False), ("lb", False)]
)
def test_a_word_that_begins_the_names_is_told(word: str, told: bool) -> None:
    """Code that puts it before ``_link_0`` makes a name that no robot has."""
    links = dict.fromkeys(("world", *(f"lbr_link_{it}" for it in range(3))))
    declared = {kind: links if kind == "link" else {} for kind in DECLARED}
    context = make_context(declared, make_naming("L2"), (), NEWEST_LTS)  # type: ignore[arg-type]
    text = section("acme_driver", f"robot_name: {word}")
    related_file = rewrite_params(read_yaml(text.encode(), "p.yaml"), context)
    assert [it.line for it in findings_of(related_file) if "begins" in it.message] == [3] * told


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("pattern", "full", "matches"),
    [
        ("/**/a/**/b", "/a/a/x/b", True),
        ("/**/a/**/b", "/x/b/a", False),
        ("/**/**/b", "/b", True),
        ("/a/**", "/a", True),
        ("/a/*/**", "/a", False),
        ("/**/a/*", "/a/a", True),
        ("/**" + "/**/a" * 30 + "/b", "/a" * 3_000, False),
        ("/**/amcl", "/amcl", True),
        ("/**/amcl", "/a/b/amcl", True),
        ("/**", "/a/b/amcl", True),
        ("/*/amcl", "/a/amcl", True),
        ("/*/amcl", "/amcl", False),
        ("/*/amcl", "/a/b/amcl", False),
        ("/a.b", "/axb", False),
        ("/*.b", "/axb", False),
        ("amcl", "/amcl", True),
        ("/a/amcl/", "/a/amcl", True),
        ("/amcl", "/a/amcl", False),
    ],
)
def test_what_a_wildcard_stands_for(pattern: str, full: str, matches: bool) -> None:
    """One star is one word, two are any number of them, none too (rcl_yaml_param_parser). Thirty of
    them once took as many ways as thirty numbers up to 3,000 have orders."""
    assert is_for(pattern, full) == matches
