# SPDX-License-Identifier: Apache-2.0
"""The topics that ros_gz_bridge must bridge for each robot, read from rewritten descriptions."""

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple, cast

from lxml import etree

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.naming import NAMESPACE, TF_TOPICS, Naming, make_naming, spelled
from multibot_rewrite.description.readback.other_topics import scoped_namespace
from multibot_rewrite.description.readback.xml import values_at
from multibot_rewrite.description.rewriters.model_namespaces import is_model_namespace
from multibot_rewrite.description.rewriters.plugin_definitions import PluginDefinition
from multibot_rewrite.description.rewriters.text import text_at
from multibot_rewrite.description.rewriters.tree import library_key
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.knowledge.records import Endpoint
from multibot_rewrite.planning.bridge_rows import (
    PLUGINS,
    SENSORS,
    BridgeRow,
    bridge_data,
    default_topics,
    given_topic,
    is_there,
    rows_of,
)
from multibot_rewrite.planning.records import Run
from multibot_rewrite.system.records import PUBLISHES, SERVES, SUBSCRIBES, Topic

# How libraries for gz-sim are called; those for Gazebo Classic that are ROS nodes have the other word.
GZ_LIBRARIES, CLASSIC_LIBRARY = ("gz-", "gz_", "ign_", "ignition-"), "gazebo_ros"
# Types of sensors that Gazebo Classic has, too; it calls the others otherwise (``gpu_ray``).
OF_BOTH = frozenset({"camera", "depth", "imu", "magnetometer", "altimeter", "force_torque"})
OF_BOTH |= {"contact", "gps", "gpu_ray", "logical_camera"}
DIRECTIONS = {"in": "GZ_TO_ROS", "out": "ROS_TO_GZ"}
TF_TYPE = "tf2_msgs/msg/TFMessage"
# The element of a system whose transforms are those of tf.
TF_ELEMENT = "tf_topic"
IMAGE = "gz.msgs.Image"
# What sdformat writes where a sensor of contacts has none (sdf/1.12/contact.sdf, Contact.cc:116).
_DEFAULT = "__default_topic__"
# Cameras whose info is below their topic, and no name that they are given.
_INFO_BELOW = frozenset({"rgbd_camera", "rgbd", "segmentation_camera", "segmentation"})
# Robot -> what its model is spawned as, if not as the robot is called.
Models = Mapping[str, str]
AS_ROBOTS: Models = MappingProxyType({})
OF_WORLD = "the default topic has the name of the world in it"
OF_SPAWNER = "the namespace of its model is made of the name that it is spawned by"
GIVE_TOPIC = "give it a topic in the description, so that a bridge can name it"
OF_ANOTHER = "take such data from another system or sensor"
OWN_ROW = "write a row for it in a bridge file, with its types"
# What a ROS name cannot have, and a word that begins with a digit.
_NOT_ROS, _NUMBER = lazy_compile(r"[^A-Za-z0-9_/]"), lazy_compile(r"(?:^|/)(?=[0-9])")


class BridgedTopic(NamedTuple):
    """One topic of the bridge, for all without a ``robot``; ``is_free``: its ROS name is not given."""

    robot: str
    ros: str
    gz: str
    ros_type: str
    gz_type: str
    direction: str
    is_free: bool = False


class UnbridgedTopic(NamedTuple):
    """A topic of a ``sensor`` or ``plugin`` that is not bridged: why, and what to do.

    ``part`` is what its gz name holds where that is not known, ``type`` its type where that tells it
    from others.
    """

    robot: str
    tag: str
    line: int
    what: str
    why: str
    hint: str
    part: str = ""
    type: str = ""


Found = BridgedTopic | UnbridgedTopic


def bridged_topics(
    inventories: Mapping[str, Inventory],
    naming: Naming,
    models: Models = AS_ROBOTS,
    runs: Sequence[Run] = (),
    placed: Collection[str] = (),
) -> tuple[list[BridgedTopic], list[UnbridgedTopic]]:
    """Return the bridged topics of a fleet, and those that cannot be bridged.

    ``inventories`` are those of the rewritten descriptions, ``models`` what they are spawned as,
    ``runs`` the robots' nodes: a topic has the type and, where the description does not say it,
    the name that these have. Robots that are ``placed`` by nodes do without the transforms of
    their drives.
    """
    bridged = [
        BridgedTopic("", name, name, ros_type, gz_type, DIRECTIONS[way])
        for name, ros_type, gz_type, way in bridge_data()["shared"]
    ]
    left: list[UnbridgedTopic] = []
    for robot, inventory in inventories.items():
        tf = _tf_topic(robot, naming) if robot in placed else ""
        for item in _robot_topics(inventory, robot, models.get(robot, robot), naming):
            if isinstance(item, BridgedTopic) and item.ros == tf:
                continue
            (bridged if isinstance(item, BridgedTopic) else left).append(item)  # type: ignore[arg-type]
    ends = lists_by_key((run.robot, it) for run in runs for it in run.names if not it[0].when)
    fitting = [_fitted_to_nodes(it, ends[it.robot]) for it in dict.fromkeys(bridged)]
    return fitting, list(dict.fromkeys(left))


def _fitted_to_nodes(topic: BridgedTopic, ends: Sequence[tuple[Endpoint, str]]) -> BridgedTopic:
    """Return the topic with the name and convertible type that the nodes at its end have."""
    role = SUBSCRIBES if topic.direction == DIRECTIONS["in"] else PUBLISHES
    sides = [it for it in ends if it[0].role == role]
    if topic.is_free and all(name != topic.ros for _, name in sides):
        sent = {name for end, name in ends if end.role not in (role, "")}
        alike = {name for end, name in sides if end.type == topic.ros_type} - sent
        topic = topic._replace(ros=alike.pop()) if len(alike) == 1 else topic
    own = [end for end, name in sides if name == topic.ros]
    types = {it for end in own for it in (end.type, *end.also)}
    made = bridge_data()["pairs"].get(next(iter(types)), ()) if len(types) == 1 else ()
    if topic.gz_type.rpartition(".")[2] in made:
        return topic._replace(ros_type=types.pop())
    return topic


def is_bridged(inventory: Inventory) -> bool:
    """Return whether a description has a topic that is bridged."""
    found = _robot_topics(inventory, "robot", "robot", make_naming("tf-per-robot"))
    return any(isinstance(it, BridgedTopic) for it in found)


def plugin_libraries(inventory: Inventory) -> list[str]:
    """Return the libraries of a description's plugins, as ``library_key`` has them."""
    hosts = (it.element for it in inventory.hosts)
    return [library_key(it.get("filename", "")) for it in hosts if it.tag == "plugin"]


def is_for_classic(inventory: Inventory) -> bool:
    """Return whether a description is for Gazebo Classic, whose topics no bridge can reach."""
    known = plugin_libraries(inventory)
    return any(CLASSIC_LIBRARY in it for it in known) and not any(
        it.startswith(GZ_LIBRARIES) for it in known
    )


def _robot_topics(inventory: Inventory, robot: str, model: str, naming: Naming) -> Iterator[Found]:
    """Yield the topics of a robot's sensors and plugins, bridged or not."""
    elsewhere = OF_BOTH if is_for_classic(inventory) else ()
    for sensor in inventory.document.root.iter("sensor"):
        if sensor.get("type") not in elsewhere:
            yield from _topics_of_sensor(sensor, robot, inventory.release)
    plugins = list(plugin_topics(inventory, robot, model, naming))
    gz_of: dict[str, set[str]] = defaultdict(set)
    # Two systems with one topic have one row, that for tf where one of them is for it; MB243 warns.
    row_of: dict[str, BridgedTopic] = {}
    for topic in (it for plugin in plugins for it in plugin.topics):
        gz_of[topic.ros].add(topic.gz)
        if topic.gz not in row_of or topic.ros == _tf_topic(robot, naming):
            row_of[topic.gz] = topic
    for topic in row_of.values():
        below = topic.gz.lstrip("/").removeprefix("model/")
        is_default = topic.ros not in (_ros_name(topic.gz), _tf_topic(robot, naming))
        # Only a system's namespace in Gazebo tells it from another one of the robot.
        if is_default and not below.startswith(f"{model}/") and len(gz_of[topic.ros]) > 1:
            yield topic._replace(ros=_robot_name(below, robot, naming))
        else:
            yield topic
    for plugin in plugins:
        yield from plugin.left


class PluginTopics(NamedTuple):
    """A plugin of gz-sim with its topics that are bridged, and those that are not."""

    plugin: etree._Element
    topics: tuple[BridgedTopic, ...]
    left: tuple[UnbridgedTopic, ...]


def plugin_topics(
    inventory: Inventory, robot: str, model: str, naming: Naming
) -> Iterator[PluginTopics]:
    """Yield the plugins of a description that have topics in Gazebo."""
    read = any(is_model_namespace(claim.site) for claim in inventory.claims)
    sections = {it.node.section.names[0] for it in inventory.hosts if it.node.section is not None}
    for host in inventory.hosts:
        section = host.node.section
        below = read and section is not None and bool(section.model_namespace)
        space = scoped_namespace(host.element) if below else ""
        rows = rows_of(PLUGINS, section.names[0] if section else "", inventory.release)
        found: list[Found] = [
            topic
            for row in rows
            if row.unless not in sections and is_there(row, host.element)
            for topic in _plugin(host.element, row, robot, model, naming, space, inventory.release)
        ]
        if section is not None and section.names[0] not in bridge_data()[PLUGINS]:
            found += _of_unknown_type(host.element, section, robot)
        bridged = tuple([it for it in found if isinstance(it, BridgedTopic)])
        left = tuple([it for it in found if isinstance(it, UnbridgedTopic)])
        if found:
            yield PluginTopics(host.element, bridged, left)


def _topics_of_sensor(sensor: etree._Element, robot: str, release: str) -> Iterator[Found]:
    kind = sensor.get("type", "")
    rows = rows_of(SENSORS, kind, release)
    loaded = (library_key(it.get("filename", "")) for it in sensor.iterchildren("plugin"))
    if not rows or not all(it.startswith(GZ_LIBRARIES) for it in loaded if it):
        return  # a Gazebo Classic sensor, whose plugin is a ROS node, or an unknown type
    base, what = text_at(sensor, rows[0].at), f"sensor {sensor.get('name')}"
    base = "" if base == _DEFAULT else base
    if not base:
        part = f"/sensor/{sensor.get('name')}/"
        yield UnbridgedTopic(robot, "sensor", _line(sensor), what, OF_WORLD, GIVE_TOPIC, part)
        return
    for row in (row for row in rows if is_there(row, sensor)):
        name = f"{base}{row.element}"
        if why := _why_not(row, release):
            yield UnbridgedTopic(
                robot, "sensor", _line(sensor), what, why, OF_ANOTHER, name, row.gz_type
            )
        else:
            yield _bridged_topic(row, robot, _ros_name(name), name)
    if any(row.gz_type == IMAGE for row in rows):
        beside = f"{base.rpartition('/')[0]}/camera_info".lstrip("/")
        own = text_at(sensor, "camera/camera_info_topic") if sensor.get("type") == "camera" else ""
        name = own or beside
        if kind in _INFO_BELOW:
            name = f"{base}/camera_info"
        types = ("sensor_msgs/msg/CameraInfo", "gz.msgs.CameraInfo")
        yield BridgedTopic(robot, _ros_name(name), name, *types, DIRECTIONS["in"])


def _why_not(row: BridgeRow, release: str) -> str:
    """Return why a topic is not bridged, empty if it is."""
    unknown = f"ros_gz_bridge of {release} converts no {row.gz_type}"
    return row.why or ("" if row.ros_type else unknown)


def _bridged_topic(row: BridgeRow, robot: str, ros: str, gz: str) -> BridgedTopic:
    return BridgedTopic(robot, ros, gz, row.ros_type, row.gz_type, DIRECTIONS[row.way])


def _plugin(
    plugin: etree._Element,
    row: BridgeRow,
    robot: str,
    model: str,
    naming: Naming,
    space: str | None,
    release: str,
) -> Iterator[Found]:
    """Yield the topics of a plugin by a row of the data, bridged or not."""
    given = given_topic(row, plugin, release)
    names: Iterable[tuple[str, str]] = [(given, "")]
    if space != "" and not given.startswith("/"):
        last = row.default.rpartition("/")[2]
        # No name is known where the namespace is made of the name that the model is spawned by.
        below = "" if space is None else f"{space.rstrip('/')}/{given or last}"
        names = [(below, "" if given else last)]
    elif not given and row.default:
        names = default_topics(row, plugin, model)
    for name, rest in names:
        unnamed = OF_WORLD if space == "" else OF_SPAWNER
        if why := _why_not(row, release) if name else unnamed:
            what = f"{name or f'<{row.element}>'} of {plugin.get('filename')}"
            hint = OF_ANOTHER if name else GIVE_TOPIC
            yield UnbridgedTopic(robot, "plugin", _line(plugin), what, why, hint, type=row.gz_type)
            continue
        # The robot's own, of what stands below its model, or that of the file.
        ros = _robot_name(rest, robot, naming) if rest else _ros_name(name)
        ros = _tf_topic(robot, naming) if row.element == TF_ELEMENT else ros
        # A shared /tf is bridged once, or each transform would arrive once for every robot.
        whose = "" if ros == _ros_name(name) == f"/{TF_TOPICS[0]}" else robot
        is_free = bool(rest) and row.element != TF_ELEMENT
        yield _bridged_topic(row, whose, ros, name)._replace(is_free=is_free)


def _of_unknown_type(
    plugin: etree._Element, section: PluginDefinition, robot: str
) -> Iterator[UnbridgedTopic]:
    """Yield the topics in Gazebo that a plugin of others is given; one with a node bridges its own."""
    is_of_gz = "::" in plugin.get("name", "") and plugin.find("ros") is None
    if not is_of_gz or any(it.kinds[:1] in (("node",), ("namespace",)) for it in section.sites):
        return
    for site in (it for it in section.sites if it.kinds[:1] == ("topic",) and it.form == "whole"):
        for name in filter(None, values_at(plugin, site.path)):
            what = f"{name} of {plugin.get('filename')}"
            why = f"the type of <{site.path}> is not known"
            yield UnbridgedTopic(robot, "plugin", _line(plugin), what, why, OWN_ROW, name)


def _line(element: etree._Element) -> int:
    return cast("int", element.sourceline)


def _ros_name(name: str) -> str:
    """Return the ROS name of a gz topic, which has no namespace: its name is the full name."""
    return f"/{_ros_characters(name.lstrip('/'))}"


def _ros_characters(name: str) -> str:
    """Return a name with ``_`` for characters that ROS does not allow."""
    return _NUMBER.sub("_", _NOT_ROS.sub("_", name))


def _tf_topic(robot: str, naming: Naming) -> str:
    tf = TF_TOPICS[0]
    return _robot_name(tf, robot, naming) if naming.layout.tf_per_robot else f"/{tf}"


def _robot_name(name: str, robot: str, naming: Naming) -> str:
    """Return a name as the robot's own topic, with the characters that ROS allows."""
    name = _ros_characters(name)
    if naming.topics == NAMESPACE:
        return f"/{robot}/{name}"
    return spelled(naming, robot, "topic", f"/{name}")


def as_yaml(bridged: Iterable[BridgedTopic]) -> str:
    """Return the configuration file of ``ros_gz_bridge parameter_bridge``."""
    return "".join(
        f'- ros_topic_name: "{it.ros}"\n'
        f'  gz_topic_name: "/{it.gz.lstrip("/")}"\n'
        f'  ros_type_name: "{it.ros_type}"\n'
        f'  gz_type_name: "{it.gz_type}"\n'
        f"  direction: {it.direction}\n"
        for it in bridged
    )


# With nothing said, a row goes both ways.
BOTH = (PUBLISHES, SUBSCRIBES)
_ROLES = {"GZ_TO_ROS": (PUBLISHES,), "ROS_TO_GZ": (SUBSCRIBES,)}


def bridged_as(topics: Iterable[BridgedTopic]) -> tuple[Topic, ...]:
    """Return the bridged topics as records of a plan, each once."""
    return once(
        Topic(it.ros, bridge=_ROLES.get(it.direction, BOTH), type=it.ros_type) for it in topics
    )


def once(topics: Iterable[Topic]) -> tuple[Topic, ...]:
    """Return each topic once, with all directions in which a bridge passes it on."""
    found: dict[str, Topic] = {}
    for topic in topics:
        first = found.setdefault(topic.name, topic)
        roles = tuple(it for it in (*BOTH, SERVES) if it in {*first.bridge, *topic.bridge})
        found[topic.name] = first._replace(bridge=roles)
    return tuple(found.values())
