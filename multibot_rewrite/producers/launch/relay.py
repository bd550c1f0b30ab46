# SPDX-License-Identifier: Apache-2.0
"""xacro files of a launch file that is read behind fences: it can start no process for them.

Its parent starts one for each, behind all fences whatever was asked for, and hands on the bytes that
the two tell each other. It looks at no file itself.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, ExitStack, contextmanager

from multibot_rewrite.base.bounded import load_json
from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.sources.child.frames import (
    FENCES,
    HEAD,
    REFUSAL,
    REQUEST,
    VALUE,
    Ask,
    GarbageError,
    RefusedError,
    framed,
)
from multibot_rewrite.description.sources.processes import XacroChild, child

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
        """The frame for a question; raises GarbageError for what is none."""
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
        if self.child is None:
            raise GarbageError
        return self.child

    def _start(self, _: str) -> bytes:
        self.children.close()
        self.child = self.children.enter_context(child(self.seconds))
        self.asked = False
        return b""

    def _send(self, data: str) -> bytes:
        raw = data.encode("latin-1")
        self._one().send(raw if self.asked else self._fenced(raw))
        self.asked = True
        return b""

    def _fenced(self, raw: bytes) -> bytes:
        """The request, with all fences around the child."""
        kind, length = HEAD.unpack(raw[: HEAD.size])
        if kind != REQUEST or len(raw) != HEAD.size + length:
            raise GarbageError
        request = load_json(raw[HEAD.size :])
        request |= {"fences": FENCES, "seconds": self.seconds}
        return framed(REQUEST, json.dumps(request).encode())


def relayed(ask: Ask) -> Callable[[float], AbstractContextManager[Relayed]]:
    """What stands for ``child`` of the processes of xacro where a parent is asked for it."""

    @contextmanager
    def started(_: float) -> Iterator[Relayed]:
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
        """That many bytes; raises EOFError where the child has ended."""
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
        try:
            return self.ask(what, name)
        except RefusedError:
            raise EOFError from None
