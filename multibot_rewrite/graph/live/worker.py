"""The manners of a process that speaks to the graph for a command: how it is told, how it ends.

Its order is the first line of its standard input. It ends when that input is closed, on SIGTERM
and on Ctrl-C, and always leaves the graph cleanly: what is killed stays in everybody's view for
20 s. What it tells goes to standard output as messages with their length before them; what
libraries print goes to standard error.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Callable
from contextlib import suppress

from multibot_rewrite.graph.live import ros
from multibot_rewrite.graph.live.request import NO_RCLPY, framed

Tell = Callable[[bytes], None]
Work = Callable[[str, threading.Event, Tell], int]
_LINE = b"\n"


def work(run: Work) -> int:
    """Run ``run(order, stop, tell)``; ``stop`` is set when it has to end. Returns the exit code."""
    result = _own_standard_output()
    stop = threading.Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: stop.set())
    order = _order()
    threading.Thread(target=_wait_for_end, args=(stop,), daemon=True).start()
    missing = ros.missing()
    if missing:
        sys.stderr.write(f"{missing}\n")
        return NO_RCLPY

    def tell(data: bytes) -> None:
        # Whoever listened is gone, and the input will be closed, too.
        with suppress(BrokenPipeError):
            _write_all(result, framed(data))

    return run(order, stop, tell)


def _own_standard_output() -> int:
    """A descriptor nobody else writes to."""
    result = os.dup(1)
    os.dup2(2, 1)
    return result


def _order() -> str:
    """The first line of standard input, read without taking more than was sent at once."""
    data = b""
    while _LINE not in data:
        more = os.read(0, 1 << 16)
        if not more:
            break
        data += more
    return data.decode()


def _wait_for_end(stop: threading.Event) -> None:
    # Unbuffered, because a thread inside sys.stdin would block the interpreter's end.
    with suppress(OSError):
        while os.read(0, 4096):
            pass
    stop.set()


def _write_all(descriptor: int, data: bytes) -> None:
    view = memoryview(data)
    while view:
        view = view[os.write(descriptor, view) :]
