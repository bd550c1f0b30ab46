# SPDX-License-Identifier: Apache-2.0
"""Talks with a child that expands a file: answers its questions, checks its result."""

from __future__ import annotations

import json
import os
import signal
import struct
from array import array
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from multibot_rewrite.base.bounded import MAX_BYTES, load_json
from multibot_rewrite.base.model import XACRO_FAILED, InputError
from multibot_rewrite.base.outside import real_path, unrepeatable
from multibot_rewrite.description.sources.access import Access, NotAllowedError
from multibot_rewrite.description.sources.child import frames
from multibot_rewrite.description.sources.processes import XacroChild, child

# What a child may ask, and read in all.
MOST_QUESTIONS, MOST_READ = 20_000, 16 * MAX_BYTES
_TRIPLE, _QUADRUPLE, _EIGHT = 3, 4, 8
# What reading an answer raises that is not what was agreed on.
_GARBAGE = (
    frames.GarbageError, ValueError, LookupError, TypeError, AttributeError, OverflowError,
    RecursionError, struct.error,
)  # fmt: skip


class Failure(NamedTuple):
    """Why there is no text: reason, file, line and column or numbers of the place, macro call."""

    reason: str
    file: str
    position: tuple[int, int] | None
    place: tuple[int, int, str] | None
    call: int


class Result(NamedTuple):
    """What a child reported, not trusted: its fences, names and element counts of ``files``.

    ``origins`` and ``calls`` are as in ``marks``, ``pieces`` and ``words`` as in
    ``child/pieces.py``."""

    notes: str
    fences: tuple[str, ...]
    files: tuple[tuple[str, int], ...]
    macros: tuple[str, ...]
    failure: Failure | None
    root: tuple[str, str]
    text: bytes
    origins: array[int]
    calls: array[int]
    pieces: array[int]
    words: tuple[str, ...]


class Sources:
    """The files read for one expansion, by the name asked for; ``changed`` by their real paths."""

    def __init__(
        self,
        access: Access,
        at_hand: Mapping[str, bytes],
        changed: Mapping[str, bytes] = MappingProxyType({}),
    ) -> None:
        self.access, self.texts, self.changed = access, dict(at_hand), changed
        self.left = MOST_READ

    def read(self, name: str) -> bytes:
        """Return a file's bytes, always the first read; raises NotAllowedError and OSError."""
        if name not in self.texts:
            path = self.access.readable(name)
            other = self.changed.get(real_path(path)) if self.changed else None
            data = self.access.read(name) if other is None else other
            if len(data) > MAX_BYTES:
                raise NotAllowedError(f"{name} is over the limit of {MAX_BYTES // 2**20} MB")
            self.texts[name] = data
        self.left -= len(self.texts[name])
        if self.left < 0 and not self.access.reach.trust:
            raise NotAllowedError(f"{name}: too much is included")
        return self.texts[name]


def converse(
    arguments: Mapping[str, str], sources: Sources, traced: bool, in_pieces: bool = False
) -> Result:
    """Let a child expand the file of ``sources.access``; raises InputError if it fails."""
    access = sources.access
    reach = access.reach
    if reach.trust:
        unrepeatable()  # it may look at anything
    seconds = reach.seconds
    request = {
        "path": access.path,
        "arguments": dict(arguments),
        "traced": traced,
        "in_pieces": in_pieces,
        "folder": os.getcwd(),
        "fences": () if reach.trust else reach.fences,
        "seconds": seconds,
    }
    with child(seconds) as it:
        try:
            it.send(frames.framed(frames.REQUEST, json.dumps(request).encode()))
            return _result(it, _answered(it, sources))
        except TimeoutError:
            raise InputError(_ended(access.path, signal.SIGALRM, seconds), XACRO_FAILED) from None
        except (EOFError, ConnectionError):
            why = _ended(access.path, it.end(ended=True), seconds)
            raise InputError(why, XACRO_FAILED) from None
        except _GARBAGE:
            said = (
                "its process sent no valid answer; remove Python in ${} that changes how it works"
            )
            raise InputError(f"{access.path}: xacro failed: {said}", XACRO_FAILED) from None


def _answered(it: XacroChild, sources: Sources) -> bytes:
    """Answer a child's questions, and return its report."""
    for _ in range(MOST_QUESTIONS):
        kind, data = frames.received(it.read, frames.LONGEST)
        if kind == frames.REPORT:
            return data
        if kind != frames.QUESTION:
            break
        it.send(_answer_to(data, sources))
    raise frames.GarbageError


def _answer_to(data: bytes, sources: Sources) -> bytes:
    """Return the frame that answers a child's question, or tells it the error."""
    what, name = load_json(data)
    access = sources.access
    ways: Mapping[str, Callable[[str], bytes]] = {
        frames.READ: sources.read,
        frames.GLOB: lambda pattern: json.dumps(access.matching(pattern)).encode(),
        frames.FIND: lambda package: os.fsencode(access.package(package)),
        frames.ENVIRONMENT: lambda variable: json.dumps(access.variable(variable)).encode(),
    }
    try:
        return frames.framed(frames.VALUE, ways[what](_to_text(name)))
    except NotAllowedError as error:
        said: list[object] = ["refused", str(error)]
    except OSError as error:
        said = ["os", error.errno or 0, error.strerror or str(error), name]
    except LookupError as error:
        said = ["lookup", str(error.args[0])]
    except ValueError as error:
        said = ["refused", f"{name!r}: {error}"]
    return frames.framed(frames.REFUSAL, json.dumps(said).encode())


def _result(it: XacroChild, data: bytes) -> Result:
    """Return the rest of a child's answer; raises the errors that converse catches."""
    report = load_json(data)
    if "missing" in report:
        raise InputError(f"{_to_text(report['missing'])}; pip install xacro, or source ROS 2")
    failed = report.get("error")
    text = b"" if failed else _next_frame(it, frames.TEXT)
    origins = b"" if failed else _next_frame(it, frames.ORIGINS)
    return Result(
        _to_text(report["notes"]),
        tuple(_to_text(name) for name in report["fences"]),
        tuple((_to_text(name), int(count)) for name, count in report["files"]),
        tuple(_to_text(name) for name in report["macros"]),
        _parsed_failure(failed) if failed else None,
        ("", "") if failed else (_to_text(report["root"][0] or ""), _to_text(report["root"][1])),
        text,
        _checked_numbers(origins, _TRIPLE),
        _checked_numbers(_next_frame(it, frames.CALLS), _QUADRUPLE),
        _checked_numbers(_next_frame(it, frames.PIECES), _EIGHT),
        tuple(_to_text(word) for word in report["words"]),
    )


def _next_frame(it: XacroChild, kind: bytes) -> bytes:
    return frames.received(it.read, {kind: frames.LONGEST[kind]})[1]


def _parsed_failure(told: Any) -> Failure:
    position, place = told["position"], told["place"]
    return Failure(
        _to_text(told["reason"]),
        _to_text(told["file"]),
        (int(position[0]), int(position[1])) if position else None,
        (int(place[0]), int(place[1]), _to_text(place[2])) if place else None,
        int(told["call"]),
    )


def _to_text(value: object) -> str:
    if not isinstance(value, str):
        raise frames.GarbageError
    return value


def _checked_numbers(data: bytes, together: int) -> array[int]:
    """Return the numbers in a frame; raises GarbageError unless they are ``together`` at a time."""
    found = array(frames.NUMBER)
    found.frombytes(data)
    if len(found) % together:
        raise frames.GarbageError
    return found


def _ended(path: str, died_of: int, seconds: float) -> str:
    """Return the message for a child that gave no answer."""
    unrepeatable()
    if died_of in (signal.SIGALRM, signal.SIGXCPU):
        why = f"it took more than {seconds:g} s; does a macro call itself? --trust lifts the limit"
    elif died_of:
        why = f"its process was ended by {signal.Signals(died_of).name}"
    else:
        why = "its process ended before it was done"
    return f"{path}: xacro failed: {why}"
