# SPDX-License-Identifier: Apache-2.0
"""What gravity does to a robot: torques beyond a motor's effort, and wheels that do not carry it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import dist

from multibot_rewrite.base.findings.finding import NOTE, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.checks.links_and_joints import Joint, roots
from multibot_rewrite.description.checks.numbers import Vector, value_of
from multibot_rewrite.description.checks.poses import (
    axis_of,
    cross,
    dot,
    minus,
    plus,
    point_in,
    pose_in,
    scaled,
)
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.rotation import turned
from multibot_rewrite.description.rewriters.text import text_at
from multibot_rewrite.rules.facts.drives import drives
from multibot_rewrite.rules.facts.memo import driven_joints, link_poses, memoized
from multibot_rewrite.rules.facts.support import beyond, contacts, hull
from multibot_rewrite.rules.subject import Subject

GRAVITY = 9.81
# A motor that lacks less than this part is a matter of rounding.
SPARE = 1.02
# Metres; a support that is missed by less is one of rounding.
STANDS = 0.003
DRIVEN = ("revolute", "continuous", "prismatic")


@rule("MB633", "too-weak-for-gravity", NOTE)
def too_weak_for_gravity(subject: Subject) -> Iterator[Problem]:
    """Driven joints with an effort that are not balanced at 0, if 0 is within their limits.

    Where nothing says what is driven, all are.
    """
    driven = driven_joints(subject)
    for joint in subject.robot.joints:
        if driven and joint.name not in driven:
            continue
        limit = joint.parts.get("limit")
        effort = None if limit is None else value_of(limit, "effort")
        if limit is None or not effort or effort < 0 or _most(subject, joint) <= effort:
            continue
        load = _load(subject, joint) if _holds(joint) else 0.0
        if load > effort * SPARE:
            unit = "N" if joint.type == "prismatic" else "Nm"
            message = f"joint {joint.name!r} holds {load:.3g} {unit} at 0, its effort is {effort:g}"
            yield Problem(limit, message, "effort", f"{load:.3g} {unit} would hold it")


def _most(subject: Subject, joint: Joint) -> float:
    """More than gravity can do at a joint whatever its axis: one quick look, enough for most."""
    pose, weight = (
        link_poses(subject).get(joint.child),
        carried(subject).get(joint.child, NO_WEIGHT),
    )
    if pose is None or not weight.mass:
        return 0.0
    arm = 1.0 if joint.type == "prismatic" else dist(weight.centre, pose.at)
    return GRAVITY * weight.mass * arm


def _holds(joint: Joint) -> bool:
    """Does a motor hold this joint, at 0?"""
    if joint.type not in DRIVEN or "mimic" in joint.parts or joint.type == "continuous":
        return joint.type == "continuous" and "mimic" not in joint.parts
    limit = joint.parts["limit"]
    lower, upper = value_of(limit, "lower", 0.0), value_of(limit, "upper", 0.0)
    return lower is not None and upper is not None and lower < upper and lower <= 0 <= upper


def _load(subject: Subject, joint: Joint) -> float:
    """The torque or force of gravity at a joint, all joints at 0."""
    pose, axis = link_poses(subject).get(joint.child), axis_of(joint)
    weight = carried(subject).get(joint.child, NO_WEIGHT)
    if pose is None or axis is None or not weight.mass:
        return 0.0
    along = turned(pose.matrix, axis)
    force = (0.0, 0.0, -GRAVITY * weight.mass)
    if joint.type == "prismatic":
        return abs(dot(along, force))
    return abs(dot(along, cross(minus(weight.centre, pose.at), force)))


@rule("MB634", "tips-over", WARNING)
def tips_over(subject: Subject) -> Iterator[Problem]:
    """Robots with a drive whose collisions are all simple, and which stand on more than one point."""
    points = contacts(subject) if drives(subject) else None
    corners = hull(points) if points else []
    if len(corners) < 2:
        return
    for root in roots(subject.robot):
        weight = carried(subject).get(root.name, NO_WEIGHT)
        way = beyond(corners, weight.centre[:2]) if weight.mass else 0.0
        if way > STANDS:
            message = f"the centre of mass is {way:.3g} m outside of the wheels' area: it tips over"
            x, y, _ = weight.centre
            hint = f"it is at {x:.3g} {y:.3g} from {root.name!r}; move it or a wheel by {way:.3g} m"
            yield Problem(root.element, message, None, hint)


class Weight(NamedTuple):
    """A mass and its centre."""

    mass: float
    centre: Vector


NO_WEIGHT = Weight(0.0, (0.0, 0.0, 0.0))


@memoized
def carried(subject: Subject) -> Mapping[str, Weight]:
    """Each link with all that is below it, in the root's frame, all joints at 0."""
    poses = link_poses(subject)
    found = dict.fromkeys(poses, NO_WEIGHT)
    afloat, origins = _without_gravity(subject), subject.elements.first("origin")
    for link, inertial in ((it, it.inertial) for it in subject.robot.links):
        if inertial is None or link.name in afloat:
            continue
        own = pose_in(origins.get(inertial.element))
        if own is not None and inertial.mass and inertial.mass > 0 and link.name in poses:
            found[link.name] = Weight(inertial.mass, point_in(poses[link.name], own.at))
    for name in reversed([*poses]):  # children come after their parents
        for joint in subject.robot.above.get(name, ())[:1]:
            if joint.parent in found:
                found[joint.parent] = _together(found[joint.parent], found[name])
    return found


def _without_gravity(subject: Subject) -> set[str]:
    """The links that a block takes the gravity from, as sdformat's parser_urdf reads it."""
    if not subject.elements.every("turnGravityOff", "gravity"):
        return set()
    blocks = [it for it in subject.elements.tops("gazebo") if it.get("reference")]
    return {
        block.get("reference", "")
        for block in blocks
        if text_at(block, "turnGravityOff").lower() in ("true", "1")
        or text_at(block, "gravity").lower() in ("false", "0")
    }


def _together(one: Weight, other: Weight) -> Weight:
    """Two weights as one."""
    if not one.mass or not other.mass:
        return one if one.mass else other
    mass = one.mass + other.mass
    moment = plus(scaled(one.centre, one.mass), scaled(other.centre, other.mass))
    return Weight(mass, scaled(moment, 1 / mass))
