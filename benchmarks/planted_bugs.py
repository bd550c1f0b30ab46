"""Do the tests notice? Plants bugs in a copy of the repository, one at a time, and runs the fast tests.

python benchmarks/planted_bugs.py                     6 bugs in each room, and the table
python benchmarks/planted_bugs.py --write             and put it into docs/planted-bugs.md
python benchmarks/planted_bugs.py steps remap -n 20   more of them in some rooms
python benchmarks/planted_bugs.py --seed 2            other ones

A bug survives if no test fails. ``fixtures/harmless_bugs.tsv`` lists those that change nothing anybody
could see, with the reason. Bugs are made by ``bugs.py`` beside this file.
"""

from __future__ import annotations

import argparse
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from bugs import Bug, bugs_in, planted

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "planted-bugs.md"
HARMLESS = ROOT / "fixtures" / "harmless_bugs.tsv"
PACKAGE = "multibot_rewrite"
COPIED = (PACKAGE, "tests", "fixtures", "docs", "examples", "share", "benchmarks", "resource")
# Room -> the folders of its tests, and of those that use it, in the order they are run.
ROOMS = {
    "rewriters": "tests/rewriters tests/steps tests/reports",
    "steps": "tests/steps tests/rewriters",
    "checks": "tests/findings tests/steps tests/rewriters tests/remap tests/cli",
    "readback": "tests/readback tests/remap tests/rewriters",
    "findings": "tests/findings tests/lint",
    "reports": "tests/reports tests/cli",
    "remap": "tests/remap tests/cli/test_remap_cli.py",
    "graph": "tests/graph",
    "lint": "tests/lint tests/findings",
    "companions": "tests/companions tests/fleets",
    "fleets": "tests/fleets tests/companions tests/cli",
    "launch": "tests/launch",
    "sources": "tests/sources tests/lint/test_lint_xacro.py tests/package",
    "cli": "tests/cli tests/fleets",
    "rosnames": "tests/remap tests/rewriters",
    "naming.py": "tests/rewriters tests/steps tests/remap",
    ".": "tests/package tests/sources tests/cli tests/rewriters",
}
# A bug in one of these could reach beyond the copy: they kill processes or delete folders.
UNSAFE = (
    "lint/workers.py",
    "sources/child/",
    "sources/processes.py",
    "cli/folders.py",
    "graph/live/",
)
FAST = ("-q", "-x", "-m", "not live and not slow", "-p", "no:cacheprovider", "--tb=no")


class Outcome(NamedTuple):
    """A bug and the first folder whose tests noticed it, empty where none did."""

    room: str
    bug: Bug
    noticed: str


class Bench(NamedTuple):
    """The copy that bugs are planted in; ``failing`` is what fails in a folder without a bug."""

    copy: Path
    seconds: int
    failing: dict[str, list[str]]


def main(arguments: Sequence[str]) -> int:
    """Plant, run, print the table; 1 if more than a tenth survived."""
    options = _options(arguments)
    with tempfile.TemporaryDirectory(prefix="planted_bugs_") as folder:
        copy = _copy(Path(folder) / "copy")
        bench = Bench(copy, options.seconds, {})
        outcomes = [it for room in options.rooms for it in _room(room, bench, options)]
    lines = list(_page(outcomes, options))
    print("\n".join(lines))
    if options.write:
        PAGE.write_text("\n".join(lines) + "\n")
    alive = _alive(outcomes)
    return int(len(alive) * 10 > len(outcomes))


def _options(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("rooms", nargs="*", metavar="ROOM", help=f"of {', '.join(ROOMS)}")
    parser.add_argument("-n", type=int, default=6, help="bugs in each room")
    parser.add_argument("--seed", type=int, default=1, help="which ones")
    parser.add_argument("--seconds", type=int, default=240, help="for the tests of one folder")
    parser.add_argument("--write", action="store_true", help="make the page anew")
    options = parser.parse_args(arguments)
    options.rooms = options.rooms or list(ROOMS)
    return options


def _copy(target: Path) -> Path:
    for name in COPIED:
        shutil.copytree(ROOT / name, target / name, ignore=shutil.ignore_patterns("__pycache__"))
    for path in ROOT.iterdir():
        if path.is_file() and not path.name.startswith("."):
            shutil.copy(path, target)
    return target


def _room(room: str, bench: Bench, options: argparse.Namespace) -> Iterator[Outcome]:
    chance = random.Random(f"{options.seed} {room}")
    home = bench.copy / PACKAGE
    every = [bug for file in _files(room, home) for bug in bugs_in(home, file)]
    for bug in sorted(chance.sample(every, min(options.n, len(every)))):
        noticed = _noticed(bug, ROOMS[room].split(), bench)
        print(f"{room}: {bug}: {noticed or 'SURVIVED'}", file=sys.stderr, flush=True)
        yield Outcome(room, bug, noticed)


def _files(room: str, home: Path) -> Iterator[str]:
    found = (home / room).rglob("*.py") if (home / room).is_dir() and room != "." else ()
    alone = [home / room] if room.endswith(".py") else home.glob("*.py") if room == "." else ()
    for path in sorted((*found, *alone)):
        file = path.relative_to(home).as_posix()
        if not file.startswith(UNSAFE) and not (room == "." and file in ROOMS):
            yield file


def _noticed(bug: Bug, folders: list[str], bench: Bench) -> str:
    target = bench.copy / PACKAGE / bug.file
    source = target.read_bytes()
    for folder in folders:
        if folder not in bench.failing:
            bench.failing[folder] = _failing(folder, bench)
        target.write_bytes(planted(source, bug))
        try:
            if _notices(folder, bug.file, bench):
                return folder
        finally:
            target.write_bytes(source)
    return ""


def _failing(folder: str, bench: Bench) -> list[str]:
    """What fails without a bug: it is left out."""
    command = [*_pytest(), *(word for word in FAST if word != "-x"), "-rfE", folder]
    done = subprocess.run(
        command, cwd=bench.copy, env=_environment(bench.copy), timeout=3 * bench.seconds,
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    lines = [line.partition(" - ")[0] for line in done.stdout.splitlines()]
    found = [line.partition(" ")[2] for line in lines if line.startswith(("FAILED ", "ERROR "))]
    if found:
        print(f"{folder}: {len(found)} tests fail without a bug", file=sys.stderr, flush=True)
    return found


def _notices(folder: str, file: str, bench: Bench) -> bool:
    left_out = [f"--deselect={name}" for name in bench.failing[folder]]
    tests = _nearest_first(bench.copy, folder, file)
    run = subprocess.Popen(
        [*_pytest(), *FAST, *left_out, *tests], cwd=bench.copy, env=_environment(bench.copy),
        start_new_session=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    try:
        return run.wait(bench.seconds) not in (0, 5)
    except subprocess.TimeoutExpired:
        return True
    finally:
        _end(run)


def _nearest_first(copy: Path, folder: str, file: str) -> list[str]:
    """The test files of a folder; first those that name the module most often."""
    name = Path(file).stem if Path(file).stem != "__init__" else Path(file).parent.name
    files = sorted((copy / folder).rglob("test_*.py")) or [copy / folder]
    files.sort(key=lambda it: -it.read_text().count(name))
    return [it.relative_to(copy).as_posix() for it in files]


def _end(run: subprocess.Popen[bytes]) -> None:
    """End it and what it started, if it is still there."""
    if run.poll() is None:
        os.killpg(run.pid, 9)
        run.wait()


def _pytest() -> list[str]:
    return [sys.executable, "-B", "-m", "pytest"]


def _environment(copy: Path) -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": str(copy), "PYTHONHASHSEED": "0"}


def harmless() -> dict[tuple[str, str, str], str]:
    """Judged by hand: (file, what was there, what was planted) -> why nobody can see it."""
    rows = [line.split("\t") for line in HARMLESS.read_text().splitlines() if line[:1] not in "#"]
    return {(file, old, new): why for file, old, new, why in rows}


def _alive(outcomes: Iterable[Outcome]) -> list[Outcome]:
    known = harmless()
    return [it for it in outcomes if not it.noticed and _key(it.bug) not in known]


def _key(bug: Bug) -> tuple[str, str, str]:
    return bug.file, bug.old, bug.new


def _page(outcomes: list[Outcome], options: argparse.Namespace) -> Iterator[str]:
    alive = _alive(outcomes)
    silent = [it for it in outcomes if not it.noticed]
    yield "# Planted bugs\n"
    yield "Made by `python benchmarks/planted_bugs.py --write`, on " + time.strftime("%Y-%m-%d.")
    yield f"Seed {options.seed}: operators, constants, conditions, calls and statements, by chance."
    yield "Bugs that change nothing anybody could see are judged by hand: `fixtures/harmless_bugs.tsv`."
    yield "\n| room | planted | noticed | harmless | survived |\n|---|--:|--:|--:|--:|"
    for room in [*options.rooms, "all"]:
        mine = [it for it in outcomes if room in ("all", it.room)]
        left = [it for it in alive if it in mine]
        quiet = len([it for it in silent if it in mine]) - len(left)
        noticed = len(mine) - quiet - len(left)
        yield f"| {_called(room)} | {len(mine)} | {noticed} | {quiet} | {len(left)} |"
    if alive:
        yield "\nWhat survived:\n"
        yield from (f"- `{it.bug}`" for it in alive)


def _called(room: str) -> str:
    return {"all": "**all**", ".": "the modules beside them"}.get(room, f"`{room}`")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
