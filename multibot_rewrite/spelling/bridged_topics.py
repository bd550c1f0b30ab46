# SPDX-License-Identifier: Apache-2.0
"""The topics that ros_gz_bridge must bridge for each robot, read from rewritten descriptions."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import lru_cache
from typing import Any, cast

from lxml import etree

from multibot_rewrite import knowledge
from multibot_rewrite.base.bounded import load_yaml, own_text
from multibot_rewrite.base.naming import NAMESPACE, TF_TOPICS, Naming, make_naming, spelled
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.readback.model_namespaces import scoped_namespace
from multibot_rewrite.description.rewriters.model_namespaces import is_model_namespace
from multibot_rewrite.description.rewriters.text import text_at
from multibot_rewrite.description.rewriters.tree import library_key
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.spelling.records import EndpointName
from multibot_rewrite.system.records import PUBLISHES, SERVES, SUBSCRIBES, Topic

# How libraries for gz-sim are called; those for Gazebo Classic that are ROS nodes have the other word.
GZ_LIBRARIES, CLASSIC_LIBRARY = ("gz-", "gz_", "ign_", "ignition-"), "gazebo_ros"
# Types of sensors that Gazebo Classic has, too; it calls the others otherwise (``gpu_ray``).
OF_BOTH = frozenset({"camera", "imu", "magnetometer", "altimeter", "force_torque"})
DIRECTIONS = {"in": "GZ_TO_ROS", "out": "ROS_TO_GZ"}
TF_TYPE = "tf2_msgs/msg/TFMessage"


class BridgedTopic(NamedTuple):
    """One topic of the bridge; ``robot`` is empty if it is bridged once for all robots. ``is_free`` is
    true where the description does not say its name in ROS."""

    robot: str
    ros: str
    gz: str
    ros_type: str
    gz_type: str
    direction: str

    is_free: bool = False


class UnbridgedTopic(NamedTuple):
    """A topic that cannot be bridged: its gz name depends on the world or the spawner. ``part`` is what
    that name holds all the same, ``type`` its type where that tells it from others."""

    robot: str
    line: int
    what: str
    part: str = ""
    type: str = ""


@lru_cache(maxsize=1)
def bridge_data() -> Mapping[str, Any]:
    """The data of ``bridge.yaml``."""
    data: Mapping[str, Any] = load_yaml(own_text(knowledge.__file__, "bridge.yaml"))
    return data


def bridged_topics(
    inventories: Mapping[str, Inventory], naming: Naming, names: Sequence[EndpointName] = ()
) -> tuple[list[BridgedTopic], list[UnbridgedTopic]]:
    """Return the bridged topics of a fleet, and those that cannot be bridged.

    ``inventories`` are those of the rewritten descriptions, ``names`` the ends of the robots' nodes: a
    topic has the type and, where the description does not say it, the name that these have.
    """
    bridged = [
        BridgedTopic("", name, name, ros_type, gz_type, DIRECTIONS[way])
        for name, ros_type, gz_type, way in bridge_data()["shared"]
    ]
    left: list[UnbridgedTopic] = []
    for robot, inventory in inventories.items():
        for item in _robot_topics(inventory, robot, naming):
            (bridged if isinstance(item, BridgedTopic) else left).append(item)  # type: ignore[arg-type]
    return [_fitting(it, names) for it in dict.fromkeys(bridged)], left


def _fitting(topic: BridgedTopic, names: Iterable[EndpointName]) -> BridgedTopic:
    """Return the topic with the name and type that the nodes at its end have, where the bridge can
    convert that type."""
    role = SUBSCRIBES if topic.direction == DIRECTIONS["in"] else PUBLISHES
    ends = [it for it in names if it.robot == topic.robot and not it.endpoint.when]
    sides = [it for it in ends if it.endpoint.role == role]
    if topic.is_free and all(it.name != topic.ros for it in sides):
        sent = {it.name for it in ends if it.endpoint.role not in (role, "")}
        alike = {it.name for it in sides if it.endpoint.type == topic.ros_type} - sent
        topic = topic._replace(ros=alike.pop()) if len(alike) == 1 else topic
    own = [it.endpoint for it in sides if it.name == topic.ros]
    types = {it for end in own for it in (end.type, *end.also)}
    if len(types) == 1 and topic.gz_type.rpartition(".")[2] in _pairs(*types):
        return topic._replace(ros_type=types.pop())
    return topic


def _pairs(ros_type: str) -> Sequence[str]:
    """The types of gz that the bridge makes of one of ROS."""
    found: Sequence[str] = bridge_data()["pairs"].get(ros_type, ())
    return found


def is_bridged(inventory: Inventory) -> bool:
    """Has a description a topic that is bridged?"""
    found = _robot_topics(inventory, "robot", make_naming("tf-per-robot"))
    return any(isinstance(it, BridgedTopic) for it in found)


def plugin_libraries(inventory: Inventory) -> list[str]:
    """The libraries of a description's plugins, as ``library_key`` has them."""
    hosts = (it.element for it in inventory.hosts)
    return [library_key(it.get("filename", "")) for it in hosts if it.tag == "plugin"]


def model_name(inventory: Inventory) -> str:
    """What a description calls its model: <robot> itself, in SDF the first <model>."""
    root = inventory.document.root
    return next(root.iter("robot", "model"), root).get("name", "")


def is_for_classic(inventory: Inventory) -> bool:
    """Is a description for Gazebo Classic, whose topics no bridge can reach?"""
    known = plugin_libraries(inventory)
    return any(CLASSIC_LIBRARY in it for it in known) and not any(
        it.startswith(GZ_LIBRARIES) for it in known
    )


def _robot_topics(
    inventory: Inventory, robot: str, naming: Naming
) -> Iterator[BridgedTopic | UnbridgedTopic]:
    elsewhere = OF_BOTH if is_for_classic(inventory) else ()
    for sensor in inventory.document.root.iter("sensor"):
        if sensor.get("type") not in elsewhere:
            yield from _sensor(sensor, robot)
    # With bare frames the spawner must give the model the robot's name, or two models collide.
    model = model_name(inventory) if "model" in naming.separators else robot
    read = any(is_model_namespace(claim.site) for claim in inventory.claims)
    for host in inventory.hosts:
        section = host.node.section
        below = read and section is not None and bool(section.model_namespace)
        space = scoped_namespace(host.element) if below else ""
        topics = bridge_data()["plugins"].get(section.names[0] if section else "", ())
        yield from _plugin(host.element, topics, robot, model, naming, space)


def _sensor(sensor: etree._Element, robot: str) -> Iterator[BridgedTopic | UnbridgedTopic]:
    kind = sensor.get("type", "")
    topics = bridge_data()["sensors"].get(kind, ())
    loaded = (library_key(it.get("filename", "")) for it in sensor.iterchildren("plugin"))
    if not topics or not all(it.startswith(GZ_LIBRARIES) for it in loaded if it):
        return  # a Gazebo Classic sensor, whose plugin is a ROS node, or an unknown type
    base = text_at(sensor, "topic")
    if not base:
        name = sensor.get("name")
        yield UnbridgedTopic(robot, _line(sensor), f"sensor {name}", f"/sensor/{name}/")
        return
    for ending, ros_type, gz_type, way in topics:
        name = f"{base}{ending}"
        yield BridgedTopic(robot, _ros_name(name), name, ros_type, gz_type, DIRECTIONS[way])
    yield from _camera_info(sensor, robot, base)


def _camera_info(sensor: etree._Element, robot: str, base: str) -> Iterator[BridgedTopic]:
    if "camera" in sensor.get("type", ""):
        beside = f"{base.rpartition('/')[0]}/camera_info".lstrip("/")
        name = text_at(sensor, "camera/camera_info_topic") or beside
        if sensor.get("type") == "rgbd_camera":  # its code uses no other name
            name = f"{base}/camera_info"
        types = ("sensor_msgs/msg/CameraInfo", "gz.msgs.CameraInfo")
        yield BridgedTopic(robot, _ros_name(name), name, *types, DIRECTIONS["in"])


def _plugin(
    plugin: etree._Element,
    topics: Iterable[Sequence[str]],
    robot: str,
    model: str,
    naming: Naming,
    space: str | None,
) -> Iterator[BridgedTopic | UnbridgedTopic]:
    for element, default, ros_type, gz_type, way in topics:
        given = _given(plugin, element, default)
        name = (
            _below(space, given, default) if space != "" else given or default.format(model=model)
        )
        if not name:
            what = f"<{element}> of {plugin.get('filename')}"
            yield UnbridgedTopic(robot, _line(plugin), what, type=gz_type)
            continue
        ros = _tf_name(robot, naming) if ros_type == TF_TYPE else _ros_name(name)
        is_free = not given and ros_type != TF_TYPE
        if is_free:
            ros = _robot_name(default.rpartition("/")[2], robot, naming)
        # A shared /tf is bridged once, or each transform would arrive once for every robot.
        whose = "" if ros == _ros_name(name) == f"/{TF_TOPICS[0]}" else robot
        yield BridgedTopic(whose, ros, name, ros_type, gz_type, DIRECTIONS[way], is_free)


def _given(plugin: etree._Element, element: str, default: str) -> str:
    """The topic that a plugin is given; below what another element says where it is made of both."""
    above, slash, own = element.rpartition("/")
    if not slash:
        return text_at(plugin, element)
    front = text_at(plugin, above)
    return f"{front}/{text_at(plugin, own) or default}" if front else ""


def _below(space: str | None, given: str, default: str) -> str:
    """A topic of a model with a namespace; empty where that is made of the name it is spawned by."""
    if space is None or given.startswith("/"):
        return given if given.startswith("/") else ""
    return f"{space.rstrip('/')}/{given or default.rpartition('/')[2]}"


def _line(element: etree._Element) -> int:
    return cast("int", element.sourceline)


def _ros_name(name: str) -> str:
    """A gz topic has no namespace: the name in the description is the full name."""
    return f"/{name.lstrip('/')}"


def _tf_name(robot: str, naming: Naming) -> str:
    tf = TF_TOPICS[0]
    return _robot_name(tf, robot, naming) if naming.layout.tf_per_robot else f"/{tf}"


def _robot_name(name: str, robot: str, naming: Naming) -> str:
    """A name as the robot's own topic."""
    if naming.topics == NAMESPACE:
        return f"/{robot}/{name}"
    return spelled(naming, robot, "topic", f"/{name}")


def as_yaml(bridged: Iterable[BridgedTopic]) -> str:
    """The configuration file of ``ros_gz_bridge parameter_bridge``."""
    rows = []
    for item in bridged:
        rows += [
            f'- ros_topic_name: "{item.ros}"\n',
            f'  gz_topic_name: "{_ros_name(item.gz)}"\n',
            f'  ros_type_name: "{item.ros_type}"\n',
            f'  gz_type_name: "{item.gz_type}"\n',
            f"  direction: {item.direction}\n",
        ]
    return "".join(rows)


# With nothing said, a row goes both ways.
BOTH = (PUBLISHES, SUBSCRIBES)
_ROLES = {"GZ_TO_ROS": (PUBLISHES,), "ROS_TO_GZ": (SUBSCRIBES,)}


def bridged_as(topics: Iterable[BridgedTopic]) -> tuple[Topic, ...]:
    """The topics that descriptions have, each once."""
    return once(
        Topic(it.ros, bridge=_ROLES.get(it.direction, BOTH), type=it.ros_type) for it in topics
    )


def once(topics: Iterable[Topic]) -> tuple[Topic, ...]:
    """Each topic once, with all that a bridge does with it."""
    found: dict[str, Topic] = {}
    for topic in topics:
        first = found.setdefault(topic.name, topic)
        roles = tuple(it for it in (*BOTH, SERVES) if it in {*first.bridge, *topic.bridge})
        found[topic.name] = first._replace(bridge=roles)
    return tuple(found.values())
