# SPDX-License-Identifier: Apache-2.0
"""What is everybody's by convention, as the sources that ``conventions`` names have it."""

from __future__ import annotations

import pytest

from multibot_rewrite.base import conventions
from multibot_rewrite.base.bounded import other_words
from multibot_rewrite.base.conventions import (
    chooses,
    is_from_outside,
    is_tool_word,
    only_looks,
    team,
)


def test_topics_that_robots_share() -> None:
    """rclcpp: every node logs, sends parameter events and reads the clock with use_sim_time."""
    every = ("/clock", "/rosout", "/parameter_events", "/diagnostics", "/diagnostics_agg", "/bond")
    # slam_toolbox for several robots: each reads the scans of all.
    assert (*every, "/localized_scan") == conventions.EVERYBODYS
    assert conventions.SENT_BY_EVERY_NODE == ("/rosout", "/parameter_events")
    assert conventions.READ_BY_EVERY_NODE == ("/clock", "/parameter_events")
    assert conventions.OF_EVERY_NODE == ("/clock", "/rosout", "/parameter_events")
    assert conventions.SENT_BY_ANY_NODE == ("/rosout", "/parameter_events", "/diagnostics")
    assert every[:4] == conventions.SHARED_TOPICS
    assert conventions.CLOCK == "/clock"


def test_frames_of_the_world_and_of_a_robot() -> None:
    """REP 105 and REP 120."""
    assert conventions.WORLD_FRAMES == ("map", "world", "earth", "utm")
    assert conventions.BODY_FRAMES == ("base_footprint", "base_link")
    sent = ("map", "world", "earth", "utm", "local_enu", "odom", "odom_combined")
    assert sent == conventions.SENT_FRAMES
    assert conventions.USUAL_FRAMES == ("map", "odom", "base_footprint", "base_link")


LOOKING = [
    "_ros2cli_123", "launch_ros_4711", "spawner_joints", "bt_navigator_rclcpp_node", "rqt_gui", "rviz2",
    "rviz", "foxglove_bridge", "rosbridge_websocket", "rosapi_params", "rosbag2_recorder", "tf2_echo",
    "view_frames",
]  # fmt: skip
DOING = [
    "_hidden", "transform_listener_impl_55d0", "spawn_entity", "nav2_container",
    "static_transform_publisher_ab", "amcl_service_client", "rosbag2_player", "teleop_twist_keyboard",
    "turtle_teleop", "joy_node", "gazebo", "gz_server", "ign_server", "ros_gz_bridge", "tf_bridge",
]  # fmt: skip


@pytest.mark.parametrize("name", [*LOOKING, *DOING])
def test_a_tool_is_known_by_its_name(name: str) -> None:
    assert is_tool_word(name)
    assert only_looks(name) is (name in LOOKING)


@pytest.mark.parametrize(
    "name",
    [
        "amcl", "driver", "container", "view_frames2", "my_rviz", "ros2cli_1", "spawner", "bridge_node",
        "static_transform_publisher", "x_gz_y", "tf2", "my_joy", "rclcpp_node",
    ],
)  # fmt: skip
def test_other_nodes_are_no_tools(name: str) -> None:
    assert not is_tool_word(name) and not only_looks(name)


def test_patterns_inside_another_are_left_out() -> None:
    found = conventions.tool_patterns()
    assert not {"_ros2cli_*", "rosbag2_recorder*"} & {*found}
    assert {"_*", "rosbag2_*", "*_bridge", "gz_*"} <= {*found}
    assert len(found) == len(conventions.TOOLS) - 2
    assert frozenset({"gazebo"}) == conventions.WORLD_NODES


@pytest.mark.parametrize(
    "name",
    [
        "cmd_vel", "cmd_vel_unstamped", "cmd_vel_teleop", "initialpose", "goal_pose", "goal_update",
        "clicked_point", "set_pose", "joy", "speed_limit", "preempt_teleop", "manual_control",
        "reference", "commands", "joint_trajectory", "trajectory", "external_wrench", "feedback",
        "set_feedback", "trajectory_execution_event", "enable_freedrive_mode", "script_command",
        "equilibrium_pose", "speed_scaling_input", "footprint", "delta_twist_cmds",
        "delta_joint_cmds", "pose_target_cmds", "planning_scene", "planning_scene_world",
        "collision_object", "attached_collision_object", "clock", "diagnostics",
        "parameter_events",
    ],
)  # fmt: skip
def test_what_a_person_or_a_scene_sends(name: str) -> None:
    assert is_from_outside(f"/r/{name}") and is_from_outside(name)
    assert not is_from_outside(f"/{name}/x")


@pytest.mark.parametrize(
    ("node", "of"),
    [
        *((f"/r/{it}_r", "Nav2") for it in (
            "controller_server", "behavior_server", "recoveries_server", "velocity_smoother",
            "collision_monitor", "docking_server", "following_server", "bt_navigator", "route_server",
            "planner_server", "waypoint_follower", "lifecycle_manager", "local_costmap",
        )),
        *((f"/a{it}", "MoveIt") for it in ("move_group", "servo_node", "moveit_simple")),
        ("/nav2/driver", "/nav2/driver"), ("/move_group/driver", "/move_group/driver"),
    ],
)  # fmt: skip
def test_nodes_that_take_turns_are_one_team(node: str, of: str) -> None:
    assert team(node) == of


@pytest.mark.parametrize(
    ("node", "it_does"),
    [
        *((f"/r/{it}", True) for it in (
            "twist_mux", "cmd_prioritizer", "arbiter", "vel_selector", "switcher", "twist_manager",
        )),
        ("/mux/driver", False), ("/driver", False),
    ],
)  # fmt: skip
def test_a_node_that_chooses_between_senders(node: str, it_does: bool) -> None:
    assert chooses(node) is it_does


def test_words_that_stand_for_a_robot() -> None:
    assert conventions.PREFIX_WORDS == ("tf_prefix", "frame_prefix", "prefix")
    assert conventions.ROBOT_WORDS == (
        "robot_namespace", "robot_name", "robot_ns", "namespace", "ns", "robot", "tf_prefix",
        "frame_prefix", "prefix",
    )  # fmt: skip
    assert [bool(conventions.PLACEHOLDER.search(it)) for it in ("<a>", "{a}", "$(a)", "%a", "a/b")] == [
        True, True, True, True, False,
    ]  # fmt: skip


def test_answers_are_options_and_keys_that_there_are() -> None:
    keys = {
        "description": "urdf xacro sdf model robot_description",
        "arguments": "args xacro_args",
        "params": "parameters params_file",
        "rviz": "rviz_config",
        "pose": "position initial_pose start_pose",
        "distro": "ros_distro release",
        "simulator": "sim gazebo",
        "use_sim_time": "sim_time",
        "affix": "prefix postfix suffix",
        "namespace": "ns",
        "nodes": "nodes_file",
        "stack": "stacks",
        "separators": "separator",
    }
    assert {word: key for key, words in keys.items() for word in words.split()} == other_words(
        "keys"
    )
    assert {other_words("options")[it] for it in ("--again", "--overwrite")} == {"--force"}
    assert other_words("options")["--inplace"] == "--in-place"
