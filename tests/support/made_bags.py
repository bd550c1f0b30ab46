# SPDX-License-Identifier: Apache-2.0
"""Bags of two robots, made with the writer of rosbags, and plans for them."""

from __future__ import annotations

import struct
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from plans import PlannedRobot, planned, planned_end
from rosbags.interfaces import (
    Qos,
    QosDurability,
    QosHistory,
    QosLiveliness,
    QosReliability,
    QosTime,
)
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

from multibot_rewrite.system.records import PUBLISHES, TOPIC, System

STORE = get_typestore(Stores.ROS2_HUMBLE)
SCAN, ODOM = "sensor_msgs/msg/LaserScan", "nav_msgs/msg/Odometry"
TWIST, TF, TEXT = "geometry_msgs/msg/Twist", "tf2_msgs/msg/TFMessage", "std_msgs/msg/String"
ROBOTS = ("robot1", "robot2")
SECOND = 1_000_000_000
# Name in the code -> type, frame of its header, messages in ten seconds.
USUAL: Mapping[str, tuple[str, str, int]] = {
    "scan": (SCAN, "laser", 100),
    "odom": (ODOM, "odom", 200),
    "cmd_vel": (TWIST, "", 100),
}
EDGES = (("odom", "base_link"), ("base_link", "laser"))


class Made(NamedTuple):
    """A topic to record; ``frames`` are those of a header, ``edges`` those of tf."""

    name: str
    type: str
    count: int
    frame: str = ""
    edges: Sequence[tuple[str, str]] = ()
    latched: Sequence[bool] = (False,)


def healthy() -> dict[str, Made]:
    """Return what two robots send that are as planned, by name."""
    found = []
    for robot in ROBOTS:
        for name, (type_, frame, count) in USUAL.items():
            found.append(Made(f"/{robot}/{name}", type_, count, frame and f"{robot}/{frame}"))
        edges = [(f"{robot}/{parent}", f"{robot}/{child}") for parent, child in EDGES]
        found.append(Made(f"/{robot}/tf", TF, 100, edges=edges[:1]))
        found.append(Made(f"/{robot}/tf_static", TF, 1, edges=edges[1:], latched=(True,)))
    return {it.name: it for it in found}


def plan() -> System:
    """Return the plan of the healthy bag."""
    robots = tuple(
        PlannedRobot(
            robot,
            (f"/{robot}/driver",),
            tuple(f"{robot}/{frame}" for frame in ("odom", "base_link", "laser")),
            f"/{robot}/tf",
        )
        for robot in ROBOTS
    )
    ends = tuple(
        planned_end(f"/{robot}/driver", TOPIC, PUBLISHES, f"/{robot}/{name}", type_, name)
        for robot in ROBOTS
        for name, type_ in (
            *((name, usual[0]) for name, usual in USUAL.items()),
            ("tf", TF),
            ("tf_static", TF),
        )
    )
    return planned("both", robots, (), ("/clock", "/rosout"), ("map",), ends)


def _text(value: str) -> bytes:
    data = value.encode() + b"\0"
    return struct.pack("<I", len(data)) + data


def _aligned(data: bytes, size: int) -> bytes:
    return data + b"\0" * (-len(data) % size)


def message(made: Made, at: int = 0) -> bytes:
    """Its bytes in CDR, as far as its header goes, or all transforms, which are ``at`` metres ahead."""
    if made.type == TF:
        body = struct.pack("<I", len(made.edges))
        for parent, child in made.edges:
            body = _aligned(body, 4) + b"\0" * 8 + _text(parent)
            body = _aligned(body, 4) + _text(child)
            body = _aligned(body, 8) + struct.pack("<7d", at, 2, 3, 0, 0, 0, 1)
        return b"\0\1\0\0" + body
    return b"\0\1\0\0" + (b"\0" * 8 + _text(made.frame) if made.frame else b"\0" * 48)


def qos(latched: bool) -> Qos:
    kept = QosDurability.TRANSIENT_LOCAL if latched else QosDurability.VOLATILE
    never = QosTime(9_223_372_036, 854_775_807)
    words = (QosHistory.KEEP_LAST, 10, QosReliability.RELIABLE, kept, never, never)
    return Qos(*words, QosLiveliness.AUTOMATIC, never, False)


def write(path: Path, topics: Iterable[Made], mcap: bool = True) -> Path:
    """Return the bag as a folder, ten seconds long; returns its path."""
    storage = StoragePlugin.MCAP if mcap else StoragePlugin.SQLITE3
    with Writer(path, version=9, storage_plugin=storage) as writer:
        for made in topics:
            profiles = [qos(latched) for latched in made.latched]
            connection = writer.add_connection(
                made.name, made.type, typestore=STORE, offered_qos_profiles=profiles
            )
            for at in range(made.count):
                when = SECOND + at * 10 * SECOND // max(made.count - 1, 1)
                writer.write(connection, when, message(made, at))
    return path
