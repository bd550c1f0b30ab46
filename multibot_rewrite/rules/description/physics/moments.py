"""Principal moments of inertia: which inertias no body has."""

from __future__ import annotations

from collections.abc import Iterator
from math import acos, cos, pi, sqrt

from multibot_rewrite.description.checks.links_and_joints import WORLD, Inertial, Link, Robot
from multibot_rewrite.description.checks.numbers import Vector
from multibot_rewrite.rules.description.physics.shared import NOTHING, inertials, parts_with_mass

# Relative; CAD programs print four digits and more.
ROUNDING = 0.01


def impossible(robot: Robot) -> Iterator[tuple[Link, Inertial, Vector, bool]]:
    """The inertias that no body has, their principal moments, the smallest first, and whether
    simulators merge the link with others that have a mass, or with ``world``."""
    parts: dict[str, int] | None = None
    for link, inertial in inertials(robot):
        if inertial.moments is None or _is_possible(inertial.moments):
            continue
        low, middle, high = moments = eigenvalues(inertial.moments)
        if high < NOTHING or (not is_negative(moments) and high <= (low + middle) * (1 + ROUNDING)):
            continue
        parts = parts_with_mass(robot) if parts is None else parts
        merged = link.name == WORLD or parts.get(link.name) != 1
        yield link, inertial, moments, merged


def _is_possible(moments: tuple[float, ...]) -> bool:
    """Is it certainly possible? Values off the diagonal shift the moments by ``off`` at most."""
    xx, xy, xz, yy, yz, zz = moments
    off = abs(xy) + abs(xz) + abs(yz)
    return min(xx, yy, zz) >= off and max(xx, yy, zz) + off <= (xx + yy + zz) / 2


def is_negative(moments: Vector) -> bool:
    """Is the smallest moment below 0, by more than rounding?"""
    return moments[0] < -1e-6 * abs(moments[2])


def fault_of(moments: Vector) -> str:
    """What is wrong with impossible moments."""
    low, middle, high = moments
    if is_negative(moments):
        return f"is not positive definite: a principal moment is {low:.3g}"
    small = " + ".join(f"{it if it > 1e-9 * high else 0:.3g}" for it in (low, middle))
    return f"is impossible: the principal moment {high:.3g} is larger than {small}"


def eigenvalues(moments: tuple[float, ...]) -> Vector:
    """Those of a symmetric 3x3 matrix, in order."""
    size = max(map(abs, moments))
    xx, xy, xz, yy, yz, zz = (it / size for it in moments)
    off = xy * xy + xz * xz + yz * yz
    if off == 0:
        low, middle, high = sorted((xx, yy, zz))
        return low * size, middle * size, high * size
    mean = (xx + yy + zz) / 3
    a, b, c = xx - mean, yy - mean, zz - mean
    spread = sqrt((a * a + b * b + c * c + 2 * off) / 6)
    det = a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz)
    angle = acos(max(-1.0, min(1.0, det / (2 * spread**3)))) / 3
    high = mean + 2 * spread * cos(angle)
    low = mean + 2 * spread * cos(angle + 2 * pi / 3)
    return low * size, (3 * mean - high - low) * size, high * size
