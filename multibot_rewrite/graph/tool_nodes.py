"""Nodes that run beside any fleet and are no part of a robot: tools, and what simulators start."""

from __future__ import annotations

import re
from fnmatch import translate
from functools import lru_cache

from multibot_rewrite.graph.snapshot import LISTENER

# No plan names them and ``learn`` leaves them out. Without a slash: in any namespace.
TOOL_NODES = (
    # Of ROS itself: hidden ones, ros2 CLI, launch, tf listeners, spawners, containers.
    "_*", "launch_ros_*", f"{LISTENER}*", "spawner_*", "spawn_entity*", "*_container",
    "static_transform_publisher_*", "*_rclcpp_node", "*_service_client",
    # To look, to drive and to record with.
    "rqt_*", "rviz*", "foxglove_*", "rosbridge*", "rosapi*", "rosbag2_*", "tf2_*", "view_frames",
    "teleop_*", "*_teleop", "joy*",
    # The world of all robots.
    "gazebo*", "gz_*", "ign_*", "ros_gz_*", "*_bridge",
)  # fmt: skip


def is_tool(node: str, more: tuple[str, ...] = ()) -> bool:
    """Is the node with this full name a tool? ``more`` are patterns beside ``TOOL_NODES``."""
    full, last = _patterns(more)
    return bool(last.fullmatch(node.rpartition("/")[2]) or full.fullmatch(node))


@lru_cache(maxsize=8)
def _patterns(more: tuple[str, ...]) -> tuple[re.Pattern[str], re.Pattern[str]]:
    every = (*TOOL_NODES, *more)
    sides = ([p for p in every if "/" in p], [p for p in every if "/" not in p])
    full, last = (re.compile("|".join(map(translate, side))) for side in sides)
    return full, last
