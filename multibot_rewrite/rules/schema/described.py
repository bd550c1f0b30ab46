# SPDX-License-Identifier: Apache-2.0
"""Rows of ``sdf.schema``: read when the first description needs them, by section.

It is made from the sources by ``tools.interfaces``; its first lines have its grammar.
"""

import os
from collections.abc import Mapping
from functools import lru_cache
from typing import NamedTuple

from multibot_rewrite.base.lazy import lazy_compile

WORDS = "words"
_VERSION = lazy_compile(r"\d+\.\d+")


class SdfRow(NamedTuple):
    """What SDF says of an attribute or element.

    ``line`` is where, ``section`` has what is below it. The value is ``low`` to ``high``. It is read
    by the versions of SDF from ``first`` to ``last``.
    """

    name: str
    type: str
    line: str
    section: str = ""
    first: tuple[int, ...] = ()
    last: tuple[int, ...] = ()
    required: bool = False
    low: float | None = None
    high: float | None = None


class SdfPart(NamedTuple):
    """A section: its name, the words behind it, its rows by name, the names that are required."""

    name: str
    words: tuple[str, ...]
    rows: Mapping[str, tuple[SdfRow, ...]]
    needed: tuple[str, ...]


@lru_cache
def chunks() -> Mapping[str, str]:
    """Return the unparsed text of every section by each of its names."""
    found: dict[str, str] = {}
    _, *parts = table_text("sdf.schema").split("\n[")
    for part in parts:
        first, *rest = part[: part.index("]")].split()
        for name in [f"{WORDS} {it}" for it in rest] or [first]:
            found[name] = part
    return found


@lru_cache(maxsize=512)
def described(name: str) -> SdfPart | None:
    """Return the section of that name, parsed; None without one."""
    text = chunks().get(name)
    if text is None:
        return None
    head, *lines = text.splitlines()
    rows: dict[str, tuple[SdfRow, ...]] = {}
    for words in filter(None, (line.partition(" =")[0].split() for line in lines)):
        tag, type_, *rest = words
        row = SdfRow(tag, type_, rest[0] if rest else type_)
        for word in rest[1:]:
            row = _with_word(row, word)
        rows[tag] = (*rows.get(tag, ()), row)
    needed = tuple(it for it, its in rows.items() if any(row.required for row in its))
    return SdfPart(name, tuple(head.partition("]")[2].split()), rows, needed)


def _with_word(row: SdfRow, word: str) -> SdfRow:
    """Return a row with what one word of its line says: a section, a range of numbers or versions."""
    if word[0] == ">":
        return row._replace(section=word[1:])
    if word == "required":
        return row._replace(required=True)
    low, dots, high = word.partition("..")
    if dots:
        return row._replace(low=float(low) if low else None, high=float(high) if high else None)
    first, dash, last = word.partition("-")
    if dash and _VERSION.fullmatch(first):
        return row._replace(first=_version(first), last=_version(last))
    return row


def _version(text: str) -> tuple[int, ...]:
    return tuple(map(int, text.split(".")))


_FOLDER = os.path.dirname(__file__)


def table_text(file: str) -> str:
    """Return the text of a table; ``pathlib`` would be loaded for it alone."""
    with open(os.path.join(_FOLDER, file), encoding="utf-8") as table:
        return table.read()
