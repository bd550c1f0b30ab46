# SPDX-License-Identifier: Apache-2.0
"""A process that forks one child for each expansion: it starts faster than a new interpreter.

It reads nothing that is not its parent's. A child gets a socket of its own, which leads to the parent.
It ends when its parent does, or when it was asked for nothing for a while.
"""

from __future__ import annotations

import json
import os
import select
import signal
import socket
import time
import warnings
from contextlib import suppress
from typing import BinaryIO

from multibot_rewrite.description.sources.child import fences, run_xacro
from multibot_rewrite.description.sources.child.frames import (
    CALLS,
    COMMAND,
    ENDED,
    MOST_TEXT,
    ORIGINS,
    PIECES,
    REPLY,
    REPORT,
    REQUEST,
    START,
    TEXT,
    asking,
    framed,
    received,
)
from multibot_rewrite.description.sources.child.run_xacro import Expanded
from multibot_rewrite.description.sources.child.seccomp import die_with_parent

IDLE_SECONDS = 10.0
MOST_LOOKS, BETWEEN_SECONDS = 250, 0.002
# What Python imports at the first use of something; behind the fences nothing is imported.
_LATE = (
    "encodings.idna", "encodings.latin_1", "encodings.utf_16", "linecache", "traceback",
    "unicodedata", "xml.dom.expatbuilder", "xml.dom.minidom", "yaml",
)  # fmt: skip


def main() -> None:
    """Serve the parent, which is at standard input."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    control = socket.socket(fileno=os.dup(0))
    nothing = os.open(os.devnull, os.O_RDWR)
    for standard in range(3):
        os.dup2(nothing, standard)
    os.close(nothing)
    warnings.simplefilter("ignore")
    for name in _LATE:
        with suppress(ImportError):
            __import__(name)
    run_xacro.missing()
    children: set[int] = set()
    while _serve_next(control, children):
        pass
    for pid in children:
        _end(pid)


def _serve_next(control: socket.socket, children: set[int]) -> bool:
    """Do what the parent asks for next; return whether there is more to come."""
    ready, _, _ = select.select([control], [], [], None if children else IDLE_SECONDS)
    if not ready:
        return False
    message, sent, _, _ = socket.recv_fds(control, COMMAND.size, 1)
    if len(message) < COMMAND.size:
        return False
    command, pid = COMMAND.unpack(message)
    if command == START:
        answer = _forked_child(control, sent[0])
        children.add(answer)
    else:
        answer = _ended(pid) if command == ENDED else _end(pid)
        children.discard(pid)
    control.sendall(REPLY.pack(answer))
    return True


def _forked_child(control: socket.socket, descriptor: int) -> int:
    pid = os.fork()
    if not pid:
        leave = os._exit
        try:
            die_with_parent()
            control.close()
            _work(descriptor)
        finally:
            leave(0)
    os.close(descriptor)
    return pid


def _ended(pid: int) -> int:
    """Return the signal that ended a child, or 0. A child may close its socket before it ends."""
    for _ in range(MOST_LOOKS):
        ended, status = os.waitpid(pid, os.WNOHANG)
        if ended:
            return os.WTERMSIG(status) if os.WIFSIGNALED(status) else 0
        time.sleep(BETWEEN_SECONDS)
    return _end(pid)


def _end(pid: int) -> int:
    """Kill a child, wait for it and return 0."""
    os.kill(pid, signal.SIGKILL)
    os.waitpid(pid, 0)
    return 0


def _work(descriptor: int) -> None:
    """Read the order, restrict this process, do it, and send the result."""
    inbox: BinaryIO = os.fdopen(descriptor, "rb", closefd=False)
    outbox: BinaryIO = os.fdopen(descriptor, "wb", buffering=0, closefd=False)
    request = json.loads(received(inbox.read, {REQUEST: MOST_TEXT})[1])
    folder = request["folder"]
    os.getcwd = lambda: folder
    held = fences.put_up(request["fences"], request["seconds"])

    def send(data: bytes) -> None:
        view = memoryview(data)
        while view:
            view = view[outbox.write(view) :]

    if missing := run_xacro.missing():
        result = Expanded({"missing": missing})
    else:
        ways = (request["traced"], request["in_pieces"])
        ask = asking(inbox.read, send)
        result = run_xacro.expand(request["path"], request["arguments"], *ways, ask)
    send(_result_frames(result._replace(report={**result.report, "fences": held})))


def _result_frames(result: Expanded) -> bytes:
    frames = framed(REPORT, json.dumps(result.report).encode())
    if "root" in result.report:
        frames += framed(TEXT, result.text) + framed(ORIGINS, result.origins)
    return frames + framed(CALLS, result.calls) + framed(PIECES, result.pieces)


if __name__ == "__main__":
    main()
