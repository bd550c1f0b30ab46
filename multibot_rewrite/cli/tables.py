"""Reports for a person: lines and tables, in colour and folded on a terminal, else plain."""

from __future__ import annotations

import io
import sys
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, NamedTuple

from multibot_rewrite.cli.output import print_bytes

if TYPE_CHECKING:
    from rich.table import Table
    from rich.text import Text

NUMBERS = ("count", "files", "rows")
# Wider than any line: what is read by a program or from a file is not folded.
ENDLESS = 100_000
_LONGEST = 60


class Grid(NamedTuple):
    """A table; columns called like one of ``NUMBERS`` are set to the right."""

    columns: Sequence[str]
    rows: Sequence[Sequence[str]]


def print_report(parts: Iterable[str | Grid]) -> None:
    """Print lines and tables to standard output; raises as ``print_bytes`` does."""
    terminal = sys.stdout is not None and sys.stdout.isatty()
    text = render(parts, terminal)
    print_bytes(text.encode("utf-8", "surrogateescape"), "--json")


def render(parts: Iterable[str | Grid], terminal: bool, width: int | None = None) -> str:
    """The report as text; ``width`` is for a terminal, whose own it is if not given."""
    from rich.console import Console

    console = Console(
        file=io.StringIO(), force_terminal=terminal, width=width if terminal else ENDLESS
    )
    with console.capture() as capture:
        for part in parts:
            console.print(renderable(part))
    return "".join(f"{line.rstrip()}\n" for line in capture.get().splitlines())


def renderable(part: str | Grid) -> Table | Text:
    """A part of a report as Rich prints it."""
    from rich.text import Text

    # Text, because brackets in a str would be read as markup.
    return _table(part) if isinstance(part, Grid) else Text(part)


def _table(grid: Grid) -> Table:
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), header_style="bold")
    for name in grid.columns:
        table.add_column(name, justify="right" if name in NUMBERS else "left", overflow="fold")
    for row in grid.rows:
        table.add_row(*(Text(cell) for cell in row))
    return table


def clip(text: str) -> str:
    """A value on one line and not longer than a line can show."""
    line = " ".join(text.split())
    return line if len(line) <= _LONGEST else f"{line[: _LONGEST - 1]}…"


def json_bytes(value: object) -> bytes:
    """``value`` as JSON; a path that is not UTF-8 keeps its bytes as escapes."""
    import json

    text = json.dumps(value, indent=1, ensure_ascii=False)
    return text.encode("utf-8", "backslashreplace") + b"\n"
