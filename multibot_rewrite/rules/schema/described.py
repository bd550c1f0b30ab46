"""Rows of ``sdf.schema``, ``plugins.schema`` and ``units.schema``: read when the first description
needs them, by section.

The first two are made from sources by ``tools.interfaces``; the first lines of each have its
grammar.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.rules.schema.tables import table_text

SDF, PLUGINS, UNITS = "sdf.schema", "plugins.schema", "units.schema"
KINDS = ("words", "hardware", "ros1")
NO_WORDS: tuple[str, ...] = ()
_VERSION = lazy_compile(r"\d+\.\d+")


class Row(NamedTuple):
    """What a source says of an attribute, element or parameter.

    ``place`` is where, ``section`` has what is below it. The value is ``low`` to ``high``, or one of
    ``words``. It is read by the versions of SDF from ``first`` to ``last``, or in ``releases``, where
    those are not all. In ``units.schema`` the type is a unit, and above ``low`` is meant where it
    ``is_open``.
    """

    name: str
    type: str
    place: str
    section: str = ""
    first: tuple[int, ...] = ()
    last: tuple[int, ...] = ()
    releases: str = ""
    required: bool = False
    low: float | None = None
    high: float | None = None
    is_open: bool = False
    words: tuple[str, ...] = NO_WORDS
    default: str = ""


class Described(NamedTuple):
    """A section: its kind, if a word stands before its names, its names, the words behind them, its
    rows by name, the names that are required.

    ``a/b`` is a row of what is in ``a``: ``blocks`` has the names that are read in each such ``a``, at
    "" those of the section itself, and ``blocks_of`` where each name is read.
    """

    kind: str
    names: tuple[str, ...]
    about: tuple[str, ...]
    rows: Mapping[str, tuple[Row, ...]]
    needed: tuple[str, ...]
    blocks: Mapping[str, tuple[str, ...]]
    blocks_of: Mapping[str, tuple[str, ...]]


@lru_cache
def chunks(file: str) -> Mapping[str, str]:
    """The text of every section of a file by each of its names; nothing is read of it yet."""
    found: dict[str, str] = {}
    _, *parts = table_text(file).split("\n[")
    for part in parts:
        head = part[: part.index("]")]
        kind, _, rest = head.partition(" ")
        names = [f"{kind} {it}" for it in rest.split()] if kind in KINDS else None
        for name in names or head.split():
            found[name] = part
    return found


@lru_cache(maxsize=512)
def described(file: str, name: str) -> Described | None:
    """The section of that name."""
    text = chunks(file).get(name)
    if text is None:
        return None
    head, *lines = text.splitlines()
    names, _, about = head.partition("]")
    rows: dict[str, tuple[Row, ...]] = {}
    for row in _rows(lines):
        rows[row.name] = (*rows.get(row.name, ()), row)
    for word in about.split():
        shared = described(file, word[1:]) if word[0] == "+" else None
        rows = {**shared.rows, **rows} if shared else rows
    kind, _, rest = names.partition(" ")
    kind, names = (kind, rest) if kind in KINDS else ("", names)
    needed = tuple(name for name, its in rows.items() if any(it.required for it in its))
    own, rest_of = tuple(names.split()), tuple(about.split())
    return Described(kind, own, rest_of, rows, needed, *_nested(rows))


def _nested(rows: Iterable[str]) -> tuple[dict[str, tuple[str, ...]], dict[str, tuple[str, ...]]]:
    """Names by the block that they are read in, and blocks by name."""
    blocks: dict[str, tuple[str, ...]] = {"": ()}
    blocks_of: dict[str, tuple[str, ...]] = {}
    for it in rows:
        above, _, name = it.rpartition("/")
        blocks_of[name] = (*blocks_of.get(name, ()), above)
        blocks[above] = (*blocks.get(above, ()), name)
    return blocks, blocks_of


def _rows(lines: list[str]) -> Iterator[Row]:
    for line in lines:
        words, _, default = line.partition(" =")
        if not words:
            continue
        name, type_, *rest = words.split()
        row = Row(name, type_, rest[0] if rest else type_, default=default)
        for word in rest[1:]:
            row = _with(row, word)
        yield row


def _with(row: Row, word: str) -> Row:
    """A row with what one word behind its place says."""
    if word[0] == ">":
        return row._replace(section=word[1:])
    if word.startswith("one:"):
        return row._replace(words=tuple(word[4:].split("|")))
    if word.startswith("releases="):
        return row._replace(releases=word[9:])
    if word in ("above:0", "from:0"):
        return row._replace(low=0.0, is_open=word == "above:0")
    return row._replace(required=True) if word == "required" else _bounded(row, word)


def _bounded(row: Row, word: str) -> Row:
    """A range of numbers or of versions; else it is the tag of a row that the newest one lacks."""
    low, dots, high = word.partition("..")
    if dots:
        return row._replace(low=float(low) if low else None, high=float(high) if high else None)
    first, dash, last = word.partition("-")
    if dash and _VERSION.fullmatch(first):
        return row._replace(first=_version(first), last=_version(last))
    return row


def _version(text: str) -> tuple[int, ...]:
    return tuple(map(int, text.split(".")))
