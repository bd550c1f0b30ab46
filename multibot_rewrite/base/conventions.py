# SPDX-License-Identifier: Apache-2.0
"""What is everybody's, by convention: topics, frames, tools, words, each with its source.

Rows are Python and not YAML, since the start of every command reads them and none pays for a parser.
"""

from __future__ import annotations

import re
from functools import cache, lru_cache
from typing import NamedTuple

from multibot_rewrite.base.lazy import lazy_compile

# Who sends a topic, or reads it: every node there is; any node may; some nodes do; a single one.
EVERY, ANY, SOME, ONE = range(4)


class SharedTopic(NamedTuple):
    """A topic that all robots may have in common. With ``kept`` a rewrite leaves its name as it is,
    unless the user says otherwise."""

    name: str
    senders: int
    readers: int
    kept: bool
    source: str


TOPICS = (
    SharedTopic("/clock", ONE, EVERY, True, "rclcpp time_source.cpp: with use_sim_time"),
    SharedTopic("/rosout", EVERY, ANY, True, "rcl logging_rosout.c"),
    SharedTopic("/parameter_events", EVERY, EVERY, True, "rclcpp node_parameters.cpp"),
    SharedTopic("/diagnostics", ANY, ANY, True, "diagnostic_updater.hpp"),
    SharedTopic("/diagnostics_agg", ONE, ANY, False, "diagnostic_aggregator aggregator.cpp"),
    # An id in each message says whose it is.
    SharedTopic("/bond", SOME, SOME, False, "bondcpp bond.cpp"),
)
CLOCK = "/clock"
# Topics that may be shared; what every node sends, has, may send; what a rewrite leaves.
EVERYBODYS = tuple(it.name for it in TOPICS)
SENT_BY_EVERY_NODE = tuple(it.name for it in TOPICS if it.senders == EVERY)
READ_BY_EVERY_NODE = tuple(it.name for it in TOPICS if it.readers == EVERY)
OF_EVERY_NODE = tuple(it.name for it in TOPICS if EVERY in (it.senders, it.readers))
SENT_BY_ANY_NODE = tuple(it.name for it in TOPICS if it.senders in (EVERY, ANY))
SHARED_TOPICS = tuple(it.name for it in TOPICS if it.kept)
# The kinds of frames by what they are fixed to.
WORLD, START, BODY = range(3)


class UsualFrame(NamedTuple):
    """A frame that has the same name on most robots: of the ``WORLD``, which is everybody's, of the
    ``START`` of one robot, or of its ``BODY``. ``expected``: nearly every robot has it."""

    name: str
    fixed_to: int
    expected: bool
    source: str


FRAMES = (
    UsualFrame("map", WORLD, True, "REP 105"),
    UsualFrame("world", WORLD, False, "sdformat: the frame of a world; MoveIt virtual joints"),
    UsualFrame("earth", WORLD, False, "REP 105"),
    UsualFrame("utm", WORLD, False, "robot_localization navsat_transform.cpp"),
    UsualFrame("local_enu", START, False, "robot_localization navsat_transform.cpp"),
    UsualFrame("odom", START, True, "REP 105"),
    UsualFrame("odom_combined", START, False, "robot_pose_ekf odom_estimation_node.cpp"),
    UsualFrame("base_footprint", BODY, True, "REP 120"),
    UsualFrame("base_link", BODY, True, "REP 105"),
)
WORLD_FRAMES = tuple(it.name for it in FRAMES if it.fixed_to == WORLD)
BODY_FRAMES = tuple(it.name for it in FRAMES if it.fixed_to == BODY)
# Frames that nodes send, whatever a description has.
SENT_FRAMES = tuple(it.name for it in FRAMES if it.fixed_to != BODY)
USUAL_FRAMES = tuple(it.name for it in FRAMES if it.expected)


class ToolNode(NamedTuple):
    """Nodes beside any fleet, by a pattern of the name without its namespace. ``looks``: it only looks,
    or passes on what a person asks for, so it is no sender of its own."""

    pattern: str
    looks: bool
    source: str


# How the names of tf2's listener nodes start; the rest is an address.
LISTENER = "transform_listener_impl_"
# How the name of a node ends that another one makes for its clients: nav2_behavior_tree
# bt_action_server_impl.hpp.
CLIENT = "_rclcpp_node"
TOOLS = (
    ToolNode("_*", False, "rcl: a name with _ in front is hidden"),
    ToolNode("_ros2cli_*", True, "ros2cli node/__init__.py NODE_NAME_PREFIX"),
    ToolNode("launch_ros_*", True, "launch_ros ros_adapters.py"),
    ToolNode(f"{LISTENER}*", False, "tf2_ros transform_listener.cpp"),
    ToolNode("spawner_*", True, "controller_manager spawner.py"),
    ToolNode("spawn_entity*", False, "gazebo_ros spawn_entity.py"),
    ToolNode("*_container", False, "nav2_bringup navigation_launch.py, rclcpp_components"),
    ToolNode(
        "static_transform_publisher_*", False, "tf2_ros static_transform_broadcaster_node.cpp"
    ),
    ToolNode(f"*{CLIENT}", True, "nav2_util simple_action_server, costmap clients"),
    ToolNode("*_service_client", False, "nav2_util lifecycle_service_client.cpp"),
    ToolNode("rqt*", True, "rqt_gui_py ros_py_plugin_provider.py"),
    ToolNode("rviz*", True, "rviz2 main.cpp"),
    ToolNode("foxglove_*", True, "foxglove_bridge ros2_foxglove_bridge.cpp"),
    ToolNode("rosbridge*", True, "rosbridge_server rosbridge_websocket.py"),
    ToolNode("rosapi*", True, "rosapi rosapi_node.py"),
    ToolNode("rosbag2_*", False, "rosbag2_transport player.cpp"),
    ToolNode("rosbag2_recorder*", True, "rosbag2_transport recorder.cpp"),
    ToolNode("tf2_*", True, "tf2_ros tf2_echo.cpp, tf2_monitor.cpp"),
    ToolNode("view_frames", True, "tf2_tools view_frames.py"),
    ToolNode("teleop_*", False, "teleop_twist_keyboard, teleop_twist_joy"),
    ToolNode("*_teleop", False, "joy_teleop, turtlesim teleop_turtle"),
    ToolNode("joy*", False, "joy joy.cpp"),
    ToolNode("gazebo*", False, "gazebo_ros gazebo_ros_init.cpp"),
    ToolNode("gz_*", False, "ros_gz_sim"),
    ToolNode("ign_*", False, "ros_ign_gazebo"),
    ToolNode("ros_gz_*", False, "ros_gz_bridge ros_gz_bridge.cpp"),
    ToolNode("*_bridge", False, "ros_gz_bridge, ros1_bridge"),
)


# Words for parts of any robot and for what they send: topics and frames are called so, whatever robots
# are called. The sensors of SDF (sdformat sdf/1.9/sensor.sdf, type), REP 105, REP 144, and sides.
PARTS = frozenset({
    "camera", "rgbd_camera", "depth_camera", "thermal_camera", "depth", "color", "rgb", "image",
    "lidar", "gpu_lidar", "ray", "laser", "scan", "points", "imu", "gps", "navsat", "gnss", "sensor",
    "magnetometer", "altimeter", "sonar", "radar", "contact", "bumper", "battery", "odom", "odometry",
    "map", "cmd", "cmd_vel", "joint", "joints", "link", "base", "wheel", "wheels", "arm", "gripper",
    "hand", "head", "tool", "torso", "front", "rear", "back", "left", "right", "top", "bottom", "upper",
    "lower",
})  # fmt: skip


# Nodes of a simulator, one for all robots: gazebo_ros gazebo_ros_init.cpp.
WORLD_NODES = frozenset({"gazebo"})
# Nodes that a person starts, whatever a launch file does: what is built starts none of them.
BY_HAND = ("teleop_twist_keyboard", "rviz2")


def tool_patterns() -> tuple[str, ...]:
    """The patterns of all tools, without those inside another."""
    from fnmatch import fnmatchcase  # few commands ask for a pattern

    every = [it.pattern for it in TOOLS]
    return tuple(
        it for it in every if not any(it != other and fnmatchcase(it, other) for other in every)
    )


# A fleet has a handful of such words, each in many nodes.
@lru_cache(maxsize=4096)
def is_tool_word(word: str) -> bool:
    """Is a node called so a tool, in whatever namespace?"""
    return _any_of(tuple(it.pattern for it in TOOLS)).fullmatch(word) is not None


@lru_cache(maxsize=4096)
def only_looks(word: str) -> bool:
    """Does a node called so only look, or pass on what a person asks for?"""
    return _any_of(tuple(it.pattern for it in TOOLS if it.looks)).fullmatch(word) is not None


@cache
def _any_of(patterns: tuple[str, ...]) -> re.Pattern[str]:
    from fnmatch import translate

    return re.compile("|".join(map(translate, patterns)))


# Topics and services that nodes read and no robot need send, by the last word, and who does.
FROM_OUTSIDE = {
    "a person or a planner of missions": (
        *(
            "cmd_vel",
            "cmd_vel_unstamped",
            "cmd_vel_teleop",
            "initialpose",
            "goal",
            "goal_pose",
            "goal_update",
        ),
        *("clicked_point", "set_pose", "joy", "speed_limit", "preempt_teleop", "manual_control"),
    ),
    "a person or a planner of motions, to a controller": (
        *("reference", "commands", "joint_trajectory", "trajectory", "external_wrench", "feedback"),
        *("set_feedback", "trajectory_execution_event", "enable_freedrive_mode", "script_command"),
        *("equilibrium_pose", "speed_scaling_input", "footprint"),
        # moveit_servo servo_parameters.yaml.
        *("delta_twist_cmds", "delta_joint_cmds", "pose_target_cmds"),
    ),
    "a scene": (
        *(
            "planning_scene",
            "planning_scene_world",
            "collision_object",
            "attached_collision_object",
        ),
    ),
    "every node, or none": ("clock", "diagnostics", "parameter_events", "robot_description"),
}
_OUTSIDE = frozenset(word for words in FROM_OUTSIDE.values() for word in words)


def is_from_outside(name: str) -> bool:
    """Is the topic or service one that no node of a robot need send?"""
    return name.rpartition("/")[2] in _OUTSIDE


# Nodes that send one after another, by an order among themselves: as many as one sender.
TEAMS = {
    "Nav2": (
        *("*controller_server*", "*behavior_server*", "*recoveries_server*", "*velocity_smoother*"),
        *("*collision_monitor*", "*docking_server*", "*following_server*", "*bt_navigator*"),
        *("*route_server*", "*planner_server*", "*waypoint_follower*", "*lifecycle_manager*"),
        # Not costmap_filter_info_server: what it sends is for costmaps.
        *("*costmap", "*costmap_[!f]*"),
    ),
    "MoveIt": ("*move_group*", "*servo*", "*moveit_*"),
}
# Between several senders and a robot: they choose one.
_CHOOSES = lazy_compile(r"mux|prioriti|arbit|selector|switch|twist_manager")


def team(node: str) -> str:
    """The node's name, or that of the nodes that it takes turns with."""
    last = node.rpartition("/")[2]
    return next((name for name, nodes in TEAMS.items() if _any_of(nodes).fullmatch(last)), node)


def chooses(node: str) -> bool:
    """Does the node choose between several senders, like twist_mux?"""
    return bool(_CHOOSES.search(node.rpartition("/")[2]))


# Words that stand for a robot where a launch file fills them in, between <>, $() or ${}: nav2_common
# ReplaceString (<robot_namespace>), husarion_ugv_ros (<namespace>/), launch_ros ParameterFile
# ($(var namespace)), turtlebot3_description (${namespace}). The second ones are prefixes of frames.
PREFIX_WORDS = ("tf_prefix", "frame_prefix", "prefix")
ROBOT_WORDS = (
    "robot_namespace",
    "robot_name",
    "robot_ns",
    "namespace",
    "ns",
    "robot",
    *PREFIX_WORDS,
)
# What a launch file or a script fills in, in a name.
PLACEHOLDER = lazy_compile(r"[<{$%]")
