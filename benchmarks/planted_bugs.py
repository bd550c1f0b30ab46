# SPDX-License-Identifier: Apache-2.0
"""Do the tests notice? Plants bugs in a copy of the repository, one at a time, and runs the fast tests.

python benchmarks/planted_bugs.py                     6 bugs in each package, and the table
python benchmarks/planted_bugs.py --write             and put it into docs/contributing/measurements.md
python benchmarks/planted_bugs.py steps remap -n 20   more of them in some packages
python benchmarks/planted_bugs.py --seed 2            other ones
python benchmarks/planted_bugs.py producers --tests tests/producers    do these tests alone notice?

A bug survives if no test fails. ``fixtures/harmless_bugs.tsv`` lists those that change nothing anybody
could see, with the reason. Bugs are made by ``bugs.py`` next to this file.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from queue import Queue
from typing import NamedTuple

from bugs import Bug, bugs_in, planted
from one_page import write_section

ROOT = Path(__file__).parents[1]
HARMLESS = ROOT / "fixtures" / "harmless_bugs.tsv"
PACKAGE = "multibot_rewrite"
# "." are the modules that are in no folder.
ROOMS = (*sorted(it.parent.name for it in (ROOT / PACKAGE).glob("*/__init__.py")), ".")
# A bug in a file with one of these could reach beyond the copy: it ends processes or deletes folders.
UNSAFE = re.compile(r"\b(?:os\.kill|killpg|os\.fork|os\._exit|rmtree|subprocess|signal)\b")
CODE = re.compile(r"\bM[A-Z]\d{3}\b")
AT_ONCE, MOST_TESTS, FEW_TESTS, WHOLE_SECONDS = 80, 600, 10, 1800
# A bug may make a loop that never ends and keeps all that it makes.
MOST_MEMORY = 6 << 30
TEMPORARY = "planted_bugs_"
# Exit codes of pytest.
WRONG_USE, NO_TESTS, TOO_LONG = 4, 5, -1
FAST = ("-q", "-x", "-m", "not live and (not slow or more)", "-p", "no:cacheprovider", "--tb=no")


class Outcome(NamedTuple):
    """A bug, how many tests were run, and whether one of them noticed it."""

    room: str
    bug: Bug
    tests: int
    noticed: bool


class Bench(NamedTuple):
    """The copy that bugs are planted in, the tests that call each of its functions, and those that
    fail without a bug; ``every`` are all that are asked."""

    copy: Path
    seconds: int
    every: Sequence[str]
    called: dict[str, list[str]]
    failing: Sequence[str]


def main(arguments: Sequence[str]) -> int:
    """Plant, run, print the table; 1 if more than a tenth survived."""
    options = _options(arguments)
    with tempfile.TemporaryDirectory(prefix=TEMPORARY) as folder:
        copies = [_copy(Path(folder) / f"copy{at}") for at in range(options.jobs)]
        calls, failing = _called(copies[0], options.notes, options.tests)
        free: Queue[Bench] = Queue()
        for copy in copies:
            free.put(Bench(copy, options.seconds, options.tests, calls, failing))
        with ThreadPoolExecutor(options.jobs) as pool:
            found = pool.map(partial(_room, free=free, options=options), options.rooms)
            outcomes = [it for room in found for it in room]
    lines = list(_page(outcomes, options))
    print("\n".join(lines))
    if options.write:
        write_section("\n".join(lines))
    alive = _alive(outcomes)
    return int(len(alive) * 10 > len(outcomes))


def _options(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("rooms", nargs="*", metavar="PACKAGE", help=f"of {', '.join(ROOMS)}")
    parser.add_argument("-n", type=int, default=6, help="bugs in each package")
    parser.add_argument("--seed", type=int, default=1, help="which ones")
    parser.add_argument("--seconds", type=int, default=600, help="for the tests of one bug")
    parser.add_argument("--jobs", type=int, default=1, help="packages at once, each in a copy")
    parser.add_argument("--notes", type=Path, help="file that keeps which test calls what")
    parser.add_argument("--whole", action="store_true", help="ask all about those that survive")
    parser.add_argument("--tests", nargs="+", default=["tests"], help="those that are asked")
    parser.add_argument("--write", action="store_true", help="make the page anew")
    options = parser.parse_args(arguments)
    options.rooms = options.rooms or list(ROOMS)
    return options


def _copy(target: Path) -> Path:
    left = (".git", ".venv", ".*_cache", ".hypothesis", "__pycache__", "*.egg-info", "build")
    return Path(shutil.copytree(ROOT, target, ignore=shutil.ignore_patterns(*left)))


def _called(
    copy: Path, notes: Path | None, tests: Sequence[str]
) -> tuple[dict[str, list[str]], list[str]]:
    """The tests by the functions that they call, and those that fail without a bug: left out."""
    notes = (notes or copy / "called.json").resolve()
    if not notes.exists():
        _note_calls(copy, notes, tests)
    calls: dict[str, list[str]] = json.loads(notes.read_text())
    if not calls:
        sys.exit("no test was run in the copy")
    failing = set(calls.pop("", ()))
    print(f"{len(failing)} tests fail without a bug", file=sys.stderr, flush=True)
    # Without those that have the path of the copy in their name: another has another.
    left = {
        name: [it for it in tests if it not in failing and TEMPORARY not in it]
        for name, tests in calls.items()
    }
    return left, sorted(failing)


def _note_calls(copy: Path, notes: Path, tests: Sequence[str]) -> None:
    environment = {**_environment(copy), "CALLED": str(notes)}
    command = [*_pytest(), *(word for word in FAST if word != "-x"), "-p", "called", *tests]
    subprocess.run(command, cwd=copy, env=environment, stdout=subprocess.DEVNULL, check=False)


def _room(room: str, free: Queue[Bench], options: argparse.Namespace) -> list[Outcome]:
    bench = free.get()
    try:
        return list(_outcomes(room, bench, options))
    finally:
        free.put(bench)


def _outcomes(room: str, bench: Bench, options: argparse.Namespace) -> Iterator[Outcome]:
    chance = random.Random(f"{options.seed} {room}")
    home = bench.copy / PACKAGE
    every = [bug for file in _files(room, home) for bug in bugs_in(home, file)]
    for bug in sorted(chance.sample(every, min(options.n, len(every)))):
        tests = _tests_of(bug, bench, chance)
        others = [*bench.every, *(f"--deselect={it}" for it in bench.failing)]
        noticed = any(_is_noticed(bug, part, bench) for part in (tests[:AT_ONCE], tests[AT_ONCE:]))
        word = "noticed" if noticed else "SURVIVED"
        if options.whole and not noticed:
            # That the whole suite takes long is no sign of a bug.
            noticed = _is_noticed(bug, others, bench._replace(seconds=WHOLE_SECONDS), (TOO_LONG,))
            word = "noticed by the whole suite" if noticed else "SURVIVED"
        print(f"{room}: {bug}: {word}, {len(tests)} tests", file=sys.stderr, flush=True)
        yield Outcome(room, bug, len(tests), noticed)


def _tests_of(bug: Bug, bench: Bench, chance: random.Random) -> list[str]:
    """Tests that call the function with the bug, and of the module where few do: what is made once is
    made in one test. A module of data is asked by those of its folder. Those named after a rule of the
    module come first, then those of files that name the module and its rules most often."""
    found = set(bench.called.get(f"{bug.file}:{bug.function}", ()))
    if len(found) < FEW_TESTS:
        found |= _tests_in(f"{bug.file}:", bench)
    folder = bug.file
    while not found and folder:
        folder = folder.rpartition("/")[0]
        found = _tests_in(folder, bench)
    name = Path(bug.file).stem if Path(bug.file).stem != "__init__" else Path(bug.file).parent.name
    rules = {*CODE.findall((bench.copy / PACKAGE / bug.file).read_text())}
    # Notes of an earlier run may name files that are gone.
    files = {it for test in found if (bench.copy / (it := test.partition("::")[0])).exists()}
    found = {test for test in found if test.partition("::")[0] in files}
    texts = {it: (bench.copy / it).read_text() for it in files}
    named = {it: sum(map(text.count, (name, *rules))) for it, text in texts.items()}

    def away(test: str) -> tuple[bool, int, str]:
        return not any(it in test for it in rules), -named[test.partition("::")[0]], test

    nearest = sorted(found, key=away)
    near, far = nearest[:AT_ONCE], nearest[AT_ONCE:]
    return near + chance.sample(far, min(MOST_TESTS - AT_ONCE, len(far)))


def _tests_in(place: str, bench: Bench) -> set[str]:
    mine = (key for key in bench.called if key.startswith(place))
    return {test for key in mine for test in bench.called[key]}


def _files(room: str, home: Path) -> Iterator[str]:
    found = (home / room).rglob("*.py") if (home / room).is_dir() and room != "." else ()
    for path in sorted((*found, *(home.glob("*.py") if room == "." else ()))):
        file = path.relative_to(home).as_posix()
        if not ("child" in file or UNSAFE.search(path.read_text())):
            yield file


def _is_noticed(bug: Bug, tests: list[str], bench: Bench, fine: Sequence[int] = ()) -> bool:
    target = bench.copy / PACKAGE / bug.file
    source = target.read_bytes()
    target.write_bytes(planted(source, bug))
    try:
        ended = _run(tests, bench) if tests else NO_TESTS
    finally:
        target.write_bytes(source)
    # Tests that are not found: the module with the bug cannot be imported, or the notes are old.
    if ended == WRONG_USE and _run(tests, bench, "--collect-only") == WRONG_USE:
        sys.exit("the notes name tests that are not there: make them anew")
    return ended not in (0, NO_TESTS, *fine)


def _run(tests: list[str], bench: Bench, *words: str) -> int:
    """What pytest ends with, or that it did not end in time."""
    run = subprocess.Popen(
        [*_pytest(), *FAST, *words, *tests], cwd=bench.copy, env=_environment(bench.copy),
        start_new_session=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    resource.prlimit(run.pid, resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))
    try:
        return run.wait(bench.seconds)
    except subprocess.TimeoutExpired:
        return TOO_LONG
    finally:
        _end(run)


def _end(run: subprocess.Popen[bytes]) -> None:
    """End it and what it started, if it is still there."""
    if run.poll() is None:
        os.killpg(run.pid, 9)
        run.wait()


def _pytest() -> list[str]:
    return [sys.executable, "-B", "-m", "pytest"]


def _environment(copy: Path) -> dict[str, str]:
    paths = os.pathsep.join((str(copy), str(copy / "benchmarks")))
    return {**os.environ, "PYTHONPATH": paths, "PYTHONHASHSEED": "0"}


def harmless() -> dict[tuple[str, ...], str]:
    """Judged by hand: file, line, what was there and what was planted -> why nobody can see it."""
    rows = [line.split("\t") for line in HARMLESS.read_text().splitlines() if line[:1] not in "#"]
    return {tuple(key): why for *key, why in rows}


def _alive(outcomes: Iterable[Outcome]) -> list[Outcome]:
    known = harmless()
    return [it for it in outcomes if not it.noticed and _key(it.bug) not in known]


def _key(bug: Bug) -> tuple[str, ...]:
    return bug.file, bug.text, bug.old, bug.new


def _page(outcomes: list[Outcome], options: argparse.Namespace) -> Iterator[str]:
    alive = _alive(outcomes)
    silent = [it for it in outcomes if not it.noticed]
    yield "# Planted bugs\n"
    yield "Made by `python benchmarks/planted_bugs.py --write`, on " + time.strftime("%Y-%m-%d.")
    yield f"Seed {options.seed}: operators, constants, conditions, calls and statements, by chance."
    yield f"For each bug the tests that call its function are run, {MOST_TESTS} at most"
    yield f"{_asked(options)}."
    yield "Bugs that change nothing anybody could see are judged by hand: `fixtures/harmless_bugs.tsv`."
    yield "\n| package | planted | noticed | harmless | survived |\n|---|--:|--:|--:|--:|"
    for room in [*options.rooms, "all"]:
        mine = [it for it in outcomes if room in ("all", it.room)]
        left = [it for it in alive if it in mine]
        quiet = len([it for it in silent if it in mine]) - len(left)
        noticed = len(mine) - quiet - len(left)
        yield f"| {_named(room)} | {len(mine)} | {noticed} | {quiet} | {len(left)} |"
    if alive:
        yield "\nWhat survived:\n"
        yield from (f"- `{it.bug}`" for it in alive)


def _asked(options: argparse.Namespace) -> str:
    if not options.whole:
        return "and no others"
    asked = "" if options.tests == ["tests"] else f" of {', '.join(options.tests)}"
    return f"and, where none of them notices it, the whole fast suite{asked}"


def _named(room: str) -> str:
    return {"all": "**all**", ".": "the other modules"}.get(room, f"`{room}`")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
