"""What is open in the robots of a plan, as rows of its file."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import LEVELS, Finding
from multibot_rewrite.base.model import InputError

KEYS = ("code", "level", "at", "message", "hint")


def gap_value(gap: Finding) -> dict[str, str]:
    """A finding as a row; ``at`` is the place in a file, empty for none."""
    at = f"{gap.file}:{gap.line}" if gap.file else ""
    return dict(zip(KEYS, (gap.code, gap.level, at, gap.message, gap.hint), strict=True))


def read_gaps(value: object, place: str) -> Iterator[Finding]:
    """The findings of rows; raises InputError with the ``place`` and what to write there."""
    if value is not None and not isinstance(value, list):
        raise InputError(f"{place} is not a list; leave it out for a plan without open ends")
    for number, row in enumerate(value or ()):
        yield _read(row, f"{place}[{number}]")


def _read(row: object, place: str) -> Finding:
    if not isinstance(row, dict) or {*row} != {*KEYS}:
        raise InputError(f"{place}: write a mapping of {', '.join(KEYS)}")
    if not all(isinstance(it, str) for it in row.values()):
        raise InputError(f"{place}: write texts")
    if row["level"] not in LEVELS:
        raise InputError(f"{place}: {row['level']!r} is not one of {', '.join(LEVELS)}")
    file, _, line = row["at"].rpartition(":")
    if row["at"] and not (file and line.isascii() and line.isdigit()):
        raise InputError(f"{place}: at: write file:line, or nothing")
    found = Finding(row["code"], row["level"], row["message"], row["hint"])
    return found._replace(file=file, line=int(line), column=1) if file else found
