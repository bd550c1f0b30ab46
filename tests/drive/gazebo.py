# SPDX-License-Identifier: Apache-2.0
"""What simulators make of a description: systems, sensors and plugins with the names that they open.

The tables beside this file were read in the sources of gz-sim, gz-sensors and gazebo_ros_pkgs.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import NamedTuple

from lxml import etree

HERE = Path(__file__).parent
# A model frame is prefixed by the model where nothing is given (DiffDrive.cc, OdometryPublisher.cc).
FRAMES = {
    "odometry-publisher": (
        "odom_frame",
        "robot_base_frame",
        "{model}/odom",
        "{model}/base_footprint",
    ),
    "": ("frame_id", "child_frame_id", "{model}/odom", "{model}/{link}"),
}
# Messages with the frames of a transform.
PLACED = ("gz.msgs.Pose_V", "gz.msgs.Odometry")
SLOT = re.compile(r"\{([\w/]+)\}")
AUTOPILOT = "ArduPilotPlugin"
# What is of ROS 1 alone, with what a robot does not do: its folder is empty in gazebo_ros_pkgs' branch
# ros2, or is left out by COLCON_IGNORE in every branch of ros_gz for ROS 2.
GONE = {
    "libgazebo_ros_control.so": ("starts", "nothing moves its joints"),
    "RosGzPointCloud": ("sees", "no point cloud comes of it"),
}
TABLES = ("gz_systems.tsv", "classic_plugins.tsv")
# Plugins with a controller manager inside.
CONTROL = ("gz_ros2_control", "ign_ros2_control", "gazebo_ros2_control")
SENSORS = {
    "depth": "depth_camera",
    "lidar": "gpu_lidar",
    "ray": "gpu_lidar",
    "gpu_ray": "gpu_lidar",
    "gps": "navsat",
}


class GzEnd(NamedTuple):
    """A gz topic that a model hears or sends; ``frames`` are parent and child of what it places,
    ``frame`` is that of a sensor's messages."""

    model: str
    role: str
    topic: str
    type: str
    what: str
    frames: tuple[str, str] = ("", "")
    frame: str = ""


class Plugin(NamedTuple):
    """A plugin of Classic: a ROS node with its rules."""

    name: str
    namespace: str
    rules: tuple[tuple[str, str], ...]
    ends: tuple[tuple[str, str, str], ...]
    frames: tuple[str, str]
    file: str


@cache
def rows(file: str) -> tuple[Mapping[str, str], ...]:
    with (HERE / file).open() as opened:
        return tuple(csv.DictReader(opened, delimiter="\t"))


def valid(topic: str) -> str:
    """gz-transport's name: one slash before it (TopicUtils::AsValidTopic)."""
    return "/" + topic.strip().replace(" ", "_").lstrip("/")


def plugin_key(element: etree._Element) -> str:
    """``diff-drive`` of ``libignition-gazebo-diff-drive-system.so``, ``diff_drive`` of Classic's."""
    name = element.get("filename", "").removeprefix("lib").removesuffix(".so")
    for ending in ("gz-sim-", "ignition-gazebo-"):
        name = name.removeprefix(ending)
    return name.removesuffix("-system").removeprefix("gazebo_ros_")


def of_plugin(plugin: etree._Element, model: str, world: str, link: str) -> Iterator[GzEnd]:
    """Yield what gz-sim opens for a plugin of a model; ``link`` is the canonical one."""
    turns = text(plugin, "use_angvel_cmd") in ("true", "1")
    words = {"model": model, "world": world, "link": link, "joint_index": "0"}
    words |= {"cmd": "cmd_vel" if turns else "cmd_thrust", "state": "force" if turns else "ang_vel"}
    for name in ("namespace", "robotNamespace"):
        words[name] = text(plugin, name) or model
    yield from of_rows(plugin, plugin_key(plugin), words)


def of_sensor(sensor: etree._Element, model: str, world: str, link: str) -> Iterator[GzEnd]:
    """Yield what it opens for a sensor, and the frame of its messages (ros_gz_bridge: / for ::)."""
    kind, name = sensor.get("type", ""), sensor.get("name", "")
    at = f"/world/{world}/model/{model}/link/{link}/sensor/{name}"
    found = (text(sensor, it) for it in ("gz_frame_id", "ignition_frame_id", "frame_id"))
    frame = next((it for it in found if it), f"{model}/{link}/{name}")
    for it in of_rows(sensor, f"sensor {SENSORS.get(kind, kind)}", {"sensor": at, "model": model}):
        yield it._replace(frame=frame)


def of_rows(element: etree._Element, key: str, words: Mapping[str, str]) -> Iterator[GzEnd]:
    for row in rows("gz_systems.tsv"):
        if row["plugin"] == key and row["role"] != "-":
            frames = frames_of(element, key, words) if row["type"] in PLACED else ("", "")
            end = GzEnd(words["model"], row["role"], "", row["type"], key, frames)
            if key == AUTOPILOT:
                yield from (end._replace(topic=valid(it)) for it in commanded(element))
            else:
                named = given(element, row["element"], words)
                topic = named or SLOT.sub(lambda it: value(element, it[1], words), row["default"])
                yield end._replace(topic=valid(topic))


def commanded(autopilot: etree._Element) -> list[str]:
    """Return the topics on which an autopilot sends to its model's systems (ArduPilotPlugin.cc)."""
    controls = [it for it in autopilot.iterfind("control") if text(it, "type") == "COMMAND"]
    return [text(it, "cmd_topic") for it in controls if text(it, "cmd_topic")]


def given(element: etree._Element, path: str, words: Mapping[str, str]) -> str:
    """Return the topic that an element gives, the first that is there of ``a|b``;
    ``topic/points`` is below that of topic, ``topic/..`` a camera_info beside it, ``{a}/{b}`` is
    made of elements or words."""
    made = (
        below(element, it) if "{" not in it else joined(element, it, words)
        for it in path.split("|")
    )
    return next((it for it in made if it), "")


def below(element: etree._Element, path: str) -> str:
    tag, _, rest = path.partition("/")
    found = text(element, tag) if tag else ""
    if not found or not rest:
        return found
    return f"{found.rpartition('/')[0]}/camera_info" if rest == ".." else f"{found}/{rest}"


def joined(element: etree._Element, path: str, words: Mapping[str, str]) -> str:
    """Nothing where the element does not have its own part of it."""
    own = [it for it in SLOT.findall(path) if it not in ("cmd", "state", "model")]
    if not any(text(element, it) for it in own[-1:]):
        return ""
    return SLOT.sub(lambda it: value(element, it[1], words), path)


def value(element: etree._Element, name: str, words: Mapping[str, str]) -> str:
    return words.get(name) or text(element, name)


def frames_of(element: etree._Element, key: str, words: Mapping[str, str]) -> tuple[str, str]:
    parent, child, *defaults = FRAMES.get(key, FRAMES[""])
    made = [it.format(**{"link": "", **words}) for it in defaults]
    return text(element, parent) or made[0], text(element, child) or made[1]


def text(element: etree._Element, tag: str) -> str:
    return (element.findtext(tag) or "").strip()


def classic_plugins(root: etree._Element) -> Iterator[Plugin]:
    """Yield the ROS nodes that plugins of Classic are (gazebo_ros/src/node.cpp)."""
    for it in root.iter("plugin"):
        file = it.get("filename", "")
        key = plugin_key(it)
        ends = tuple(
            (row["role"], filled(row["name"], it), filled(row["type"], it))
            for row in rows("classic_plugins.tsv")
            if row["plugin"] == key
        )
        ros = it.find("ros")
        if not file.removeprefix("lib").startswith("gazebo_ros") or (ros is None and not ends):
            continue
        rules = () if ros is None else tuple(rules_of(ros))
        space = "/" + (text(ros, "namespace") if ros is not None else "").strip("/")
        frames = (
            text(it, "odometry_frame") or "odom",
            text(it, "robot_base_frame") or "base_footprint",
        )
        yield Plugin(it.get("name", ""), space, rules, ends, frames, file)


def strangers(
    roots: Mapping[str, etree._Element], models: Mapping[str, str]
) -> Iterator[tuple[str, str]]:
    """Plugins and sensors of spawned robots that no source was read of."""
    known = {row["plugin"] for file in TABLES for row in rows(file)}
    for who in (it for it in roots if it in models):
        for it in roots[who].iter("plugin"):
            # A hardware class of ros2_control has no file: its controller manager loads it.
            if it.getparent().tag == "hardware" or it.get("filename", "") in ("", *GONE):
                continue
            ours = any(word in it.get("filename", "") for word in CONTROL)
            if not ours and plugin_key(it) not in known:
                yield who, it.get("filename", "")
        for it in roots[who].iter("sensor"):
            kind = it.get("type", "")
            inside = it.getparent().tag in ("ros2_control", "hardware")
            if not inside and f"sensor {SENSORS.get(kind, kind)}" not in known:
                yield who, f"sensor {kind}"


def filled(name: str, plugin: etree._Element) -> str:
    words = {"camera_name": text(plugin, "camera_name") or "camera"}
    words["output_type"] = text(plugin, "output_type") or "sensor_msgs/PointCloud2"
    made = name.format(**words)
    return made.replace("sensor_msgs/", "sensor_msgs/msg/") if "{output_type}" in name else made


def rules_of(ros: etree._Element) -> Iterator[tuple[str, str]]:
    """Yield the rules of a plugin: ``<remapping>``, and arguments as on a command line."""
    for it in (*ros.findall("remapping"), *ros.findall("argument")):
        old, found, new = (it.text or "").strip().rpartition(" ")[2].partition(":=")
        if found:
            yield old, new
