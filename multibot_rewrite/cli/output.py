"""What the commands print and write: results, diffs, findings, the summary."""

from __future__ import annotations

import argparse
import io
import os
import sys
from collections import Counter
from collections.abc import Iterable, Sequence
from itertools import chain
from typing import TYPE_CHECKING, TypeVar

from multibot_rewrite.cli.files import write_all
from multibot_rewrite.cli.usage import input_name, target_path
from multibot_rewrite.model import Finding, UsageError
from multibot_rewrite.naming import SEPARATORS

if TYPE_CHECKING:
    from multibot_rewrite.library import Rewrite

MANY = 20
_T = TypeVar("_T")


def deliver(
    options: argparse.Namespace,
    results: Iterable[tuple[str, bytes]],
    more: list[tuple[str, bytes]],
    before: bytes,
    total: int,
) -> None:
    """Print or write the results as they are made, and ``more`` files with them."""
    target = options.input if options.in_place else options.output
    if target:
        files = ((target_path(target, robot), data) for robot, data in results)
        write_all(watched(chain(more, files), total, "writing"))
        return
    write_all(more)
    for robot, data in results:
        name = input_name(options)
        print_bytes(diff(before, data, name, f"{name} for {robot}") if options.diff else data)


def watched(items: Iterable[_T], total: int, doing: str) -> Iterable[_T]:
    """The same items, with a progress bar where there are many and somebody is looking."""
    if total < MANY or not sys.stderr.isatty():
        return items
    from rich.console import Console
    from rich.progress import track

    return track(items, doing, total, console=Console(stderr=True), transient=True)


def diff(old: bytes, new: bytes, name: str, new_name: str) -> bytes:
    """A unified diff that patch reads."""
    from difflib import diff_bytes, unified_diff

    # Unlike splitlines, this ends lines at line feeds only, as patch does.
    before, after = io.BytesIO(old).readlines(), io.BytesIO(new).readlines()
    names = os.fsencode(name), os.fsencode(new_name)
    lines = diff_bytes(unified_diff, before, after, *names)
    cut_short = b"\n\\ No newline at end of file\n"
    return b"".join(line if line.endswith(b"\n") else line + cut_short for line in lines)


def print_bytes(data: bytes, instead: str = "-o") -> None:
    """Write to standard output, now: what fails must be told before the report.

    ``instead`` is the option that writes a file.
    """
    if sys.stdout is None:
        raise UsageError(f"standard output is closed; name a file with {instead}")
    try:
        sys.stdout.buffer.write(data)
        sys.stdout.buffer.flush()
    except OSError as error:
        # Python would complain again when it closes standard output.
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        if isinstance(error, BrokenPipeError):
            raise
        raise UsageError(f"standard output: cannot be written: {error.strerror}") from None


def print_lines(lines: Iterable[object]) -> None:
    """A line each to standard output; what no text can hold, from a file, is shown escaped."""
    text = "".join(f"{line}\n" for line in lines)
    print_bytes(text.encode("utf-8", "backslashreplace"), "--report")


def changes_json(first: Rewrite, robots: list[str]) -> bytes:
    """Every change for every robot, as ``--changes`` writes it."""
    import json

    rewrites = [first._replace(robot=robot) for robot in robots]
    table = {
        "file": first.template.inventory.document.file,
        "robots": {r.robot: [change._asdict() for change in r.changes] for r in rewrites},
    }
    return json.dumps(table, indent=1, ensure_ascii=False).encode() + b"\n"


def summary(first: Rewrite, robots: list[str]) -> str:
    """One line: how many names of each kind were spelled."""
    inventory, plan = first.template.inventory, first.template.plan
    names = {
        (kind, claim.value)
        for claim, spelling in zip(inventory.claims, plan.renames.values, strict=True)
        for kind, *_ in spelling
    }
    counts = Counter(kind for kind, _ in names)
    known = [
        f"{counts[kind]} {kind}{'s' * (counts[kind] > 1)}" for kind in SEPARATORS if counts[kind]
    ]
    inserted = f", {len(plan.insertions)} inserted" if plan.insertions else ""
    who = robots[0] if len(robots) == 1 else f"{len(robots)} robots"
    return f"{who}: {', '.join(known) or 'nothing to rename'}{inserted}; proved"


def print_findings(findings: Sequence[Finding]) -> None:
    """One line each to standard error, in colour on a terminal."""
    colorful = sys.stderr.isatty() and "NO_COLOR" not in os.environ
    paint = {"warning": "\033[33m", "error": "\033[31m"} if colorful else {}
    for finding in findings:
        color = paint.get(finding.level, "")
        sys.stderr.write(f"{color}{finding}{color and chr(27) + '[0m'}\n")


def say(text: str, program: str = "urdf-postfix") -> None:
    """A line to standard error."""
    sys.stderr.write(f"{program}: {text}\n")
