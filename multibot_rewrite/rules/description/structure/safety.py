"""Safety controllers, their soft limits, and dynamics."""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.description.checks.links_and_joints import Joint, Robot
from multibot_rewrite.description.checks.numbers import value_of
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.description.structure.shared import (
    BOUNDED,
    LIMIT,
    TOLERANCE,
    joints_with,
    one_joint,
)
from multibot_rewrite.rules.subject import Subject

Range = tuple[float, float]


@rule(
    "MB532",
    "soft-limits",
    WARNING,
    what="The soft limits of a <safety_controller> leave the joint no range; or one of them is "
    "outside of the joint's limits, which is a note.",
    why="A missing soft limit is 0. MoveIt, ros2_control and joint_state_publisher use the range "
    "that is inside both kinds of limits: MoveIt cannot plan for a joint that can only be at 0, "
    "and a soft limit outside has no effect.",
    fix="Write soft_lower_limit and soft_upper_limit inside of lower and upper, or delete the element.",
    bad=one_joint("revolute", LIMIT, '<safety_controller k_velocity="10"/>'),
    good=one_joint(
        "revolute",
        LIMIT,
        '<safety_controller soft_lower_limit="-1" soft_upper_limit="1" k_velocity="10"/>',
    ),
    line=6,
)
def soft_limits(subject: Subject) -> Iterator[Problem]:
    """Against hard limits that leave a range themselves."""
    for joint, safety, soft, hard in _soft_and_hard(subject.robot):
        if hard[0] >= hard[1]:
            continue
        said = f"joint {joint.name!r}: the soft limits {soft[0]:g} to {soft[1]:g}"
        if max(soft[0], hard[0]) >= min(soft[1], hard[1]):
            yield Problem(safety, f"{said} leave no range")
        if soft[0] < hard[0] - TOLERANCE or soft[1] > hard[1] + TOLERANCE:
            message = f"{said} are outside of {hard[0]:g} to {hard[1]:g}"
            yield Problem(safety, message, level=NOTE)


@rule(
    "MB534",
    "dynamics-empty",
    ERROR,
    what="A <dynamics> has neither damping nor friction.",
    why="urdfdom rejects the file ('joint dynamics element specified with no damping and no "
    "friction').",
    fix="Add one of them, or delete the element.",
    bad=one_joint("continuous", "<dynamics/>"),
    good=one_joint("continuous", '<dynamics damping="0.1"/>'),
    line=5,
)
def dynamics_empty(subject: Subject) -> Iterator[Problem]:
    """Dynamics without a value."""
    for joint, dynamics in joints_with(subject.robot, "dynamics"):
        if dynamics.get("damping") is None and dynamics.get("friction") is None:
            message = f"<dynamics> of joint {joint.name!r} has neither damping nor friction"
            yield Problem(dynamics, message)


def _soft_and_hard(robot: Robot) -> Iterator[tuple[Joint, _Element, Range, Range]]:
    """The bounded joints with a safety controller, and both pairs of limits as MoveIt reads them."""
    for joint, safety in joints_with(robot, "safety_controller"):
        limit = joint.parts.get("limit")
        if joint.type not in BOUNDED or limit is None:
            continue
        soft = (value_of(safety, f"soft_{it}_limit", 0.0) for it in ("lower", "upper"))
        hard = (value_of(limit, it, 0.0) for it in ("lower", "upper"))
        read = [it for it in (*soft, *hard) if it is not None]
        if len(read) == 4:
            yield joint, safety, (read[0], read[1]), (read[2], read[3])
