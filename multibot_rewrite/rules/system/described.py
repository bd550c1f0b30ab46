# SPDX-License-Identifier: Apache-2.0
"""Dangers of latched descriptions: empty, of another robot, of other frames or joints."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from multibot_rewrite.base.findings.finding import ERROR, Finding
from multibot_rewrite.base.wording import SEVERAL, only, shorten, unique
from multibot_rewrite.rules.declaration import system_rule
from multibot_rewrite.rules.system.frame_ids import frames_in, trees_of
from multibot_rewrite.system import words
from multibot_rewrite.system.index import Index, at_work, nodes_of, robots_of, sent_on
from multibot_rewrite.system.records import TOPIC, Description

# A description of one link fits anything.
_TWO = 2


@system_rule("MG420", "description-does-not-fit", ERROR, absence=True)
def description_does_not_fit(seen: Index) -> Iterator[Finding]:
    """Report the first fault of a description."""
    for it in seen.system.descriptions:
        _, senders = sent_on(seen, it.topic)
        robot = seen.robot(it.topic) or only(robots_of(seen, senders))
        if senders and (told := _wrong(seen, it, robot)):
            message, hint = told
            yield description_does_not_fit.finding(
                message, hint, robot=robot, node=senders[0], names=(it.topic,)
            )


def _wrong(seen: Index, it: Description, robot: str) -> tuple[str, str] | None:
    """Return what is wrong with a description and what to do; None for nothing."""
    if not it.links:
        ends = seen.by_name[TOPIC, it.topic]
        readers = nodes_of(at_work(ends.subscribers))
        wait = f"; {shorten(readers, SEVERAL)} has no model" if readers else ""
        return (
            f"{it.topic} is empty, or no URDF{wait}",
            "see the command that makes it: xacro's log",
        )
    others = {seen.frame_robot(link) for link in it.links} - {""}
    if robot and others and robot not in others:
        other = min(others)
        return (
            f"{it.topic} has the links of {other}: {shorten(it.links, SEVERAL)}",
            f"load the description of {robot}",
        )
    return _other_frames(seen, it, robot) or _other_joints(seen, it)


def _other_frames(seen: Index, it: Description, robot: str) -> tuple[str, str] | None:
    """Return a fault if no link is a sent frame, with or without a prefix (frame_prefix)."""
    trees = [one for one in trees_of(seen, robot) if one.edges]
    frames = {one for tree in trees for one in frames_in(tree.edges)}
    own = sorted(one for one in frames if seen.frame_robot(one) in ("", robot))
    if len(it.links) < _TWO or not own or any(_is_of(one, it.links) for one in own):
        return None
    return (
        f"no link of {it.topic} ({shorten(it.links, SEVERAL)}) is a frame that is sent"
        f" ({shorten(own, SEVERAL)})",
        "who sends tf has another description: load one in both",
    )


def _is_of(frame: str, links: Sequence[str]) -> bool:
    return any(frame == link or frame.endswith(f"/{link}") for link in links)


def _other_joints(seen: Index, it: Description) -> tuple[str, str] | None:
    """Return what is wrong where no sender of joint states in its namespace has a joint of it. One with
    joints of its own alone is healthy among others, so each of them has to be heard."""
    space = it.topic.rpartition("/")[0]
    heard = [one for one in seen.system.heard if one.joints]
    for topic in unique(one.topic for one in heard):
        type_, senders = sent_on(seen, topic)
        said = [one.joints for one in heard if one.topic == topic]
        fits = type_ == words.JOINTS and topic.rpartition("/")[0] == space and it.joints
        if not fits or not senders or len(said) < len(senders):
            continue
        named = unique(name for joints in said for name in joints)
        if {*named}.isdisjoint(it.joints):
            return (
                f"{it.topic} has the joints {shorten(it.joints, SEVERAL)}, and"
                f" {shorten(senders, SEVERAL)} sends {shorten(named, SEVERAL)} on {topic}",
                f"give {shorten(senders, SEVERAL)} the names that the description has",
            )
    return None
