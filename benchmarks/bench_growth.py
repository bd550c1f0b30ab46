# SPDX-License-Identifier: Apache-2.0
"""Measure how the cost of a rewrite and of the lint grows: what twice as much costs, in CPU time.

python benchmarks/bench_growth.py            print the table
python benchmarks/bench_growth.py --write    and put it into docs/contributing/measurements.md
"""

from __future__ import annotations

import platform
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from lxml import etree
from one_page import write_section

from multibot_rewrite import MultibotError, rewrite
from multibot_rewrite.lint.check import lint_data
from multibot_rewrite.rules.settings import Settings

ROOT = Path(__file__).parent.parent
# The tests count steps of the same descriptions.
sys.path.insert(0, str(ROOT / "tests" / "support"))
from growing import GROWING, description  # noqa: E402

# More than any public description has.
COUNTS = {
    "mentions": 10_000,
    "plugins with insertions": 3_000,
    "unknown plugins": 10_000,
    "undeclared references": 20_000,
}
USUAL = 4_000
RUNS = 3
# No bound on the time of a file: it is what is measured.
UNBOUNDED = Settings(seconds=0)
HEAD = """\
# Benchmark of growth

Made by `python benchmarks/bench_growth.py --write` in one run: CPU time, the least of {runs} runs.
CPython {python}, lxml {lxml}, 2 cores. A ratio is what twice as much costs, the larger one of from half
and from a quarter to half: 2 is linear, 4 quadratic.

| what a description has many of | count | rewrite, s | ratio | lint, s | ratio |
|---|--:|--:|--:|--:|--:|
"""


def rewritten(data: bytes) -> None:
    try:
        rewrite(data, "robot1")
    except MultibotError:
        # What is refused is read as far as that.
        return


def linted(data: bytes) -> None:
    lint_data("robot.urdf", data, UNBOUNDED)


def least(work: Callable[[bytes], None], data: bytes) -> float:
    return min(_seconds(work, data) for _ in range(RUNS))


def _seconds(work: Callable[[bytes], None], data: bytes) -> float:
    begun = time.process_time()
    work(data)
    return time.process_time() - begun


def rows() -> Iterator[str]:
    for what in GROWING:
        count = COUNTS.get(what, USUAL)
        row = f"| {what} | {count:,} |"
        for work in (rewritten, linted):
            work(description(what, 10))
            small, half, whole = (
                least(work, description(what, count // part)) for part in (4, 2, 1)
            )
            row += f" {whole:.2f} | {max(whole / half, half / small):.1f} |"
        yield f"{row}\n"


def main() -> None:
    lxml = ".".join(map(str, etree.LXML_VERSION[:3]))
    head = HEAD.format(runs=RUNS, python=platform.python_version(), lxml=lxml)
    made = [head]
    sys.stdout.write(head)
    for row in rows():
        made.append(row)
        sys.stdout.write(row)
        sys.stdout.flush()
    if "--write" in sys.argv:
        write_section("".join(made))


if __name__ == "__main__":
    main()
