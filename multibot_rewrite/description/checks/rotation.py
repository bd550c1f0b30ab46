# SPDX-License-Identifier: Apache-2.0
"""Rotations: roll, pitch and yaw, quaternions and matrices as urdfdom reads them.

Sources: urdfdom_headers, pose.h (``setFromRPY``, ``setFromQuaternion``, ``normalize``): yaw is applied
last, a quaternion is divided by its length, and one without a length is no rotation.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, cos, hypot, isfinite, sin, sqrt

from multibot_rewrite.description.checks.numbers import Vector

Quaternion = tuple[float, float, float, float]
Matrix = tuple[Vector, Vector, Vector]
NO_ROTATION: Quaternion = (0.0, 0.0, 0.0, 1.0)
# Matrices that differ by less are the same rotation.
SAME = 1e-12


def length_of(quaternion: Sequence[float]) -> float:
    """The length; 0 or infinite where the squares are too small or too large for a double."""
    return sqrt(sum(it * it for it in quaternion))


def unit(quaternion: Quaternion) -> Quaternion:
    """The quaternion as urdfdom keeps it."""
    length = length_of(quaternion)
    if not length or not isfinite(length):
        return NO_ROTATION
    x, y, z, w = (it / length for it in quaternion)
    return x, y, z, w


def matrix_of_quaternion(quaternion: Quaternion) -> Matrix:
    """The matrix of a quaternion of any length."""
    x, y, z, w = unit(quaternion)
    return (
        (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
        (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
        (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
    )


def quaternion_of_rpy(rpy: Vector) -> Quaternion:
    """The quaternion of roll, pitch and yaw."""
    (a, b, c), (d, e, f) = ([half(it / 2) for it in rpy] for half in (sin, cos))
    return (
        a * e * f - d * b * c,
        d * b * f + a * e * c,
        d * e * c - a * b * f,
        d * e * f + a * b * c,
    )


def rpy_of(matrix: Matrix) -> Vector:
    """Roll, pitch and yaw of a matrix; where yaw is free, roll makes up for whatever it is."""
    (r00, r01, r02), (r10, r11, r12), (r20, *_) = matrix
    yaw = atan2(r10, r00)
    roll = atan2(sin(yaw) * r02 - cos(yaw) * r12, cos(yaw) * r11 - sin(yaw) * r01)
    return roll, atan2(-r20, hypot(r00, r10)), yaw


def is_same(one: Matrix, other: Matrix) -> bool:
    """Are two matrices one rotation?"""
    pairs = ((a, b) for rows in zip(one, other, strict=True) for a, b in zip(*rows, strict=True))
    return all(abs(a - b) <= SAME for a, b in pairs)


def turned(matrix: Matrix, vector: Vector) -> Vector:
    """A vector after the rotation."""
    (a, b, c), (d, e, f), (g, h, i) = matrix
    x, y, z = vector
    return a * x + b * y + c * z, d * x + e * y + f * z, g * x + h * y + i * z


def product(outer: Matrix, inner: Matrix) -> Matrix:
    """The rotation ``inner``, and then ``outer``."""
    columns = inverse(inner)
    first, second, third = outer
    return turned(columns, first), turned(columns, second), turned(columns, third)


def inverse(matrix: Matrix) -> Matrix:
    """The rotation back."""
    (a, b, c), (d, e, f), (g, h, i) = matrix
    return (a, d, g), (b, e, h), (c, f, i)
