# SPDX-License-Identifier: Apache-2.0
"""Regular expressions of a file, as ``std::regex`` reads them (ECMAScript, bytes, libstdc++).

Python's ``re`` tries one way after another, and for ``(a+)+b`` there are too many. Here all ways are
followed at once (K. Thompson, 1968), so a name takes as long as it has letters.
"""

from __future__ import annotations

import re
import string
from collections import deque
from collections.abc import Callable, Container, Iterable, Iterator
from typing import TypeAlias

from multibot_rewrite.base.lazy import lazy_compile

# What a top-level "|" must not be looked for in, is one piece; a class without an end goes to the end.
_CLASS = r"\[(?:\\.|\[:\w+:\]|[^\]\\[]|\[(?!:\w+:\]))*"
_PIECES = lazy_compile(
    rf"\\(?:x[0-9a-fA-F]{{2}}|u00[0-9a-fA-F]{{2}}|.)|{_CLASS}\]?|\{{\d+(?:,\d*)?\}}|\(\?:|.",
    re.DOTALL,
)
_WHOLE_CLASS = lazy_compile(rf"{_CLASS}\]", re.DOTALL)
_IN_CLASS = lazy_compile(r"\\(?:x[0-9a-fA-F]{2}|u00[0-9a-fA-F]{2}|.)|\[:\w+:\]|.", re.DOTALL)
_LENGTH, _STATES, _DEPTH = 500, 2_000, 30
_ALL = frozenset(map(chr, range(256)))
_LETTERS, _DIGITS = frozenset(string.ascii_letters), frozenset(string.digits)
_WORD, _SPACE = _LETTERS | _DIGITS | {"_"}, frozenset(string.whitespace)
_POSIX = {
    "alpha": _LETTERS,
    "digit": _DIGITS,
    "d": _DIGITS,
    "alnum": _LETTERS | _DIGITS,
    "lower": frozenset(string.ascii_lowercase),
    "upper": frozenset(string.ascii_uppercase),
    "punct": frozenset(string.punctuation),
    "xdigit": frozenset(string.hexdigits),
    "space": _SPACE,
    "s": _SPACE,
    "blank": frozenset(" \t"),
    "w": _WORD,
}
_ESCAPED = {"d": _DIGITS, "w": _WORD, "s": _SPACE}
_CONTROL = {"n": "\n", "t": "\t", "r": "\r", "f": "\f", "v": "\v", "0": "\0"}
# Back references, edges of words, control characters, numbers without digits.
_ELSEWHERE = frozenset("123456789bBcxu")
_REPEATS = {"*": (0, None), "+": (1, None), "?": (0, 1)}
_BEGIN, _END = "^", "$"

# The characters that lead on, or the place that must be here, or None; and the states behind.
_State: TypeAlias = "tuple[frozenset[str] | str | None, tuple[int, ...]]"
# Adds the states of a piece before a state; the first of them.
_Piece: TypeAlias = "Callable[[list[_State], int], int]"


class PatternError(ValueError):
    """Not a pattern, or more than is checked: back references, assertions, great size."""


def pieces_of(pattern: str) -> Iterator[re.Match[str]]:
    """Return the characters, escapes, classes and counts of a pattern."""
    return _PIECES.finditer(pattern)


class Pattern:
    """A pattern for whole names. What is found out for one name serves the next."""

    def __init__(self, pattern: str) -> None:
        """Read the pattern; raises PatternError."""
        if len(pattern) > _LENGTH:
            raise PatternError(f"longer than {_LENGTH} characters")
        pieces = deque(piece[0] for piece in pieces_of(_bytes(pattern)))
        self._states: list[_State] = [(None, ())]
        first = _parse_alternatives(pieces, 0)(self._states, 0)
        if pieces:
            raise PatternError("a bracket is not opened")
        self._first = self._reached((first,), {_BEGIN})
        self._alone = self._reached((first,), {_BEGIN, _END})
        self._steps: dict[tuple[frozenset[int], str], frozenset[int]] = {}

    def matches(self, name: str) -> bool:
        """Return whether the whole name is one of the pattern's."""
        if not name:
            return 0 in self._alone
        here = self._first
        for character in _bytes(name):
            step = here, character
            if step not in self._steps:
                states = (self._states[at] for at in here)
                led = (behind for over, behind in states if over is not None and character in over)
                self._steps[step] = self._reached({at for behind in led for at in behind}, set())
            here = self._steps[step]
            if not here:
                return False
        return 0 in self._reached(here, {_END})

    def _reached(self, states: Iterable[int], places: Container[str]) -> frozenset[int]:
        """Return these states and all that follow without reading a character."""
        found = set(states)
        waiting = list(found)
        while waiting:
            over, behind = self._states[waiting.pop()]
            if over is None or over in places:
                new = set(behind) - found
                found |= new
                waiting += new
        return frozenset(found)


def _bytes(text: str) -> str:
    """Return the bytes of a text, as characters: ``std::regex`` knows no others."""
    return text.encode("utf-8", "surrogateescape").decode("latin-1")


def _parse_alternatives(pieces: deque[str], depth: int) -> _Piece:
    if depth > _DEPTH:
        raise PatternError(f"nested deeper than {_DEPTH} levels")
    ways = [_parse_sequence(pieces, depth)]
    while pieces and pieces[0] == "|":
        pieces.popleft()
        ways.append(_parse_sequence(pieces, depth))
    return lambda states, after: _add_state(states, None, *(way(states, after) for way in ways))


def _parse_sequence(pieces: deque[str], depth: int) -> _Piece:
    row: list[_Piece] = []
    while pieces and pieces[0] not in "|)":
        piece = _parse_atom(pieces.popleft(), pieces, depth)
        while pieces and _is_count(pieces[0]):
            piece = _repeated(piece, *_least_and_most(pieces.popleft()))
            # As few as possible: the same names.
            if pieces and pieces[0] == "?":
                pieces.popleft()
        row.append(piece)

    def add(states: list[_State], after: int) -> int:
        for piece in reversed(row):
            after = piece(states, after)
        return after

    return add


def _parse_atom(piece: str, pieces: deque[str], depth: int) -> _Piece:
    """Return a function that adds the states for a character, class, anchor or group."""
    if piece in ("(", "(?:"):
        inner = _parse_alternatives(pieces, depth + 1)
        if not pieces:
            raise PatternError("a bracket is not closed")
        pieces.popleft()
        return inner
    if piece in (_BEGIN, _END):
        if pieces and _is_count(pieces[0]):
            raise PatternError(f"{piece} cannot be repeated")
        return lambda states, after: _add_state(states, piece, after)
    if _is_count(piece) or (piece[0] == "[" and not _WHOLE_CLASS.fullmatch(piece)):
        raise PatternError(f"{piece} repeats nothing, or is not closed")
    characters = _matched_characters(piece)
    return lambda states, after: _add_state(states, characters, after)


def _add_state(states: list[_State], over: frozenset[str] | str | None, *behind: int) -> int:
    """Add a state that leads over a character to those ``behind``; return its number."""
    if len(states) > _STATES:
        raise PatternError("too much is repeated")
    states.append((over, behind))
    return len(states) - 1


def _is_count(piece: str) -> bool:
    return piece in _REPEATS or piece[0] == "{"


def _least_and_most(count: str) -> tuple[int, int | None]:
    if count in _REPEATS:
        return _REPEATS[count]
    least, comma, most = count[1:-1].partition(",")
    if len(count) == 1 or len(least) > len(str(_STATES)) or len(most) > len(str(_STATES)):
        raise PatternError(f"{count} is no count")
    return int(least), int(most or least) if most or not comma else None


def _repeated(piece: _Piece, least: int, most: int | None) -> _Piece:
    """Return a piece that is repeated so often."""
    if most is not None and most < least:
        raise PatternError(f"{{{least},{most}}} is no count")

    def add(states: list[_State], after: int) -> int:
        start = after
        if most is None:
            start = _add_state(states, None)
            states[start] = None, (piece(states, start), after)
        for _ in range(0 if most is None else most - least):
            start = _add_state(states, None, piece(states, start), after)
        for _ in range(least):
            start = _add_state(states, None, piece(states, start))
        return start

    return add


def _matched_characters(piece: str) -> frozenset[str]:
    if piece == ".":
        return _ALL - {"\n", "\r"}
    if piece[0] == "[":
        inner = piece[1:-1]
        return _ALL - _class_characters(inner[1:]) if inner[:1] == "^" else _class_characters(inner)
    return _escaped_letters(piece[1:]) if piece[0] == "\\" else frozenset(piece)


def _escaped_letters(letter: str) -> frozenset[str]:
    if letter.lower() in _ESCAPED:
        known = _ESCAPED[letter.lower()]
        return known if letter.islower() else _ALL - known
    if letter in _CONTROL:
        return frozenset(_CONTROL[letter])
    if len(letter) > 1:
        return frozenset(chr(int(letter[1:], 16)))
    if not letter or letter in _ELSEWHERE:
        raise PatternError(f"\\{letter} is incomplete, or depends on the text around it")
    return frozenset(letter)


def _class_characters(inner: str) -> frozenset[str]:
    found: set[str] = set()
    pieces = deque(piece[0] for piece in _IN_CLASS.finditer(inner))
    while pieces:
        first = _member_characters(pieces.popleft())
        if len(pieces) < 2 or pieces[0] != "-":
            found |= first
            continue
        pieces.popleft()
        last = _member_characters(pieces.popleft())
        if len(first) != 1 or len(last) != 1 or min(first) > min(last):
            raise PatternError("a range of characters has no end")
        found.update(map(chr, range(ord(min(first)), ord(min(last)) + 1)))
    return frozenset(found)


def _member_characters(piece: str) -> frozenset[str]:
    if not piece.startswith("[:"):
        return _escaped_letters(piece[1:]) if piece[0] == "\\" else frozenset(piece)
    if piece[2:-2] not in _POSIX:
        raise PatternError(f"{piece} is no class of characters")
    return _POSIX[piece[2:-2]]
