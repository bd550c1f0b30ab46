"""The programs of known nodes: what ``ros2 run`` and launch start.

By a node's name in its entry; one without a row has a program of its own name in its package.
Sources: the launch files and CMakeLists.txt of each package on its jazzy branch; nav2_bringup
launch/*.py of humble (1.1.20), jazzy (1.3.13), kilted (1.4.2), lyrical (1.5.1) and rolling (a3a97043e);
slam_toolbox launch/online_sync_launch.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.base.releases import has_release
from multibot_rewrite.knowledge.records import NodeFacts

LIFECYCLE_MANAGER, SLAM, CONTAINER = "lifecycle_manager", "slam_toolbox", "component_container"


class Program(NamedTuple):
    """A node's program, its class as a component if it can be one, and further words for it."""

    package: str
    executable: str
    plugin: str = ""
    words: tuple[str, ...] = ()


PROGRAMS: Mapping[str, Program] = MappingProxyType(
    {
        "map_server": Program("nav2_map_server", "map_server", "nav2_map_server::MapServer"),
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
        "costmap_filter_info_server": Program(
            "nav2_map_server",
            "costmap_filter_info_server",
            "nav2_map_server::CostmapFilterInfoServer",
        ),
        "map_saver": Program("nav2_map_server", "map_saver_server"),
        SLAM: Program("slam_toolbox", "sync_slam_toolbox_node"),
        # Last, so that what it manages is there.
        LIFECYCLE_MANAGER: Program(
            "nav2_lifecycle_manager",
            "lifecycle_manager",
            "nav2_lifecycle_manager::LifecycleManager",
        ),
    }
)
# Executables that are not called as the node.
_EXECUTABLES: Mapping[str, str] = MappingProxyType(
    {
        "apriltag": "apriltag_node",
        "controller_manager": "ros2_control_node",
        "depthimage_to_laserscan": "depthimage_to_laserscan_node",
        "ekf_filter_node": "ekf_node",
        "image_republisher": "republish",
        "imu_filter_madgwick": "imu_filter_madgwick_node",
        "pointcloud_to_laserscan": "pointcloud_to_laserscan_node",
        "ros_gz_bridge": "parameter_bridge",
        "teleop_twist_joy_node": "teleop_node",
    }
)


def program_of(node: NodeFacts, release: str) -> Program | None:
    """The program of a node in a release; None where no package is known, and for one that is only a
    component."""
    known = node.known or node.name
    if known == CONTAINER:
        return container_of(release)
    if known in PROGRAMS:
        return PROGRAMS[known]
    if not node.package or known[:1].isupper():
        return None
    return Program(node.package, _EXECUTABLES.get(known, known))


def container_of(release: str) -> Program:
    """The program of a container in a release."""
    if has_release("lyrical+", release):
        words = ("--isolated", "--executor-type", "single-threaded")
        return Program("rclcpp_components", CONTAINER, words=words)
    return Program("rclcpp_components", f"{CONTAINER}_isolated")


def activates_itself(node: NodeFacts, release: str) -> bool:
    """Does a node work as soon as it runs, or does a lifecycle manager of Nav2 take care of it?

    slam_toolbox has a life cycle from Jazzy on, and none of Nav2's managers knows it.
    """
    return (node.known or node.name) != SLAM or not has_release("jazzy+", release)
