# SPDX-License-Identifier: Apache-2.0
"""The parent's side of the processes that expand xacro.

A server, started once for each process and ended when it is idle, forks a child for each expansion.
"""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import threading
import weakref
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import lru_cache
from time import monotonic

from multibot_rewrite.base.child import isolated
from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.sources.child.frames import COMMAND, END, ENDED, REPLY, START

_MODULE = "multibot_rewrite.description.sources.child.serve"
# Python finds what this process finds, and nothing by the variables of the environment.
# For the start of a process that is to answer within a time.
SLACK_SECONDS = 5.0
# The libraries of an installation; without the other, wheels of rclpy would start Python twice.
_KEPT_VARIABLES = ("LD_LIBRARY_PATH", "_ROS_WHEELS_BOOTSTRAP_COMPLETE")


class ServerGoneError(Exception):
    """The server ended: it was idle, or it was killed."""


class Server:
    """The process that forks. Any thread may use it."""

    def __init__(self) -> None:
        self.control, theirs = socket.socketpair()
        self.lock = threading.Lock()
        command = isolated(_MODULE)
        kept = {it: os.environ[it] for it in _KEPT_VARIABLES if it in os.environ}
        nothing = subprocess.DEVNULL
        with theirs:
            process = subprocess.Popen(
                command, stdin=theirs.fileno(), stdout=nothing, stderr=nothing, env=kept, cwd=os.sep
            )
        self.pid = process.pid
        weakref.finalize(self, _close_and_wait, self.control, process)

    def start(self, theirs: socket.socket) -> int:
        """Start a child with that socket and return its number; raises ServerGoneError."""
        return self._send_command(START, 0, [theirs.fileno()])

    def end(self, pid: int, ended: bool) -> int:
        """End a child; return the signal that had ended it, or 0. Raises ServerGoneError."""
        return self._send_command(ENDED if ended else END, pid, [])

    def _send_command(self, command: bytes, pid: int, descriptors: list[int]) -> int:
        with self.lock:
            try:
                socket.send_fds(self.control, [COMMAND.pack(command, pid)], descriptors)
                answer = self.control.recv(REPLY.size, socket.MSG_WAITALL)
            except OSError:
                raise ServerGoneError from None
            except BaseException:
                # Interrupted: the answer to come would be taken for that of the next question.
                self.control.close()
                raise
        if len(answer) < REPLY.size:
            raise ServerGoneError
        return int(REPLY.unpack(answer)[0])


class XacroChild:
    """A process that expands one file, and the socket that leads to it."""

    def __init__(self, server: Server, pid: int, ours: socket.socket, deadline: float) -> None:
        self.server, self.pid, self.ours, self.deadline = server, pid, ours, deadline
        self.signal: int | None = None

    def send(self, data: bytes) -> None:
        """Send all of the bytes; raises OSError."""
        self.ours.settimeout(self._seconds_left())
        self.ours.sendall(data)

    def read(self, count: int) -> bytes:
        """Return that many bytes; raises EOFError if the child has ended, and TimeoutError."""
        parts = bytearray()
        while len(parts) < count:
            self.ours.settimeout(self._seconds_left())
            more = self.ours.recv(min(count - len(parts), 2**20))
            if not more:
                raise EOFError
            parts += more
        return bytes(parts)

    def _seconds_left(self) -> float:
        left = self.deadline - monotonic()
        if left <= 0:
            raise TimeoutError
        return left

    def end(self, ended: bool = False) -> int:
        """End the child; return the signal if it had ended by itself, or 0."""
        if self.signal is None:
            self.ours.close()
            self.signal = 0
            with suppress(ServerGoneError):
                self.signal = self.server.end(self.pid, ended)
        return self.signal


@contextmanager
def child(seconds: float) -> Iterator[XacroChild]:
    """Yield a child with a time limit, which ends with the block. Raises InputError."""
    ours, theirs = socket.socketpair()
    with theirs:
        server, pid = _started_child(theirs)
    found = XacroChild(server, pid, ours, monotonic() + seconds + SLACK_SECONDS)
    try:
        yield found
    finally:
        found.end()


def _started_child(theirs: socket.socket) -> tuple[Server, int]:
    for _ in range(2):
        one = server(os.getpid())
        try:
            return one, one.start(theirs)
        except ServerGoneError:
            server.cache_clear()
    why = f"{sys.executable} does not run {_MODULE}; install multibot_rewrite for it"
    raise InputError(f"xacro: no process can be started: {why}")


@lru_cache(maxsize=1)
def server(pid: int) -> Server:
    """Return the server of this process, which is started; a fork of it gets its own."""
    return Server()


def _close_and_wait(control: socket.socket, process: subprocess.Popen[bytes]) -> None:
    control.close()
    process.terminate()
    process.wait()
