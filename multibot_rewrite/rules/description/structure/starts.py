# SPDX-License-Identifier: Apache-2.0
"""Positions that a description gives joints, against their limits: those they follow, those they
start at."""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.description.checks.links_and_joints import BOUNDED, Joint, joints_with
from multibot_rewrite.description.checks.numbers import number, value_of
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.rewriters.text import text_of
from multibot_rewrite.rules.subject import Subject

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
