# SPDX-License-Identifier: Apache-2.0
"""Description bytes -> everything that runs because of it, by the names it has then."""

from collections.abc import Container, Iterable, Iterator
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.releases import ROS_1
from multibot_rewrite.description.readback import active, parameters
from multibot_rewrite.description.readback.nodes import (
    BELOW,
    TOPIC,
    ReadNode,
    RuntimeName,
    frames_of,
    node_of,
)
from multibot_rewrite.description.readback.other_topics import of_others, resolved
from multibot_rewrite.description.readback.xml import read_xml, values_at
from multibot_rewrite.description.rewriters.plugin_definitions import Definitions, PluginDefinition
from multibot_rewrite.description.rewriters.plugin_definitions.grammar import MODEL as OF_MODEL

NODE, FRAME = "node", "frame"
# Where a frame is written that no parameter holds.
IN_CODE = "its code"
# Elements besides plugins and sensors that have a topic, by what holds it.
WITH_TOPICS = (
    ("gazebo", "particle_emitter"),
    ("sdf.link", "particle_emitter"),
    ("webots", "webots"),
)


class Reading(NamedTuple):
    """The nodes and names that a description starts.

    ``unknown`` are plugins without definition: number and library. ``missed`` are frames below a
    model's name, which are in no robot's tree. ``other_ends`` are of topics that are the world's
    or left as they are, and of topics below one of ``names``."""

    nodes: tuple[ReadNode, ...]
    names: tuple[RuntimeName, ...]
    unknown: tuple[tuple[int, str], ...]
    missed: tuple[RuntimeName, ...] = ()
    other_ends: tuple[RuntimeName, ...] = ()


class _Host(NamedTuple):
    """An element that something runs for, and what is known about it."""

    element: _Element
    number: int
    section: PluginDefinition


def read(data: bytes, file: str, definitions: Definitions) -> Reading:
    """Return the names that programs make of a description; raises InputError."""
    return read_tree(read_xml(data, file), definitions)


def read_tree(root: _Element, definitions: Definitions) -> Reading:
    """Return the names of a parsed description; raises nothing."""
    hosts, unknown = _hosts(root, definitions)
    nodes = _ros_nodes(hosts, definitions.release)
    with_node = {it.number for it in nodes}
    # A plugin of ROS 1 has the one node of its process.
    without_rules = _without_rules(root, hosts, with_node) if definitions.ros != ROS_1 else ()
    names = [*_links(root), *_node_names(nodes), *without_rules]
    names += _other_names_of_hosts(root, hosts, "plugin", with_node, definitions)
    systems = enumerate(root.iter("ros2_control"))
    known = ((it, number, active.hardware_section(it, definitions)) for number, it in systems)
    hardware = [_Host(it, number, section) for it, number, section in known if section]
    names += _other_names_of_hosts(root, hardware, "ros2_control", (), definitions)
    names += _sensor_names(root, definitions)
    names += _element_names(root, definitions)
    missed = tuple(it for it in names if it.kind == FRAME and it.name.startswith(parameters.MODEL))
    heard = tuple(it for it in names if it not in missed) if missed else tuple(names)
    below = (end for it in nodes for end in _endpoints(it, below=True))
    others = (
        RuntimeName(TOPIC, name, "plugin", it.number, path)
        for it in hosts
        for name, path in of_others(it.element, it.section)
    )
    ends = (*others, *below)
    return Reading(nodes, heard, tuple(unknown), _of_first_senders(missed, hosts), ends)


def transforms_sent(
    root: _Element, definitions: Definitions
) -> Iterator[tuple[_Element, str, str]]:
    """Yield (plugin, parent, child) for each plugin that sends a transform of odometry."""
    hosts, _ = _hosts(root, definitions)
    senders = {it.number: it for it in hosts if "/tf" in it.section.publishes}
    for node in _ros_nodes(senders.values(), definitions.release):
        frames = dict(node.frames)
        for parent, child in node.sends:
            yield senders[node.number].element, frames[parent], frames[child]


def _hosts(root: _Element, definitions: Definitions) -> tuple[list[_Host], list[tuple[int, str]]]:
    """Return the plugins with a definition, and (number, name) of those without one."""
    hosts: list[_Host] = []
    unknown: list[tuple[int, str]] = []
    for number, plugin in enumerate(root.iter("plugin")):
        # The class of a ros2_control system, or a plugin of Webots: none of Gazebo's.
        if active.why_not_loaded(plugin, definitions) or "filename" not in plugin.attrib:
            continue
        section, known = active.plugin_section(plugin, definitions)
        if not known:
            unknown.append((number, plugin.get("filename", "") or plugin.get("name", "")))
        if section is not None:
            hosts.append(_Host(plugin, number, section))
    return hosts, unknown


def _ros_nodes(hosts: Iterable[_Host], release: str) -> tuple[ReadNode, ...]:
    made = (node_of(*it, release) for it in hosts)
    return tuple(node for node in made if node is not None)


def _of_first_senders(
    missed: tuple[RuntimeName, ...], hosts: list[_Host]
) -> tuple[RuntimeName, ...]:
    """Return the names without those of transforms that another system sends already."""
    numbers = {it.number for it in missed}
    models = {it.number: parameters.around(it.element) for it in hosts}
    sent: set[_Element] = set()
    partly: set[int] = set()
    for it in hosts:
        sites = [s for s in it.section.sites if OF_MODEL in s.default and s.kinds[0] == FRAME]
        if it.number not in numbers:
            sent |= {
                models[it.number] for s in sites if parameters.default_of(it.element, s.default)
            }
        elif any(any(values_at(it.element, s.path)) for s in sites):
            partly.add(it.number)
    sent |= {models[it] for it in partly}
    first: dict[_Element, int] = {}
    for number in sorted(numbers - partly):
        model = models[number]
        # robot_state_publisher does not read a model in a model.
        if model not in sent and next(model.iterancestors("model"), None) is None:
            first.setdefault(model, number)
    return tuple(it for it in missed if it.number in partly or it.number in first.values())


def _node_names(nodes: tuple[ReadNode, ...]) -> Iterator[RuntimeName]:
    for node in nodes:
        if node.name:
            yield RuntimeName(NODE, node.full_name, "plugin", node.number, "@name")
        if node.helper:
            yield RuntimeName(NODE, node.helper, "plugin", node.number, "its own node")
        # What is below a stem is named by it.
        yield from _endpoints(node, below=False)
        for path, full in node.stems:
            yield RuntimeName(BELOW, full, "plugin", node.number, path)


def _without_rules(
    root: _Element, hosts: list[_Host], with_node: Container[int]
) -> Iterator[RuntimeName]:
    """Yield the nodes of ROS 2 plugins without <ros>; they have the plugin's name, no namespace."""
    # Plankton ThrusterROSPlugin.cpp, gazebo_ros node.hpp CreateWithArgs.
    for host in hosts if root.find(".//plugin/ros") is not None else ():
        is_named = any(it.path == "@name" and "node" in it.kinds for it in host.section.sites)
        if is_named and host.number not in with_node:
            name = host.element.get("name", "").strip()
            yield RuntimeName(NODE, f"/{name}", "plugin", host.number, "@name")


def _endpoints(node: ReadNode, below: bool) -> Iterator[RuntimeName]:
    """Yield the ends that are on and ``below`` one of the node's stems, or the others."""
    stems = {path for path, _ in node.stems}
    yield from (it for it in node.endpoints if not it.off and (it.parameter in stems) == below)


def _other_names_of_hosts(
    root: _Element, hosts: list[_Host], tag: str, nodes: Container[int], definitions: Definitions
) -> Iterator[RuntimeName]:
    """Yield the names of plugins that no ROS 2 node asks for: gz topics, frames, look-ups, files."""
    for host in hosts:
        if host.number not in nodes or _is_of_either(host):
            yield from _topics(host, tag, definitions.release)
        yield from _frame_names(host, tag)
        yield from _world_lookups(root, host, definitions)
        yield from _opened_names(host, tag)


def _is_of_either(host: _Host) -> bool:
    """Return whether ROS 1 may load a plugin as well as ROS 2, which alone reads a <ros>."""
    # ROS 1's takes no rules and reads a namespace in addition to its other parameters.
    if host.section.ros or host.element.find("ros") is not None:
        return False
    return any(it.kinds == ("namespace",) and "/" not in it.path for it in host.section.sites)


def _sensor_names(root: _Element, definitions: Definitions) -> Iterator[RuntimeName]:
    for number, sensor in enumerate(root.iter("sensor")):
        # What is known about every sensor, and about those of this type.
        of_type = definitions.find("sensor", sensor.get("type", "").strip())
        unread = {it.path for section in of_type for it in section.sites if it.role == "keep"}
        for section in (*definitions.find("element", "sensor"), *of_type):
            sites = tuple(it for it in section.sites if it.path not in unread)
            host = _Host(sensor, number, section._replace(sites=sites) if unread else section)
            yield from _topics(host, "sensor", definitions.release)
            yield from _opened_names(host, "sensor")


def _element_names(root: _Element, definitions: Definitions) -> Iterator[RuntimeName]:
    for tag, held in WITH_TOPICS:
        if next(root.iter(held), None) is None:
            continue
        (section,) = definitions.find("element", tag)
        for number, element in enumerate(root.iter(tag.rpartition(".")[2])):
            host = _Host(element, number, section)
            yield from _topics(host, element.tag, definitions.release)


def _links(root: _Element) -> Iterator[RuntimeName]:
    """Yield the links of the robot and of its models: frames that robot_state_publisher sends."""
    for number, link in enumerate(root.iter("link")):
        parent = link.getparent()
        if parent is not None and parent.tag in ("robot", "model") and link.get("name"):
            yield RuntimeName(FRAME, link.get("name", "").strip(), "link", number, "@name")


def _topics(host: _Host, tag: str, release: str) -> Iterator[RuntimeName]:
    """Yield topics that are no ROS 2 node's: below the namespace that the plugin puts in front."""
    for kind, name, path in resolved(host.element, host.section, release):
        yield RuntimeName(kind, name, tag, host.number, path)


def _frame_names(host: _Host, tag: str) -> Iterator[RuntimeName]:
    for path, value in frames_of(host.element, host.section):
        yield RuntimeName(FRAME, value, tag, host.number, path)
    for name in _hardwired(host, FRAME):
        yield RuntimeName(FRAME, name, tag, host.number, IN_CODE)


def _hardwired(host: _Host, kind: str) -> Iterator[str]:
    for entry in host.section.hardwired:
        of_kind, _, name = entry.partition(":")
        if of_kind == kind:
            yield from parameters.filled(host.element, host.section, name)


def _opened_names(host: _Host, tag: str) -> Iterator[RuntimeName]:
    for kind, value, path in active.opened(host.element, host.section):
        yield RuntimeName(kind, value, tag, host.number, path)


def _world_lookups(root: _Element, host: _Host, definitions: Definitions) -> Iterator[RuntimeName]:
    """Yield names of things in this file that a plugin or system looks up in the whole world."""
    # A name that begins with the robot's own model is yielded as the name of that model.
    kind, tag = host.section.unique, str(host.element.tag)
    (every,) = definitions.find("element", tag)
    sites = [it for it in (*every.sites, *host.section.sites) if it.role != "keep"]
    model = root if root.tag == "robot" else next(root.iter("model"), root)
    for site in (it for it in sites if it.form in ("scoped", "suffixed")):
        for value in dict.fromkeys(parameters.values_of(host.element, site)):
            if "::" in value and value.partition("::")[0] == model.get("name", ""):
                yield RuntimeName("model", value, tag, host.number, site.path)
    if not kind:
        return
    # A URDF is one model, by the name of its root.
    own = root.iter("robot", "model") if kind == "model" else root.iter(kind)
    there = {element.get("name") for element in own}
    for name in there.intersection(_hardwired(host, kind)):
        yield RuntimeName(kind, str(name), tag, host.number, IN_CODE)
    for site in sites:
        if kind in site.kinds and site.form != "own":
            for value in dict.fromkeys(parameters.values_of(host.element, site)):
                # What is looked up below a link has its name.
                if (value.partition("::")[0] if site.form == "suffixed" else value) in there:
                    yield RuntimeName(kind, value, tag, host.number, site.path)
