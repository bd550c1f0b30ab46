# SPDX-License-Identifier: Apache-2.0
"""The process that reads launch files: ``python -m multibot_rewrite.producers.launch``.

Standard input has the orders, standard output gets an answer for each. Every file is read in a fork of
this process, behind fences unless it is trusted: here nothing of a launch file runs. Without launch its
stand-in reads the files.
"""

from __future__ import annotations

import json
import os
import signal
import socket
import sys
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import nullcontext, suppress
from time import monotonic
from typing import Any

from multibot_rewrite.base.bounded import load_json
from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.sources import conversation
from multibot_rewrite.description.sources.child.frames import (
    QUESTION,
    REPORT,
    GarbageError,
    asking,
    framed,
    received,
)
from multibot_rewrite.description.sources.child.seccomp import die_with_parent
from multibot_rewrite.producers.launch.confined import (
    NOT_FENCED,
    NotFencedError,
    Relay,
    confine,
    relayed,
)
from multibot_rewrite.producers.launch.door import is_there
from multibot_rewrite.producers.launch.read import UnreadableError, read_graph
from multibot_rewrite.producers.launch.records import LaunchGraph, LaunchOrder, graph_of, orders_of
from multibot_rewrite.producers.launch.source_packages import SOURCES, link_sources, packages_for
from multibot_rewrite.producers.launch.stand_in import is_stood_in, standing_in

NO_LAUNCH = (
    "launch is not installed here, and its stand-in does not know all of it: source ROS 2 "
    "(. /opt/ros/jazzy/setup.bash), or give a system_model.yaml of play_launch"
)
# All files together have the time of so many.
_MOST_FILES = 2
# How long each frame may be.
_LONGEST: Mapping[bytes, int] = {QUESTION: 2**24, REPORT: 2**28}


def main() -> None:
    """Read the orders, write the answers: a graph, or why there is none."""
    seconds, orders = orders_of(sys.stdin.read())
    linked: dict[object, str] = {}
    answers: list[object] = []
    within: set[str] = set()
    left = _MOST_FILES * seconds
    with standing_in() if not is_there() else nullcontext():
        for at, order in enumerate(orders):
            if os.path.realpath(order.file) in within:
                answers.append({"graph": LaunchGraph()})
                continue
            if left <= 0:
                answers.append({"error": "those before it took too long"})
                continue
            folder = os.path.join(tempfile.gettempdir(), f"{at}")
            os.mkdir(folder)
            same = frozenset(packages_for(order.file, order.roots).items())
            first = linked.setdefault(same, folder)
            if first == folder:
                link_sources(order.file, order.roots, folder)
            else:
                os.symlink(f"{first}/{SOURCES}", f"{folder}/{SOURCES}")
            answer, spent = _answer(order, folder, first, seconds)
            answers.append(answer)
            left -= spent
            if order.every:
                within.update(_included(answer))
    sys.stdout.write(json.dumps(answers))


def _included(answer: Any) -> Iterator[str]:
    """Yield the files that a launch file includes: what they start is known with it."""
    with suppress(InputError, ValueError, TypeError, LookupError, AttributeError):
        for it in graph_of(answer["graph"]).includes:
            yield os.path.realpath(it.file)


def _answer(order: LaunchOrder, folder: str, first: str, seconds: float) -> tuple[object, float]:
    """Return a fork's answer for one launch file, and the processor time that it took."""
    ours, theirs = socket.socketpair()
    pid = os.fork()
    if not pid:
        leave = os._exit
        try:
            ours.close()
            die_with_parent()
            _work(order, folder, first, seconds, theirs.detach())
        finally:
            leave(0)
    theirs.close()
    waited = 0.0
    try:
        answer = _listened(ours, seconds)
    except TimeoutError:
        answer, waited = {"error": f"reading it took more than {seconds:g} s; stopped"}, seconds
    except (OSError, EOFError, GarbageError, ValueError, LookupError, TypeError):
        answer = {"error": "its process ended before it was read"}
    ours.close()
    os.kill(pid, signal.SIGKILL)
    _, _, used = os.wait4(pid, 0)
    return answer, max(waited, used.ru_utime + used.ru_stime)


def _listened(ours: socket.socket, seconds: float) -> object:
    """Hand on what the fork and its xacro children tell each other, until there is a report."""
    end = monotonic() + seconds

    def read(count: int) -> bytes:
        """Return so many bytes of the child's; raises EOFError, and TimeoutError when time is over."""
        parts = bytearray()
        while len(parts) < count:
            ours.settimeout(max(end - monotonic(), 0.001))
            more = ours.recv(min(count - len(parts), 2**20))
            if not more:
                raise EOFError
            parts += more
        return bytes(parts)

    with Relay(seconds) as relay:
        while True:
            kind, data = received(read, _LONGEST)
            if kind == REPORT:
                return load_json(data)
            ours.sendall(relay.answer(*load_json(data)))


def _work(order: LaunchOrder, folder: str, first: str, seconds: float, place: int) -> None:
    """Read a launch file behind the fences, and tell the parent at the socket ``place``."""
    inbox, outbox = os.fdopen(place, "rb", closefd=False), os.fdopen(place, "wb", closefd=False)

    def send(data: bytes) -> None:
        outbox.write(data)
        outbox.flush()

    # What a launch file prints is nobody's.
    nothing = os.open(os.devnull, os.O_RDWR)
    for standard in range(3):
        os.dup2(nothing, standard)
    tempfile.tempdir = os.environ["ROS_LOG_DIR"] = folder
    stood_in = is_stood_in()
    try:
        if not order.trusted:
            found = packages_for(order.file, order.roots).values()
            confine(order, folder, [first, *found], seconds)
            vars(conversation)["child"] = relayed(asking(inbox.read, send))
        graph = read_graph(order, folder)
        answer: object = {"graph": graph._replace(stood_in=stood_in)}
    except NotFencedError:
        answer = {"error": NOT_FENCED}
    except UnreadableError as error:
        doubtful = stood_in and not error.of_file
        answer = {"error": f"{error}; {NO_LAUNCH}" if doubtful else f"{error}"}
    send(framed(REPORT, json.dumps(answer).encode()))


if __name__ == "__main__":
    main()
