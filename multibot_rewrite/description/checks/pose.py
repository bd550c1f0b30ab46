"""An ``<origin>`` as it is written, whatever version reads it."""

from __future__ import annotations

from lxml.etree import _Element

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.checks.numbers import Vector, numbers, vector
from multibot_rewrite.description.checks.rotation import (
    Matrix,
    Quaternion,
    matrix_of_quaternion,
    quaternion_of_rpy,
)

ZERO = "0 0 0"
ROTATIONS = ("rpy", "quat_xyzw")


class Pose(NamedTuple):
    """Where something is, and how it is turned."""

    at: Vector
    matrix: Matrix


def pose_of(origin: _Element | None) -> Pose | None:
    """The pose of an ``<origin>``, none of which is no pose; None where its values are not numbers.

    Of two rotations the quaternion counts.
    """
    at = vector(ZERO if origin is None else origin.get("xyz", ZERO))
    turn = quaternion(origin) or _rolled(origin)
    return None if at is None or turn is None else Pose(at, matrix_of_quaternion(turn))


def quaternion(origin: _Element | None) -> Quaternion | None:
    """The four numbers of ``quat_xyzw``; None where it is missing or something else."""
    found = None if origin is None else numbers(origin.get("quat_xyzw", ""))
    if found is None or len(found) != 4:
        return None
    x, y, z, w = found
    return x, y, z, w


def rolled(origin: _Element) -> Matrix | None:
    """The rotation of ``rpy`` alone."""
    turn = _rolled(origin)
    return None if turn is None else matrix_of_quaternion(turn)


def _rolled(origin: _Element | None) -> Quaternion | None:
    rpy = vector(ZERO if origin is None else origin.get("rpy", ZERO))
    return None if rpy is None else quaternion_of_rpy(rpy)
