# SPDX-License-Identifier: Apache-2.0
"""Joints that mimic others, and positions against limits: those that joints follow, those they
start at.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.wording import SHOWN, shorten
from multibot_rewrite.description.checks.links_and_joints import (
    BOUNDED,
    ONE_AXIS,
    TYPES,
    Joint,
    Robot,
    joints_with,
)
from multibot_rewrite.description.checks.numbers import number, value_of
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.rewriters.text import text_of
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


Bounds = tuple[float, float]
# Of a joint's range; and in radians or metres.
PART, ROUNDING = 0.05, 0.01
CONTROLLER = "gz-sim-joint-position-controller-system"


@rule("MB536", "mimic-beyond-limits", WARNING)
def mimic_beyond_limits(subject: Subject) -> Iterator[Problem]:
    """Joints with limits that follow a joint with limits."""
    for joint, mimic in joints_with(subject.robot, "mimic"):
        leader = subject.robot.joint.get(mimic.get("joint", ""))
        own, its = _bounds(joint), None if leader is None else _bounds(leader)
        ratio, shift = value_of(mimic, "multiplier", 1.0), value_of(mimic, "offset", 0.0)
        if leader is None or own is None or its is None or ratio is None or shift is None:
            continue
        low, high = sorted(it * ratio + shift for it in its)
        if _outside(low, own) or _outside(high, own):
            message = (
                f"joint {joint.name!r} goes from {low:.4g} to {high:.4g} with {leader.name!r}, its "
                f"limits are {own[0]:.4g} to {own[1]:.4g}"
            )
            yield Problem(mimic, message, None, f'lower="{low:.4g}" upper="{high:.4g}" would do')


def _bounds(joint: Joint) -> Bounds | None:
    """The limits of a joint that has a range."""
    limit = joint.parts.get("limit") if joint.type in BOUNDED else None
    if limit is None:
        return None
    lower, upper = value_of(limit, "lower", 0.0), value_of(limit, "upper", 0.0)
    return None if lower is None or upper is None or lower >= upper else (lower, upper)


def _outside(value: float, bounds: Bounds) -> bool:
    slack = max(PART * (bounds[1] - bounds[0]), ROUNDING if bounds[1] - bounds[0] > 0.5 else 0.0)
    return not bounds[0] - slack <= value <= bounds[1] + slack


@rule("MB537", "start-beyond-limits", WARNING)
def start_beyond_limits(subject: Subject) -> Iterator[Problem]:
    """Values that are numbers, of joints with a range."""
    for element, name in _starts(subject):
        joint, value = subject.robot.joint.get(name), number(text_of(element))
        bounds = None if joint is None else _bounds(joint)
        if value is None or bounds is None or bounds[0] - 1e-3 <= value <= bounds[1] + 1e-3:
            continue
        message = (
            f"joint {name!r} starts at {value:g}, its limits are {bounds[0]:g} to {bounds[1]:g}"
        )
        yield Problem(element, message, "")


def _starts(subject: Subject) -> Iterator[tuple[_Element, str]]:
    """Each value that a joint starts at, and the joint."""
    for system in subject.elements.tops("ros2_control"):
        for joint in system.iterchildren("joint"):
            for state in joint.iterchildren("state_interface"):
                for param in state.iterchildren("param") if state.get("name") == "position" else ():
                    if param.get("name") == "initial_value":
                        yield param, joint.get("name", "")
    for plugin, section in subject.inventory.served:
        if CONTROLLER in section.names:
            names = [text_of(it) for it in plugin.iterchildren("joint_name")]
            starts = [*plugin.iterchildren("initial_position")]
            yield from zip(starts, names[:1] * len(starts), strict=True)
