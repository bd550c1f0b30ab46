# SPDX-License-Identifier: Apache-2.0
"""Measure whole commands of this checkout against those of an earlier commit, in one run.

python benchmarks/bench_before.py COMMIT            print the table
python benchmarks/bench_before.py COMMIT --write    and put it into docs/contributing/measurements.md

Both read the same inputs: the examples of the commit, descriptions that are made, and plans with
snapshots that each makes for itself, since their forms differ.
"""

from __future__ import annotations

import argparse
import io
import os
import statistics
import subprocess
import sys
import tarfile
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from bench_build import ROBOTS, write_fleets
from one_page import write_section
from pairs import MACHINE, as_installed, child, seconds
from robots import robot

HERE = Path(__file__).parent.parent
RUNS = 31
# A check reads a snapshot by this option, before and now.
OPTIONS = ("--snapshot", "--from")
# The sizes of fleets whose graphs are checked: robots, nodes a robot, topics a node.
FLEETS = {"100 robots x 20 topics": (100, 1, 20), "1,000 robots x 20 nodes": (1_000, 20, 1)}
MAKE = """
import sys
sys.path[:0] = [sys.argv[1], sys.argv[1] + "/benchmarks"]
import bench_graph as it
plan = it.plan_of(it.Size(*map(int, sys.argv[3:]), 1))
texts = {"plan": getattr(it, "plan_to_json", it.to_json)(plan), "graph": it.to_json(it.graph_of(plan))}
for name, text in texts.items():
    data = text if isinstance(text, bytes) else text.encode()
    open(f"{sys.argv[2]}-{name}.json", "wb").write(data)
"""
HEAD = """\
# Against an earlier commit

Made by `python benchmarks/bench_before.py {commit} --write` in one run: CPU time of whole commands,
children included. Both commits take turns; a ratio is the median of {runs} pairs, so another process
that takes the caches away for a while counts little. {machine}.

| command | input | before, s | ratio |
|---|---|--:|--:|
"""


class Row(NamedTuple):
    """One line of the table; ``before`` is in seconds, at best."""

    command: str
    about: str
    before: float
    ratio: float


def unpacked(commit: str, folder: Path) -> Path:
    """Return the files of a commit, which end where a repository does."""
    data = subprocess.run(["git", "archive", commit], cwd=HERE, check=True, capture_output=True)
    with tarfile.open(fileobj=io.BytesIO(data.stdout)) as archive:
        archive.extractall(folder, filter="data")
    (folder / ".git").mkdir()
    return folder


def run(program: str, *words: object, tree: Path) -> None:
    """Run a command of a checkout, found in the folder that it runs in."""
    command = [sys.executable, "-m", f"multibot_rewrite.cli.{program}", *map(str, words)]
    child(command, 1, folder=str(tree))


def compared(command: str, about: str, job: Callable[[Path], object], before: Path) -> Row:
    """Return the times of a job in both checkouts, in turns; each has run once before."""
    sides = [partial(job, before), partial(job, HERE)]
    for side in sides:
        side()
    pairs = [[seconds(side) for side in sides] for _ in range(RUNS)]
    ratio = statistics.median(now / then for then, now in pairs)
    return Row(command, about, min(then for then, _ in pairs), ratio)


def rows(before: Path, folder: Path) -> Iterator[Row]:
    """Yield the commands of a day: a rewrite, a lint, builds, checks."""
    for links in (60, 700):
        file = folder / f"robot{links}.urdf"
        file.write_bytes(robot(links))
        about = f"a URDF of {file.stat().st_size / 1000:,.0f} kB"
        out = ("-q", "-o", folder / "{robot}.urdf")
        yield _row("urdf-postfix", about, before, "urdf_postfix", file, "robot1", "robot2", *out)
        yield _row("urdf-lint", about, before, "urdf_lint", file, "-q")
    for file in sorted(before.glob("examples/*/fleet.yaml")):
        out = ("-q", "-o", folder / "out")
        yield _row("multibot build", file.parent.name, before, "multibot", "build", file, *out)
    _, many = write_fleets(folder)
    out = ("-q", "-o", folder / "many")
    yield _row(
        "multibot build", f"{ROBOTS} robots with Nav2", before, "multibot", "build", many, *out
    )
    for about, size in FLEETS.items():
        yield compared("multibot check", about, partial(_checked, folder, size), before)


def _row(command: str, about: str, before: Path, program: str, *words: object) -> Row:
    return compared(command, about, lambda tree: run(program, *words, tree=tree), before)


def _checked(folder: Path, size: tuple[int, ...], tree: Path) -> None:
    """Compare a snapshot with its plan; both are made when they are first asked for."""
    is_now = tree == HERE
    stem = folder / f"{'now' if is_now else 'before'}{size[0]}"
    plan, graph = Path(f"{stem}-plan.json"), Path(f"{stem}-graph.json")
    if not graph.exists():
        child([sys.executable, "-c", MAKE, str(tree), str(stem), *map(str, size)])
    run("multibot", "check", plan, OPTIONS[is_now], graph, tree=tree)


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("commit")
    parser.add_argument("--write", action="store_true")
    given = parser.parse_args()
    # The lint keeps what it found where it can.
    os.environ["XDG_CACHE_HOME"] = os.devnull
    text = HEAD.format(commit=given.commit, runs=RUNS, machine=MACHINE)
    with as_installed(), TemporaryDirectory() as made, TemporaryDirectory() as folder:
        for it in rows(unpacked(given.commit, Path(made)), Path(folder)):
            line = f"| `{it.command}` | {it.about} | {it.before:.3g} | {it.ratio:.2f} |"
            print(line, flush=True)
            text += f"{line}\n"
    if given.write:
        write_section(text)


if __name__ == "__main__":
    main()
