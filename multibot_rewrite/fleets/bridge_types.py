"""Types in the rows of a ros_gz_bridge file that the bridge does not convert into each other."""

from __future__ import annotations

from collections.abc import Iterator

import yaml

from multibot_rewrite.companions.bridge_entry import TYPES
from multibot_rewrite.companions.rviz.read_config import text_of
from multibot_rewrite.companions.yaml_text import YamlText, found_at
from multibot_rewrite.findings.finding import WARNING, Finding
from multibot_rewrite.findings.rule import declare
from multibot_rewrite.remap.bridged_topics import bridge_data

NOT_CONVERTED = declare(
    "MF510",
    "bridge-types-not-converted",
    WARNING,
    what="ros_gz_bridge knows the ROS type and the gz type of an entry, and does not convert the one "
    "into the other.",
    why="ros_gz_bridge fails to make this bridge, so the topic is not bridged.",
    fix="Write the type that belongs to the other one.",
    bad="""\
- ros_topic_name: scan
  gz_topic_name: scan
  ros_type_name: sensor_msgs/msg/PointCloud2
  gz_type_name: gz.msgs.LaserScan
""",
    good="""\
- ros_topic_name: scan
  gz_topic_name: scan
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
""",
    formats=("bridge",),
)


def not_converted(document: YamlText, row: yaml.Node) -> Iterator[Finding]:
    """An entry whose types do not belong together."""
    ros, gz = (text_of(row, key) for key in TYPES)
    known: dict[str, list[str]] = bridge_data()["pairs"]
    bare = gz.rpartition("msgs.")[2]
    belongs = known.get(ros, ())
    others = [it for it, types in known.items() if bare in types]
    if belongs and others and bare not in belongs:
        message = f"{ros} and {gz} are not converted into each other"
        hint = f"with {gz} write {' or '.join(others)}"
        yield found_at(document, row, NOT_CONVERTED, message, hint)
