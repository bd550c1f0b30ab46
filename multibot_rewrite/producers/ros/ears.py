# SPDX-License-Identifier: Apache-2.0
"""What is received while the graph is looked at: transforms, and headers if they are asked for."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from multibot_rewrite.producers.ros import assemble, ros
from multibot_rewrite.producers.ros.headers import CLOCK_TYPE, HeaderSamples, Receive
from multibot_rewrite.producers.ros.look import GraphSession
from multibot_rewrite.producers.ros.tf_subscriptions import Callback, TfSubscriptions
from multibot_rewrite.producers.ros.voices import Mark
from multibot_rewrite.producers.zenoh.cdr import read_tf, read_transform
from multibot_rewrite.system.records import End

# tf has 10 Hz or more; a shared topic of 100 robots took 1.3 s to be received completely.
TF_SECONDS = (1.5, 3.0)
# Sensors have 5 Hz or more; what is sent once a minute is not waited for.
HEADER_SECONDS = 1.5


class Ears:
    """What is received while the graph is looked at: transforms, and headers if they are asked for."""

    def __init__(self, session: GraphSession) -> None:
        self._request = session.request
        self.tf = TfSubscriptions(partial(_subscribe, session))
        self.headers = HeaderSamples(partial(_subscribe_to_headers, session))

    def update(self, endpoints: Sequence[End]) -> None:
        """Subscribe to what is published now."""
        self.tf.update(endpoints, self._request.substitutes)
        if self._request.headers:
            self.headers.update(endpoints)

    def silent(self) -> list[str]:
        """The topics on which nothing has come."""
        return sorted({*self.tf.silent(), *self.headers.silent()})

    def keep_waiting(self) -> bool:
        """Whether something may still come."""
        return self.tf.keep_waiting(*TF_SECONDS) or self.headers.keep_waiting(HEADER_SECONDS)


def _subscribe(
    session: GraphSession, topic: str, type_: str, latched: bool, callback: Callback
) -> Callable[[], None] | str:
    """Subscribe to a tf topic: what ends the subscription, or why its type is not usable."""
    class_, reason = ros.raw_message_class(type_)
    if not class_:
        return f"{reason}; install tf2_msgs or source ROS 2"
    read = read_tf if type_ == assemble.TF_TYPES[0] else read_transform

    def received(data: bytes, mark: Mark) -> None:
        message = read(data)
        if message:
            callback(message, mark)

    end = ros.subscribe(session.node, class_, topic, latched, received)
    return end or "they have two types, and the other is read already"


def _subscribe_to_headers(
    session: GraphSession, topic: str, type_: str, latched: bool, callback: Receive
) -> Callable[[], None] | None:
    """Subscribe to the last message only, since there may be large images; None without a header."""
    if type_ != CLOCK_TYPE and not ros.begins_with_header(type_):
        return None
    class_, _ = ros.raw_message_class(type_)
    # Of the clock all are wanted: it may go back at any.
    depth = 0 if type_ == CLOCK_TYPE else 1
    return class_ and ros.subscribe(session.node, class_, topic, latched, callback, depth=depth)
