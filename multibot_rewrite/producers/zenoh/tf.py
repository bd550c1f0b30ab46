# SPDX-License-Identifier: Apache-2.0
"""The transforms that arrive through a Zenoh router while a snapshot is taken."""

from __future__ import annotations

import time
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator

from multibot_rewrite.base.wording import SEVERAL, shorten
from multibot_rewrite.producers.ros.assemble import TF_TYPES
from multibot_rewrite.producers.ros.tf_subscriptions import Callback, TfSubscriptions
from multibot_rewrite.producers.zenoh.cdr import read_tf
from multibot_rewrite.producers.zenoh.session import RouterSession
from multibot_rewrite.system.records import PUBLISHES, Caveat, End

POLL_SECONDS = 0.05
# tf has 10 Hz or more: all that a publisher sends has come twice. A silent one is waited for longer.
TF_SECONDS, TF_LONGEST_SECONDS = 0.5, 3.0
# The type part of a topic's key expression (rmw_zenoh design.md), the hash left open.
_TF_KEY = "tf2_msgs::msg::dds_::TFMessage_/*"
_GID_BYTES = 16


class ZenohTf:
    """The tf topics of a session: who publishes there, and who has spoken."""

    def __init__(self, session: RouterSession, domain: int) -> None:
        self._session, self._domain = session, domain
        self._publishers: Counter[str] = Counter()
        self._spoken: dict[str, set[bytes]] = defaultdict(set)
        self._unread: set[str] = set()
        self.subscriptions = TfSubscriptions(self._subscribe)

    def update(self, endpoints: Iterable[End]) -> None:
        """Subscribe to the tf topics among these, and to no other."""
        ends = [it for it in endpoints if it.type == TF_TYPES[0] and it.role == PUBLISHES]
        self._publishers = Counter(end.name for end in ends)
        self.subscriptions.update(ends, False)

    def listen(self, endpoints: Iterable[End], seconds: float) -> None:
        """Subscribe, and wait until every publisher has spoken, ``seconds`` at the longest."""
        self.update(endpoints)
        began = time.monotonic()
        while self._publishers and self._waiting(time.monotonic() - began, seconds):
            time.sleep(POLL_SECONDS)
            self._session.deliver()

    def _waiting(self, passed: float, seconds: float) -> bool:
        silent = any(len(self._spoken[it]) < many for it, many in self._publishers.items())
        return passed < min(seconds, TF_LONGEST_SECONDS if silent else TF_SECONDS)

    def _subscribe(
        self, topic: str, type_: str, latched: bool, callback: Callback
    ) -> Callable[[], None]:
        def received(payload: bytes, attachment: bytes) -> None:
            message = read_tf(payload)
            # rmw_zenoh design.md: the sender's gid is at the end of the attachment.
            sender = attachment[-_GID_BYTES:]
            self._spoken[topic].add(sender)
            if message is None:
                self._unread.add(topic)
            else:
                callback(message, sender)

        key = f"{self._domain}/{topic.strip('/')}/{_TF_KEY}"
        return self._session.subscribe(key, latched, received)

    def caveats(self) -> Iterator[Caveat]:
        """What was not heard, or is no TFMessage."""
        if self._unread:
            topics = shorten(sorted(self._unread), SEVERAL)
            yield Caveat("frames-not-read", True, f"messages on {topics} are no TFMessage in CDR")
        silent = sorted(it for it in self._publishers if not self._spoken[it])
        if silent:
            # One silent publisher is usual; nothing at all rather is a door that is shut.
            deaf = len(silent) == len(self._publishers)
            text = f"no transform was heard on {shorten(silent, SEVERAL)}"
            remedy = "the publishers are silent, or access control keeps us from listening"
            yield Caveat("frames-not-heard", deaf, f"{text}: {remedy}")
