# SPDX-License-Identifier: Apache-2.0
"""The fences around the reading of a launch file, and the files and variables that are left to it.

It may read what a xacro file of its package may, what a sourced ROS has, and what Python imports; it
writes in a folder of its own. The kernel has to hold that: what a launch file does, it does itself.
It can start no process for its xacro files. Its parent starts one for each, behind all fences whatever
was asked for, and hands on the bytes that the two tell each other. It looks at no file itself.
"""

from __future__ import annotations

import json
import os
import sys
import sysconfig
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, ExitStack, contextmanager
from typing import Any

from multibot_rewrite.base.bounded import load_json
from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.sources.access import VARIABLES, Access, Reach
from multibot_rewrite.description.sources.child.fences import Files, put_up
from multibot_rewrite.description.sources.child.frames import (
    FENCES,
    HEAD,
    KERNEL,
    LANDLOCK,
    LIMITS,
    REFUSAL,
    REQUEST,
    SECCOMP,
    VALUE,
    Ask,
    GarbageError,
    RefusedError,
    framed,
)
from multibot_rewrite.description.sources.processes import XacroChild, child
from multibot_rewrite.producers.launch.records import LaunchOrder

# What the loader of Linux reads for a library.
_LIBRARIES = ("/lib", "/lib64", "/usr/lib", "/usr/lib64", "/usr/local/lib", "/etc/ld.so.cache")
# Variables that are no secret, beside those that xacro sees.
_PLAIN = (
    "COLUMNS", "DISPLAY", "HOME", "HOSTNAME", "LANG", "LOGNAME", "PATH", "USER", "MULTIBOT_",
    "LD_LIBRARY_PATH", "LINES", "PYTHONPATH",
)  # fmt: skip
NOT_FENCED = (
    "a launch file is a program, and this system has not both Landlock and seccomp to fence it in;"
    " --trust runs it without (SECURITY.md)"
)


class NotFencedError(Exception):
    """The kernel has not the fences."""


def confine(order: LaunchOrder, folder: str, more: Sequence[str], seconds: float) -> None:
    """Fence in this process, which may write in ``folder`` and read ``more``; raises NotFencedError."""
    access = Access(order.file, Reach(order.roots), None)
    files = Files((*_readable_paths(access), *more), (folder, os.devnull))
    hidden = {it for it in os.environ if not it.startswith((*VARIABLES, *_PLAIN))}
    held = put_up((LANDLOCK, LIMITS, SECCOMP), seconds, files)
    if not KERNEL.issubset(held):
        raise NotFencedError
    for name in hidden:
        del os.environ[name]
    os.environ.__class__ = type("Environ", (type(os.environ),), {"__getitem__": _asked(hidden)})
    # A library that may start no thread would end the process.
    os.environ |= dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    # They would change files that are only read; what copies files asks for them. Nothing is done, and
    # nothing is there.
    vars(os).update(dict.fromkeys(("chmod", "utime", "listxattr"), lambda *_, **__: ()))


def _asked(hidden: set[str]) -> Callable[[Any, str], str]:
    """Return the look-up of a variable; a hidden one that is set raises PermissionError."""
    look_up = type(os.environ).__getitem__

    def asked(environ: Any, name: str) -> str:
        """Return a variable's value; raises PermissionError for a hidden one."""
        if name in hidden:
            told = "is set, but a launch file sees ROS's variables alone; give --trust"
            raise PermissionError(f"the environment variable {name!r} {told}")
        return look_up(environ, name)

    return asked


def _readable_paths(access: Access) -> Iterator[str]:
    # The files in the folder of the launch file, which may be a home.
    for folder in access.beside:
        with os.scandir(folder or os.curdir) as found:
            # A link that leads to itself is none.
            shown = (it.path for it in found if it.name[0] != ".")
            yield from filter(os.path.isfile, shown)
    yield from access.roots
    for prefix in access.sourced:
        yield prefix
        # What ``colcon build --symlink-install`` links to.
        above, _, inside = prefix.rpartition("/install")
        if above and inside[:1] in ("", "/"):
            yield from (os.path.join(above, it) for it in ("src", "build"))
    yield from sys.path
    yield from (sysconfig.get_path(it) for it in ("stdlib", "platstdlib"))
    yield from filter(None, [sys.pycache_prefix])
    yield from (*_LIBRARIES, "/dev/null", "/dev/urandom")


START, SEND, READ, END = "start", "send", "read", "end"
# Bytes that are handed on at once.
_MOST = 2**20


class Relay:
    """The parent's side: one child after the other."""

    def __init__(self, seconds: float) -> None:
        self.seconds = seconds
        self.children = ExitStack()
        self.child: XacroChild | None = None
        self.asked = False

    def __enter__(self) -> Relay:
        return self

    def __exit__(self, *_: object) -> None:
        self.children.close()

    def answer(self, what: str, name: str) -> bytes:
        """Return the frame for a question; raises GarbageError for what is none."""
        ways: Mapping[str, Callable[[str], bytes]] = {
            START: self._start,
            SEND: self._send,
            READ: lambda count: self._one().read(min(int(count), _MOST)),
            END: lambda ended: str(self._one().end(ended == "1")).encode(),
        }
        if what not in ways:
            raise GarbageError
        try:
            return framed(VALUE, ways[what](name))
        except (InputError, OSError, EOFError) as error:
            return framed(REFUSAL, json.dumps(["refused", str(error)]).encode())

    def _one(self) -> XacroChild:
        """Return the child that runs; raises GarbageError without one."""
        if self.child is None:
            raise GarbageError
        return self.child

    def _start(self, _: str) -> bytes:
        """Start a xacro child in place of the last one; return an empty answer."""
        self.children.close()
        self.child = self.children.enter_context(child(self.seconds))
        self.asked = False
        return b""

    def _send(self, data: str) -> bytes:
        """Send bytes to the child, the order with its fences; return an empty answer."""
        raw = data.encode("latin-1")
        self._one().send(raw if self.asked else self._fenced(raw))
        self.asked = True
        return b""

    def _fenced(self, raw: bytes) -> bytes:
        """Return the request with all fences around the child."""
        kind, length = HEAD.unpack(raw[: HEAD.size])
        if kind != REQUEST or len(raw) != HEAD.size + length:
            raise GarbageError
        request = load_json(raw[HEAD.size :])
        request |= {"fences": FENCES, "seconds": self.seconds}
        return framed(REQUEST, json.dumps(request).encode())


def relayed(ask: Ask) -> Callable[[float], AbstractContextManager[Relayed]]:
    """Return what replaces ``child`` of the xacro processes where a parent is asked for it."""

    @contextmanager
    def started(_: float) -> Iterator[Relayed]:
        """Yield a child that the parent runs; raises InputError if it refuses."""
        try:
            ask(START, "")
        except RefusedError as error:
            raise InputError(str(error)) from None
        found = Relayed(ask)
        try:
            yield found
        finally:
            found.end()

    return started


class Relayed:
    """A child that the parent has started; it is used like an ``XacroChild``."""

    def __init__(self, ask: Ask) -> None:
        self.ask = ask
        self.signal: int | None = None

    def send(self, data: bytes) -> None:
        """Send all of it; raises EOFError where the child has ended."""
        for at in range(0, len(data), _MOST):
            self._asked(SEND, data[at : at + _MOST].decode("latin-1"))

    def read(self, count: int) -> bytes:
        """Return that many bytes; raises EOFError where the child has ended."""
        parts = bytearray()
        while len(parts) < count:
            parts += self._asked(READ, str(min(count - len(parts), _MOST)))
        return bytes(parts)

    def end(self, ended: bool = False) -> int:
        """End it; the signal if it had ended by itself, or 0."""
        if self.signal is None:
            self.signal = int(self._asked(END, "1" if ended else ""))
        return self.signal

    def _asked(self, what: str, name: str) -> bytes:
        """Return the parent's answer; raises EOFError if it refuses."""
        try:
            return self.ask(what, name)
        except RefusedError:
            raise EOFError from None
