# SPDX-License-Identifier: Apache-2.0
"""Dangers of what tf2 does not take: transforms that it drops as they come."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from math import inf, isfinite

from multibot_rewrite.base.conventions import BODY_FRAMES
from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.wording import only, shorten, unique
from multibot_rewrite.rules.declaration import system_rule
from multibot_rewrite.system.index import Index, robots_of, sent_on
from multibot_rewrite.system.records import Edge

# QUATERNION_NORMALIZATION_TOLERANCE of tf2/src/buffer_core.cpp.
_TOLERANCE = 10e-3


@system_rule("MG416", "transform-refused", ERROR)
def transform_refused(seen: Index) -> Iterator[Finding]:
    """By the checks of BufferCore::setTransformImpl; the transforms of one topic and reason are one."""
    found: dict[tuple[str, str], list[Edge]] = defaultdict(list)
    for tree in seen.trees:
        for it in tree.edges:
            if why := _why(it):
                found[it.topic, why].append(it)
    for (topic, why), edges in found.items():
        senders = unique(node for it in edges for node in it.publishers)
        listed = shorten(
            unique(f"{it.parent or '(none)'} -> {it.child or '(none)'}" for it in edges)
        )
        robots = unique(seen.frame_robot(it.child) for it in edges)
        yield transform_refused.finding(
            f"tf2 drops {listed} on {topic}: {why}",
            f"one of {shorten(senders)} sends it" if senders else "",
            robot=only(robots) or only(robots_of(seen, senders)),
            names=(topic, *unique(it.child for it in edges if it.child)),
        )
    yield from _poses(seen)


def _poses(seen: Index) -> Iterator[Finding]:
    for it in seen.system.heard:
        _, senders = sent_on(seen, it.topic)
        if senders and (why := _odd(it.pose)):
            yield transform_refused.finding(
                f"the pose on {it.topic} cannot be used: {why}",
                f"see what {shorten(senders)} makes it of",
                robot=only(robots_of(seen, senders)), node=senders[0], names=(it.topic,),
            )  # fmt: skip


def _why(it: Edge) -> str:
    if not (it.child and it.parent):
        return "a frame has no name"
    if it.child == it.parent:
        return "a frame is its own parent"
    return _odd(it.transform)


def _odd(numbers: tuple[float, ...]) -> str:
    if not all(map(isfinite, numbers)):
        return "a number in it is not finite (NaN)"
    length = sum(number * number for number in numbers[3:])
    if numbers and abs(length - 1) > _TOLERANCE:
        return "its quaternion is all zeros" if not length else "its quaternion is not of length 1"
    return ""


# No robot's part is so far from its base, in metres: a place in millimetres is.
_FAR = 20.0


@system_rule("MG418", "part-far-away", WARNING)
def part_far_away(seen: Index) -> Iterator[Finding]:
    """By the length alone: what is below the map is as far away as the building is long."""
    for tree in seen.trees:
        above = {it.child: it.parent for it in tree.edges}
        for it in tree.edges:
            away = max(map(abs, it.transform[:3]), default=0.0)
            if it.static and _FAR < away < inf and _is_of_a_body(seen, it.parent, above):
                yield part_far_away.finding(
                    f"{it.parent} -> {it.child} on {it.topic} is {away:g} m long",
                    "write metres",
                    robot=seen.frame_robot(it.child) or only(robots_of(seen, it.publishers)),
                    names=(it.child, it.topic),
                )


def _is_of_a_body(seen: Index, frame: str, above: Mapping[str, str]) -> bool:
    """Is it the base of a robot, or below it?"""
    way = [frame]
    while way[-1] in above and above[way[-1]] not in way:
        way.append(above[way[-1]])
    return any(seen.plain_frame(it) in BODY_FRAMES for it in way)
