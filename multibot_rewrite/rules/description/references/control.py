# SPDX-License-Identifier: Apache-2.0
"""Joints that <ros2_control> and transmissions drive, or should; its interfaces: twice, misspelt,
without a state.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.nearest import slip_of
from multibot_rewrite.description.checks.links_and_joints import Joint
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.description.structure.control_values import mimic_of_none
from multibot_rewrite.rules.facts.elements import COMMAND, OWNERS, STANDARD, STATE, name_of
from multibot_rewrite.rules.facts.memo import driven_joints, since_jazzy
from multibot_rewrite.rules.subject import Subject

# Types that a motor cannot move.
UNDRIVEN = ("fixed", "floating", "planar", "")


@rule("MB223", "transmission-without-joint", WARNING)
def transmission_without_joint(subject: Subject) -> Iterator[Problem]:
    """Transmissions of the robot; those of the PR2 name joints by other tags."""
    with_joint = subject.elements.first("joint")
    for it in subject.elements.tops("transmission"):
        if it in with_joint:
            continue
        if not any("joint" in str(child.tag).lower() for child in it.iterchildren("*")):
            message = f"transmission {it.get('name', '')!r} has no joint"
            yield Problem(it, message, None, "name its joint")


@rule("MB224", "driven-fixed-joint", ERROR)
def driven_fixed_joint(subject: Subject) -> Iterator[Problem]:
    """Joints that ros2_control is to move and that cannot."""
    for it in _components(subject.document.root):
        joint = subject.robot.joint.get(it.get("name", ""))
        if joint is not None and joint.type == "fixed":
            message = f"joint {joint.name!r} is fixed"
            yield Problem(it, message, "name", "remove it", level=since_jazzy(subject))


@rule("MB225", "fixed-transmission", WARNING)
def fixed_transmission(subject: Subject) -> Iterator[Problem]:
    """Joints of transmissions that cannot move."""
    if all(it.type != "fixed" for it in subject.robot.joints):
        return
    for transmission in subject.elements.tops("transmission"):
        for it in transmission.iterchildren("joint"):
            joint = subject.robot.joint.get(it.get("name", ""))
            if joint is not None and joint.type == "fixed":
                yield Problem(it, f"joint {joint.name!r} is fixed", "name", "nothing moves it")


@rule("MB226", "commanded-mimic", WARNING)
def commanded_mimic(subject: Subject) -> Iterator[Problem]:
    """Mimicking joints with a command interface of their own."""
    for it, other in _mimicking(subject):
        if it.find("command_interface") is not None:
            message = f"joint {it.get('name')!r} mimics {other!r} and has a command interface"
            hint = 'delete the interface, or set mimic="false"'
            yield Problem(it, message, "name", hint, level=NOTE if since_jazzy(subject) else "")


@rule("MB227", "mimic-without-its-joint", WARNING)
def mimic_without_its_joint(subject: Subject) -> Iterator[Problem]:
    """Mimicking joints whose leader is not in the same <ros2_control>."""
    yield from mimic_of_none(subject)
    beside: dict[_Element, set[str]] = {}
    for it, other in _mimicking(subject):
        system = it.getparent()
        assert system is not None
        if system not in beside:
            beside[system] = {name_of(joint) for joint in system.iterchildren("joint")}
        if other not in beside[system]:
            message = (
                f"joint {it.get('name')!r} mimics {other!r}, which is not in this <ros2_control>"
            )
            yield Problem(it, message, "name", "put both in one <ros2_control>")


@rule("MB228", "undriven-joint", NOTE)
def undriven_joint(subject: Subject) -> Iterator[Problem]:
    """One finding per robot: the joints that were forgotten, or are passive."""
    if not subject.elements.tops("ros2_control", "transmission"):
        return
    named = driven_joints(subject)
    left = [it for it in subject.robot.joints if it.name not in named and _needs_a_drive(it)]
    if left and len(left) < sum(map(_needs_a_drive, subject.robot.joints)):
        names = ", ".join(it.name for it in left[:5]) + (", ..." if len(left) > 5 else "")
        message = f"nothing drives the joint{'s' * (len(left) > 1)} {names}"
        yield Problem(
            left[0].element,
            message,
            "name",
            "add to <ros2_control> what moves; publish the state of a passive joint",
        )


def _needs_a_drive(joint: Joint) -> bool:
    return joint.type not in UNDRIVEN and joint.element.find("mimic") is None


def _mimicking(subject: Subject) -> Iterator[tuple[_Element, str]]:
    """Joints in <ros2_control> that follow another one, and which."""
    for it in _components(subject.document.root):
        joint = subject.robot.joint.get(it.get("name", ""))
        mimic = None if joint is None else joint.element.find("mimic")
        if mimic is not None and it.get("mimic", "").strip().lower() not in ("false", "0"):
            yield it, mimic.get("joint", "")


def _components(root: _Element) -> Iterator[_Element]:
    """The joints in <ros2_control>."""
    for system in root.iterchildren("ros2_control"):
        yield from system.iterchildren("joint")


@rule("MB231", "repeated-interface", ERROR)
def repeated_interface(subject: Subject) -> Iterator[Problem]:
    """Interfaces of one component."""
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
    """One finding for two systems: the first of what both export."""
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
    """Interfaces of joints."""
    for owner in subject.elements.owners():
        for it in owner.iterchildren(COMMAND, STATE) if owner.tag == "joint" else ():
            name = name_of(it)
            near = "" if name in STANDARD else _meant(name)
            if near:
                message = f"no controller asks for {name!r} of a joint"
                yield Problem(it, message, "name", f"did you mean {near!r}?")


@rule("MB239", "commanded-joint-without-state", NOTE)
def commanded_joint_without_state(subject: Subject) -> Iterator[Problem]:
    """One finding a robot: the first of such joints; another system may have the state."""
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
def _meant(name: str) -> str:
    """The interface of ros2_control that is almost called like that."""
    return slip_of(name, STANDARD)
