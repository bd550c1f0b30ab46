# SPDX-License-Identifier: Apache-2.0
"""Names and values as part of a sentence or a table, or each once."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

FEW, SEVERAL, SHOWN = 3, 5, 8
_LONGEST = 60


def shorten(names: Iterable[str], most: int = FEW) -> str:
    """Return the first names of a list, each once, and the number of the others, as a text."""
    unique = list(dict.fromkeys(names))
    more = f" and {len(unique) - most} more" if len(unique) > most else ""
    return ", ".join(unique[:most]) + more


def clip(text: str) -> str:
    """Return a value on one line, cut to the length that a line can show."""
    line = " ".join(text.split())
    return line if len(line) <= _LONGEST else f"{line[: _LONGEST - 1]}…"


def and_then(words: Sequence[str]) -> str:
    """Return words as a list in English: ``a``, ``a and b``, ``a, b and c``."""
    return " and ".join(filter(None, (", ".join(words[:-1]), *words[-1:])))


def unique(names: Iterable[str]) -> tuple[str, ...]:
    """Return each name once, in their order."""
    return tuple(dict.fromkeys(names))


def only(names: Sequence[str]) -> str:
    """Return the one name, empty for several or none."""
    return names[0] if len(names) == 1 else ""


def plural(count: int, word: str) -> str:
    """Return a number and a noun, in the plural unless the number is 1."""
    ending = "es" if word.endswith("s") else "s"
    return f"{count} {word}{ending * (count != 1)}"


# A value that a message repeats may be a whole file.
LONGEST = 1_000
# What ends a line or steers a terminal; what turns the direction of reading; what stands in no XML or
# UTF-8: lone surrogates are bytes of a file's name that are no UTF-8.
_STEERING = "\x00-\x08\x0b-\x1a\x1c-\x1f\x7f-\x9f\u2028\u2029"
_TURNING = "\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069"
_ODD = f"{_STEERING}{_TURNING}\ud800-\udfff\ufffe\uffff"
_IN_A_LINE = f"[{_ODD}\t\n\x1b]"
_NOT_ESCAPED = f"[\x7f-\x9f\u2028\u2029{_TURNING}]"
# Colours are ours, or do no harm.
_IN_A_TEXT = f"[{_ODD}]|\x1b(?!\\[[0-9;]*m)"


def one_line(text: str) -> str:
    """Return the text on one line, odd characters escaped as in Python, a very long one shortened."""
    if len(text) > LONGEST:
        text = f"{text[: LONGEST // 2]} … {text[-LONGEST // 2 :]}"
    if text.isprintable():
        return text  # as most are: the pattern takes longer to compile than a report to write
    return re.sub(_IN_A_LINE, _escaped_match, text)


def for_terminal(text: str) -> str:
    """Return several lines, possibly coloured, with every odd character escaped."""
    if text.replace("\n", "").isprintable():
        return text
    return re.sub(_IN_A_TEXT, _escaped_match, text)


def in_json(text: str) -> str:
    """Return a JSON text with JSON escapes for the characters that a terminal would obey."""
    return re.sub(_NOT_ESCAPED, lambda found: f"\\u{ord(found[0]):04x}", text)


def _escaped_match(found: re.Match[str]) -> str:
    return found[0].encode("unicode_escape").decode()
