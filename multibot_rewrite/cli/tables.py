# SPDX-License-Identifier: Apache-2.0
"""Reports for a person: lines and tables, in which no name is cut in two.

A table folds between names, and where even that does not fit, each row becomes lines of its own."""

import argparse
import sys
from collections.abc import Iterable, Iterator, Sequence
from itertools import zip_longest
from typing import NamedTuple

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.wording import in_json, one_line
from multibot_rewrite.cli.output import deliver, goes_to_file, prints_colour

JSON = "json"
# Columns with these names are set to the right.
NUMBERS = ("count", "files", "rows")
GAP = "  "
# Where a cell may be folded: behind a blank, or behind a slash inside a name.
_PIECE = lazy_compile(r"[^ /]*(?:/+|\s+|$)")


class Grid(NamedTuple):
    """A table."""

    columns: Sequence[str]
    rows: Sequence[Sequence[str]]


def deliver_report(options: argparse.Namespace, parts: Iterable[str | Grid]) -> None:
    """Write lines and tables where ``-o`` says, as wide as the terminal that shows them."""
    deliver(options, render(parts, _width(options), prints_colour(options)).encode())


def _width(options: argparse.Namespace) -> int | None:
    """Return the terminal's width; None if a program or a file gets the text."""
    if goes_to_file(options) or sys.stdout is None or not sys.stdout.isatty():
        return None
    from shutil import get_terminal_size

    return get_terminal_size().columns


def render(parts: Iterable[str | Grid], width: int | None = None, colour: bool = False) -> str:
    """Return the report as text; without a ``width`` nothing is folded."""
    return "".join(
        f"{line.rstrip()}\n" for part in parts for line in _part_lines(part, width, colour)
    )


def _part_lines(part: str | Grid, width: int | None, colour: bool) -> Iterable[str]:
    if isinstance(part, str):
        return [one_line(part)]
    rows = [[one_line(cell) for cell in row] for row in part.rows]
    return _table_lines(part._replace(rows=rows), width, colour)


def _table_lines(grid: Grid, width: int | None, colour: bool) -> Iterator[str]:
    widths = _column_widths(grid, width)
    if widths is None:
        # A line for each cell, an empty one between rows.
        longest = max(map(len, grid.columns))
        for number, row in enumerate(grid.rows):
            yield from [""] * (number > 0)
            cells = zip(grid.columns, row, strict=True)
            yield from (f"{name.ljust(longest)}  {text}" for name, text in cells if text)
        return
    head = next(_row_lines(grid.columns, grid, widths))
    yield f"\033[1m{head.rstrip()}\033[0m" if colour else head
    for row in grid.rows:
        yield from _row_lines(row, grid, widths)


def _column_widths(grid: Grid, width: int | None) -> list[int] | None:
    """Return the width of each column; None if names would have to be cut."""
    columns = [*zip(grid.columns, *grid.rows, strict=True)]
    natural = [max(map(len, cells)) for cells in columns]
    # A cell may be folded between its pieces.
    pieces = ([it for cell in cells for it in _PIECE.findall(cell)] for cells in columns)
    least = [max((len(it.rstrip()) for it in own), default=0) for own in pieces]
    room = sum(natural) if width is None else width - len(GAP) * (len(columns) - 1)
    if sum(least) > room:
        return None
    left = room - sum(least)
    # The narrow columns first: what a long one lacks is folded.
    for at in sorted(range(len(columns)), key=lambda it: natural[it]):
        more = min(natural[at] - least[at], left)
        least[at] += more
        left -= more
    return least


def _folded_cell(cell: str, width: int) -> list[str]:
    """Return a cell in lines of that width."""
    lines = [""]
    for piece in filter(None, _PIECE.findall(cell)):
        if len(lines[-1]) + len(piece.rstrip()) > width:
            lines.append("")
        lines[-1] += piece
    return lines


def _row_lines(row: Sequence[str], grid: Grid, widths: Sequence[int]) -> Iterator[str]:
    """Yield the lines of a row, usually one."""
    folded = [_folded_cell(cell, width) for cell, width in zip(row, widths, strict=True)]
    for line in zip_longest(*folded, fillvalue=""):
        cells = zip(line, grid.columns, widths, strict=True)
        yield GAP.join(
            text.rstrip().rjust(width) if name in NUMBERS else text.rstrip().ljust(width)
            for text, name, width in cells
        )


def json_bytes(value: object) -> bytes:
    """Return ``value`` as JSON; a byte of a path that is not UTF-8 becomes a JSON escape."""
    import json

    text = in_json(json.dumps(value, indent=1, ensure_ascii=False))
    return text.encode("utf-8", "backslashreplace") + b"\n"
