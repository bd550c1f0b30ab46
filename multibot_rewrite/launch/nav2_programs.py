"""The programs of Nav2's nodes, and the classes of those that can be components.

Source: nav2_bringup launch/*.py of humble (1.1.20), jazzy (1.3.13), kilted (1.4.2), lyrical (1.5.1) and
rolling (a3a97043e); slam_toolbox launch/online_sync_launch.py; topic_tools relay_node.cpp;
lifecycle_msgs msg/Transition.msg.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import NamedTuple

from multibot_rewrite.releases import has_release


class Program(NamedTuple):
    """A node's program, its class as a component if it can be one, and further words for it."""

    package: str
    executable: str
    plugin: str = ""
    words: tuple[str, ...] = ()


CONTAINER, MAP_SERVER, SLAM = "nav2_container", "map_server", "slam_toolbox"
MANAGER, SHARED_MANAGER = "lifecycle_manager", "lifecycle_manager_shared"
STATE = "robot_state_publisher"
TRANSITIONS: Mapping[str, int] = MappingProxyType({"configure": 1, "activate": 3})
_MAPS = Program("nav2_map_server", "map_server", "nav2_map_server::MapServer")
_FILTERS = Program(
    "nav2_map_server", "costmap_filter_info_server", "nav2_map_server::CostmapFilterInfoServer"
)
# By the name of the node in its stack.
PROGRAMS: Mapping[str, Program] = MappingProxyType(
    {
        MAP_SERVER: _MAPS,
        "amcl": Program("nav2_amcl", "amcl", "nav2_amcl::AmclNode"),
        "controller_server": Program(
            "nav2_controller", "controller_server", "nav2_controller::ControllerServer"
        ),
        "smoother_server": Program(
            "nav2_smoother", "smoother_server", "nav2_smoother::SmootherServer"
        ),
        "planner_server": Program("nav2_planner", "planner_server", "nav2_planner::PlannerServer"),
        "route_server": Program("nav2_route", "route_server", "nav2_route::RouteServer"),
        "behavior_server": Program(
            "nav2_behaviors", "behavior_server", "behavior_server::BehaviorServer"
        ),
        "bt_navigator": Program(
            "nav2_bt_navigator", "bt_navigator", "nav2_bt_navigator::BtNavigator"
        ),
        "waypoint_follower": Program(
            "nav2_waypoint_follower",
            "waypoint_follower",
            "nav2_waypoint_follower::WaypointFollower",
        ),
        "velocity_smoother": Program(
            "nav2_velocity_smoother",
            "velocity_smoother",
            "nav2_velocity_smoother::VelocitySmoother",
        ),
        "collision_monitor": Program(
            "nav2_collision_monitor",
            "collision_monitor",
            "nav2_collision_monitor::CollisionMonitor",
        ),
        "docking_server": Program(
            "opennav_docking", "opennav_docking", "opennav_docking::DockingServer"
        ),
        "following_server": Program(
            "opennav_following", "opennav_following", "opennav_following::FollowingServer"
        ),
        "keepout_filter_mask_server": _MAPS,
        "speed_filter_mask_server": _MAPS,
        "keepout_costmap_filter_info_server": _FILTERS,
        "speed_costmap_filter_info_server": _FILTERS,
        "map_saver": Program("nav2_map_server", "map_saver_server"),
        SLAM: Program("slam_toolbox", "sync_slam_toolbox_node"),
        # Last, so that what they manage is there.
        MANAGER: Program(
            "nav2_lifecycle_manager",
            "lifecycle_manager",
            "nav2_lifecycle_manager::LifecycleManager",
        ),
    }
)


RELAY = Program("topic_tools", "relay")


def container_of(release: str) -> Program:
    """The program of the container in a release."""
    if has_release("lyrical+", release):
        words = ("--isolated", "--executor-type", "single-threaded")
        return Program("rclcpp_components", "component_container", words=words)
    return Program("rclcpp_components", "component_container_isolated")


def kind_of(name: str) -> str:
    """The key in ``PROGRAMS`` of a node: that of all lifecycle managers is the same."""
    return MANAGER if name.startswith(MANAGER) else name


def with_program(names: Iterable[str]) -> list[str]:
    """Those of the nodes that have one of these programs, managers last."""
    order = list(PROGRAMS)
    known = (it for it in names if kind_of(it) in PROGRAMS)
    return sorted(known, key=lambda it: order.index(kind_of(it)))
