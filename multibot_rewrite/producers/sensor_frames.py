# SPDX-License-Identifier: Apache-2.0
"""The frames of what sensors of gz-sim send.

Source: gz-sim8 src/systems/sensors/Sensors.cc and Imu.cc (a sensor is called as its scoped name),
gz-sensors src/Sensor.cc (ign-sensors6, gz-sensors8, gz-sensors9: what names the frame, else its own
name), ros_gz_bridge convert/utils.hpp (frame_id_gz_to_ros makes / of each ::).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple, cast

from lxml.etree import _Element

from multibot_rewrite.base.releases import has_release
from multibot_rewrite.description.checks.links_and_joints import read_robot
from multibot_rewrite.description.rewriters.text import text_at

# The first of them that is there counts in these releases.
_NAMED = (
    ("camera/optical_frame_id", ""),
    *(("ignition_frame_id", "humble"), ("frame_id", "kilted+"), ("gz_frame_id", "")),
)
_MODEL, _LINK = "model", "link"


class SensorFrame(NamedTuple):
    """The gz topic of a sensor, or that above its topics, and the frame of what it sends: one that its
    description names, or that which its place in the model makes. ``link`` is
    where it is written."""

    topic: str
    frame: str
    link: str
    is_named: bool
    line: int


def sensor_frames(root: _Element, model: str, release: str) -> Iterator[SensorFrame]:
    """Yield the frames of the sensors on links, in the order of the file; ``model`` is the spawned
    model's name. In a URDF the links at fixed joints are merged."""
    bodies = read_robot(root).body
    names = [path for path, words in _NAMED if has_release(words, release)]
    for sensor in root.iter("sensor"):
        link, above = _place(sensor)
        line = cast("int", sensor.sourceline)
        named = next(filter(None, (text_at(sensor, it) for it in names)), "")
        made = "/".join((model, *above, bodies.get(link, link), sensor.get("name", "")))
        yield SensorFrame(_full(text_at(sensor, "topic")), named or made, link, bool(named), line)


def sensor_on(topic: str, sensors: Iterable[SensorFrame]) -> SensorFrame | None:
    """Return the sensor that sends on a gz topic; None without."""
    name = _full(topic)
    found = [it for it in sensors if it.link and it.topic != "/" and _is_at(name, it.topic)]
    return max(found, key=lambda it: len(it.topic), default=None)


def _is_at(name: str, above: str) -> bool:
    return name == above or name.startswith(f"{above}/")


def _full(topic: str) -> str:
    return f"/{topic.lstrip('/')}"


def _place(sensor: _Element) -> tuple[str, list[str]]:
    """Return a sensor's link, empty for a sensor of a joint, and the models around it."""
    host = sensor.getparent()
    if host is None or host.tag not in (_LINK, "gazebo"):
        return "", []
    models = [it.get("name", "") for it in host.iterancestors(_MODEL)]
    return host.get("name" if host.tag == _LINK else "reference", ""), models[-2::-1]
