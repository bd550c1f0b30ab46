# SPDX-License-Identifier: Apache-2.0
"""The transforms of a snapshot as trees to be drawn over the robots, and where they differ from the
description."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from math import acos, degrees, dist, isfinite

from multibot_rewrite.base.conventions import WORLD_FRAMES
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.checks.poses import inverse, matrix_of_quaternion, product
from multibot_rewrite.pages.view.models import Joint
from multibot_rewrite.system.records import Edge
from multibot_rewrite.system.tf_copies import tree_topic

# What rounding and single precision explain.
METRES, DEGREES = 0.001, 0.1


class HeardFrame(NamedTuple):
    """A frame in its parent: x, y, z and a quaternion x, y, z, w."""

    name: str
    parent: str
    transform: tuple[float, ...]


class HeardTree(NamedTuple):
    """Frames below ``root`` on a tf topic, parents first. It stands where ``robot`` is planned to be,
    at the world's origin for none."""

    topic: str
    root: str
    robot: str
    frames: tuple[HeardFrame, ...]


class LinkFrames(NamedTuple):
    """A robot's links as frames of its tf topic."""

    robot: str
    topic: str
    frames: frozenset[str]


def heard_trees(
    heard: Iterable[Edge], robots: Sequence[LinkFrames], shared: frozenset[str]
) -> tuple[HeardTree, ...]:
    """The trees of a snapshot; a frame whose place was not heard is left out with those below it."""
    by_topic: dict[str, dict[str, Edge]] = defaultdict(dict)
    for it in heard:
        by_topic[tree_topic(it.topic)].setdefault(it.child, it)
    return tuple(
        HeardTree(topic, root, _robot(topic, root, frames, robots, shared), frames)
        for topic, above in by_topic.items()
        for root in dict.fromkeys(it.parent for it in above.values())
        if root not in above
        for frames in [tuple(_below(root, above))]
        if frames
    )


def placed(edge: Edge) -> tuple[float, ...]:
    """Its transform, if all of it is numbers."""
    return edge.transform if all(map(isfinite, edge.transform)) else ()


def _below(root: str, above: Mapping[str, Edge]) -> Iterator[HeardFrame]:
    children: dict[str, list[Edge]] = defaultdict(list)
    for it in above.values():
        children[it.parent].append(it)
    todo = [root]
    for name in todo:  # grows
        for it in children[name]:
            if transform := placed(it):
                yield HeardFrame(it.child, name, transform)
                todo.append(it.child)


def _robot(
    topic: str,
    root: str,
    frames: Sequence[HeardFrame],
    robots: Sequence[LinkFrames],
    shared: frozenset[str],
) -> str:
    """The one robot whose tree this is: nothing says where its root is in the world."""
    if root in shared or root in WORLD_FRAMES:
        return ""
    names = {root, *(it.name for it in frames)}
    own = [it.robot for it in robots if it.topic == topic and it.frames & names]
    return own[0] if len(own) == 1 else ""


def moved(joints: Iterable[Joint], heard: Mapping[str, tuple[float, ...]]) -> Iterator[str]:
    """Links on fixed joints that were heard at another place, and how far off; ``heard`` is by link."""
    for it in joints:
        if it.type == "fixed" and heard.get(it.child):
            metres, angle = apart(it, heard[it.child])
            if metres > METRES or angle > DEGREES:
                yield f"{it.child} by {metres:.3f} m and {angle:.1f} degrees"


def apart(joint: Joint, heard: tuple[float, ...]) -> tuple[float, float]:
    """Metres and degrees between a joint's origin and a transform."""
    (a, b, c, x), (d, e, f, y), (g, h, i, z) = (tuple(row) for row in joint.pose[:3])
    turn = product(
        inverse(((a, b, c), (d, e, f), (g, h, i))),
        matrix_of_quaternion((heard[3], heard[4], heard[5], heard[6])),
    )
    cosine = (turn[0][0] + turn[1][1] + turn[2][2] - 1) / 2
    return dist((x, y, z), heard[:3]), degrees(acos(max(-1.0, min(1.0, cosine))))
