# SPDX-License-Identifier: Apache-2.0
"""ros2_control in a simulator: what loads it, whose hardware it is, and who else drives its joints."""

from __future__ import annotations

import os
from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.nearest import slip_of
from multibot_rewrite.base.outside import is_folder, is_there
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.rewriters.text import text_of
from multibot_rewrite.description.sources.packages import in_sources
from multibot_rewrite.description.sources.read import XACRO
from multibot_rewrite.description.sources.trace import alike
from multibot_rewrite.description.steps.document import Document
from multibot_rewrite.rules.facts.elements import COMMAND, STANDARD, name_of
from multibot_rewrite.rules.facts.memo import level_of_absence
from multibot_rewrite.rules.facts.simulators import (
    GAZEBO,
    SIMULATORS,
    driving,
    library_of,
    manager_plugins,
    simulated,
    simulator_of,
)
from multibot_rewrite.rules.facts.source_values import is_fixed, starts_of
from multibot_rewrite.rules.subject import Subject


@rule("MB233", "simulated-hardware-not-loaded", WARNING)
def simulated_hardware_not_loaded(subject: Subject) -> Iterator[Problem]:
    """Systems of simulators in a whole description without any plugin that makes a manager."""
    if not subject.robot.links or manager_plugins(subject):
        return
    for _, it, simulator in simulated(subject):
        message = (
            f"nothing loads {text_of(it)}: the description has no plugin of {simulator.name} for it"
        )
        yield Problem(it, message, "", f"add a <plugin> with {simulator.plugins[0]}")


@rule("MB234", "no-controllers-file", ERROR)
def no_controllers_file(subject: Subject) -> Iterator[Problem]:
    """Plugins of gz_ros2_control; that of Classic goes on without a file."""
    for plugin in manager_plugins(subject):
        library = library_of(plugin)
        given = [it for it in plugin.iterchildren("parameters") if text_of(it)]
        if not given and library in GAZEBO.plugins:
            words = f"{library} has no <parameters>, so it makes no controller_manager"
            level = WARNING if _is_told(subject, plugin) else ERROR
            yield Problem(plugin, words, None, "name the controllers' file", level=level)
        for it in given:
            path = text_of(it)
            if "$(" in path:
                words = "is a substitution of xacro, which the plugin does not know"
                hint = "expand the file with xacro first, and name it .xacro"
                level = NOTE if _is_for_xacro(subject.document) else WARNING
                yield Problem(it, f"<parameters> {path!r} {words}", "", hint, level=level)
                continue
            # Where xacro has expanded $(find), the folder of the package is there.
            home = os.path.dirname(os.path.dirname(path))
            is_here = subject.origins and os.path.isabs(path) and is_folder(home)
            if is_here and not is_there(path) and not in_sources(path):
                # A whole folder may be made by the build.
                level = "" if is_folder(os.path.dirname(path)) else WARNING
                yield Problem(
                    it,
                    f"there is no file {alike(path, os.curdir)}",
                    "",
                    "correct the path",
                    level=level,
                )


def _is_told(subject: Subject, plugin: _Element) -> bool:
    """Is the file an argument of xacro, which the launch file passes?"""
    starts = starts_of(subject, list(plugin.iterchildren("parameters")))
    return any(not is_fixed(subject, it, "") for it in starts.values())


def _is_for_xacro(document: Document) -> bool:
    """Does a description say that xacro reads it first, as the demos of gz_ros2_control do?"""
    spaces = (it for it in document.root.nsmap.values() if it.endswith("/xacro"))
    return XACRO in os.path.basename(document.file) or any(spaces)


@rule("MB242", "nothing-to-control", ERROR)
def nothing_to_control(subject: Subject) -> Iterator[Problem]:
    """Plugins of the two simulators in a whole description without a system: component_parser.cpp
    throws, gz_ros2_control_plugin.cpp and gazebo_ros2_control_plugin.cpp catch it."""
    if not subject.robot.links or subject.elements.every("ros2_control"):
        return
    for plugin in manager_plugins(subject):
        found = (it for it in SIMULATORS if library_of(plugin) in it.plugins)
        for simulator in () if subject.document.root.tag == "sdf" else found:
            message = f"{library_of(plugin)} is not active: the description has no <ros2_control>"
            hint = f"add one with the class {simulator.hardware[0]} and the joints"
            yield Problem(plugin, message, "filename", hint, level=level_of_absence(subject))


@rule("MB235", "hardware-of-other-simulator", ERROR)
def hardware_of_other_simulator(subject: Subject) -> Iterator[Problem]:
    """Systems of one simulator where there are plugins of the other alone."""
    libraries = {library_of(it) for it in manager_plugins(subject)}
    there = [it for it in SIMULATORS if libraries & set(it.plugins)]
    for _, it, simulator in simulated(subject):
        if there and simulator not in there:
            message = f"{text_of(it)} is for {simulator.name}, the plugin is of {there[0].name}"
            yield Problem(it, message, "", f"did you mean {there[0].hardware[0]}?")


@rule("MB236", "joint-with-two-drivers", WARNING)
def joint_with_two_drivers(subject: Subject) -> Iterator[Problem]:
    """Joints that plugins drive, against command interfaces and each other: once a joint.

    Whoever has a command interface of a joint holds it while no controller claims it (``hold_joints``).
    """
    rivals = {
        (name_of(joint), simulator.name): "<ros2_control>"
        for system, _, simulator in simulated(subject)
        for joint in system.iterchildren("joint")
        if joint.find(COMMAND) is not None
    }
    by: dict[tuple[str, str], _Element] = {}
    told: set[tuple[str, str]] = set()
    for it, plugin in driving(subject):
        # A file may have plugins for both simulators; each loads its own.
        key = text_of(it), simulator_of(plugin).name
        other = by.setdefault(key, plugin)
        rival = rivals.get(key) or (library_of(other) if other is not plugin else "")
        if rival and key not in told:
            told.add(key)
            yield Problem(it, f"{rival} commands joint {key[0]!r} as well", "", "keep one of them")


@rule("MB238", "interface-not-simulated", WARNING)
def interface_not_simulated(subject: Subject) -> Iterator[Problem]:
    """Command interfaces of joints in systems of simulators; misspelt ones are MB110's."""
    for system, plugin, simulator in simulated(subject):
        for joint in system.iterchildren("joint"):
            for it in joint.iterchildren(COMMAND):
                name = name_of(it)
                known = name in simulator.takes or not name or slip_of(name, STANDARD) != ""
                if not known or name == "acceleration":
                    message = f"{text_of(plugin)} exports no command interface {name!r}"
                    yield Problem(it, message, "name", f"it knows {', '.join(simulator.takes)}")
