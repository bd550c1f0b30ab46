# SPDX-License-Identifier: Apache-2.0
"""Finds everything in a description that opens a topic, node, frame, socket, file or the like.

What it opens is known if its plugin definition holds a name or says ``opens:``. Where elements
are found: sdformat src/Root.cc, Model.cc and parser_urdf.cc (plugins are anywhere in a
``<gazebo>``), gz-sim SystemManager.cc (a plugin of a plugin is its own matter),
webots_ros2_driver WebotsNode.cpp, ros2_control component_parser.cpp."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.releases import OF_OLD, ROS_1, ROS_2
from multibot_rewrite.description.readback.parameters import given_at, holds
from multibot_rewrite.description.readback.xml import child_text, text_of
from multibot_rewrite.description.rewriters.plugin_definitions import Definitions, PluginDefinition
from multibot_rewrite.description.rewriters.plugin_definitions.grammar import split_opens

# gz-sim's loader takes a library with or without lib and .so, versions, and the old name
# (gazebosim/gz-sim src/SystemLoader.cc).
_ENDING = lazy_compile(r"\.(?:so|dylib|dll)\Z")
_SYSTEM = lazy_compile(r"(?:ignition-gazebo|gz-sim)\d*-?(.*)")
# A plugin of ROS 1 in a file for ROS 2, and who has it: the branch for ROS 2 lacks it.
_LEFT_OVER = ROS_2, ROS_1, OF_OLD
_BY_GAZEBO_ROS = "ros-simulation/gazebo_ros_pkgs"
# Every plugin that is not known and has a <ros> is a node.
WITH_ROS = "any_with_ros"


def plugin_section(
    plugin: _Element, definitions: Definitions
) -> tuple[PluginDefinition | None, bool]:
    """Return the definition of a plugin, or None, and whether the plugin itself is known."""
    with_ros = plugin.find("ros") is not None
    for key in _definition_keys(plugin):
        found = definitions.find("plugin", key)
        # gz-sim calls a plugin by its class. One that is called so is no library of Gazebo Classic,
        # which calls a node by that name; those of gazebo_ros are for Classic alone.
        sites = found[0].sites if found and not key.startswith("gazebo_ros") else ()
        of_node = any(it.path == "@name" and it.role == "declares" for it in sites)
        if of_node and "::" in plugin.get("name", ""):
            continue
        # Nothing in ROS 1 reads a <ros>.
        if found and not (with_ros and all(it.ros == ROS_1 for it in found)):
            return _section_by_ros(found, plugin), True
    # A system of gz-sim is called by its class: whether it has a node is not known.
    if not with_ros or "::" in plugin.get("name", ""):
        return None, False
    return definitions.find("plugin", WITH_ROS)[0], False


def _definition_keys(plugin: _Element) -> Iterator[str]:
    """Yield the names under which a plugin may have a definition: library, class, type."""
    library = plugin.get("filename", "").strip().rpartition("/")[2].removeprefix("lib")
    name = _ENDING.sub("", library)
    system = _SYSTEM.fullmatch(name)
    yield f"gz-sim-{system[1]}" if system else name
    class_ = plugin.get("name", "").strip()
    if "::" in class_:
        yield class_.replace("ignition::gazebo::", "gz::sim::")
    # What webots_ros2_driver loads has no library: a class, or a module of Python.
    yield plugin.get("type", "").strip()


def _section_by_ros(found: Sequence[PluginDefinition], plugin: _Element) -> PluginDefinition:
    """Return the definition for the ROS that loads a plugin."""
    # Only ROS 2 reads <ros>; without one the ROS that reads more of the parameters counts.
    by_release = {section.ros: section for section in found}
    new, old = by_release.get(ROS_2, found[0]), by_release.get(ROS_1)
    if old is None or plugin.find("ros") is not None:
        return new
    tags = {child.tag for child in plugin}
    return old if len(tags & old.tags) > len(tags & new.tags) else new


def hardware_class(system: _Element) -> str:
    """Return the class that a ros2_control system loads, by its last ``<hardware>``; or empty."""
    # Each one replaces the one before (component_parser.cpp parse_resource_from_xml).
    blocks = system.findall("hardware")
    return child_text(blocks[-1], "plugin") or "" if blocks else ""


def hardware_section(system: _Element, definitions: Definitions) -> PluginDefinition | None:
    """Return the definition of the class that a ros2_control system loads."""
    return next(iter(definitions.find("hardware", hardware_class(system))), None)


PLUGIN, HARDWARE, SENSOR, INCLUDE = "plugin", "hardware class", "sensor type", "included model"
# A number is an address of which it is known how that of the next robot is made.
ADDRESS, NUMBER, FILE = "address", "number", "file"
_DEVICE = lazy_compile(r"/dev/\S+|v?can\d+|COM\d+")
# What is of the computer that a driver runs on.
DEVICE, PORT = "device", "port"
NOTHING, UNKNOWN, NAMESPACE, TRANSFORMS = "nothing", "unknown", "namespace", "transforms"
OF_MODEL = "model"
# What is sent or heard where no rule reaches, on the one topic that all have: frames keep robots apart.
TRANSFORMS_ON = "transforms on"
# The kind of what only a namespace keeps apart.
RELATIVE = "relative names of"
# No device at all; a port that the system gives, every address of a machine, its loopback: no two
# robots meet there.
NOWHERE = frozenset(
    (
        *("", '""', "R", "-1", "0", "none", "None", "INADDR_ANY", "0.0.0.0"),
        "127.0.0.1",
        "R127.0.0.1",
        "localhost",
        "lo",
    )
)
# Kinds of names that something runs by: a section with one of them says what it opens.
_OPENED = frozenset({"topic", "subtopic", "service", "stem", "namespace"})
# Of a URDF itself, in which nothing loads a <plugin>.
_PARTS = frozenset({"robot", "link", "joint", "sensor", "ros2_control"})
# A <plugin> in these is a class that is loaded by what is around it, or MJCF, which runs nothing.
_NO_PLUGINS = frozenset({"hardware", "transmission", "raw_inputs", "mujoco_inputs", "extension"})


class ActivePart(NamedTuple):
    """An element that runs something: what ``kind``, by which name, and what is known of it."""

    kind: str
    element: _Element
    name: str
    section: PluginDefinition | None

    @property
    def is_known(self) -> bool:
        """Return whether a definition says what the part opens."""
        return self.section is not None and says_what_it_opens(self.section)

    @property
    def opens_something(self) -> bool:
        """Return False only if all that it opens is known: named by values, which are compared."""
        # What is below the name that its model is spawned with is known, too, but not what a sensor
        # without a topic opens.
        words = self.section.opens if self.section else ()
        if self.kind == SENSOR and self.section:
            return False
        known = (NOTHING, OF_MODEL)
        return not words or any(it not in known and not split_opens(it).path for it in words)

    @property
    def is_apart(self) -> bool:
        """Return whether all that a part opens, besides names in values, is below a namespace."""
        words = self.section.opens if self.section else ()
        return {NAMESPACE} == {it for it in words if not split_opens(it).path}


def active_parts(root: _Element, definitions: Definitions) -> Iterator[ActivePart]:
    """Yield all active parts of a description, kind by kind."""
    every = lists_by_key((str(it.tag), it) for it in root.iter("plugin", "sensor", "include"))
    for plugin in every["plugin"]:
        if not _is_of_another(plugin) and not why_not_loaded(plugin, definitions):
            section, known = plugin_section(plugin, definitions)
            yield ActivePart(PLUGIN, plugin, plugin_name(plugin), section if known else None)
    for system in root.iter("ros2_control"):
        if class_ := hardware_class(system):
            yield ActivePart(HARDWARE, system, class_, hardware_section(system, definitions))
    for sensor in every["sensor"]:
        type_ = sensor.get("type", "").strip()
        if type_ and _is_simulated(sensor):
            section = next(iter(definitions.find("sensor", type_)), None)
            yield ActivePart(SENSOR, sensor, type_, section)
    for include in every["include"]:
        uri = child_text(include, "uri")
        if uri and next(include.iterancestors("model", "gazebo"), None) is not None:
            yield ActivePart(INCLUDE, include, uri, None)


def is_loaded(plugin: _Element) -> bool:
    """Return whether a simulator looks for a plugin at this place."""
    # In a URDF: <gazebo> and tags of others (sdformat parser_urdf.cc, WebotsNode.cpp).
    return not _PARTS.issuperset(str(it.tag) for it in plugin.iterancestors())


def _is_of_another(plugin: _Element) -> bool:
    return not _NO_PLUGINS.isdisjoint(str(it.tag) for it in plugin.iterancestors())


def why_not_loaded(plugin: _Element, definitions: Definitions) -> str:
    """Return why nothing is loaded for a plugin, with what to do; empty if it is no such plugin."""
    if not is_loaded(plugin):
        return "move it into a <gazebo>"
    if _is_of_another(plugin):
        return ""
    if not {"filename", "type"} & {*plugin.attrib}:  # required (sdformat plugin.sdf)
        return "it has no library: write its filename="
    section, _ = plugin_section(plugin, definitions)
    if not section or (definitions.ros, section.ros, definitions.release) != _LEFT_OVER:
        return ""
    hint = "ROS 2 has no such library: write the plugin that it has for this"
    return hint if section.source.startswith(_BY_GAZEBO_ROS) else ""


def plugin_name(plugin: _Element) -> str:
    """Return the name of what a plugin loads, as the file has it."""
    return plugin.get("filename") or plugin.get("type") or plugin.get("name") or ""


def _is_simulated(sensor: _Element) -> bool:
    """Return whether a sensor is Gazebo's, not urdfdom's or ros2_control's."""
    parent = sensor.getparent()
    if parent is None or parent.tag in ("robot", "ros2_control"):
        return False
    # A URDF's <link> holds sensors of other programs; an SDF's and a <gazebo>'s are Gazebo's.
    return next(sensor.iterancestors("gazebo", "sdf"), None) is not None


def says_what_it_opens(section: PluginDefinition) -> bool:
    """Return whether a definition says what the plugin opens."""
    if section.opens:
        return UNKNOWN not in section.opens
    own = (it for it in section.sites if it.role != "keep" and it.section[:9] != "block ros")
    return bool(section.wired) or any(not _OPENED.isdisjoint(it.kinds) for it in own)


def opened(host: _Element, section: PluginDefinition) -> Iterator[tuple[str, str, str]]:
    """Yield (kind, text, parameter) of what a part opens: addresses, files, unlisted names."""
    if NAMESPACE in section.opens:
        yield RELATIVE, section.names[0], "opens"
    if TRANSFORMS in section.opens:
        yield TRANSFORMS_ON, "/tf", "its own listener"
    for word in section.opens:
        it = split_opens(word)
        if not it.path or (it.when and not holds(host, it.when)):
            continue
        # A camera puts its sensor's name in front of its files (gz-sensors CameraSensor.cc, SaveImage).
        own = f"/{host.get('name', '')}" if host.tag == "sensor" and it.kind == FILE else ""
        values = [f"{value}{own}" for value in given_at(host, it.path) if value]
        for value in values or ([it.default] if it.default else []):
            # The first device of its kind has the number 0.
            if value not in NOWHERE or (it.kind == DEVICE and value == "0"):
                yield NUMBER if it.step else it.kind, value, it.path
    if host.tag == "ros2_control" and NOTHING not in section.opens:
        paths = {split_opens(word).path for word in section.opens}
        for param in host.iterfind("hardware/param"):
            path = f"hardware/param[@name={param.get('name', '')}]"
            if path not in paths and is_device(text := text_of(param)):
                yield DEVICE, text, path


def is_device(text: str) -> bool:
    """Return whether a text is the name of a computer's device, whatever parameter has it."""
    return _DEVICE.fullmatch(text) is not None
