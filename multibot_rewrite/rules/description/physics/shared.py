# SPDX-License-Identifier: Apache-2.0
"""What rules about mass, inertia and shapes share: how they are read."""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.description.checks.links_and_joints import Inertial, Link, Robot
from multibot_rewrite.description.checks.numbers import numbers

# What MuJoCo takes for nothing (mjMINVAL).
NOTHING = 1e-15
SHAPES = {"box": ("size",), "cylinder": ("radius", "length"), "sphere": ("radius",)}


def inertials(robot: Robot) -> Iterator[tuple[Link, Inertial]]:
    """The links that have an inertial, and it."""
    for link in robot.links:
        if link.inertial is not None:
            yield link, link.inertial


def part_of(inertial: Inertial, tag: str) -> _Element:
    """A child of an inertial, the inertial itself where it has none."""
    found = inertial.element.find(tag)
    return inertial.element if found is None else found


def moves(robot: Robot, name: str) -> bool:
    """Is a link the child of a joint that is not fixed?"""
    return name in robot.above and robot.above[name][0].type != "fixed"


def parts_with_mass(robot: Robot) -> dict[str, int]:
    """Body -> how many of its links have a mass."""
    count = dict.fromkeys(robot.body.values(), 0)
    for link, inertial in inertials(robot):
        if link.name in robot.body and inertial.mass != 0:
            count[robot.body[link.name]] += 1
    return count


def sizes_of(shape: _Element) -> tuple[float, ...]:
    """The sizes of a shape; empty if one is missing or not a number."""
    return numbers(" ".join([shape.get(name, "?") for name in SHAPES[str(shape.tag)]])) or ()
