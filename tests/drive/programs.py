# SPDX-License-Identifier: Apache-2.0
"""What a program opens by the sources of its package, from which ``fixtures/interfaces`` was read.

``opened`` gives the names of the code, or those of the parameters that lead elsewhere.
"""

from __future__ import annotations

import csv
import lzma
import re
from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any, NamedTuple

from paths import ROOT

# Programs that are not called as their node is.
NODES = {
    "async_slam_toolbox_node": "slam_toolbox",
    "sync_slam_toolbox_node": "slam_toolbox",
    "localization_slam_toolbox_node": "slam_toolbox",
    "ekf_node": "ekf_filter_node",
    "ukf_node": "ukf_filter_node",
    "opennav_docking": "docking_server",
    "opennav_following": "following_server",
    "imu_filter_madgwick_node": "imu_filter_madgwick",
    "pointcloud_to_laserscan_node": "pointcloud_to_laserscan",
    "ros2_control_node": "controller_manager",
    "lifecycle_manager": "lifecycle_manager",
    "teleop_node": "teleop_twist_joy_node",
    "map_saver_server": "map_saver",
    "debayer_node": "DebayerNode",
    "rectify_node": "RectifyNode",
    # Components of Nav2 (RCLCPP_COMPONENTS_REGISTER_NODE at the end of each source).
    "AmclNode": "amcl",
    "BehaviorServer": "behavior_server",
    "BtNavigator": "bt_navigator",
    "CollisionMonitor": "collision_monitor",
    "ControllerServer": "controller_server",
    "DockingServer": "docking_server",
    "FollowingServer": "following_server",
    "LifecycleManager": "lifecycle_manager",
    "MapSaver": "map_saver",
    "MapServer": "map_server",
    "PlannerServer": "planner_server",
    "RouteServer": "route_server",
    "SmootherServer": "smoother_server",
    "VelocitySmoother": "velocity_smoother",
    "WaypointFollower": "waypoint_follower",
}
# Controllers that are another with one interface (velocity_controllers/src/*.cpp and its neighbours).
SAME = dict.fromkeys(
    (f"joint_group_{it}_controller" for it in ("position", "velocity", "effort")),
    "forward_command_controller",
)
# Nodes inside a program, with a namespace of their own (nav2_costmap_2d/src/costmap_2d_ros.cpp).
COSTMAPS = {"controller_server": "local_costmap", "planner_server": "global_costmap"}
# The class whose parameters a node has.
CLASSES = {
    "amcl": "AmclNode",
    "behavior_server": "BehaviorServer",
    "bt_navigator": "BtNavigator",
    "collision_monitor": "CollisionMonitor",
    "ekf_filter_node": "RosFilter",
    "slam_toolbox": "SlamToolbox",
}
MAP = "nav_msgs/msg/OccupancyGrid"
STAMPED = ("enable_stamped_cmd_vel", {"humble": False, "iron": False, "jazzy": False})
# Parameters that the extraction could not tie to a name, with the default (nav2_collision_monitor
# src/collision_monitor_node.cpp, slam_toolbox src/slam_toolbox_common.cpp).
PARAMETERS = {
    ("collision_monitor", "cmd_vel_smoothed"): "cmd_vel_in_topic",
    ("collision_monitor", "cmd_vel"): "cmd_vel_out_topic",
    ("bt_navigator", "odom"): "odom_topic",
    ("controller_server", "odom"): "odom_topic",
    ("velocity_smoother", "odom"): "odom_topic",
}
GIVEN = {
    ("slam_toolbox", "<get>"): ("scan_topic", "/scan"),
    ("slam_toolbox", "<map_name>"): ("map_name", "/map"),
    # moveit_cpp.hpp, PlanningSceneMonitorOptions
    ("move_group", "<topic>"): ("planning_scene_monitor_options.joint_state_topic", "joint_states"),
}
# What a class asks itself before it makes an end for the first time (planning_scene_monitor.cpp). Since
# Jazzy debayer.cpp and rectify.cpp ask where somebody listens to what they send: here somebody does.
ONCE = ("!current_state_monitor_", "!sub_raw_", "!sub_camera_")
# What is made of what came, and is no sensor's.
MAKING = ("DebayerNode", "RectifyNode")
# image_transport's publishers and subscribers of image_pipeline have no type in their calls: what is no
# camera's info is an image (image_proc/src/*.cpp, depth_image_proc/src/*.cpp).
PIPELINE, INFO = "image_pipeline", "sensor_msgs/msg/CameraInfo"
OF_HUMBLE = ("RectifyNode", "<camera_info>", "humble")
# Goals by the word of MoveIt for them (moveit_simple_controller_manager.cpp).
GOALS = {
    it: f"control_msgs/action/{it}"
    for it in ("FollowJointTrajectory", "GripperCommand", "ParallelGripperCommand")
}
SIMPLE = "moveit_simple_controller_manager"


# What rtabmap synchronises of a camera, by the parameter that is asked for it; the first one that is on
# counts (rtabmap_sync/src/CommonDataSubscriber.cpp, setupCallbacks, and the files of its impl/).
CAMERAS = {
    "sensor_data": ("sensor_data",),
    "rgbd": ("rgbd_image",),
    "stereo": (*("left/image_rect", "right/image_rect", "left/camera_info", "right/camera_info"),),
    "depth": ("rgb/image", "depth/image", "rgb/camera_info"),
    "rgb": ("rgb/image", "rgb/camera_info"),
}
# What it synchronises of a scanner, and with what else; none beside sensor_data and stereo.
SCANS = ("scan_descriptor", "scan", "scan_cloud")
BESIDE = ("odom", "odom_info", "user_data")
SYNCHRONISED = {*(it for own in CAMERAS.values() for it in own), *SCANS, *BESIDE, "rgbd_images"}


class Opened(NamedTuple):
    """One end: what the code calls it, whether something else decides that it is opened, and whether a
    node of its own in the process opens it, which has neither its name nor its namespace."""

    role: str
    name: str
    type: str
    sure: bool = True
    helper: bool = False


@cache
def table(release: str) -> Mapping[str, tuple[Mapping[str, str], ...]]:
    """Return the rows of each node of a release."""
    rows: dict[str, list[Mapping[str, str]]] = {}
    with lzma.open(ROOT / "fixtures" / "interfaces" / f"{release}.tsv.xz", "rt") as file:
        for row in csv.DictReader(file, delimiter="\t", quoting=csv.QUOTE_NONE):
            rows.setdefault(row["node"], []).append(row)
    return {node: tuple(found) for node, found in rows.items()}


def node_of(executable: str) -> str:
    """Return the node that a program is, as the table calls it."""
    last = executable.rpartition("::")[2]
    return NODES.get(last, last)


def is_known(node: str, release: str) -> bool:
    return SAME.get(node, node) in table(release)


def opened(node: str, values: Mapping[str, Any], release: str) -> Iterator[Opened]:
    """Yield the ends of a node with these parameters."""
    for row in table(release).get(SAME.get(node, node), ()):
        name = led_by(node, row, values)
        # Until Jazzy rectify.cpp names its image as it stands in the code (camera_subscriber.cpp:119).
        name = "camera_info" if (node, name, release) == OF_HUMBLE else name
        if node == "rtabmap" and name in SYNCHRONISED and name not in synchronised(values):
            continue
        met = [is_met(it, values, release) for it in row["condition"].split("; ") if it]
        if False not in met:
            sure = "<" not in name and None not in met
            yield Opened(row["role"], name, type_of(row), sure, row["way"] == "helper")


def type_of(row: Mapping[str, str]) -> str:
    if row["type"] or row["repository"] != PIPELINE:
        return row["type"]
    return INFO if "info" in row["name"].lower() else "sensor_msgs/msg/Image"


def synchronised(values: Mapping[str, Any]) -> set[str]:
    """Return the topics that rtabmap waits for before it does anything, as its parameters say:
    by default a colour and a depth image with odometry."""
    on = subscribed(values)
    camera = next((it for it in CAMERAS if it in on), "")
    of_camera = CAMERAS.get(camera, ())
    if camera == "rgbd" and values.get("rgbd_cameras") == 0:
        of_camera = ("rgbd_images",)
    scans = () if camera in ("sensor_data", "stereo") else [it for it in SCANS if it in on][:1]
    # It knows the odometry from tf where it has the name of its frame.
    without = {"odom"} if values.get("odom_frame_id") else set()
    return {*of_camera, *scans, *({*BESIDE} & (on - without))}


def subscribed(values: Mapping[str, Any]) -> set[str]:
    """Return what its parameters ask rtabmap to subscribe to, whether or not that counts."""
    on = {"depth", "rgb", "odom"}
    for it in (*CAMERAS, *SCANS, *BESIDE):
        given = values.get(f"subscribe_{it}")
        on = on | {it} if given is True else on - {it} if given is False else on
    return on


def is_exact(values: Mapping[str, Any]) -> bool:
    """Whether rtabmap takes messages of one and the same stamp alone: by default of scans without a
    camera, and of stereo cameras."""
    given, on = values.get("approx_sync"), subscribed(values)
    by_default = "stereo" in on or (on.isdisjoint(CAMERAS) and not on.isdisjoint(SCANS))
    return by_default if given is None else given is False


def muxed(values: Mapping[str, Any]) -> Iterator[Opened]:
    """Yield the inputs of twist_mux (src/twist_mux.cpp, getTopicHandles), and what it sends
    where its parameter says that commands are stamped."""
    stamped = values.get("use_stamped") is True
    kind = f"geometry_msgs/msg/Twist{'Stamped' if stamped else ''}"
    for key, it in values.items():
        if re.fullmatch(r"topics\..+\.topic", key):
            yield Opened("subscribes", str(it), kind)
    if stamped:
        yield Opened("publishes", "cmd_vel_out", kind)


def executed(values: Mapping[str, Any]) -> Iterator[Opened]:
    """Yield the actions of controllers that move_group sends goals to."""
    yield from (goal for goal, _ in handles(values))


def handles(values: Mapping[str, Any]) -> Iterator[tuple[Opened, list[str]]]:
    """Each action that move_group is a client of, with the joints that it moves by it
    (moveit_simple_controller_manager.cpp; action_based_controller_handle.hpp, getActionName)."""
    for name in values.get(f"{SIMPLE}.controller_names") or ():
        at = f"{SIMPLE}.{name}"
        kind, space = values.get(f"{at}.type"), values.get(f"{at}.action_ns")
        if kind in GOALS:
            goal = Opened("calls", f"{name}/{space}" if space else str(name), GOALS[kind])
            yield goal, values.get(f"{at}.joints") or []


def led_by(node: str, row: Mapping[str, str], values: Mapping[str, Any]) -> str:
    """Return the name that a parameter gives, or that of the code."""
    if row["name"] == "<either>joint_states":  # joint_state_broadcaster.cpp
        return f"{'~/' if values.get('use_local_topics') is True else ''}joint_states"
    # Below the name of the node itself: get_name() + "/..."
    own = re.sub("^<get_name>/", "~/", row["name"])
    parameter, default = GIVEN.get((node, own), (row["parameter"], own))
    parameter = PARAMETERS.get((node, row["name"]), parameter)
    return str(values.get(parameter) or default) if parameter else default


def is_met(condition: str, values: Mapping[str, Any], release: str) -> bool | None:
    """Whether a condition of the code holds, where it is a parameter's member (``use_stamped_vel_``,
    ``not (params_.enable)``); nav2_util/twist_publisher.hpp calls its one ``is_stamped_``."""
    if condition in ONCE:
        return True
    found = re.fullmatch(r"(not \()?(?:params_\.)?(\w+?)_?\)?", condition)
    if not found:
        return None
    name, defaults = STAMPED if found[2] == "is_stamped" else (found[2], {})
    value = values.get(name, defaults.get(release, True) if defaults else None)
    return value != bool(found[1]) if isinstance(value, bool) else None


def costmap_sources(values: Mapping[str, Any], release: str) -> Iterator[Opened]:
    """Yield the sensors of a costmap (nav2_costmap_2d/plugins/obstacle_layer.cpp): until Jazzy
    their relative topics are the costmap's own, later those of its parent, as
    joinWithParentNamespace makes them."""
    for layer in values.get("plugins", ()):
        if str(values.get(f"{layer}.plugin", "")).endswith("StaticLayer"):
            yield map_of(str(values.get(f"{layer}.map_topic", "")), release)
        for source in str(values.get(f"{layer}.observation_sources", "")).split():
            at = f"{layer}.{source}"
            kind = str(values.get(f"{at}.data_type", "LaserScan"))
            topic = str(values.get(f"{at}.topic", source))
            if not topic.startswith("/") and release not in ("humble", "iron", "jazzy"):
                topic = f"../{topic}"
            yield Opened("subscribes", topic, f"sensor_msgs/msg/{kind}")


def map_of(topic: str, release: str) -> Opened:
    """Return the map of a static layer (nav2_costmap_2d/plugins/static_layer.cpp): by default
    the one of the namespace above; a relative one is the costmap's own until Jazzy."""
    own = topic and (topic.startswith("/") or release in ("humble", "iron", "jazzy"))
    return Opened("subscribes", topic if own else f"../{topic or 'map'}", MAP)


def flat(values: Mapping[str, Any], at: str = "") -> dict[str, Any]:
    """Parameters with dots, as rcl has them."""
    found: dict[str, Any] = {}
    for key, it in values.items():
        found |= flat(it, f"{at}{key}.") if isinstance(it, dict) else {f"{at}{key}": it}
    return found


def parameters_of(fqn: str, sections: list[Mapping[str, Any]]) -> dict[str, Any]:
    """Return a node's values in parameter files, later over earlier ones (rcl_yaml_param_parser)."""
    found: dict[str, Any] = {}
    for file in sections:
        if "" in file:
            found |= file[""]
            continue
        for key, values in keys_of(file):
            if re.fullmatch(pattern(key), fqn):
                found |= flat(values)
    return found


def keys_of(file: Any, at: str = "") -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Yield the nodes of a parameter file with their values."""
    if not isinstance(file, dict):
        return
    for key, it in file.items():
        if key == "ros__parameters":
            yield at, it or {}
        else:
            yield from keys_of(it, f"{at}/{str(key).strip('/')}")


def pattern(key: str) -> str:
    """``**`` is any number of words, ``*`` one."""
    words = {"/**": r"(/[^/]+)+", "/*": "/[^/]+"}
    parts = re.split(r"(/\*\*|/\*)", key)
    return "".join(words.get(it) or re.escape(it) for it in parts)


@cache
def defaults(node: str, release: str) -> Mapping[str, Any]:
    """Return the frames and switches that a node has without a parameter file."""
    found = {}
    with lzma.open(ROOT / f"fixtures/interfaces/parameters_{release}.tsv.xz", "rt") as file:
        for row in csv.reader(file, delimiter="\t", quoting=csv.QUOTE_NONE):
            wanted = ("frame", "tf_", "publish_tf", "topic")
            own = row[1] == CLASSES.get(node, node) and row[4]
            if own and (row[3] == "bool" or any(it in row[2] for it in wanted)):
                found[row[2]] = {"true": True, "false": False, '""': ""}.get(row[4], row[4])
    return found
