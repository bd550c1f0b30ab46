"""What ros_gz_bridge is told -> its topics in ROS.

Source: ros_gz jazzy, ros_gz_bridge/src/parameter_bridge.cpp (``TOPIC@ROS_TYPE[GZ_TYPE``: ``[`` from the
simulator, ``]`` to it, ``@`` both ways) and bridge_config.cpp (the keys of its file).
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import yaml

from multibot_rewrite.base.bounded import load_yaml
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES

if TYPE_CHECKING:
    from multibot_rewrite.producers.launch.running import RunningNode

_BRIDGE = "ros_gz_bridge"
_WORD = re.compile(r"(?P<topic>[^@]+)@(?P<type>[^@\[\]]+)(?P<way>[@\[\]])[^@\[\]]+")
_ROLES = {"[": (PUBLISHES,), "]": (SUBSCRIBES,), "@": (PUBLISHES, SUBSCRIBES)}
_WAYS = {"GZ_TO_ROS": "[", "ROS_TO_GZ": "]", "BIDIRECTIONAL": "@"}
Row = tuple[str, str, str, str]


def is_bridge(it: RunningNode) -> bool:
    """Does the node pass topics of a simulator on?"""
    return it.facts is not None and (it.facts.known or it.facts.name) == _BRIDGE


def bridged_by(it: RunningNode) -> Iterator[Row]:
    """Role, topic and type in ROS, and the topic in the simulator, of all that a bridge passes on."""
    for word in it.arguments:
        found = _WORD.fullmatch(word)
        if found:
            yield from _rows(found["topic"], found["type"], found["way"], found["topic"])
    given = it.values.get("config_file")
    path = str(given.value) if given else ""
    if path and os.path.isfile(path):
        yield from _of_text(read_file(path).decode("utf-8", "replace"))
    for text in it.texts:
        yield from _of_text(text)


def _of_text(text: str) -> Iterator[Row]:
    try:
        entries = load_yaml(text)
    except (yaml.YAMLError, ValueError):
        return
    for entry in entries if isinstance(entries, list) else ():
        if isinstance(entry, Mapping):
            topic = entry.get("ros_topic_name") or entry.get("topic_name")
            way = _WAYS.get(str(entry.get("direction", "BIDIRECTIONAL")), "@")
            inside = entry.get("gz_topic_name") or topic
            if topic:
                yield from _rows(str(topic), str(entry.get("ros_type_name", "")), way, str(inside))


def _rows(topic: str, type_: str, way: str, inside: str) -> Iterator[Row]:
    package, _, name = type_.partition("/")
    full = type_ if "/msg/" in type_ or not name else f"{package}/msg/{name}"
    yield from ((role, topic, full, inside) for role in _ROLES[way])
