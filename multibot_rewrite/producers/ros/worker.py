# SPDX-License-Identifier: Apache-2.0
"""Start, protocol and end of a child process that uses rclpy.

Its order is the first line of its standard input. It ends when that input is closed, on SIGTERM
and on Ctrl-C, and always leaves the graph cleanly: a process that is killed stays visible in the
graph for 20 s. Its messages go to standard output, each with its length before it; what libraries
print goes to standard error.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Callable
from contextlib import suppress

from multibot_rewrite.producers.ros import ros
from multibot_rewrite.producers.ros.request import NO_RCLPY, framed

Send = Callable[[bytes], None]
Worker = Callable[[str, threading.Event, Send], int]
_LINE = b"\n"


def run_worker(run: Worker) -> int:
    """Run ``run(order, stop, send)``; ``stop`` is set when it has to end. Returns the exit code."""
    result = _private_output()
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
            _write_all(result, framed(data))

    return run(order, stop, send)


def _private_output() -> int:
    """A descriptor for messages; what libraries print to standard output goes to standard error."""
    result = os.dup(1)
    os.dup2(2, 1)
    return result


def _read_order() -> str:
    """The first line of standard input; reads no more than was sent with it."""
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


def _write_all(descriptor: int, data: bytes) -> None:
    view = memoryview(data)
    while view:
        view = view[os.write(descriptor, view) :]
