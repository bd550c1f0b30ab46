# SPDX-License-Identifier: Apache-2.0
"""The frames that a child and its parent send each other: a letter, a length, and that many bytes.

A child asks for what it needs (QUESTION), one thing at a time, and gets a VALUE or a REFUSAL. Its
result is a REPORT, and for an expansion the TEXT, and the numbers of ORIGINS, CALLS and PIECES.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Mapping

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
    """What came is no frame that was agreed on."""


def framed(kind: bytes, data: bytes) -> bytes:
    """A frame as it is sent."""
    return HEAD.pack(kind, len(data)) + data


def received(read: Callable[[int], bytes], longest: Mapping[bytes, int]) -> tuple[bytes, bytes]:
    """The next frame; ``read`` gives as many bytes as it is asked for. Raises GarbageError."""
    kind, length = HEAD.unpack(read(HEAD.size))
    if length > longest.get(kind, -1):
        raise GarbageError
    return kind, read(length)
