# SPDX-License-Identifier: Apache-2.0
"""Facts as a table: one line a fact, columns with tabs between, sorted."""

from __future__ import annotations

import lzma
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from multibot_rewrite.producers.sources.records import Place


class Fact(NamedTuple):
    """An endpoint that a node declares.

    ``way`` is ``helper`` for the listener's own node of tf2, ``private`` for a node that the class
    makes for itself; else it is empty. ``parameter`` sets the name. ``condition`` is empty for always.
    """

    node: str
    role: str
    name: str
    type: str
    way: str
    parameter: str
    condition: str
    place: Place


COLUMNS = (*Place._fields[:-1], *Fact._fields[:-1])


def read_packed(path: Path) -> str:
    """Return the text of a packed table (``xz -d`` shows it)."""
    return lzma.decompress(path.read_bytes()).decode()


def write_packed(path: Path, text: str) -> None:
    """Write the text of a table, packed."""
    path.write_bytes(lzma.compress(text.encode(), preset=9 | lzma.PRESET_EXTREME))


def to_table(facts: Iterable[Fact]) -> str:
    """Return the table's text."""
    rows = sorted({_row(fact) for fact in facts}, key=lambda it: (it[0], it[4:8], it))
    return "".join("\t".join(row) + "\n" for row in (COLUMNS, *rows))


def _row(fact: Fact) -> tuple[str, ...]:
    place = fact.place
    where = (place.repository, place.version, place.path, str(place.line))
    own = (fact.node, fact.role, fact.name, fact.type, fact.way, fact.parameter, fact.condition)
    return (*where, *own)


def from_table(text: str) -> tuple[Fact, ...]:
    """Return the facts of a table that ``to_table`` wrote."""
    return tuple(_fact(line.split("\t")) for line in text.splitlines()[1:])


def _fact(row: list[str]) -> Fact:
    repository, version, path, line, *own = row
    return Fact(*own, Place(repository, version, path, int(line)))  # type: ignore[call-arg,arg-type]
