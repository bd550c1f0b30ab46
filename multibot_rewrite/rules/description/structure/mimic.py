# SPDX-License-Identifier: Apache-2.0
"""Joints that mimic others."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.wording import SHOWN, shorten
from multibot_rewrite.description.checks.links_and_joints import ONE_AXIS, TYPES, Robot, joints_with
from multibot_rewrite.description.checks.numbers import value_of
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.subject import Subject


@rule("MB526", "mimic-loop", ERROR)
def mimic_loop(subject: Subject) -> Iterator[Problem]:
    """Each loop, at its first mimic, and each mimic of the joint it is in."""
    for joint, mimic in joints_with(subject.robot, "mimic"):
        if mimic.get("joint") == joint.name and joint.name:
            yield Problem(mimic, f"joint {joint.name!r} mimics itself", "joint")
    for loop in _loops(_leaders(subject.robot)):
        if len(loop) > 1:
            mimic = subject.robot.joint[loop[0]].parts["mimic"]
            names = shorten(map(repr, loop), SHOWN)
            yield Problem(mimic, f"joints mimic each other in a loop: {names}", "joint")


@rule("MB528", "mimic-chain", NOTE)
def mimic_chain(subject: Subject) -> Iterator[Problem]:
    """Mimics of mimics; a loop is MB526."""
    leader = _leaders(subject.robot)
    chained = {name: follows for name, follows in leader.items() if follows in leader}
    round_ = {name for loop in _loops(chained) for name in loop}
    for name, follows in chained.items():
        if name not in round_:
            late = "; robot_state_publisher sends no transform for it" if name < follows else ""
            message = f"joint {name!r} mimics {follows!r}, which mimics {leader[follows]!r}{late}"
            yield Problem(subject.robot.joint[name].parts["mimic"], message, "joint")


@rule("MB529", "mimic-of-fixed", ERROR)
def mimic_of_fixed(subject: Subject) -> Iterator[Problem]:
    """Mimics of joints without one position; the mimic of a fixed joint does not matter."""
    for joint, mimic in joints_with(subject.robot, "mimic"):
        leader = subject.robot.joint.get(mimic.get("joint", ""))
        if (
            leader
            and leader.type in TYPES
            and leader.type not in ONE_AXIS
            and joint.type in ONE_AXIS
        ):
            message = f"joint {joint.name!r} mimics {leader.name!r}, which is {leader.type}"
            yield Problem(mimic, message, "joint")


@rule("MB530", "mimic-multiplier-zero", WARNING)
def mimic_multiplier_zero(subject: Subject) -> Iterator[Problem]:
    """Mimics whose joint never moves."""
    for joint, mimic in joints_with(subject.robot, "mimic"):
        if value_of(mimic, "multiplier", 1.0) == 0 and joint.type in ONE_AXIS:
            message = f"joint {joint.name!r} never moves: the multiplier of its mimic is 0"
            yield Problem(mimic, message, "multiplier")


def _leaders(robot: Robot) -> dict[str, str]:
    """Mimicking joint -> the joint it follows."""
    return {
        joint.name: mimic.get("joint", "")
        for joint, mimic in joints_with(robot, "mimic")
        if robot.joint[joint.name] is joint
    }


def _loops(leader: Mapping[str, str]) -> list[list[str]]:
    """The joints that follow each other in a loop."""
    done: set[str] = set()
    found = []
    for start in leader:
        way: dict[str, None] = {}
        name = start
        while name in leader and name not in done:
            done.add(name)
            way[name] = None
            name = leader[name]
        if name in way:
            found.append(list(way)[list(way).index(name) :])
    return found
