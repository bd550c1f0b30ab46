"""What a ros_gz_bridge file for one robot has besides that robot: other models, services."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import yaml

from multibot_rewrite.base.conventions import PLACEHOLDER
from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.companions.bridge_entry import (
    BOTH,
    GZ,
    GZ_MODEL,
    SERVICE,
    BridgeEntry,
)
from multibot_rewrite.companions.rviz.read_config import text_of
from multibot_rewrite.companions.yaml_text import YamlText, found_at, items

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


NOT_PER_ROBOT = declare(
    "MF503",
    "bridge-not-per-robot",
    WARNING,
    what="A service has one entry for all robots.",
    why="The robots share the service: each call goes to the one robot whose name it has in gz.",
    fix="Write the service once for each robot.",
    bad="""\
- service_name: /model/rover/reset
  ros_type_name: std_srvs/srv/Empty
""",
    good="""\
- service_name: /world/hall/control
  ros_type_name: ros_gz_interfaces/srv/ControlWorld
""",
    formats=("bridge",),
)


def shared_services(document: YamlText, entries: Iterable[BridgeEntry]) -> Iterator[Finding]:
    """Services that are not those of the world."""
    for entry in entries:
        service = text_of(entry.node, SERVICE)
        if service and not service.strip("/").startswith("world/"):
            message = f"service {service!r} is bridged once for all robots"
            yield found_at(
                document, entry.node, NOT_PER_ROBOT, message, "add an entry for each robot"
            )
