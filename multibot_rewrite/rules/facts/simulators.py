# SPDX-License-Identifier: Apache-2.0
"""What a description has for a simulator: hardware, plugins that load it, plugins that drive joints."""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.description.rewriters.text import text_of
from multibot_rewrite.description.rewriters.tree import library_key
from multibot_rewrite.knowledge.worlds import CLASSIC, DRIVES, GAZEBO, SIMULATORS, Simulator
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.subject import Subject


@memoized
def simulator_plugins(subject: Subject) -> list[_Element]:
    """Return the plugins of Gazebo: in blocks of a robot that it reads, or anywhere in an SDF."""
    if subject.document.root.tag == "sdf":
        # A model may have its <ros2_control> in it, where <plugin> is a class.
        plugins = subject.elements.every("plugin")
        return [it for it in plugins if next(it.iterancestors("ros2_control"), None) is None]
    if not subject.elements.every("plugin"):
        return []
    blocks = subject.elements.tops("gazebo")
    return [plugin for block in blocks for plugin in block.iter("plugin")]


@memoized
def manager_plugins(subject: Subject) -> list[_Element]:
    """Return the plugins that make a controller manager in a simulator, those of vendors too."""
    return [it for it in simulator_plugins(subject) if "ros2_control" in library_of(it)]


@memoized
def simulated(subject: Subject) -> list[tuple[_Element, _Element, Simulator]]:
    """Return the simulated systems of ros2_control: element, the hardware's ``<plugin>``, simulator."""
    return [
        (system, it, simulator)
        for system in subject.elements.tops("ros2_control")
        for it in system.iterfind("hardware/plugin")
        for simulator in SIMULATORS
        if text_of(it) in simulator.hardware
    ]


@memoized
def commanded(subject: Subject) -> frozenset[str]:
    """Return the joints that a simulator commands: by its hardware, or by a plugin that drives."""
    held = (
        it.get("name", "")
        for system, _, _ in simulated(subject)
        for it in system.iterchildren("joint")
        if it.find("command_interface") is not None
    )
    return frozenset((*held, *(text_of(it) for it, _ in driving(subject))))


def driving(subject: Subject) -> Iterator[tuple[_Element, _Element]]:
    """Yield (parameter, plugin) where a parameter names a joint that the plugin commands."""
    for plugin in simulator_plugins(subject):
        for tag in DRIVES.get(library_of(plugin), ()):
            yield from ((it, plugin) for it in plugin.iterchildren(tag) if text_of(it))


def simulator_of(plugin: _Element) -> Simulator:
    """Return the simulator that loads a plugin of ``DRIVES``."""
    return GAZEBO if library_of(plugin).startswith("gz-sim-") else CLASSIC


def library_of(plugin: _Element) -> str:
    """Return the library of a plugin without version and ending."""
    return library_key(plugin.get("filename", "").strip().rpartition("/")[2])
