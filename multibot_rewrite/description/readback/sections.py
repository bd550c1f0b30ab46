# SPDX-License-Identifier: Apache-2.0
"""Which section of the vocabulary is about an element, as the programs choose what they load."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from lxml.etree import _Element

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.description.readback.xml import child_text
from multibot_rewrite.description.rewriters.vocabulary import Vocabulary, VocabularySection

# gz-sim's loader takes a library with or without lib and .so, versions, and the old name
# (gazebosim/gz-sim src/SystemLoader.cc).
_ENDING = lazy_compile(r"\.(?:so|dylib|dll)\Z")
_SYSTEM = lazy_compile(r"(?:ignition-gazebo|gz-sim)\d*-?(.*)")
ROS_1, ROS_2 = "1", "2"
# Every plugin that is not known and has a <ros> is a node.
WITH_ROS = "any_with_ros"


def plugin_section(
    plugin: _Element, vocabulary: Vocabulary
) -> tuple[VocabularySection | None, bool]:
    """The section of a plugin, None where it has none, and whether the plugin itself is known."""
    with_ros = plugin.find("ros") is not None
    for key in _keys(plugin):
        found = vocabulary.find("plugin", key)
        if found and _is_another(plugin, key, found[0]):
            continue
        # Nothing in ROS 1 reads a <ros>.
        if found and not (with_ros and all(it.ros == ROS_1 for it in found)):
            return _of_release(found, plugin), True
    if not with_ros:
        return None, False
    return vocabulary.find("plugin", WITH_ROS)[0], False


def _is_another(plugin: _Element, key: str, section: VocabularySection) -> bool:
    """gz-sim calls a plugin by its class. One that is called so is no library of Gazebo Classic, which
    calls a node by that name; those of gazebo_ros are for Classic alone."""
    of_node = any(it.path == "@name" and it.role == "declares" for it in section.sites)
    return of_node and "::" in plugin.get("name", "") and not key.startswith("gazebo_ros")


def _keys(plugin: _Element) -> Iterator[str]:
    library = plugin.get("filename", "").strip().rpartition("/")[2].removeprefix("lib")
    name = _ENDING.sub("", library)
    system = _SYSTEM.fullmatch(name)
    yield f"gz-sim-{system[1]}" if system else name
    class_ = plugin.get("name", "").strip()
    if "::" in class_:
        yield class_.replace("ignition::gazebo::", "gz::sim::")
    # What webots_ros2_driver loads has no library: a class, or a module of Python.
    yield plugin.get("type", "").strip()


def _of_release(found: Sequence[VocabularySection], plugin: _Element) -> VocabularySection:
    """ROS 1 and ROS 2 have plugins of one name. Only ROS 2 reads <ros> and has <ros2_control>; in
    a robot without them the release that reads more of the parameters counts, ROS 2 if both do."""
    by_release = {section.ros: section for section in found}
    new, old = by_release.get(ROS_2, found[0]), by_release.get(ROS_1)
    own = plugin.find("ros") is not None
    if old is None or own or plugin.getroottree().find("ros2_control") is not None:
        return new
    tags = {child.tag for child in plugin}
    return old if len(tags & old.tags) > len(tags & new.tags) else new


def hardware_class(system: _Element) -> str:
    """The class that a ros2_control system loads, empty without one: of its last ``<hardware>``
    (ros2_control component_parser.cpp parse_resource_from_xml: each one replaces the one before)."""
    blocks = system.findall("hardware")
    return child_text(blocks[-1], "plugin") or "" if blocks else ""


def hardware_section(system: _Element, vocabulary: Vocabulary) -> VocabularySection | None:
    """The section of the class that a ros2_control system loads."""
    return next(iter(vocabulary.find("hardware", hardware_class(system))), None)


def sensor_sections(sensor: _Element, vocabulary: Vocabulary) -> list[VocabularySection]:
    """What is known about every sensor, and about those of this type."""
    type_ = sensor.get("type", "").strip()
    return [*vocabulary.find("element", "sensor"), *vocabulary.find("sensor", type_)]
