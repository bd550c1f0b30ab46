# SPDX-License-Identifier: Apache-2.0
"""The frames that a child and its parent exchange: a letter, a length, and that many bytes.

A child asks for files, packages or variables (QUESTION), one at a time, and gets a VALUE or a
REFUSAL. Its result is a REPORT, and for an expansion the TEXT, and the numbers of ORIGINS, CALLS
and PIECES."""

from __future__ import annotations

import io
import json
import struct
from collections.abc import Callable, Mapping
from types import SimpleNamespace
from typing import Any

HEAD = struct.Struct(">cI")
REQUEST, VALUE, REFUSAL = b"R", b"V", b"X"
QUESTION, REPORT, TEXT, ORIGINS, CALLS, PIECES = b"Q", b"J", b"T", b"O", b"C", b"P"
# What a child may ask for.
READ, GLOB, FIND, ENVIRONMENT = "read", "glob", "find", "env"
# The fences around a child.
LIMITS, LANDLOCK, SECCOMP, AUDIT = "limits", "landlock", "seccomp", "audit"
# In this order: the later ones refuse what the earlier ones need.
FENCES = (LANDLOCK, LIMITS, SECCOMP, AUDIT)
KERNEL = frozenset((LANDLOCK, SECCOMP))
# How long each frame of a child may be; a larger one is a lie.
MOST_TEXT = 16 * 2**20
LONGEST: Mapping[bytes, int] = {
    QUESTION: 2**16,
    REPORT: 2**20,
    TEXT: MOST_TEXT,
    ORIGINS: 2**25,
    CALLS: 2**25,
    PIECES: 2**27,
}
# The signed integers of ORIGINS, CALLS and PIECES.
NUMBER = "i"
# A letter and the number of a process; the answer is such a number, or that of a signal.
COMMAND, REPLY = struct.Struct(">ci"), struct.Struct(">i")
START, END, ENDED = b"s", b"e", b"d"


class GarbageError(Exception):
    """The received bytes are no expected frame."""


def framed(kind: bytes, data: bytes) -> bytes:
    """Return a frame as it is sent."""
    return HEAD.pack(kind, len(data)) + data


def received(read: Callable[[int], bytes], longest: Mapping[bytes, int]) -> tuple[bytes, bytes]:
    """Return the next frame; ``read`` returns as many bytes as requested. Raises GarbageError."""
    kind, length = HEAD.unpack(read(HEAD.size))
    if length > longest.get(kind, -1):
        raise GarbageError
    return kind, read(length)


Ask = Callable[[str, str], bytes]
_ANSWERS = {VALUE: 2 * MOST_TEXT, REFUSAL: MOST_TEXT}


class RefusedError(Exception):
    """The parent refused; the text is its reason."""


_ERRORS: dict[str, Callable[..., Exception]] = {
    "os": OSError,
    "lookup": LookupError,
    "refused": RefusedError,
}


def asking(read: Callable[[int], bytes], write: Callable[[bytes], object]) -> Ask:
    """Return the function that asks the parent; it raises the parent's error."""

    def ask(what: str, name: str) -> bytes:
        """Return the parent's answer; raises the parent's error."""
        write(framed(QUESTION, json.dumps([what, str(name)]).encode()))
        kind, data = received(read, _ANSWERS)
        if kind == VALUE:
            return data
        error, *words = json.loads(data)
        raise _ERRORS[error](*words)

    return ask


def connect(xacro: Any, substitution: Any, ask: Ask) -> None:
    """Let the parent answer what xacro opens, looks for and reads of the environment from now on."""

    def opened(name: str, *_: object, **__: object) -> io.TextIOBase:
        """Return the text file that the parent reads."""
        return io.TextIOWrapper(io.BytesIO(ask(READ, name)), "utf-8")

    xacro.open = opened
    xacro.glob = SimpleNamespace(glob=lambda pattern: json.loads(ask(GLOB, pattern)))
    # Relative names stay relative: the parent knows the folder.
    xacro.root_dir = ""
    ways = {
        "find": lambda package: ask(FIND, package).decode(),
        "env": _known(substitution._eval_env, ask),
        "optenv": _known(substitution._eval_optenv, ask),
    }
    for name, way in ways.items():
        setattr(substitution, f"_eval_{name}", way)
    substitution._eval_dict.update(ways)


def _known(look_up: Callable[..., str], ask: Ask) -> Callable[..., str]:
    """Return a function that asks the parent for a variable, or else calls ``look_up``."""

    def known(name: str, *more: str, **named: str) -> str:
        found = json.loads(ask(ENVIRONMENT, name))
        # A child has no variables: this one raises, or takes the default.
        return look_up(name, *more, **named) if found is None else str(found)

    return known
