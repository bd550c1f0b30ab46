# SPDX-License-Identifier: Apache-2.0
"""Equal robots compared: what comes from one and not, or less often, from another."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping

from multibot_rewrite.base.conventions import SENT_FRAMES
from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.rules.declaration import system_rule
from multibot_rewrite.system import words
from multibot_rewrite.system.index import Index, at_work, nodes_of
from multibot_rewrite.system.records import TOPIC, Edge

# Topics of one robot and of another are as often, unless something is wrong: so many times.
RATIO = 3.0
# Where there were too many topics to listen to all.
_NOT_ALL = "headers-not-read"
# Fewer messages say nothing of a rate.
ENOUGH = 10


@system_rule("MG326", "less-than-another-robot", WARNING)
def less_than_another_robot(seen: Index) -> Iterator[Finding]:
    """Of the robots that have the topic, the one with the most messages is the measure."""
    yield from _silent(seen)
    yield from _slow(seen)
    yield from _slow_transforms(seen)
    for there in _of_each(seen).values():
        best = max(there.values(), key=lambda it: seen.known.messages[it])
        most = seen.known.messages[best]
        for robot, name in there.items() if most >= ENOUGH else ():
            count = seen.known.messages[name]
            if not count:
                message = f"{name} has no message, {best} has {most}"
                yield less_than_another_robot.finding(message, robot=robot, names=(name,))
            elif count * RATIO <= most and seen.known.seconds:
                slow, usual = (f"{it / seen.known.seconds:.1f} Hz" for it in (count, most))
                message = f"{name} came at {slow}, {best} at {usual}"
                yield less_than_another_robot.finding(message, robot=robot, names=(name,))


def _of_each(seen: Index) -> Mapping[str, Mapping[str, str]]:
    """Name without the robot's -> robot -> name, of the topics whose messages were counted."""
    found: dict[str, dict[str, str]] = defaultdict(dict)
    for name in seen.known.messages:
        if robot := seen.robot(name):
            found[seen.plain(name)][robot] = name
    return found


def _slow(seen: Index) -> Iterator[Finding]:
    """Of a running system the rate of a sensor is known, from a second of it."""
    rates = {it.topic: it.rate for it in seen.system.heard if it.rate}
    there: dict[tuple[str, str], dict[str, str]] = defaultdict(dict)
    for it in seen.topics if rates else ():
        robot = seen.robot(it.name)
        if robot and it.name in rates and words.kind_of_data(it.name, it.type):
            there[seen.plain(it.name), it.type][robot] = it.name
    for own in there.values():
        best = max(own.values(), key=lambda it: rates[it])
        for robot, name in own.items():
            if rates[name] * RATIO <= rates[best]:
                node = nodes_of(at_work(seen.by_name[TOPIC, name].publishers))[0]
                message = (
                    f"publishes {name} at {rates[name]:.1f} Hz, {best} comes at {rates[best]:.1f}"
                )
                yield less_than_another_robot.finding(
                    f"{message} Hz", "see its log, and the processor time that it has",
                    robot=robot, node=node, names=(name,),
                )  # fmt: skip


def _slow_transforms(seen: Index) -> Iterator[Finding]:
    """Odometry and localization, which go on without a pause: joints and what is seen need not."""
    there: dict[tuple[str, str], dict[str, Edge]] = defaultdict(dict)
    for it in (edge for tree in seen.trees for edge in tree.edges if edge.rate):
        robot, parent = (
            seen.frame_robot(it.child) or seen.robot(it.topic),
            seen.plain_frame(it.parent),
        )
        if robot and parent in SENT_FRAMES:
            there[parent, seen.plain_frame(it.child)][robot] = it
    for own in there.values():
        best = max(own.values(), key=lambda it: it.rate)
        for robot, it in own.items():
            if it.rate * RATIO <= best.rate:
                said = f"{it.parent} -> {it.child} on {it.topic} comes at {it.rate:.1f} Hz"
                yield less_than_another_robot.finding(
                    f"{said}, {best.parent} -> {best.child} at {best.rate:.1f} Hz",
                    "see the node that sends it, and the processor time that it has",
                    robot=robot, names=(it.child, it.topic),
                )  # fmt: skip


def _silent(seen: Index) -> Iterator[Finding]:
    """Of a running system one message a topic is known: of one robot it came, of the other not, which
    has sent others."""
    heard = {it.topic for it in seen.system.heard}
    if any(it.code == _NOT_ALL for it in seen.system.environment.caveats):
        return
    there_at_all = {seen.robot(it) for it in heard}
    there: dict[tuple[str, str], dict[str, str]] = defaultdict(dict)
    for it in seen.topics if heard and seen.nodes and not seen.known.messages else ():
        robot = seen.robot(it.name)
        if robot and words.kind_of_data(it.name, it.type) and at_work(it.publishers):
            there[seen.plain(it.name), it.type][robot] = it.name
    for own in there.values():
        loud = next((name for name in own.values() if name in heard), "")
        for robot, name in own.items() if loud else ():
            if name not in heard and robot in there_at_all:
                node = nodes_of(at_work(seen.by_name[TOPIC, name].publishers))[0]
                message = f"publishes {name}, on which no message came; {loud} has some"
                yield less_than_another_robot.finding(
                    message, "see its log", robot=robot, node=node, names=(name,)
                )
