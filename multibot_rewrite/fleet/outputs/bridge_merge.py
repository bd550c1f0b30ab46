"""Bridge files of one robot and bridged topics of its description -> one ros_gz_bridge file."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping

import yaml

from multibot_rewrite.base.findings.finding import ERROR, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.base.model import InputError
from multibot_rewrite.companions.bridge_entry import BOTH, GZ, GZ_MODEL, MODEL_SLOT, ROS
from multibot_rewrite.companions.rviz.read_config import text_of
from multibot_rewrite.companions.template import FileTemplate, fill_template
from multibot_rewrite.companions.yaml_blocks import blocks, cut_out, moved
from multibot_rewrite.companions.yaml_text import YamlText, found_at, read_yaml
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.spelling.bridged_topics import BridgedTopic, as_yaml

# Topics that several gz topics may come out on.
TF = frozenset({"/tf", "/tf_static"})
# What gz-transport takes in a topic (gz-transport TopicUtils).
_GZ_WORD = re.compile(r"[A-Za-z0-9_.-]+(?:/[A-Za-z0-9_.-]+)*")


def fill_bridge(template: FileTemplate, namespace: str, tag: str, model: str) -> str:
    """A robot's bridge file; InputError if its model's name cannot be part of a gz topic."""
    text = fill_template(template, namespace, tag)
    if MODEL_SLOT in text and not _GZ_WORD.fullmatch(model):
        raise InputError(
            f"model {model!r} cannot be part of a gz topic; use letters, digits, _ . and - only"
        )
    return text.replace(MODEL_SLOT, model)


def as_spawned(
    topics: Iterable[BridgedTopic], robots: Iterable[RewrittenRobot]
) -> list[BridgedTopic]:
    """The bridged topics of descriptions, with the names that the models are spawned with.

    ``ros_gz_sim create -name`` gives a model another name than its description has.
    """
    names = {it.spec.namespace: it for it in robots}
    return [_spawned(it, names[it.robot]) if it.robot in names else it for it in topics]


def _spawned(it: BridgedTopic, robot: RewrittenRobot) -> BridgedTopic:
    # If frames stay bare, the generated name is the robot's, not that of the description.
    inner = robot.member.inventory.document.root.get("name", "")
    found = GZ_MODEL.fullmatch(it.gz)
    if not found or found["model"] not in (inner, robot.spec.namespace):
        return it
    return it._replace(gz=f"{found['above']}{robot.spec.model}{found['rest'] or ''}")


def merge_bridges(
    texts: Iterable[tuple[str, str]], generated: Iterable[BridgedTopic]
) -> tuple[str, tuple[Finding, ...]]:
    """One file from several (file, text) and the bridged topics of descriptions.

    An entry of a file wins over a generated one with the same gz topic. Two gz topics that are
    bridged to one ROS topic are an error.
    """
    parts: list[str] = []
    findings: list[Finding] = []
    bridged: dict[str, tuple[int, str]] = {}
    for at, (file, text) in enumerate(texts):
        document = read_yaml(text.encode(), file)
        root = document.root
        if not isinstance(root, yaml.SequenceNode) or not root.value:
            continue
        for node, (start, end, column) in zip(root.value, blocks(document, root), strict=True):
            gz = _full(text_of(node, BOTH) or text_of(node, GZ) or text_of(node, ROS))
            ros = _full(text_of(node, BOTH) or text_of(node, ROS) or text_of(node, GZ))
            # Topics for all robots, such as the clock, are bridged once, by the first file.
            if bridged.setdefault(gz, (at, ros))[0] == at:
                findings += _same_ros_topic(document, node, gz, ros, bridged)
                parts.append(moved(cut_out(document, start, end), -column))
    more = [it for it in generated if _full(it.gz) not in bridged]
    return "".join(parts) + as_yaml(more), tuple(findings)


def _full(name: str) -> str:
    return f"/{name.lstrip('/')}"


ONE_ROS_TOPIC = declare(
    "MF506",
    "bridge-two-on-one-topic",
    ERROR,
    what="Two gz topics are bridged to one ROS topic.",
    why="The data of both is mixed: who subscribes gets scans of two sensors in turn.",
    fix="Give each entry its own ros_topic_name.",
    bad="""\
- ros_topic_name: scan
  gz_topic_name: front_scan
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
- ros_topic_name: scan
  gz_topic_name: rear_scan
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
""",
    good="""\
- ros_topic_name: scan
  gz_topic_name: front_scan
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
- ros_topic_name: rear_scan
  gz_topic_name: rear_scan
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
""",
    line=5,
    formats=("bridge",),
)


def _same_ros_topic(
    document: YamlText, node: yaml.Node, gz: str, ros: str, bridged: Mapping[str, tuple[int, str]]
) -> Iterator[Finding]:
    first = next((other for other, (_, name) in bridged.items() if name == ros), gz)
    if first != gz and ros not in TF and text_of(node, "direction") != "ROS_TO_GZ":
        message = f"gz topics {first} and {gz} are both bridged to ROS topic {ros}"
        yield found_at(document, node, ONE_ROS_TOPIC, message, "give each its own ros_topic_name")
