"""What is wrong with the entries of a ros_gz_bridge file."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import yaml

from multibot_rewrite.companions.bridge_entry import (
    BOTH,
    DIRECTIONS,
    GZ,
    GZ_MODEL,
    KEYS,
    MODEL_SLOT,
    PART,
    ROS,
    SERVICE,
    TYPES,
    BridgeEntry,
)
from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.names.rename_map import is_declared
from multibot_rewrite.companions.names.robot_topics import is_topic
from multibot_rewrite.companions.rviz.read_config import text_of
from multibot_rewrite.companions.yaml_text import YamlText, found_at, is_text, items, pairs
from multibot_rewrite.findings.finding import WARNING, Finding
from multibot_rewrite.findings.rule import declare
from multibot_rewrite.fleets.bridge_types import not_converted
from multibot_rewrite.nearest import did_you_mean
from multibot_rewrite.system.conventions import PLACEHOLDER

SKIPPED_ENTRY = declare(
    "MF502",
    "bridge-skips-entry",
    WARNING,
    what="ros_gz_bridge does not load an entry: a type or a topic is missing, topic_name is beside "
    "ros_topic_name or gz_topic_name, or the direction is not known. The entry is left out.",
    why="ros_gz_bridge logs an error and goes on without the entry, so one topic is not bridged.",
    fix="Correct the entry as the message says.",
    bad="""\
- topic_name: scan
  ros_topic_name: front_scan
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
""",
    good="""\
- gz_topic_name: scan
  ros_topic_name: front_scan
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
""",
    formats=("bridge",),
)


def skipped(document: YamlText, node: yaml.Node) -> Iterator[Finding]:
    """An entry that the bridge does not load."""
    fault = _fault(node)
    if fault:
        hint = "ros_gz_bridge skips this entry, so it is left out"
        yield found_at(document, node, SKIPPED_ENTRY, fault, hint)


def _fault(node: yaml.Node) -> str:
    """Why the bridge does not load an entry; empty if it does."""
    if not isinstance(node, yaml.MappingNode):
        return "the entry is not a map of keys and values"
    both, ros, gz = (text_of(node, key) for key in (BOTH, ROS, GZ))
    if both and (ros or gz):
        return f"{BOTH} cannot be used together with {ROS if ros else GZ}"
    if text_of(node, SERVICE):
        return ""
    missing = [key for key in TYPES if not text_of(node, key)]
    if missing or not (both or ros or gz):
        return f"{' and '.join(missing or (ROS, GZ))} is missing"
    direction = text_of(node, "direction")
    known = not direction or direction in DIRECTIONS
    return "" if known else f"direction {direction!r} is not one of {', '.join(DIRECTIONS)}"


SECOND_MODEL = declare(
    "MF505",
    "bridge-of-second-model",
    WARNING,
    what="A bridge file has topics of two models. The first model is the robot; topics of the other "
    "are bridged once for all robots.",
    why="If the other model is a robot too, its topics stay as they are, and the copies of it that "
    "are spawned for the fleet are not bridged.",
    fix="Nothing, if it is a part of the world such as a door. Otherwise write the robot's model, or "
    "give the other robot its own bridge file.",
    bad="""\
- ros_topic_name: odom
  gz_topic_name: /model/rover/odometry
  ros_type_name: nav_msgs/msg/Odometry
  gz_type_name: gz.msgs.Odometry
- ros_topic_name: battery
  gz_topic_name: /model/rover_v2/battery/linear_battery/state
  ros_type_name: sensor_msgs/msg/BatteryState
  gz_type_name: gz.msgs.BatteryState
""",
    good="""\
- ros_topic_name: odom
  gz_topic_name: /model/rover/odometry
  ros_type_name: nav_msgs/msg/Odometry
  gz_type_name: gz.msgs.Odometry
- ros_topic_name: battery
  gz_topic_name: /model/rover/battery/linear_battery/state
  ros_type_name: sensor_msgs/msg/BatteryState
  gz_type_name: gz.msgs.BatteryState
""",
    line=5,
    formats=("bridge",),
)


def model_of(document: YamlText) -> str:
    """The model that a file is for: the first in its gz topics, empty for none."""
    return next((name for _, name in _models(document)), "")


def other_models(document: YamlText, model: str) -> Iterator[Finding]:
    """Each other model than ``model``, at its first entry."""
    first: dict[str, yaml.Node] = {}
    for node, name in _models(document):
        first.setdefault(name, node)
    for name, node in first.items():
        if name != model:
            message = f"model {name!r} is not the robot's model {model!r}"
            hint = "its topics stay as they are and are bridged once for all robots"
            yield found_at(document, node, SECOND_MODEL, message, hint)


def _models(document: YamlText) -> Iterator[tuple[yaml.Node, str]]:
    """Each entry that is for a model, with the model."""
    for node in items(document.root):
        for key in (BOTH, GZ):
            found = GZ_MODEL.fullmatch(text_of(node, key))
            if found and not PLACEHOLDER.search(found["model"]):
                yield node, found["model"]


def entry_findings(document: YamlText, entry: BridgeEntry, context: Context) -> Iterator[Finding]:
    """What is wrong with an entry that the bridge loads."""
    yield from _names(document, entry)
    yield from _parts(document, entry, context)
    yield from not_converted(document, entry.node)
    yield from _unknown_keys(document, entry)
    yield from _mentions(document, entry, context)


NOT_PER_ROBOT = declare(
    "MF503",
    "bridge-not-per-robot",
    WARNING,
    what="A topic holds a placeholder that is not replaced, or a service has one entry for all robots.",
    why="Every robot gets the same entry: two bridges publish one topic, or robots share a service.",
    fix="Write the topic without the robot's name and without a placeholder; the build adds the name. "
    "Write a service once for each robot.",
    bad="""\
- ros_topic_name: scan/$(var side)
  gz_topic_name: scan
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
""",
    good="""\
- ros_topic_name: scan/left
  gz_topic_name: scan
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
""",
    formats=("bridge",),
)
INVALID_TOPIC = declare(
    "MF501",
    "bridge-topic-invalid",
    WARNING,
    what="The ROS topic of an entry is not a valid ROS topic name. Without ros_topic_name it is the gz "
    "topic, where a part may be a number.",
    why="ROS refuses the name, so the topic is not bridged.",
    fix="Add a ros_topic_name of letters, digits and underscores.",
    bad="""\
- gz_topic_name: /model/rover/joint/wheel_joint/0/cmd_pos
  ros_type_name: std_msgs/msg/Float64
  gz_type_name: gz.msgs.Double
  direction: ROS_TO_GZ
""",
    good="""\
- gz_topic_name: /model/rover/joint/wheel_joint/0/cmd_pos
  ros_topic_name: wheel_position
  ros_type_name: std_msgs/msg/Float64
  gz_type_name: gz.msgs.Double
  direction: ROS_TO_GZ
""",
    formats=("bridge",),
)


def _names(document: YamlText, entry: BridgeEntry) -> Iterator[Finding]:
    node, service = entry.node, text_of(entry.node, SERVICE)
    if PLACEHOLDER.search(entry.new_ros + entry.new_gz):
        message = f"the placeholder in {entry.ros!r} or its gz topic is not replaced"
        hint = "replace it for each robot, or write the topic without the robot's name"
        yield found_at(document, node, NOT_PER_ROBOT, message, hint)
    elif not service and not is_topic(entry.ros):
        message = f"{entry.ros!r} is not a valid ROS topic name"
        yield found_at(document, node, INVALID_TOPIC, message, f"add a {ROS}")
    if service and not service.strip("/").startswith("world/"):
        message = f"service {service!r} is bridged once for all robots"
        yield found_at(document, node, NOT_PER_ROBOT, message, "add an entry for each robot")


UNKNOWN_PART = declare(
    "MF507",
    "bridge-part-not-declared",
    WARNING,
    what="A gz topic names a link, joint or sensor that the description does not have.",
    why="The name is not rewritten. Gazebo uses the rewritten name, so nothing is bridged.",
    fix="Correct the name; the message has the nearest one.",
    bad="""\
- gz_topic_name: /model/rover/joint/weel_joint/cmd_vel
  ros_topic_name: wheel_speed
  ros_type_name: std_msgs/msg/Float64
  gz_type_name: gz.msgs.Double
""",
    good="""\
- gz_topic_name: /model/rover/joint/wheel_joint/cmd_vel
  ros_topic_name: wheel_speed
  ros_type_name: std_msgs/msg/Float64
  gz_type_name: gz.msgs.Double
""",
    formats=("bridge",),
)


def _parts(document: YamlText, entry: BridgeEntry, context: Context) -> Iterator[Finding]:
    for kind, name in PART.findall(entry.gz if MODEL_SLOT in entry.new_gz else ""):
        if not is_declared(context.names, kind, name) and not PLACEHOLDER.search(name):
            near = _near(name, context.names.declared.get(kind, ()))
            message = f"the description has no {kind} {name!r}{near}"
            yield found_at(document, entry.node, UNKNOWN_PART, message, "correct the name")


UNKNOWN_KEY = declare(
    "MF504",
    "bridge-key-unknown",
    WARNING,
    what="An entry has a key that ros_gz_bridge does not know.",
    why="ros_gz_bridge ignores it without a message, so the default is used.",
    fix="Correct the key; the message has the nearest one.",
    bad="""\
- topic_name: scan
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
  subscriber_queu: 5
""",
    good="""\
- topic_name: scan
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
  subscriber_queue: 5
""",
    line=4,
    formats=("bridge",),
)


def _unknown_keys(document: YamlText, entry: BridgeEntry) -> Iterator[Finding]:
    for key, _ in pairs(entry.node):
        if key.value not in KEYS:
            near = _near(key.value, KEYS)
            message = f"unknown key {key.value!r}, which ros_gz_bridge ignores{near}"
            yield found_at(document, key, UNKNOWN_KEY, message, "correct the key")


NAME_OF_UNKNOWN_USE = declare(
    "MF508",
    "bridge-name-of-unknown-use",
    WARNING,
    what="A value is the name of a link or joint, at a key that holds no such name.",
    why="It is not rewritten. If the value is meant as the link or joint, it is the same for all "
    "robots and is not a name of the rewritten descriptions.",
    fix="If it is a frame, write it at frame_id. If it is another name, rename it for each robot.",
    bad="""\
- topic_name: scan
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
  publish_optical_frame: lidar_link
""",
    good="""\
- topic_name: scan
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
  frame_id: lidar_link
""",
    line=4,
    formats=("bridge",),
)


def _mentions(document: YamlText, entry: BridgeEntry, context: Context) -> Iterator[Finding]:
    for key, node in pairs(entry.node):
        usual = key.value not in KEYS or key.value in (BOTH, ROS, GZ, "frame_id")
        if not usual and _is_mention(node, context):
            message = (
                f"{node.value!r} is the name of a link or joint, but its use here is not known"
            )
            hint = "if it is a name, rename it by hand"
            yield found_at(document, node, NAME_OF_UNKNOWN_USE, message, hint)


def _is_mention(node: yaml.Node, context: Context) -> bool:
    known = context.names
    return is_text(node) and any(is_declared(known, it, node.value) for it in ("link", "joint"))


def _near(name: str, known: Iterable[str]) -> str:
    near = did_you_mean(name, known)
    return f", {near}" if near else ""
