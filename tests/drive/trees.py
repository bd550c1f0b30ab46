# SPDX-License-Identifier: Apache-2.0
"""Which transforms are sent, and by whom: what each program makes of its parameters and description."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

TF = "tf2_msgs/msg/TFMessage"
ODOMETRY = "nav_msgs/msg/Odometry"
# The frame of the odometry that a node hears, beside its parameters.
HEARD = "frame of odometry"
# Parent and child by parameter, and the parameter that switches it off (amcl_node.cpp,
# slam_toolbox_common.cpp, rtabmap_slam/src/CoreWrapper.cpp).
SENT = {
    "amcl": ("global_frame_id", "odom_frame_id", "tf_broadcast"),
    "slam_toolbox": ("map_frame", "odom_frame", ""),
    "rtabmap": ("map_frame_id", HEARD, "publish_tf"),
}
DEFAULTS = {
    "slam_toolbox": {"map_frame": "map", "odom_frame": "odom", "base_frame": "base_footprint"},
    "amcl": {"global_frame_id": "map", "odom_frame_id": "odom", "base_frame_id": "base_footprint"},
    "rtabmap": {"map_frame_id": "map", "frame_id": "base_link"},
}
DRIVES = {"diff_drive_controller": "base_link", "mecanum_drive_controller": "base_footprint"}
# Frames that a program looks up, by parameter (the files of nav2, slam_toolbox and robot_localization).
LOOKED_UP = {
    "amcl": ("base_frame_id", "odom_frame_id"),
    "slam_toolbox": ("base_frame", "odom_frame"),
    "bt_navigator": ("global_frame", "robot_base_frame"),
    "behavior_server": ("local_frame", "robot_base_frame"),
    "collision_monitor": ("base_frame_id", "odom_frame_id"),
    "local_costmap": ("global_frame", "robot_base_frame"),
    "global_costmap": ("global_frame", "robot_base_frame"),
    "ekf_filter_node": ("base_link_frame", "odom_frame"),
    "rtabmap": ("frame_id", HEARD),
}


class Edge(NamedTuple):
    """A transform on a topic."""

    robot: str
    topic: str
    parent: str
    child: str
    node: str


def is_static(topic: str) -> bool:
    return "tf_static" in topic.split("/")


def static_of(topic: str) -> str:
    """Return the topic of static transforms, beside that of the others: /tf_static/robot1."""
    return "/".join("tf_static" if it == "tf" else it for it in topic.split("/"))


def moving_of(topic: str) -> str:
    return "/".join("tf" if it == "tf_static" else it for it in topic.split("/"))


def with_odometry(node: Any, nodes: Iterable[Any], ends: Any, gz: Any, bridges: Any) -> Any:
    """Return the node with the frame of the odometry that it hears: what places the map against
    it and has no name for it takes that (rtabmap_slam/src/CoreWrapper.cpp, odomFrameId_)."""
    if node.what != "rtabmap":
        return node
    heard = [it.name for it in ends if it[1:3] == (node.fqn, "subscribes") and it.type == ODOMETRY]
    found = [it for topic in heard for it in begun(topic, nodes, ends, gz, bridges)]
    given = node.values.get("odom_frame_id")
    return node._replace(values={**node.values, HEARD: given or next(iter(found), "")})


def begun(topic: str, nodes: Iterable[Any], ends: Any, gz: Any, bridges: Any) -> Iterator[str]:
    """Yield the frames in which the odometry on a topic begins."""
    rows = [it.gz for it in bridges if it.to_ros and (it.ros, it.type) == (topic, ODOMETRY)]
    for end in gz:
        if end.role == "sends" and end.topic in rows and end.type == "gz.msgs.Odometry":
            yield end.frames[0]
    senders = {it.node for it in ends if it.role == "publishes" and it[3:5] == (topic, ODOMETRY)}
    for it in (it for it in nodes if it.fqn in senders):
        if it.what in DRIVES:
            yield of_drive(it)[0]
        elif it.what == "ekf_filter_node":
            yield str(it.values.get("world_frame") or it.values.get("odom_frame", "odom"))
        elif isinstance(it.values.get(""), tuple):
            yield it.values[""][0]


def edges_of(
    given: Any, nodes: Iterable[Any], roots: Mapping[str, Any], ends: Any, gz: Any, bridges: Any
) -> Iterator[Edge]:
    """Every transform that is sent."""
    topics = {
        (it.node, is_static(it.name)): it.name
        for it in ends
        if it.type == TF and it.role == "publishes"
    }
    for it in nodes:
        for parent, child, static in sent_by(it, roots.get(it.robot)):
            topic = topics.get((it.fqn, static))
            if topic:
                yield Edge(it.robot, topic, parent, child, it.fqn)
    for end in (it for it in gz if it.frames[0]):
        for row in bridges:
            if row.gz == end.topic and row.to_ros and row.type == TF:
                yield Edge(end.model, row.ros, *end.frames, f"gz {end.model} {end.what}")


def sent_by(node: Any, root: Any) -> Iterator[tuple[str, str, bool]]:
    """Parent, child and whether it is static."""
    values = {
        **DEFAULTS.get(node.what, {}),
        **{k: v for k, v in node.values.items() if v not in ("", None)},
    }
    if node.what == "robot_state_publisher" and root is not None:
        yield from of_description(root, str(values.get("frame_prefix", "")))
    elif node.what == "static_transform_publisher":
        yield from of_arguments(node.values.get("", []))
    elif node.what in SENT:
        parent, child, switch = SENT[node.what]
        if (not switch or values.get(switch, True)) and values.get(child):
            yield str(values[parent]), str(values[child]), False
    elif node.what in DRIVES and values.get("enable_odom_tf", True):
        yield *of_drive(node), False
    elif node.what == "ekf_filter_node" and values.get("publish_tf", True):
        yield of_filter(values)
    elif isinstance(values.get(""), tuple) and any(it.type == TF for it in node.ends):
        yield *values[""], False


def of_drive(node: Any) -> tuple[str, str]:
    """Parent and child of a wheeled controller's odometry."""
    values = {key: it for key, it in node.values.items() if it not in ("", None)}
    before = prefix(values, node.namespace)
    odom, base = (
        values.get("odom_frame_id", "odom"),
        values.get("base_frame_id", DRIVES[node.what]),
    )
    return f"{before}{odom}".lstrip("/"), f"{before}{base}".lstrip("/")


def of_description(root: Any, before: str) -> Iterator[tuple[str, str, bool]]:
    for joint in root.iterfind("joint"):
        parent, child = joint.find("parent"), joint.find("child")
        if parent is not None and child is not None:
            static = joint.get("type") == "fixed"
            yield before + parent.get("link"), before + child.get("link"), static


def of_arguments(words: list[str]) -> Iterator[tuple[str, str, bool]]:
    if "--frame-id" in words:
        yield words[words.index("--frame-id") + 1], words[words.index("--child-frame-id") + 1], True


def of_filter(values: Mapping[str, Any]) -> tuple[str, str, bool]:
    """robot_localization/src/ros_filter.cpp: the world frame decides which of the two is sent."""
    odom, base, world = (
        str(values.get(key, default))
        for key, default in (
            ("odom_frame", "odom"),
            ("base_link_frame", "base_link"),
            ("map_frame", "map"),
        )
    )
    return (world, odom, False) if values.get("world_frame", odom) == world else (odom, base, False)


def prefix(values: Mapping[str, Any], namespace: str) -> str:
    """diff_drive_controller.cpp: the prefix that is given, else the node's namespace."""
    if not values.get("tf_frame_prefix_enable", True):
        return ""
    found = str(values.get("tf_frame_prefix") or namespace).strip("/")
    return f"{found}/" if found else ""


def whole(edges: Iterable[Edge]) -> dict[str, dict[str, set[str]]]:
    """Topic -> child -> its parents."""
    found: dict[str, dict[str, set[str]]] = {}
    for it in edges:
        found.setdefault(it.topic, {}).setdefault(it.child, set()).add(it.parent)
    return found


def connected(edges: Iterable[Edge], one: str, other: str) -> bool:
    """Whether two frames are in one tree."""
    near: dict[str, set[str]] = {}
    for it in edges:
        near.setdefault(it.parent, set()).add(it.child)
        near.setdefault(it.child, set()).add(it.parent)
    seen, queue = {one}, [one]
    while queue:
        for it in near.get(queue.pop(), set()) - seen:
            seen.add(it)
            queue.append(it)
    return other in seen
