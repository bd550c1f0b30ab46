# SPDX-License-Identifier: Apache-2.0
"""Descriptions that a launch publishes or puts into a simulator -> what plugins in them make.

Source: gz_ros2_control of humble to rolling, gz_ros2_control_plugin.cpp: each file of ``<parameters>``
is an argument ``--params-file``, rules of ``<ros>`` are arguments, too; ``use_sim_time`` is true.
ros_gz_sim create.cpp and gazebo_ros spawn_entity.py: a model by ``-topic``, ``-file`` or ``-string``.
"""

import os
from collections.abc import Iterable, Iterator, Mapping
from itertools import pairwise
from typing import NamedTuple

from lxml.etree import SubElement, tostring

from multibot_rewrite.base.bounded import load_yaml
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.releases import ROS_2
from multibot_rewrite.base.rosnames import expand
from multibot_rewrite.description.readback.nodes import ReadNode
from multibot_rewrite.description.readback.parameters import MODEL
from multibot_rewrite.description.readback.reading import FRAME, Reading, read
from multibot_rewrite.description.readback.xml import read_xml, values_at
from multibot_rewrite.description.rewriters.plugin_definitions import load_definitions
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.producers.launch.programs import program_of, programs
from multibot_rewrite.producers.launch.records import LaunchedNode, ParameterText
from multibot_rewrite.system.records import TOPIC, Edge, Place, edge_of

_PROGRAM = ("controller_manager", "ros2_control_node")
# The plugin gives the manager the clock and, in Humble by its constructor, the description.
_GIVEN = ParameterText(
    "", "/**:\n  ros__parameters: {use_sim_time: true, robot_description: <robot/>}\n"
)
# Frames of systems of gz that send odometry, with the last word of their topic where the description
# names none (gz-sim src/systems: diff_drive, ackermann_steering, mecanum_drive, tracked_vehicle;
# OdometryPublisher.cc:283).
_PARENTS = {"frame_id": "tf", "odom_frame": "pose"}
_TF, _CLASSIC_TF = "tf_topic", "/tf"


class Published(NamedTuple):
    """A description that a launched node publishes, its topic, and the place in the launch file."""

    text: str
    topic: str
    place: Place


class Model(NamedTuple):
    """A description that is read; ``spawned`` into a simulator with ``words``, or not."""

    name: str
    text: str
    reading: Reading
    spawned: bool
    place: Place
    words: tuple[str, ...] = ()


class Models(NamedTuple):
    """The descriptions of a launch, and spawners whose model is not known."""

    found: tuple[Model, ...]
    lost: tuple[LaunchedNode, ...]


def models_of(
    started: Iterable[LaunchedNode], published: Iterable[Published], release: str
) -> Models:
    """Return what spawners put into a simulator, and what is only published."""
    spawners = [it for it in started if program_of(it) in programs().spawners]
    texts = {it.topic: it for it in published}
    found, lost, taken = [], [], set()
    for it in spawners:
        said = (*it.arguments, *_of_parameters(it))
        words = dict(pairwise(said))
        topic = expand(words.get("-topic", ""), it.namespace, "") if "-topic" in words else ""
        text = texts[topic].text if topic in texts else _model_text(words)
        name = words.get("-name", words.get("-entity", ""))
        moved = _with_namespace(text, words.get("-robot_namespace", ""))
        model = _read_model(name, moved, it.place, release, spawned=True)
        found += [model._replace(text=text, words=said)] if model else []
        lost += [] if model else [it]
        taken.add(topic)
    rest = (it for it in texts.values() if it.topic not in taken)
    more = (_read_model("", it.text, it.place, release, spawned=False) for it in rest)
    return Models((*found, *filter(None, more)), tuple(lost))


def _of_parameters(it: LaunchedNode) -> Iterator[str]:
    """Yield the arguments of a spawner that are parameters (ros_gz jazzy ros_gz_sim/src/create.cpp)."""
    for given in it.parameters:
        found = load_yaml(given.text, given.file or it.place.file)
        own = found.get("/**", {}) if isinstance(found, dict) else {}
        for name, value in (own.get("ros__parameters") or {}).items():
            if value != "":
                yield from (f"-{name}", str(value))


def _with_namespace(text: str, namespace: str) -> str:
    """Return a description with Classic's namespace in its plugins (gazebo_ros_factory.cpp)."""
    if not namespace or not text:
        return text
    try:
        root = read_xml(text.encode(), "")
    except InputError:
        return text
    for plugin in root.iter("plugin"):
        ros = plugin.find("ros")
        ros = SubElement(plugin, "ros") if ros is None else ros
        own = ros.find("namespace")
        (SubElement(ros, "namespace") if own is None else own).text = namespace
    return tostring(root, encoding="unicode")


def _model_text(words: Mapping[str, str]) -> str:
    """Return the description in a spawner's arguments, of its file or as it is; or empty."""
    path = words.get("-file", "")
    return read_file(path).decode() if os.path.isfile(path) else words.get("-string", "")


def _read_model(name: str, text: str, place: Place, release: str, spawned: bool) -> Model | None:
    try:
        reading = read(text.encode(), place.file, load_definitions((), release, ros=ROS_2))
    except InputError:
        return None
    return Model(name, text, reading, spawned, place)


def managers(model: Model, files: Mapping[str, ParameterText]) -> Iterator[LaunchedNode]:
    """Yield controller managers that plugins make, with the ``files`` that descriptions name."""
    plugins = [*read_xml(model.text.encode(), model.place.file).iter("plugin")]
    for node in (it for it in model.reading.nodes if it.manager):
        named = values_at(plugins[node.number], "parameters")
        texts = (files[path.strip()] for path in named if path.strip() in files)
        home, _, name = node.manager.rpartition("/")
        given = (*texts, _GIVEN)
        rules = tuple(rules_of(node))
        yield LaunchedNode(*_PROGRAM, name, home or "/", rules, given, "", (), "", model.place)


def rules_of(node: ReadNode) -> Iterator[tuple[str, str]]:
    """Yield the remap rules of a plugin."""
    for rule in (it.rule for it in node.rules):
        yield f"{rule.node}:{rule.source}".lstrip(":"), rule.target


def frames_of_plugins(models: Iterable[Model]) -> dict[str, str]:
    """Return by plugin node the frame of its sensor data, if set (utils.cpp, SensorFrameID)."""
    found = {}
    for reading in (it.reading for it in models if it.spawned):
        frames = {it.number: it.name for it in reading.names if it.path == "frame_name"}
        for node in (it for it in reading.nodes if it.number in frames):
            found[expand(node.name, node.namespace or "/", "")] = frames[node.number]
    return found


def sent_by_plugins(models: Iterable[Model]) -> dict[str, list[tuple[str, Edge]]]:
    """Return by plugin node its odometry transforms, with topics (PublishOdometryTf)."""
    found: dict[str, list[tuple[str, Edge]]] = {}
    for node in (node for it in models if it.spawned for node in it.reading.nodes):
        topic = next((it.name for it in node.endpoints if it.code_name == _CLASSIC_TF), "")
        frames = dict(node.frames)
        for parent, child in node.sends if topic else ():
            name = expand(node.name, node.namespace or "/", "")
            sent = (topic, edge_of(frames[parent], frames[child]))
            found.setdefault(name, []).append(sent)
    return found


def sent_in_simulator(models: Iterable[Model]) -> dict[str, list[Edge]]:
    """Return the transforms that systems of gz send, by the topic in the simulator."""
    return lists_by_key(sent for it in models if it.spawned for sent in _sent_by_systems(it))


def _sent_by_systems(model: Model) -> Iterator[tuple[str, Edge]]:
    """Yield (topic in the simulator, transform) for what systems of a model send."""
    plugins: dict[int, dict[str, str]] = {}
    for it in (*model.reading.names, *model.reading.missed):
        if it.tag == "plugin" and it.kind in (FRAME, TOPIC):
            name = it.name.replace(MODEL, f"{model.name}/")
            plugins.setdefault(it.number, {})[it.path] = name
    for number in {it.number for it in model.reading.nodes} & plugins.keys():
        del plugins[number]
    for own in plugins.values():
        parent = next((it for it in _PARENTS if it in own), "")
        child = next((own[it] for it in ("child_frame_id", "robot_base_frame") if it in own), "")
        if parent and child:
            topic = own.get(_TF, f"/model/{model.name}/{_PARENTS[parent]}")
            yield topic, edge_of(own[parent], child)
