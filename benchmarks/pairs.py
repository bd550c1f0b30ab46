# SPDX-License-Identifier: Apache-2.0
"""Ratios that hold on a busy machine: CPU time, the least of each side, both sides in turn in one run.

CPU time is that of the process and of its ended children, user and system. Other processes can only
make it more (caches, a lower clock), so the least of several rounds is nearest to the truth.
"""

from __future__ import annotations

import gc
import os
import platform
import subprocess
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from resource import RUSAGE_CHILDREN, getrusage
from typing import NamedTuple

Job = Callable[[], object]
# A shorter job is repeated: a clock has its own cost.
LEAST_SECONDS = 0.005
HOW = """ratios of
CPU time, user and system, children included; of each side the least of several rounds in which both
take turns. Lower is better"""
MACHINE = f"CPython {platform.python_version()}, {os.cpu_count()} cores, a shared machine"


class Row(NamedTuple):
    """One line of the table."""

    what: str
    against: str
    ratio: float
    goal: str


def paired(job: Job, floor: Job, runs: int = 15) -> float:
    """How much more CPU time ``job`` takes than ``floor``."""
    ours, least = least_seconds(job, floor, runs=runs)
    return ours / least


def least_seconds(*jobs: Job, runs: int = 15) -> list[float]:
    """CPU seconds of one call of each job, at best; the jobs take turns."""
    times = [_times(job) for job in jobs]
    gc.collect()
    rounds = [[seconds(job, n) for job, n in zip(jobs, times, strict=True)] for _ in range(runs)]
    return [min(column) for column in zip(*rounds, strict=True)]


def _times(job: Job) -> int:
    job()
    return max(1, int(LEAST_SECONDS / max(seconds(job), 1e-7)))


def seconds(job: Job, times: int = 1) -> float:
    """CPU seconds of one call, its processes included."""
    before = _used()
    for _ in range(times):
        job()
    return (_used() - before) / times


def _used() -> float:
    ended = getrusage(RUSAGE_CHILDREN)
    return time.process_time() + ended.ru_utime + ended.ru_stime


def child(arguments: list[str], *codes: int, folder: str | None = None) -> None:
    """Run a process to its end, in a ``folder``; ``codes`` are exit codes that are right beside 0."""
    null = subprocess.DEVNULL
    done = subprocess.run(arguments, stdout=null, stderr=null, check=False, cwd=folder)
    if done.returncode not in (0, *codes):
        raise RuntimeError(f"{arguments} ended with {done.returncode}")


@contextmanager
def as_installed() -> Iterator[None]:
    """Commands find their modules compiled and beside the sources, whatever the environment says."""
    for name in ("PYTHONDONTWRITEBYTECODE", "PYTHONPYCACHEPREFIX"):
        os.environ.pop(name, None)
    yield


def table(rows: Iterable[Row]) -> str:
    """Return the rows as Markdown."""
    head = "| what | against | ratio | goal |\n|---|---|--:|--:|\n"
    return head + "".join(f"| {r.what} | {r.against} | {r.ratio:.3g} | {r.goal} |\n" for r in rows)
