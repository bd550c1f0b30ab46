# SPDX-License-Identifier: Apache-2.0
"""An entry of a ros_gz_bridge file: its keys, what the bridge refuses, its names before and after.

Source: gazebosim/ros_gz ros_gz_bridge/src/bridge_config.cpp (parseEntry, and its messages).
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import NamedTuple

import yaml

from multibot_rewrite.base.conventions import PLACEHOLDER
from multibot_rewrite.base.nearest import did_you_mean_one_of
from multibot_rewrite.companions.yaml_text import Block, YamlText, items, pairs

# Stands for the name of the spawned model: it may differ from the namespace and the tag.
MODEL_SLOT = "multibotModelSlot"
BOTH, ROS, GZ = "topic_name", "ros_topic_name", "gz_topic_name"
TYPES = ("ros_type_name", "gz_type_name")
DIRECTIONS = ("BIDIRECTIONAL", "GZ_TO_ROS", "ROS_TO_GZ")
SERVICE, FRAME = "service_name", "frame_id"
KEYS: tuple[str, ...] = (BOTH, ROS, GZ, *TYPES, SERVICE, "direction", "publisher_queue")
KEYS += ("subscriber_queue", "lazy", "publish_optical_frame", FRAME, "qos_profile")
KEYS += ("gz_req_type_name", "gz_rep_type_name")
GZ_MODEL = re.compile(r"(?P<above>/?(?:world/[^/]+/)?model/)(?P<model>[^/]+)(?P<rest>/.*)?")
# A link, joint or sensor in a gz topic.
PART = re.compile(r"(?<=/)(link|joint|sensor)/([^/]+)")


class BridgeEntry(NamedTuple):
    """An entry and its names: both sides as they are, and as each robot has them.

    ``own`` is true if each robot needs its own.
    """

    node: yaml.MappingNode
    block: Block
    ros: str
    gz: str
    new_ros: str
    new_gz: str
    own: bool


class RowFault(NamedTuple):
    """Why the bridge leaves an entry out, and the node that it is about."""

    node: yaml.Node
    message: str
    hint: str


Row = Mapping[str, tuple[yaml.ScalarNode, yaml.Node]]
_OUT = "the bridge leaves it out"


def row_of(node: yaml.Node) -> Row:
    """Return the keys and values of an entry by the texts of the keys."""
    return {str(key.value): (key, value) for key, value in pairs(node)}


def text_in(row: Row, key: str) -> str:
    """Return the value of a key as text; empty if it is missing or not a scalar."""
    value = row[key][1] if key in row else None
    return str(value.value) if isinstance(value, yaml.ScalarNode) else ""


def faults(node: yaml.Node) -> Iterator[RowFault]:
    """Yield why the bridge does not load an entry; nothing if it does."""
    row = row_of(node)
    if not row:
        yield RowFault(node, f"the row is not a map of keys and values: {_OUT}", "")
        return
    for other in (ROS, GZ) if BOTH in row else ():
        if other in row:
            message = f"the row has {BOTH} and {other}: {_OUT}"
            yield RowFault(row[other][0], message, f"delete {BOTH}")
    direction = text_in(row, "direction")
    if direction and direction not in DIRECTIONS:
        hint = did_you_mean_one_of(direction, DIRECTIONS)
        message = f"the bridge has no direction {direction!r}: {_OUT}"
        yield RowFault(row["direction"][1], message, hint)
    lacks = " and ".join(it for it in TYPES if not text_in(row, it))
    if not any(text_in(row, it) for it in (BOTH, ROS, GZ)):
        lacks = ROS
    if lacks and not text_in(row, SERVICE):
        yield RowFault(node, f"the row has no {lacks}: {_OUT}", f"add {lacks}")


def below(name: str, above: str) -> str:
    """Return a ROS name of a bridge that runs in the namespace ``above`` below the robot's."""
    return f"/{above}/{name}" if above and not name.startswith("/") else name


def models(document: YamlText) -> Iterator[tuple[yaml.Node, str]]:
    """Yield each entry that is for a model, with the model."""
    for node in items(document.root):
        for key in (BOTH, GZ):
            found = GZ_MODEL.fullmatch(text_in(row_of(node), key))
            if found and not PLACEHOLDER.search(found["model"]):
                yield node, found["model"]


def model_of(document: YamlText) -> str:
    """Return the model that a file is for: the first in its gz topics, empty for none."""
    return next((name for _, name in models(document)), "")
