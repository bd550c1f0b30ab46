"""What is asked of a process that speaks to the graph, and the words between it and the command."""

from __future__ import annotations

import json
from typing import Any, NamedTuple

# The child's exit codes besides 0; rcl itself ends a process with 102.
NO_RCLPY, ENDED = 4, 130
RMW_MISMATCH = 102
_LINE = b"\n"


class Request(NamedTuple):
    """Stop when the nodes of ``expected`` (full names) are seen, at the latest after ``timeout``
    seconds; also tell QoS and process of ``topics``.

    With ``watch`` it never stops, and tells a snapshot whenever something changed. With
    ``stand_ins`` transforms are also read from the messages a rehearsal has without tf2_msgs.
    """

    timeout: float
    expected: tuple[str, ...] = ()
    topics: tuple[str, ...] = ()
    watch: bool = False
    stand_ins: bool = False


def to_text(order: tuple[Any, ...]) -> str:
    """An order, a record of plain values, as one line."""
    return json.dumps(order)


def from_text(text: str) -> Request:
    """Read what ``to_text`` made of a Request."""
    timeout, expected, topics, watch, stand_ins = json.loads(text)
    return Request(float(timeout), tuple(expected), tuple(topics), watch, stand_ins)


def framed(data: bytes) -> bytes:
    """A message with its length before it: several follow one another in a pipe."""
    return b"%d" % len(data) + _LINE + data
