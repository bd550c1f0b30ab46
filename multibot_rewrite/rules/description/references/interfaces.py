# SPDX-License-Identifier: Apache-2.0
"""Interfaces of ros2_control systems: twice, misspelt, without a state."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, NOTE
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.nearest import slip_of
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.facts.certain import since_jazzy
from multibot_rewrite.rules.facts.elements import COMMAND, OWNERS, STANDARD, STATE, name_of
from multibot_rewrite.rules.subject import Subject


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
