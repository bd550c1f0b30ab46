"""What is asked of a look at the graph, and the words between the command and its child process."""

from __future__ import annotations

import json
from typing import NamedTuple

# The child's exit codes besides 0; rcl itself ends a process with 102.
NO_RCLPY, ENDED = 4, 130
RMW_MISMATCH = 102


class Request(NamedTuple):
    """Stop when the nodes of ``expected`` (full names) are seen, at the latest after ``timeout``
    seconds; also tell QoS and process of ``topics``."""

    timeout: float
    expected: tuple[str, ...] = ()
    topics: tuple[str, ...] = ()


def to_text(request: Request) -> str:
    """The request as one line."""
    return json.dumps(request)


def from_text(text: str) -> Request:
    """Read what ``to_text`` wrote."""
    timeout, expected, topics = json.loads(text)
    return Request(float(timeout), tuple(expected), tuple(topics))
