"""What is heard on the topics of transforms; how one subscribes is handed in."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from multibot_rewrite.graph.environment import listed
from multibot_rewrite.graph.live import gather
from multibot_rewrite.graph.snapshot import Caveat, GraphEndpoint
from multibot_rewrite.remap.records import PUBLISHES

# As long as tf2 keeps a transform.
FORGET_SECONDS = 10.0
Topic = tuple[str, str, bool]
Take = Callable[[Any], None]
# (topic, type, latched, take) -> what ends the subscription, or why there is none.
Subscribe = Callable[[str, str, bool, Take], "Callable[[], None] | str"]


class Ears:
    """Subscriptions to topics of transforms, and the edges that came on them lately."""

    def __init__(self, subscribe: Subscribe) -> None:
        self._subscribe = subscribe
        self._ends: dict[Topic, Callable[[], None]] = {}
        self._deaf: dict[str, str] = {}
        self._heard: dict[gather.Heard, float] = {}
        self._began = time.monotonic()

    def attend(self, endpoints: Iterable[GraphEndpoint], stand_ins: bool) -> None:
        """Listen to every topic of transforms there is, and to none that is gone."""
        types = gather.TF_TYPES if stand_ins else gather.TF_TYPES[:1]
        topics = {
            (end.name, end.type, end.qos.durability == "TRANSIENT_LOCAL")
            for end in endpoints
            if end.type in types and end.role == PUBLISHES and end.qos
        }
        for topic in self._ends.keys() - topics:
            self._leave(topic)
        for topic in sorted(topics - self._ends.keys()):
            self._join(topic)

    def _join(self, topic: Topic) -> None:
        name, type_, latched = topic
        end = self._subscribe(name, type_, latched, lambda it: self._take(name, latched, it))
        if isinstance(end, str):
            self._deaf[name] = end
        else:
            self._ends[topic] = end
            self._began = time.monotonic()

    def _leave(self, topic: Topic) -> None:
        self._ends.pop(topic)()
        name, _, latched = topic
        self._heard = {
            it: at for it, at in self._heard.items() if (it.topic, it.latched) != (name, latched)
        }

    def _take(self, topic: str, latched: bool, message: Any) -> None:
        now = time.monotonic()
        # A message of one transform stands in for tf's own in a rehearsal.
        for transform in getattr(message, "transforms", (message,)):
            parent, child = transform.header.frame_id, transform.child_frame_id
            self._heard[gather.Heard(topic, latched, parent, child)] = now

    def edges(self) -> tuple[gather.Heard, ...]:
        """What was heard and still holds: latched transforms do for ever."""
        limit = time.monotonic() - FORGET_SECONDS
        return tuple(sorted(it for it, at in self._heard.items() if it.latched or at >= limit))

    def waiting(self, first: float, last: float) -> bool:
        """Whether to go on: ``first`` seconds in any case, ``last`` where a topic is silent."""
        passed = time.monotonic() - self._began
        heard = {(it.topic, it.latched) for it in self._heard}
        silent = any((name, latched) not in heard for name, _, latched in self._ends)
        return bool(self._ends) and passed < (last if silent else first)

    def caveats(self) -> Iterator[Caveat]:
        """What could not be listened to."""
        if self._deaf:
            names, reason = listed(sorted(self._deaf)), next(iter(self._deaf.values()))
            remedy = "install tf2_msgs or source ROS 2"
            text = f"the frames on {names} were not read: {reason}; {remedy}"
            yield Caveat("frames-not-read", False, text)
