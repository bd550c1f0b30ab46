# SPDX-License-Identifier: Apache-2.0
"""ros2_control: driven joints, interfaces, what loads it in a simulator, and rival drivers."""

from __future__ import annotations

import os
from collections.abc import Iterator
from functools import lru_cache

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, rule
from multibot_rewrite.base.grouping import sets_by_key
from multibot_rewrite.base.nearest import slip_of
from multibot_rewrite.base.outside import is_folder, is_there
from multibot_rewrite.base.wording import SEVERAL, shorten
from multibot_rewrite.description.checks.links_and_joints import Joint
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.rewriters.text import text_of
from multibot_rewrite.description.sources.packages import in_sources
from multibot_rewrite.description.sources.read import XACRO
from multibot_rewrite.description.sources.trace import alike
from multibot_rewrite.knowledge.worlds import GAZEBO, SIMULATORS
from multibot_rewrite.rules.description.structure.mimic import controlled_joints, mimic_of_none
from multibot_rewrite.rules.facts.memo import driven_joints, level_of_absence, since_jazzy
from multibot_rewrite.rules.facts.simulators import (
    driving,
    library_of,
    manager_plugins,
    simulated,
    simulator_of,
)
from multibot_rewrite.rules.facts.source_values import is_fixed, starts_of
from multibot_rewrite.rules.subject import COMMAND, OWNERS, STANDARD, STATE, Subject, name_of

# Types that a motor cannot move.
UNDRIVEN = ("fixed", "floating", "planar", "")


@rule("MB223", "transmission-without-joint", WARNING)
def transmission_without_joint(subject: Subject) -> Iterator[Problem]:
    """Report transmissions without a joint; those of the PR2 name joints by other tags."""
    with_joint = subject.elements.first("joint")
    for it in subject.elements.tops("transmission"):
        if it in with_joint:
            continue
        if not any("joint" in str(child.tag).lower() for child in it.iterchildren("*")):
            message = f"transmission {it.get('name', '')!r} has no joint"
            yield Problem(it, message, None, "name its joint")


@rule("MB224", "driven-fixed-joint", ERROR)
def driven_fixed_joint(subject: Subject) -> Iterator[Problem]:
    """Report joints that ros2_control is to move and that cannot."""
    for it, joint in controlled_joints(subject):
        if joint.type == "fixed":
            message = f"joint {joint.name!r} is fixed"
            yield Problem(it, message, "name", "remove it", level=since_jazzy(subject))


@rule("MB225", "fixed-transmission", WARNING)
def fixed_transmission(subject: Subject) -> Iterator[Problem]:
    """Report joints of transmissions that cannot move."""
    if all(it.type != "fixed" for it in subject.robot.joints):
        return
    for transmission in subject.elements.tops("transmission"):
        for it in transmission.iterchildren("joint"):
            joint = subject.robot.joint.get(it.get("name", ""))
            if joint is not None and joint.type == "fixed":
                yield Problem(it, f"joint {joint.name!r} is fixed", "name", "nothing moves it")


@rule("MB226", "commanded-mimic", WARNING)
def commanded_mimic(subject: Subject) -> Iterator[Problem]:
    """Report mimicking joints with a command interface of their own."""
    for it, other in _mimicking(subject):
        if it.find("command_interface") is not None:
            message = f"joint {it.get('name')!r} mimics {other!r} and has a command interface"
            hint = 'delete the interface, or set mimic="false"'
            yield Problem(it, message, "name", hint, level=NOTE if since_jazzy(subject) else "")


@rule("MB227", "mimic-without-its-joint", WARNING)
def mimic_without_its_joint(subject: Subject) -> Iterator[Problem]:
    """Report mimicking joints whose leader is not in the same <ros2_control>."""
    yield from mimic_of_none(subject)
    joints = (it for it in subject.elements.owners() if it.tag == "joint")
    beside = sets_by_key((it.getparent(), name_of(it)) for it in joints)
    for it, other in _mimicking(subject):
        if other not in beside[it.getparent()]:
            who = f"joint {it.get('name')!r} mimics {other!r}"
            message = f"{who}, which is not in this <ros2_control>"
            yield Problem(it, message, "name", "put both in one <ros2_control>")


@rule("MB228", "undriven-joint", NOTE)
def undriven_joint(subject: Subject) -> Iterator[Problem]:
    """Report, once per robot, joints that nothing drives: forgotten or passive."""
    if not subject.elements.tops("ros2_control", "transmission"):
        return
    named = driven_joints(subject)
    left = [it for it in subject.robot.joints if it.name not in named and _needs_a_drive(it)]
    if left and len(left) < sum(map(_needs_a_drive, subject.robot.joints)):
        names = shorten((it.name for it in left), SEVERAL)
        message = f"nothing drives the joint{'s' * (len(left) > 1)} {names}"
        hint = "add to <ros2_control> what moves; publish the state of a passive joint"
        yield Problem(left[0].element, message, "name", hint)


def _needs_a_drive(joint: Joint) -> bool:
    return joint.type not in UNDRIVEN and joint.element.find("mimic") is None


def _mimicking(subject: Subject) -> Iterator[tuple[_Element, str]]:
    """Yield (joint in <ros2_control>, joint that it follows)."""
    for it, joint in controlled_joints(subject):
        mimic = joint.element.find("mimic")
        if mimic is not None and it.get("mimic", "").strip().lower() not in ("false", "0"):
            yield it, mimic.get("joint", "")


@rule("MB231", "repeated-interface", ERROR)
def repeated_interface(subject: Subject) -> Iterator[Problem]:
    """Report an interface that a component declares twice."""
    for owner in subject.elements.owners():
        seen: set[tuple[str, str]] = set()
        for it in owner.iterchildren(COMMAND, STATE):
            key = str(it.tag), name_of(it)
            if key in seen and key[1]:
                where = f"{owner.tag} {name_of(owner)!r}"
                message = f"{where} has {it.tag} {key[1]!r} twice"
                yield Problem(it, message, "name", "delete one", level=since_jazzy(subject))
            seen.add(key)


@rule("MB232", "interface-of-two-systems", ERROR)
def interface_of_two_systems(subject: Subject) -> Iterator[Problem]:
    """Report, once for two systems, the first interface that both export."""
    first: dict[str, _Element] = {}
    both: dict[tuple[_Element, _Element], list[tuple[_Element, str]]] = {}
    for system in subject.elements.tops("ros2_control"):
        for owner in system.iterchildren(*OWNERS):
            for it in owner.iterchildren(COMMAND, STATE):
                name = f"{it.tag} {name_of(owner)}/{name_of(it)}"
                there = first.setdefault(name, system)
                if there is not system:
                    both.setdefault((there, system), []).append((owner, name))
    for (there, _), ((owner, name), *others) in both.items():
        more = f" and {len(others)} more" if others else ""
        message = f"{name}{more} is in <ros2_control> {name_of(there)!r} as well"
        hint = "leave it to one system"
        yield Problem(owner, message, "name", hint, level=since_jazzy(subject))


def misspelt_interfaces(subject: Subject) -> Iterator[Problem]:
    """Report misspelt interfaces of joints."""
    for owner in subject.elements.owners():
        for it in owner.iterchildren(COMMAND, STATE) if owner.tag == "joint" else ():
            name = name_of(it)
            near = "" if name in STANDARD else _near_interface(name)
            if near:
                message = f"no controller asks for {name!r} of a joint"
                yield Problem(it, message, "name", f"did you mean {near!r}?")


@rule("MB239", "commanded-joint-without-state", NOTE)
def commanded_joint_without_state(subject: Subject) -> Iterator[Problem]:
    """Report the first joint with commands and no state; another system may have the state."""
    systems = [
        it for it in subject.elements.tops("ros2_control") if it.find("hardware") is not None
    ]
    joints = [joint for system in systems for joint in system.iterchildren("joint")]
    known = {name_of(it) for it in joints if it.find(STATE) is not None}
    found = [it for it in joints if it.find(COMMAND) is not None and name_of(it) not in known]
    if found:
        more = f" and {len(found) - 1} more" if len(found) > 1 else ""
        message = f"joint {name_of(found[0])!r}{more} has commands and no state"
        yield Problem(found[0], message, "name", 'add <state_interface name="position"/>')


@lru_cache(maxsize=256)
def _near_interface(name: str) -> str:
    """Return the standard interface of ros2_control with nearly this name, or empty."""
    return slip_of(name, STANDARD)


@rule("MB233", "simulated-hardware-not-loaded", WARNING)
def simulated_hardware_not_loaded(subject: Subject) -> Iterator[Problem]:
    """Report systems of simulators in a whole description without a plugin for the manager."""
    if not subject.robot.links or manager_plugins(subject):
        return
    for _, it, simulator in simulated(subject):
        why = f"the description has no plugin of {simulator.name} for it"
        message = f"nothing loads {text_of(it)}: {why}"
        yield Problem(it, message, "", f"add a <plugin> with {simulator.plugins[0]}")


@rule("MB234", "no-controllers-file", ERROR)
def no_controllers_file(subject: Subject) -> Iterator[Problem]:
    """Report plugins of gz_ros2_control; that of Classic goes on without a file."""
    for plugin in manager_plugins(subject):
        library = library_of(plugin)
        given = [it for it in plugin.iterchildren("parameters") if text_of(it)]
        if not given and library in GAZEBO.plugins:
            words = f"{library} has no <parameters>, so it makes no controller_manager"
            starts = starts_of(subject, list(plugin.iterchildren("parameters"))).values()
            # The file may be an argument of xacro, which the launch file passes.
            level = ERROR if all(is_fixed(subject, it, "") for it in starts) else WARNING
            yield Problem(plugin, words, None, "name the controllers' file", level=level)
        for it in given:
            path = text_of(it)
            if "$(" in path:
                words = "is a substitution of xacro, which the plugin does not know"
                hint = "expand the file with xacro first, and name it .xacro"
                # A description may say that xacro reads it, as the demos of gz_ros2_control do.
                of_xacro = any(it.endswith("/xacro") for it in subject.document.root.nsmap.values())
                of_xacro = of_xacro or XACRO in os.path.basename(subject.document.file)
                level = NOTE if of_xacro else WARNING
                yield Problem(it, f"<parameters> {path!r} {words}", "", hint, level=level)
                continue
            # Where xacro has expanded $(find), the folder of the package is there.
            home = os.path.dirname(os.path.dirname(path))
            is_here = subject.origins and os.path.isabs(path) and is_folder(home)
            if is_here and not is_there(path) and not in_sources(path):
                # A whole folder may be made by the build.
                level = "" if is_folder(os.path.dirname(path)) else WARNING
                message = f"there is no file {alike(path, os.curdir)}"
                yield Problem(it, message, "", "correct the path", level=level)


@rule("MB242", "nothing-to-control", ERROR)
def nothing_to_control(subject: Subject) -> Iterator[Problem]:
    """Report plugins of the two simulators in a whole description without a system."""
    # component_parser.cpp throws; gz_ros2_control_plugin.cpp, gazebo_ros2_control_plugin.cpp catch it.
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
    """Report systems of one simulator if there are only plugins of the other."""
    libraries = {library_of(it) for it in manager_plugins(subject)}
    there = [it for it in SIMULATORS if libraries & set(it.plugins)]
    for _, it, simulator in simulated(subject):
        if there and simulator not in there:
            message = f"{text_of(it)} is for {simulator.name}, the plugin is of {there[0].name}"
            yield Problem(it, message, "", f"did you mean {there[0].hardware[0]}?")


@rule("MB236", "joint-with-two-drivers", WARNING)
def joint_with_two_drivers(subject: Subject) -> Iterator[Problem]:
    """Report, once a joint, joints that two plugins command, or a plugin and a command interface."""
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
    """Report command interfaces of joints in systems of simulators; MB110 has misspelt ones."""
    for system, plugin, simulator in simulated(subject):
        for joint in system.iterchildren("joint"):
            for it in joint.iterchildren(COMMAND):
                name = name_of(it)
                known = name in simulator.takes or not name or slip_of(name, STANDARD) != ""
                if not known or name == "acceleration":
                    message = f"{text_of(plugin)} exports no command interface {name!r}"
                    yield Problem(it, message, "name", f"use one of {', '.join(simulator.takes)}")
