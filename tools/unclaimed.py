# SPDX-License-Identifier: Apache-2.0
"""``python -m tools.unclaimed LIST PATH...``: links and joints in values that no definition reads.

LIST says which of them need no line: ``tag path TAB reason``. Printed is the rest, and what explains
nothing any more: exit code 1 where there is either, 2 for wrong use.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from fnmatch import fnmatchcase
from pathlib import Path
from typing import NamedTuple

from multibot_rewrite.base.model import InputError, MultibotError
from tools.survey import MentionPlace, Survey, Tally, surveyed


class Reason(NamedTuple):
    """A line of a list of explained mentions: ``path`` may hold ``*`` for any text."""

    path: str
    text: str
    line: int


class Explained(NamedTuple):
    """The exact mentions of a survey, sorted by whether a reason holds for them.

    ``stale`` are the reasons that hold for none.
    """

    explained: Sequence[tuple[MentionPlace, Tally, Reason]]
    left: Sequence[tuple[MentionPlace, Tally]]
    stale: Sequence[Reason]


def read_reasons(text: str, file: str) -> list[Reason]:
    """Lines of ``tag path TAB reason``; empty ones and those starting with ``#`` are skipped.

    Raises InputError naming file and line.
    """
    reasons = []
    for number, row in enumerate(text.splitlines(), 1):
        if not row.strip() or row.startswith("#"):
            continue
        path, _, reason = (word.strip() for word in row.partition("\t"))
        if not path or not reason:
            raise InputError(f"{file}:{number}: write the tag path, a tab, and the reason")
        reasons.append(Reason(path, reason, number))
    return reasons


def explain(total: Survey, reasons: Sequence[Reason]) -> Explained:
    """Sort the exact mentions by the first reason that holds for each."""
    explained, left = [], []
    used: set[Reason] = set()
    for mention, tally in total.mentions.items():
        holding = [it for it in reasons if mention.exact and _holds(it, mention)]
        used.update(holding)
        if holding:
            explained.append((mention, tally, holding[0]))
        elif mention.exact:
            left.append((mention, tally))
    return Explained(explained, left, [it for it in reasons if it not in used])


def _holds(reason: Reason, mention: MentionPlace) -> bool:
    # Only * is a wildcard: brackets are part of a path.
    return fnmatchcase(mention.path, reason.path.replace("[", "[[]").replace("?", "[?]"))


def main(words: Sequence[str]) -> int:
    """Print what is left; returns the exit code."""
    try:
        reasons = read_reasons(Path(words[0]).read_text("utf-8-sig"), words[0])
        found = explain(surveyed(words[1:])[0], reasons)
    except (MultibotError, OSError, IndexError) as error:
        print(f"unclaimed: {error}", file=sys.stderr)
        return 2
    for mention, tally in found.left:
        print(f"{tally.place}: {mention.path}: {tally.value}")
    for stale in found.stale:
        print(f"{words[0]}:{stale.line}: explains nothing any more: {stale.path}")
    return int(bool(found.left or found.stale))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
