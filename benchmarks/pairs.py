"""Ratios that hold on a noisy machine: both sides of a pair are measured in turn, in one run."""

from __future__ import annotations

import statistics
import subprocess
import time
from collections.abc import Callable, Iterable
from typing import NamedTuple

Job = Callable[[], object]


class Row(NamedTuple):
    """One line of the table; ``ratio`` is the median over pairs."""

    what: str
    against: str
    ratio: float
    goal: str


def paired(job: Job, floor: Job, runs: int = 15) -> float:
    """Median of job/floor over alternating runs, each side timed alone."""
    job(), floor()
    return statistics.median(seconds(job) / seconds(floor) for _ in range(runs))


def seconds(job: Job) -> float:
    """Wall time of one call."""
    start = time.perf_counter()
    job()
    return time.perf_counter() - start


def child(arguments: list[str], *codes: int) -> None:
    """Run a process to its end; ``codes`` are exit codes that are right beside 0."""
    done = subprocess.run(
        arguments, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False
    )
    if done.returncode not in (0, *codes):
        raise RuntimeError(f"{arguments} ended with {done.returncode}")


def table(rows: Iterable[Row]) -> str:
    """The rows as Markdown."""
    head = "| what | against | ratio | goal |\n|---|---|--:|--:|\n"
    return head + "".join(f"| {r.what} | {r.against} | {r.ratio:.3g} | {r.goal} |\n" for r in rows)
