# SPDX-License-Identifier: Apache-2.0
"""What a viewer can show of each robot of a plan: topics, description, the frame it stands in."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from multibot_rewrite.base.conventions import WORLD_FRAMES
from multibot_rewrite.system.records import PUBLISHES, RUNS, SUBSCRIBES, TOPIC, Robot, System

_STRING, _DESCRIPTION = "std_msgs/msg/String", "robot_description"


class Shown(NamedTuple):
    """A robot with the types of the topics that its nodes and bridges send, and of those they read.

    A robot without a name stands for what all robots share.
    """

    robot: Robot
    sent: dict[str, str]
    read: dict[str, str]

    @property
    def description(self) -> str:
        """The topic of its description."""
        sent = self.of_type({_STRING})
        usual = f"/{self.robot.name}/{_DESCRIPTION}"
        return next((it for it in sent if _DESCRIPTION in it), usual)

    def of_type(self, types: Iterable[str]) -> list[str]:
        """What it sends of some types."""
        some = set(types)
        return [name for name, type_ in self.sent.items() if type_ in some]

    def clicked(self, word: str) -> str:
        """The topic it reads that is called so, or ""."""
        return next((it for it in self.read if self.is_called(it, word)), "")

    def is_called(self, topic: str, word: str) -> bool:
        """Is the topic ``/robot1/WORD`` or ``/WORD/robot1``?"""
        own = ("", self.robot.name, self.robot.tag)
        return [it for it in topic.split("/") if it not in own] == [word]


def shown_by_robot(plan: System) -> tuple[list[Shown], Shown]:
    """Every robot, and what is of all robots."""
    every = {it.name: Shown(it, {}, {}) for it in (Robot(""), *plan.robots)}
    tags = {it.tag or it.name: it.name for it in plan.robots}
    owners = {it.name: it.robot for it in plan.nodes}
    for end in plan.ends:
        if end.kind == TOPIC and end.sure == RUNS:
            _add(every.get(owners.get(end.node, "")), end.role, end.name, end.type)
    for topic in plan.topics:
        words = topic.name.strip("/").split("/")
        owner = words[0] if words[0] in every else tags.get(words[-1], "")
        for role in topic.bridge if owner else ():
            _add(every[owner], role, topic.name, topic.type)
    shared = every.pop("")
    return list(every.values()), shared


def _add(shown: Shown | None, role: str, topic: str, type_: str) -> None:
    if shown and role in (PUBLISHES, SUBSCRIBES):
        (shown.sent if role == PUBLISHES else shown.read).setdefault(topic, type_)


def world_of_plan(plan: System) -> str:
    """The frame of all robots in which they stand, else the first robot's first."""
    return next(_worlds(plan), "")


def _worlds(plan: System) -> Iterator[str]:
    shared = plan.shared_frames
    yield from (it.parent for it in plan.edges if it.parent in shared)
    yield from (it for it in WORLD_FRAMES if it in shared)
    yield from (it for robot in plan.robots for it in robot.frames)
