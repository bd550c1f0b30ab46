"""The programs of known nodes: what ``ros2 run`` and launch start, by a node's name in ``nodes.yaml``.

A node without a row has a program of its own name in its package. Sources: the launch files and
CMakeLists.txt of each package on its jazzy branch; for Nav2 nav2_bringup/launch.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

from multibot_rewrite.remap.records import NodeFacts

MANAGER_KIND = "lifecycle_manager"


class Program(NamedTuple):
    """A node's program, the class of which it is a component if it can be one, further words for it."""

    package: str
    executable: str
    plugin: str = ""
    words: tuple[str, ...] = ()


# Node -> executable, where it is not called as the node.
_EXECUTABLES: Mapping[str, str] = MappingProxyType(
    {
        "apriltag": "apriltag_node",
        "controller_manager": "ros2_control_node",
        "depthimage_to_laserscan": "depthimage_to_laserscan_node",
        "docking_server": "opennav_docking",
        "ekf_filter_node": "ekf_node",
        "following_server": "opennav_following",
        "image_republisher": "republish",
        "imu_filter_madgwick": "imu_filter_madgwick_node",
        "map_saver": "map_saver_server",
        "navsat_transform_node": "navsat_transform_node",
        "pointcloud_to_laserscan": "pointcloud_to_laserscan_node",
        "ros_gz_bridge": "parameter_bridge",
        "slam_toolbox": "async_slam_toolbox_node",
        "teleop_twist_joy_node": "teleop_node",
        "component_container": "component_container_isolated",
    }
)
# Node -> its class as a component.
_PLUGINS: Mapping[str, str] = MappingProxyType(
    {
        "map_server": "nav2_map_server::MapServer",
        "amcl": "nav2_amcl::AmclNode",
        "controller_server": "nav2_controller::ControllerServer",
        "smoother_server": "nav2_smoother::SmootherServer",
        "planner_server": "nav2_planner::PlannerServer",
        "route_server": "nav2_route::RouteServer",
        "behavior_server": "behavior_server::BehaviorServer",
        "bt_navigator": "nav2_bt_navigator::BtNavigator",
        "waypoint_follower": "nav2_waypoint_follower::WaypointFollower",
        "velocity_smoother": "nav2_velocity_smoother::VelocitySmoother",
        "collision_monitor": "nav2_collision_monitor::CollisionMonitor",
        "docking_server": "opennav_docking::DockingServer",
        "following_server": "opennav_following::FollowingServer",
        "costmap_filter_info_server": "nav2_map_server::CostmapFilterInfoServer",
        "lifecycle_manager": "nav2_lifecycle_manager::LifecycleManager",
        "DebayerNode": "image_proc::DebayerNode",
        "RectifyNode": "image_proc::RectifyNode",
        "PointCloudXyzNode": "depth_image_proc::PointCloudXyzNode",
    }
)


def program_of(node: NodeFacts) -> Program | None:
    """The program of a node; None where no package is known, and for one that is only a component."""
    known = node.known or node.name
    if not node.package or known[:1].isupper():
        return None
    executable = _EXECUTABLES.get(known, known)
    return Program(node.package, executable, _PLUGINS.get(known, ""))
