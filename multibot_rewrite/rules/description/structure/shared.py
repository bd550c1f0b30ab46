# SPDX-License-Identifier: Apache-2.0
"""What rules about the tree and its joints share: the types of joints."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from lxml.etree import _Element

from multibot_rewrite.description.checks.links_and_joints import Joint, Robot

TYPES = ("fixed", "revolute", "continuous", "prismatic", "floating", "planar")
# The types with one position, which have an axis; the types that need a limit.
ONE_AXIS = frozenset(("revolute", "continuous", "prismatic"))
BOUNDED = frozenset(("revolute", "prismatic"))
TOLERANCE = 1e-3
SHOWN = 8


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
