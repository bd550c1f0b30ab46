# SPDX-License-Identifier: Apache-2.0
"""The request to a child process that uses rclpy, its start and end, and the messages between them.

Its order is the first line of its standard input. It ends when that input is closed, on SIGTERM
and on Ctrl-C, and always leaves the graph cleanly: a process that is killed stays visible in the
graph for 20 s. Its messages go to standard output, each with its length before it; what libraries
print goes to standard error."""

import json
import os
import signal
import sys
import threading
from collections.abc import Callable, Collection, Mapping
from contextlib import suppress
from typing import Any, NamedTuple

from multibot_rewrite.producers.ros import ros
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
    transforms are also read from the messages that a rehearsal has without tf2_msgs; without it one
    message a sensor topic is received, for its frame. With
    ``asks`` nodes of a watched graph are asked for their states, each for these parameters besides.
    With ``shows`` what is seen is sent once while it is waited whether more comes.
    """

    timeout: float
    expected: tuple[str, ...] = ()
    watch: bool = False
    substitutes: bool = False
    asks: Mapping[str, Collection[str]] | None = None
    shows: bool = False

    def expects(self, end: End) -> bool:
        """Return whether an end is one that is waited for."""
        return not {end.node, end.name}.isdisjoint(self.expected)

    def is_met(self, ends: Collection[End]) -> bool:
        """Return whether something is expected, and all of it has ends."""
        there = {name for it in ends for name in (it.node, it.name)}
        return bool(self.expected) and there.issuperset(self.expected)


def to_text(order: tuple[Any, ...]) -> str:
    """Return an order, a record of plain values, as one line."""
    return json.dumps(order)


def from_text(text: str) -> Request:
    """Return the Request that ``to_text`` wrote."""
    timeout, expected, *others = json.loads(text)
    return Request(float(timeout), tuple(expected), *others)


def framed(data: bytes) -> bytes:
    """Return a message with its length before it, so that several can follow in a pipe."""
    return b"%d" % len(data) + _LINE + data


Send = Callable[[bytes], None]
Worker = Callable[[str, threading.Event, Send], int]


def run_worker(run: Worker) -> int:
    """Run ``run(order, stop, send)``; ``stop`` is set when it has to end. Returns the exit code."""
    # For messages; what libraries print to standard output goes to standard error.
    result = os.dup(1)
    os.dup2(2, 1)
    stop = threading.Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: stop.set())
    order = _read_order()
    threading.Thread(target=_wait_for_end, args=(stop,), daemon=True).start()
    missing = ros.missing()
    if missing:
        sys.stderr.write(f"{missing}\n")
        return NO_RCLPY

    def send(data: bytes) -> None:
        # The command has ended; the input will be closed as well.
        with suppress(BrokenPipeError):
            left = memoryview(framed(data))
            while left:
                left = left[os.write(result, left) :]

    return run(order, stop, send)


def _read_order() -> str:
    """Return the first line of standard input; reads no more than was sent with it."""
    data = b""
    while _LINE not in data:
        more = os.read(0, 1 << 16)
        if not more:
            break
        data += more
    return data.decode()


def _wait_for_end(stop: threading.Event) -> None:
    # Unbuffered, because a thread that reads sys.stdin would keep the interpreter from exiting.
    with suppress(OSError):
        while os.read(0, 4096):
            pass
    stop.set()
