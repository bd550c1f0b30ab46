# SPDX-License-Identifier: Apache-2.0
"""Drives against the robot: wheels, their sizes, directions and grip; gravity against motors."""

from collections.abc import Iterator, Mapping
from math import dist, pi
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, rule
from multibot_rewrite.description.checks.links_and_joints import Joint, roots
from multibot_rewrite.description.checks.numbers import Vector, number, value_of
from multibot_rewrite.description.checks.poses import (
    axis_of,
    cross,
    dot,
    minus,
    plus,
    point_in,
    pose_in,
    scaled,
    turned,
)
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.unknown import is_unknown
from multibot_rewrite.description.rewriters.text import text_at
from multibot_rewrite.rules.facts.drives import (
    Drive,
    are_opposite,
    are_swapped,
    drives,
    radius,
    rolling_faults,
    separation,
    size_of,
    wheel_joints,
)
from multibot_rewrite.rules.facts.memo import driven_joints, link_poses, memoized, number_at
from multibot_rewrite.rules.facts.support import beyond, contacts, hull
from multibot_rewrite.rules.subject import Subject

# A wheel with limits so far apart is not meant to stop, in radians.
ENDLESS = 20 * pi


@rule("MB620", "wheel-size", WARNING)
def wheel_size(subject: Subject) -> Iterator[Problem]:
    """Yield drives whose wheel distance (first pair) or radius (all) differs from the description's."""
    for drive in drives(subject):
        tags, robot = drive.tags, drive.robot
        value = size_of(drive, tags.separation, tags.defaults[0])
        found = separation(robot, *drive.pairs[0], bool(drive.left[1:]))
        if value is not None and value > 0 and found and not found.holds(value):
            yield _size_problem(drive, tags.separation, value, "the wheels are", found.best)
        value, unit = size_of(drive, tags.radius, tags.defaults[1]), tags.radius_of
        found = radius(robot, (*drive.left, *drive.right))
        if value is not None and value > 0 and found and not found.holds(value * unit):
            yield _size_problem(drive, tags.radius, value, "the wheels have", found.best / unit)


def _size_problem(drive: Drive, name: str, value: float, words: str, measured: float) -> Problem:
    element = drive.sizes[name]
    said = "" if element is not None else "not said, and "
    apart = " apart" if "sep" in name.lower() else ""
    message = f"{name} is {said}{value:g} m, but {words} {measured:.4g} m{apart}"
    place = (drive.plugin, None) if element is None else (element, "")
    return Problem(place[0], message, place[1], f"write {measured:.4g}")


@rule("MB622", "wheels-turn-wrong", WARNING)
def wheels_turn_wrong(subject: Subject) -> Iterator[Problem]:
    """Yield drives whose left and right are swapped, or whose axes of a pair are opposite."""
    for drive in drives(subject):
        left, right = drive.pairs[0]
        way = are_swapped(left, right) if drive.tags.turns_left else 0.0
        if way:
            names = f"{left.joint.name!r} is {way:.3g} m right of {right.joint.name!r}"
            hint = "swap left and right, or turn the axes of both joints around"
            yield Problem(left.named, f"left wheel {names}", "", hint)
        for left, right in drive.pairs:
            if "fixed" in (left.joint.type, right.joint.type):
                continue  # MB624
            if left.joint.name == right.joint.name:
                message = f"{left.joint.name!r} is the left and the right wheel"
                yield Problem(right.named, message, "", "name the joint of the other wheel")
            for words in rolling_faults(drive.robot, left, right):
                yield Problem(right.named, words, "", "correct it, or name other wheels")
            if are_opposite(left, right):
                names = f"{left.joint.name!r} and {right.joint.name!r}"
                message = f"the axes of wheels {names} point in opposite directions"
                yield Problem(right.named, message, "", "turn one of them around")


@rule("MB624", "wheel-cannot-turn", ERROR)
def wheel_cannot_turn(subject: Subject) -> Iterator[Problem]:
    """Report each joint that a drive names as a wheel and that cannot turn."""
    for element, joint in wheel_joints(subject):
        if fault := _why_not_turning(joint):
            yield Problem(element, f"wheel joint {joint.name!r} {fault}", "", "make it continuous")


def _why_not_turning(joint: Joint) -> str:
    """Return why a wheel cannot turn, for a message; empty if it can."""
    if joint.type in ("fixed", "prismatic"):
        return f"is {joint.type}: it cannot turn"
    limit = joint.parts.get("limit")
    if joint.type != "revolute":
        return ""
    if limit is not None:
        lower, upper = number(limit.get("lower", "0")), number(limit.get("upper", "0"))
    else:  # of an SDF
        lower, upper = (number_at(joint.element, f"axis/limit/{it}") for it in ("lower", "upper"))
    if lower is None or upper is None or upper - lower >= ENDLESS:
        return ""
    return f"turns from {lower:g} to {upper:g} radians only"


@rule("MB636", "wheel-without-grip", WARNING)
def wheel_without_grip(subject: Subject) -> Iterator[Problem]:
    """Report blocks of driven links on a continuous joint, if nothing else moves the robot."""
    blocks = [it for it in subject.elements.tops("gazebo") if it.get("reference")]
    driven = driven_joints(subject) if blocks and not _is_pushed(subject) else ()
    wheels = {
        it.child for it in subject.robot.joints if it.type == "continuous" and it.name in driven
    }
    for block in blocks:
        name = block.get("reference", "")
        # A wheel with rollers has grip one way alone, along <fdir1> or across it.
        for tag in ("mu1", "mu", "mu2") if name in wheels and block.find("fdir1") is None else ():
            value, element = number_at(block, tag), block.find(tag)
            if value is not None and value <= 0 and element is not None:
                message = f"{tag} of driven wheel {name!r} is {value:g}: it has no grip"
                yield Problem(element, message, "", "write 1.0 or so")
                break


# They set the speed of the body, and the wheels turn for the eye.
_PUSHING = frozenset(("gazebo_ros_planar_move", "gz-sim-velocity-control-system"))


def _is_pushed(subject: Subject) -> bool:
    """Return whether the robot has a plugin that moves its body, or an unknown one."""
    blocks = set(subject.elements.tops("gazebo"))
    return any(
        is_unknown(section) or not _PUSHING.isdisjoint(section.names)
        for plugin, section in subject.inventory.served
        if plugin.tag == "plugin" and plugin.getparent() in blocks
    )


GRAVITY = 9.81
# A motor that lacks less than this part is a matter of rounding.
SPARE = 1.02
# Metres; a support that is missed by less is one of rounding.
STANDS = 0.003
DRIVEN = ("revolute", "continuous", "prismatic")


@rule("MB633", "too-weak-for-gravity", NOTE)
def too_weak_for_gravity(subject: Subject) -> Iterator[Problem]:
    """Report driven joints whose effort does not hold their load at 0; without a drive all joints."""
    driven = driven_joints(subject)
    for joint in subject.robot.joints:
        if driven and joint.name not in driven:
            continue
        limit = joint.parts.get("limit")
        effort = None if limit is None else value_of(limit, "effort")
        if limit is None or not effort or effort < 0 or _most_load(subject, joint) <= effort:
            continue
        load = _load(subject, joint) if _is_held_at_0(joint) else 0.0
        if load > effort * SPARE:
            unit = "N" if joint.type == "prismatic" else "Nm"
            message = f"joint {joint.name!r} holds {load:.3g} {unit} at 0, its effort is {effort:g}"
            yield Problem(limit, message, "effort", f"{load:.3g} {unit} would hold it")


def _most_load(subject: Subject, joint: Joint) -> float:
    """Return an upper bound of gravity at a joint with any axis: quick, and enough for most."""
    pose = link_poses(subject).get(joint.child)
    weight = carried(subject).get(joint.child, NO_WEIGHT)
    if pose is None or not weight.mass:
        return 0.0
    arm = 1.0 if joint.type == "prismatic" else dist(weight.centre, pose.at)
    return GRAVITY * weight.mass * arm


def _is_held_at_0(joint: Joint) -> bool:
    """Return whether a motor holds this joint at 0."""
    if joint.type not in DRIVEN or "mimic" in joint.parts or joint.type == "continuous":
        return joint.type == "continuous" and "mimic" not in joint.parts
    limit = joint.parts["limit"]
    lower, upper = value_of(limit, "lower", 0.0), value_of(limit, "upper", 0.0)
    return lower is not None and upper is not None and lower < upper and lower <= 0 <= upper


def _load(subject: Subject, joint: Joint) -> float:
    """Return the torque or force of gravity at a joint, with all joints at 0."""
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
    """Report robots with a drive and simple collisions that touch the ground in more than one point."""
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
    """Return each link with all that is below it, in the root's frame, all joints at 0."""
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
                found[joint.parent] = _sum(found[joint.parent], found[name])
    return found


def _without_gravity(subject: Subject) -> set[str]:
    """Return the links for which a block turns gravity off, as sdformat's parser_urdf reads it."""
    if not subject.elements.every("turnGravityOff", "gravity"):
        return set()
    blocks = [it for it in subject.elements.tops("gazebo") if it.get("reference")]
    return {
        block.get("reference", "")
        for block in blocks
        if text_at(block, "turnGravityOff").lower() in ("true", "1")
        or text_at(block, "gravity").lower() in ("false", "0")
    }


def _sum(one: Weight, other: Weight) -> Weight:
    """Return two weights as one."""
    if not one.mass or not other.mass:
        return one if one.mass else other
    mass = one.mass + other.mass
    moment = plus(scaled(one.centre, one.mass), scaled(other.centre, other.mass))
    return Weight(mass, scaled(moment, 1 / mass))
