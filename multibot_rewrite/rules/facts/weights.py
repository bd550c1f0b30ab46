"""What links weigh with all that they carry, and where, with every joint at 0."""

from __future__ import annotations

from collections.abc import Mapping

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.checks.numbers import Vector
from multibot_rewrite.description.checks.poses import plus, point_in, pose_in, scaled
from multibot_rewrite.description.rewriters.text import text_at
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.facts.poses import link_poses
from multibot_rewrite.rules.subject import Subject


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
