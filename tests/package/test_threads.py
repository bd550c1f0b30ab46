# SPDX-License-Identifier: Apache-2.0
"""The public calls from many threads give what one thread gives, from the first call on."""

from __future__ import annotations

import json
import random
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest
from case_files import load_cases
from paths import ROBOTS
from threads_child import Job, outcome

CHILD = Path(__file__).parents[1] / "support" / "threads_child.py"
THREADS = 8
OFTEN, VERY_OFTEN = range(10), range(10, 50)


@cache
def jobs() -> tuple[Job, ...]:
    """Every robot and case of the fixtures rewritten, and what comes of it stripped."""
    files = sorted(it for it in ROBOTS.iterdir() if it.suffix in (".urdf", ".sdf"))
    robots = [("rewrite", it.read_text(), {}) for it in files]
    cases = [("rewrite", it.source.decode(), dict(it.options)) for it in load_cases()]
    given = [("strip", it.output.decode(), dict(it.options)) for it in load_cases()]
    return (*robots, *cases, *given)


def check(run: int) -> None:
    """Run a fresh process with a thread for each of some calls, and compare the results."""
    chosen = random.Random(run).sample(jobs(), THREADS)
    made = subprocess.run(
        [sys.executable, str(CHILD)],
        input=json.dumps(chosen, default=str),
        capture_output=True,
        text=True,
        check=True,
    )
    assert json.loads(made.stdout) == [outcome(*job) for job in chosen]


@pytest.mark.sample(4)
@pytest.mark.slow
@pytest.mark.parametrize("run", OFTEN)
def test_threads_of_a_fresh_process_give_what_one_thread_gives(run: int) -> None:
    check(run)


@pytest.mark.deep
@pytest.mark.parametrize("run", VERY_OFTEN)
def test_threads_of_many_fresh_processes_give_what_one_thread_gives(run: int) -> None:
    check(run)
