# SPDX-License-Identifier: Apache-2.0
"""What rules about the tree and its joints share: the types of joints, and examples."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from lxml.etree import _Element

from multibot_rewrite.description.checks.links_and_joints import Joint, Robot
from multibot_rewrite.rules.description.examples import a_joint, a_link

TYPES = ("fixed", "revolute", "continuous", "prismatic", "floating", "planar")
# The types with one position, which have an axis; the types that need a limit.
ONE_AXIS = frozenset(("revolute", "continuous", "prismatic"))
BOUNDED = frozenset(("revolute", "prismatic"))
TOLERANCE = 1e-3
SHOWN = 8
TWO_LINKS = a_link("a") + a_link("b")
LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'


def one_joint(type_: str, *inside: str) -> str:
    """An example: two links and a joint, whose content begins in line 5."""
    return TWO_LINKS + a_joint("j", type_, "a", "b", *inside)


def two_joints(inside: str, *first: str) -> str:
    """An example: a revolute joint, and another with something in it, in line 11 if ``first`` is
    not given."""
    return (
        one_joint("revolute", LIMIT, *first)
        + a_link("c")
        + a_joint("k", "revolute", "b", "c", LIMIT, inside)
    )


def fixed_joint(name: str, parent: str, child: str) -> str:
    """An example: a fixed joint."""
    return a_joint(name, "fixed", parent, child)


def first_names(names: Iterable[str]) -> str:
    """The first of many names, quoted."""
    all_ = [repr(it) for it in names]
    more = f" and {len(all_) - SHOWN} more" if len(all_) > SHOWN else ""
    return ", ".join(all_[:SHOWN]) + more


def joints_with(robot: Robot, tag: str) -> Iterator[tuple[Joint, _Element]]:
    """The joints that have such an element."""
    for joint in robot.joints:
        if tag in joint.parts:
            yield joint, joint.parts[tag]
