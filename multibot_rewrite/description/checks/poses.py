# SPDX-License-Identifier: Apache-2.0
"""Rotations, the pose of an ``<origin>``, and the poses of links with every joint at 0.

Sources: urdfdom_headers, pose.h (``setFromRPY``, ``setFromQuaternion``, ``normalize``): yaw is
applied last, a quaternion is divided by its length, and one without a length is no rotation;
urdfdom and sdformat: the origin of a joint is the child's frame in the parent's, and its axis is in
the child's.
"""

from collections.abc import Mapping, Sequence
from functools import lru_cache
from math import atan2, cos, hypot, isfinite, sin, sqrt
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.description.checks.links_and_joints import Joint, Robot, roots
from multibot_rewrite.description.checks.numbers import Vector, numbers, vector

Quaternion = tuple[float, float, float, float]
Matrix = tuple[Vector, Vector, Vector]
NO_ROTATION: Quaternion = (0.0, 0.0, 0.0, 1.0)
# Matrices that differ by less are the same rotation.
SAME = 1e-12


def length_of(quaternion: Sequence[float]) -> float:
    """Return the length; 0 or infinite if the squares are too small or too large for a double."""
    return sqrt(sum(it * it for it in quaternion))


def unit(quaternion: Quaternion) -> Quaternion:
    """Return the quaternion as urdfdom keeps it."""
    length = length_of(quaternion)
    if not length or not isfinite(length):
        return NO_ROTATION
    x, y, z, w = (it / length for it in quaternion)
    return x, y, z, w


def matrix_of_quaternion(quaternion: Quaternion) -> Matrix:
    """Return the matrix of a quaternion of any length."""
    x, y, z, w = unit(quaternion)
    return (
        (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
        (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
        (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
    )


def quaternion_of_rpy(rpy: Vector) -> Quaternion:
    """Return the quaternion of roll, pitch and yaw."""
    (a, b, c), (d, e, f) = ([half(it / 2) for it in rpy] for half in (sin, cos))
    return (
        a * e * f - d * b * c,
        d * b * f + a * e * c,
        d * e * c - a * b * f,
        d * e * f + a * b * c,
    )


def rpy_of(matrix: Matrix) -> Vector:
    """Return roll, pitch and yaw of a matrix; where yaw is free, roll makes up for it."""
    (r00, r01, r02), (r10, r11, r12), (r20, *_) = matrix
    yaw = atan2(r10, r00)
    roll = atan2(sin(yaw) * r02 - cos(yaw) * r12, cos(yaw) * r11 - sin(yaw) * r01)
    return roll, atan2(-r20, hypot(r00, r10)), yaw


def is_same(one: Matrix, other: Matrix) -> bool:
    """Return whether two matrices are one rotation."""
    pairs = ((a, b) for rows in zip(one, other, strict=True) for a, b in zip(*rows, strict=True))
    return all(abs(a - b) <= SAME for a, b in pairs)


def turned(matrix: Matrix, vector: Vector) -> Vector:
    """Return a vector after the rotation."""
    (a, b, c), (d, e, f), (g, h, i) = matrix
    x, y, z = vector
    return a * x + b * y + c * z, d * x + e * y + f * z, g * x + h * y + i * z


def product(outer: Matrix, inner: Matrix) -> Matrix:
    """Return the rotation ``inner`` followed by ``outer``."""
    columns = inverse(inner)
    first, second, third = outer
    return turned(columns, first), turned(columns, second), turned(columns, third)


def inverse(matrix: Matrix) -> Matrix:
    """Return the inverse rotation."""
    (a, b, c), (d, e, f), (g, h, i) = matrix
    return (a, d, g), (b, e, h), (c, f, i)


ZERO = "0 0 0"
ROTATIONS = ("rpy", "quat_xyzw")
STRAIGHT: Matrix = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
X: Vector = (1.0, 0.0, 0.0)


class Pose(NamedTuple):
    """Where something is, and how it is turned."""

    at: Vector
    matrix: Matrix


HERE = Pose((0.0, 0.0, 0.0), STRAIGHT)


def pose_of(origin: _Element | None) -> Pose | None:
    """Return the pose of an ``<origin>``, the identity without one; None if its values are not numbers.

    Of two rotations the quaternion counts.
    """
    at = vector(ZERO if origin is None else origin.get("xyz", ZERO))
    turn = quaternion(origin) or _rotation_of(origin)
    return None if at is None or turn is None else Pose(at, matrix_of_quaternion(turn))


def quaternion(origin: _Element | None) -> Quaternion | None:
    """Return the four numbers of ``quat_xyzw``; None if it is missing or something else."""
    found = None if origin is None else numbers(origin.get("quat_xyzw", ""))
    if found is None or len(found) != 4:
        return None
    x, y, z, w = found
    return x, y, z, w


def rolled(origin: _Element) -> Matrix | None:
    """Return the rotation of ``rpy`` alone."""
    turn = _rotation_of(origin)
    return None if turn is None else matrix_of_quaternion(turn)


def _rotation_of(origin: _Element | None) -> Quaternion | None:
    rpy = vector(ZERO if origin is None else origin.get("rpy", ZERO))
    return None if rpy is None else quaternion_of_rpy(rpy)


def link_poses(robot: Robot) -> Mapping[str, Pose]:
    """Return each link's pose in the root of its tree, without those below an invalid origin."""
    found = {it.name: HERE for it in roots(robot)}
    todo = list(found)
    for name in todo:  # grows
        for joint in robot.below.get(name, ()):
            is_new = joint.child and joint.child not in found
            own = pose_in(joint.parts.get("origin")) if is_new else None
            if own is not None:
                found[joint.child] = placed(found[name], own)
                todo.append(joint.child)
    return found


def origin_of(element: _Element) -> Pose | None:
    """Return the pose in the first ``<origin>`` of an element."""
    return pose_in(next(element.iterchildren("origin"), None))


def pose_in(origin: _Element | None) -> Pose | None:
    """Return the pose in an ``<origin>``."""
    if origin is None:
        return HERE
    if origin.get("quat_xyzw") is not None:
        return pose_of(origin)
    return _pose(origin.get("xyz", ZERO), origin.get("rpy", ZERO))


@lru_cache(maxsize=1024)  # several rules ask for the same ones
def _pose(xyz: str, rpy: str) -> Pose | None:
    at, angles = vector(xyz), vector(rpy)
    if at is None or angles is None:
        return None
    is_turned = any(angles)
    return Pose(at, matrix_of_quaternion(quaternion_of_rpy(angles)) if is_turned else STRAIGHT)


def sdf_pose(text: str) -> Pose | None:
    """Return the pose in a ``<pose>`` of six numbers, the identity for an empty one."""
    values = numbers(text)
    if values == ():
        return HERE
    return None if values is None or len(values) != 6 else pose_of_six(values)


def pose_of_six(values: Sequence[float]) -> Pose:
    """Return the pose of x, y, z, roll, pitch and yaw."""
    x, y, z, roll, pitch, yaw = map(float, values)
    return Pose((x, y, z), matrix_of_quaternion(quaternion_of_rpy((roll, pitch, yaw))))


def placed(outer: Pose, inner: Pose) -> Pose:
    """Return a pose that is relative to another one, in that one's frame."""
    if outer.matrix is STRAIGHT:
        return Pose(plus(outer.at, inner.at), inner.matrix)
    turn = outer.matrix if inner.matrix is STRAIGHT else product(outer.matrix, inner.matrix)
    return Pose(plus(outer.at, turned(outer.matrix, inner.at)), turn)


def point_in(pose: Pose, point: Vector) -> Vector:
    """Return a point of a frame, in the frame that its pose is given in."""
    return plus(pose.at, turned(pose.matrix, point))


def axis_of(joint: Joint) -> Vector | None:
    """Return a joint's axis in its child's frame, of length 1; None if it has no direction."""
    written = joint.parts.get("axis")
    axis = X if written is None else vector(written.get("xyz"))
    return None if axis is None or not any(axis) else scaled(axis, 1 / length(axis))


def plus(one: Vector, other: Vector) -> Vector:
    """Return the sum."""
    return one[0] + other[0], one[1] + other[1], one[2] + other[2]


def minus(one: Vector, other: Vector) -> Vector:
    """Return the difference."""
    return one[0] - other[0], one[1] - other[1], one[2] - other[2]


def scaled(vector_: Vector, factor: float) -> Vector:
    """Return a vector times a factor."""
    return vector_[0] * factor, vector_[1] * factor, vector_[2] * factor


def dot(one: Vector, other: Vector) -> float:
    """Return the scalar product."""
    return one[0] * other[0] + one[1] * other[1] + one[2] * other[2]


def cross(one: Vector, other: Vector) -> Vector:
    """Return the vector product."""
    (a, b, c), (x, y, z) = one, other
    return b * z - c * y, c * x - a * z, a * y - b * x


def length(vector_: Vector) -> float:
    """Return how long a vector is."""
    return sqrt(dot(vector_, vector_))
