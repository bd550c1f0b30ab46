# SPDX-License-Identifier: Apache-2.0
"""What rules about mass, inertia and shapes share: how they are read, and examples."""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.description.checks.links_and_joints import Inertial, Link, Robot
from multibot_rewrite.description.checks.numbers import numbers
from multibot_rewrite.rules.description.examples import a_joint, block

# What MuJoCo takes for nothing (mjMINVAL).
NOTHING = 1e-15
SHAPES = {"box": ("size",), "cylinder": ("radius", "length"), "sphere": ("radius",)}
INERTIA = '<inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/>'
BOX = '<geometry><box size="1 1 1"/></geometry>'


def diagonal(ixx: str, iyy: str, izz: str, ixy: str = "0") -> str:
    """An inertia with these moments."""
    return f'<inertia ixx="{ixx}" ixy="{ixy}" ixz="0" iyy="{iyy}" iyz="0" izz="{izz}"/>'


def one_link(*inside: str, name: str = "a") -> str:
    """An example: a link, whose content begins in line 2."""
    return block(f'<link name="{name}">', *inside)


def visual(shape: str) -> str:
    """An example: a link that shows a shape."""
    return one_link(block("<visual>", f"<geometry>{shape}</geometry>"))


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


def a_wheel(side: str, y: str, type_: str = "continuous", axis: str = "0 1 0") -> str:
    lying = '<origin rpy="1.5708 0 0"/>'
    shape = '<geometry><cylinder radius="0.1" length="0.04"/></geometry>'
    """An example: a wheel of a rover, 7 lines."""
    return block(f'<link name="{side}">', block("<collision>", lying, shape)) + a_joint(
        f"{side}_joint", type_, "base", side, f'<origin xyz="0 {y} 0"/>', f'<axis xyz="{axis}"/>'
    )


LEFT, RIGHT = a_wheel("left", "0.2"), a_wheel("right", "-0.2")
