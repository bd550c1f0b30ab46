# SPDX-License-Identifier: Apache-2.0
"""Subscriptions to the tf topics of a graph (by a function that is passed in), and their rates."""

import time
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from typing import Any, NamedTuple

from multibot_rewrite.base.grouping import lists_by_key, sets_by_key
from multibot_rewrite.base.wording import SEVERAL, shorten
from multibot_rewrite.producers.ros.assemble import TF_TYPES, ReceivedTransform, age_of, numbers_of
from multibot_rewrite.system.records import PUBLISHES, TOPIC, Caveat, Edge, End

# So many times between two messages say how often they come, and more do not say more.
ENOUGH, MOST = 3, 50


class Pace(NamedTuple):
    """The last stamp in seconds, the times between the stamps so far, and how far one went back."""

    last: float = -1.0
    between: tuple[float, ...] = ()
    back: float = 0.0

    def after(self, stamp: float) -> "Pace":
        """Return the pace with one message more."""
        if self.last < 0 or stamp == self.last:
            return self._replace(last=stamp)
        if stamp < self.last:
            return self._replace(last=stamp, back=max(self.back, self.last - stamp))
        between = (*self.between, stamp - self.last) if len(self.between) < MOST else self.between
        return self._replace(last=stamp, between=between)

    def rate(self) -> float:
        """Return messages a second; 0 if unknown."""
        from statistics import median  # slow to import, and few messages are counted

        return round(1 / median(self.between), 1) if len(self.between) >= ENOUGH else 0.0


# A publisher that was started anew goes back once; of what is latched each publisher has one message.
BACK_MOVING, BACK_LATCHED = 2, 1
# The number of a message, or its sender's own mark where the middleware tells that.
Mark = int | bytes | None


class Voices(NamedTuple):
    """What was heard of one transform: the last mark, and how often it went back or was another."""

    last: Mark = None
    back: int = 0

    def after(self, mark: Mark) -> "Voices":
        """Return what was heard with one message more."""
        if mark is None:
            return self
        return Voices(mark, self.back + _goes_back(self.last, mark))

    def several(self, latched: bool) -> bool:
        """Return whether several publishers send it."""
        return self.back >= (BACK_LATCHED if latched else BACK_MOVING)


def _goes_back(last: Mark, mark: Mark) -> bool:
    """Return whether a message's mark shows another sender than the last one."""
    if isinstance(last, bytes) and isinstance(mark, bytes):
        return last != mark
    return isinstance(last, int) and isinstance(mark, int) and mark <= last


# As long as tf2 keeps a transform.
FORGET_SECONDS = 10.0
# Name, type, and whether it is latched (transient local).
Topic = tuple[str, str, bool]
Callback = Callable[[Any, Mark], None]
# (topic, type, latched, callback) -> what ends the subscription, or why there is none.
Subscribe = Callable[[str, str, bool, Callback], "Callable[[], None] | str"]


def _topic(end: End) -> Topic:
    return end.name, end.type, bool(end.qos and end.qos.durability == "TRANSIENT_LOCAL")


class _Received(NamedTuple):
    """One transform: when it came, its last numbers, empty if latched ones differ, and its age."""

    at: float
    numbers: tuple[float, ...]
    voices: Voices
    pace: Pace = Pace()
    age: float = 0.0


class TfSubscriptions:
    """Subscriptions to all tf topics, and what has come of each transform."""

    def __init__(self, subscribe: Subscribe) -> None:
        self._subscribe = subscribe
        self._open: dict[Topic, Callable[[], None]] = {}
        self._senders: set[End] = set()
        self._failed: dict[str, str] = {}
        self._received: dict[ReceivedTransform, _Received] = {}
        self._began = time.monotonic()

    def update(self, endpoints: Iterable[End], substitutes: bool) -> None:
        """Subscribe to every tf topic that is published, and to no other."""
        types = TF_TYPES if substitutes else TF_TYPES[:1]
        senders = {it for it in endpoints if it.type in types and it.role == PUBLISHES and it.qos}
        topics = {_topic(it) for it in senders}
        left, there = (
            {_topic(it)[::2] for it in self._senders - senders},
            {it[::2] for it in topics},
        )
        self._senders = senders
        # Who comes after a sender that left is no second one; what is latched comes again.
        self._received = {
            it: own._replace(voices=Voices()) if it[:2] in left else own
            for it, own in self._received.items()
            if it[:2] in there
        }
        for topic in [it for it in self._open if it not in topics or (it[2] and it[::2] in left)]:
            self._open.pop(topic)()
        for topic in sorted(topics - self._open.keys()):
            name, _, latched = topic
            end = self._subscribe(*topic, partial(self._receive, name, latched))
            if isinstance(end, str):
                self._failed[name] = end
            else:
                self._open[topic] = end
                self._began = time.monotonic()

    def _receive(self, topic: str, latched: bool, message: Any, mark: Mark) -> None:
        now = time.monotonic()
        # In a rehearsal without tf2_msgs each message is a single transform.
        for transform in getattr(message, "transforms", (message,)):
            parent, child = transform.header.frame_id, transform.child_frame_id
            edge = ReceivedTransform(topic, latched, parent, child)
            old, numbers = self._received.get(edge), numbers_of(transform.transform)
            voices = (old.voices if old else Voices()).after(mark)
            # What several latched publishers have each in another way is nowhere.
            differ = latched and old and old.numbers != numbers and voices.several(True)
            new = _Received(now, () if differ else numbers, voices)
            if not latched:
                pace = (old.pace if old else Pace()).after(transform.header.stamp)
                # The youngest: a message may be late.
                age = age_of(transform.header.stamp)
                new = new._replace(pace=pace, age=min(old.age if old else age, age, key=abs))
            self._received[edge] = new

    def transforms(self) -> tuple[ReceivedTransform, ...]:
        """Return the transforms that are still valid; latched ones always are."""
        limit = time.monotonic() - FORGET_SECONDS
        valid = (it for it, own in self._received.items() if it.latched or own.at >= limit)
        return tuple(sorted(valid))

    def edges(self, endpoints: Iterable[End]) -> Iterator[Edge]:
        """Yield the transforms that are still valid, each once a topic; static if latched ones came."""
        sent = (it for it in endpoints if (it.kind, it.role) == (TOPIC, PUBLISHES))
        senders = sets_by_key((it.name, it.node) for it in sent)
        alike = lists_by_key(((it.topic, it.parent, it.child), it) for it in self.transforms())
        for (topic, parent, child), own in sorted(alike.items()):
            known = [self._received[it] for it in own]
            several = any(
                one.voices.several(it.latched) for it, one in zip(own, known, strict=True)
            )
            rate = 0.0 if several else known[0].pace.rate()
            yield Edge(
                child, parent, topic, own[-1].latched, tuple(sorted(senders[topic])), several,
                known[-1].numbers, rate, age=known[0].age,
            )  # fmt: skip

    def keep_waiting(self, first: float, last: float) -> bool:
        """Return whether to wait longer: ``first`` seconds always, ``last`` while a topic is silent."""
        passed = time.monotonic() - self._began
        return bool(self._open) and passed < (last if self.silent() else first)

    def silent(self) -> list[str]:
        """Return the topics on which nothing has come."""
        received = {(it.topic, it.latched) for it in self._received}
        return [name for name, _, latched in self._open if (name, latched) not in received]

    def caveats(self) -> Iterator[Caveat]:
        """Yield a limitation for the topics that it could not subscribe to."""
        if self._failed:
            topics = shorten(sorted(self._failed), SEVERAL)
            reason = next(iter(self._failed.values()))
            text = f"the frames on {topics} were not read: {reason}"
            yield Caveat("frames-not-read", False, text)
