"""Rows of a ros_gz_bridge file as the bridge reads them.

Source: gazebosim/ros_gz ros_gz_bridge/src/bridge_config.cpp (parseEntry, and its messages).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import yaml

from multibot_rewrite.base.findings.finding import WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.nearest import did_you_mean
from multibot_rewrite.companions.bridge_entry import KEYS, TYPES, faults, row_of, text_in
from multibot_rewrite.companions.kinds import BRIDGE
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.yaml_text import items
from multibot_rewrite.rules.files.examples import a_row
from multibot_rewrite.rules.files.records import Remark, remark_at
from multibot_rewrite.spelling.bridged_topics import bridge_data


@rule(
    "MB855",
    "bridge-row",
    WARNING,
    what="ros_gz_bridge does not load a row: a type or a topic is missing, topic_name is beside "
    "ros_topic_name or gz_topic_name, or the direction is not known.",
    why="ros_gz_bridge reports the row and goes on without it, so one topic is not bridged.",
    fix="Write ros_topic_name and gz_topic_name or topic_name, both types, and one of BIDIRECTIONAL, "
    "GZ_TO_ROS and ROS_TO_GZ.",
    bad=a_row("direction: GZ_TO_ROSS"),
    good=a_row("direction: GZ_TO_ROS"),
    line=5,
    formats=(BRIDGE,),
)
def bridge_row(file: NamedFile) -> Iterator[Remark]:
    """Each fault of each row."""
    for node in _rows(file):
        yield from (remark_at(*fault) for fault in faults(node))


def _rows(file: NamedFile) -> list[yaml.Node]:
    return items(file.document.root) if file.document else []


@rule(
    "MB858",
    "bridge-key",
    WARNING,
    what="A row of a ros_gz_bridge file has a key that the bridge does not know.",
    why="ros_gz_bridge ignores it without a message, so the default is used.",
    fix="Correct the key.",
    bad=a_row("subscriber_queu: 5"),
    good=a_row("subscriber_queue: 5"),
    line=5,
    formats=(BRIDGE,),
)
def bridge_key(file: NamedFile) -> Iterator[Remark]:
    """Each key of each row."""
    for row in map(row_of, _rows(file)):
        for name, (key, _) in row.items():
            if name not in KEYS:
                message = f"the bridge knows no {name!r}, and ignores it"
                yield remark_at(key, message, did_you_mean(name, KEYS) or "delete it")


@rule(
    "MB874",
    "bridge-types-not-converted",
    WARNING,
    what="ros_gz_bridge knows the ROS type and the gz type of a row, and does not convert the one "
    "into the other.",
    why="ros_gz_bridge fails to make this bridge, so the topic is not bridged.",
    fix="Write the type that belongs to the other one.",
    bad=a_row().replace("gz.msgs.LaserScan", "gz.msgs.IMU"),
    good=a_row(),
    formats=(BRIDGE,),
)
def not_converted(file: NamedFile) -> Iterator[Remark]:
    """Rows whose types do not belong together."""
    known: Mapping[str, list[str]] = bridge_data()["pairs"]
    for node in _rows(file):
        ros, gz = (text_in(row_of(node), key) for key in TYPES)
        bare, belongs = gz.rpartition("msgs.")[2], known.get(ros, ())
        others = [it for it, types in known.items() if bare in types]
        if belongs and others and bare not in belongs:
            message = f"{ros} and {gz} are not converted into each other"
            yield remark_at(node, message, f"with {gz} write {' or '.join(others)}")
