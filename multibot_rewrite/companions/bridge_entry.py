"""An entry of a ros_gz_bridge file: its keys, the gz topics of a model, its names before and after."""

from __future__ import annotations

import re

import yaml

from multibot_rewrite.companions.yaml_blocks import Block
from multibot_rewrite.record import NamedTuple

# Stands for the name of the spawned model: it may differ from the namespace and the tag.
MODEL_SLOT = "multibotModelSlot"
BOTH, ROS, GZ = "topic_name", "ros_topic_name", "gz_topic_name"
TYPES = ("ros_type_name", "gz_type_name")
DIRECTIONS = ("BIDIRECTIONAL", "GZ_TO_ROS", "ROS_TO_GZ")
SERVICE = "service_name"
KEYS: tuple[str, ...] = (
    BOTH,
    ROS,
    GZ,
    *TYPES,
    SERVICE,
    "direction",
    "publisher_queue",
    "subscriber_queue",
    "lazy",
)
KEYS += ("publish_optical_frame", "frame_id", "qos_profile", "gz_req_type_name", "gz_rep_type_name")
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


def below(name: str, above: str) -> str:
    """A ROS name of a bridge that runs in a namespace below the robot's."""
    return f"/{above}/{name}" if above and not name.startswith("/") else name
