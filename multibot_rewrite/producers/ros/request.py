# SPDX-License-Identifier: Apache-2.0
"""The request to a child process that uses rclpy, and the messages between it and the command."""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping
from typing import Any

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.system.records import End

# The child's exit codes besides 0; rcl itself ends a process with 102.
NO_RCLPY, ENDED = 4, 130
RMW_MISMATCH = 102
# Before a message that says what is seen so far, in words.
SO_FAR = b"#"
_LINE = b"\n"


class Request(NamedTuple):
    """What a snapshot is asked for.

    The observation ends when the nodes and topics of ``expected`` (full names) are in the graph, and
    after ``timeout`` seconds at the latest. The snapshot has QoS and process of these topics. With
    ``watch`` it does not end, and there is a snapshot after each change. With ``substitutes``
    transforms are also read from the messages that a rehearsal has without tf2_msgs. With
    ``headers`` one message a sensor topic is received, for its frame; not when watching. With
    ``asks`` nodes of a watched graph are asked for their states, each for these parameters besides.
    With ``shows`` what is seen is sent once while it is waited whether more comes.
    """

    timeout: float
    expected: tuple[str, ...] = ()
    watch: bool = False
    substitutes: bool = False
    headers: bool = False
    asks: Mapping[str, Collection[str]] | None = None
    shows: bool = False

    def expects(self, end: End) -> bool:
        """Whether an end is of what is waited for."""
        return not {end.node, end.name}.isdisjoint(self.expected)

    def is_met(self, ends: Collection[End]) -> bool:
        """Whether something is expected, and all of it has ends."""
        there = {name for it in ends for name in (it.node, it.name)}
        return bool(self.expected) and there.issuperset(self.expected)


def to_text(order: tuple[Any, ...]) -> str:
    """An order, a record of plain values, as one line."""
    return json.dumps(order)


def from_text(text: str) -> Request:
    """Read what ``to_text`` made of a Request."""
    timeout, expected, *others = json.loads(text)
    return Request(float(timeout), tuple(expected), *others)


def framed(data: bytes) -> bytes:
    """A message with its length before it, so that several can follow one another in a pipe."""
    return b"%d" % len(data) + _LINE + data
