"""``python -m tools.strangers FOLDER``: what a new user would get with public robots.

FOLDER has a checkout of each repository of ``strangers.tsv``, called owner+name. Each is given to
``multibot init``, what that wrote to ``multibot build``, and the built folder to the drive test, with
ROS_DISTRO as the repository's users have it. Printed is a table; times are those of the processor.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

LIST = Path(__file__).with_name("strangers.tsv")
DRIVE = Path(__file__).parents[1] / "tests" / "drive"
MULTIBOT = (sys.executable, "-m", "multibot_rewrite.cli.multibot")
# What stands for a release that is no longer kept, or where the repository names none.
RELEASE = {"foxy": "humble", "galactic": "humble", "iron": "humble", "-": "jazzy"}
# Seconds after which a command is ended.
PATIENCE = 300


class Stranger(NamedTuple):
    """A repository of the list; ``half`` is "work" or "last"."""

    name: str
    kind: str
    formats: str
    release: str
    half: str


class Ran(NamedTuple):
    """A command that was run: its exit code, what it printed, seconds."""

    code: int
    out: str
    err: str
    seconds: float


class Row(NamedTuple):
    """What happened: how far it came ("init", "build", "drive"), the word for it, why, seconds of init
    and of build."""

    stranger: Stranger
    word: str
    why: str
    init: float
    build: float


def strangers(path: Path = LIST) -> list[Stranger]:
    """The repositories of the list."""
    lines = [it for it in path.read_text().splitlines() if not it.startswith("#")]
    return [Stranger(*it.split("\t")) for it in lines[1:]]


def tried(it: Stranger, checkout: Path, folder: Path) -> Row:
    """Init, build and drive one repository; everything is written below ``folder``."""
    folder.mkdir(parents=True, exist_ok=True)
    fleet, out = folder / "fleet.yaml", folder / "out"
    release = RELEASE.get(it.release, it.release)
    made = run(
        [*MULTIBOT, "init", str(checkout), "-n", "2", "--yes", "--force", "-o", str(fleet)], release
    )
    if made.code:
        return Row(it, _word(made, "init"), _first(made), made.seconds, 0.0)
    built = run([*MULTIBOT, "build", str(fleet), "-o", str(out), "--force"], release)
    if built.code:
        return Row(it, _word(built, "build"), _first(built), made.seconds, built.seconds)
    driven = run([sys.executable, str(DRIVE), str(out), "--json"], release)
    return Row(it, *_driven(driven), made.seconds, built.seconds)


def run(command: Sequence[str], release: str) -> Ran:
    """Run a command without a terminal."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    environ = {**os.environ, "ROS_DISTRO": release}
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=PATIENCE, stdin=subprocess.DEVNULL,
            check=False, env=environ,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        return Ran(-1, "", f"it took more than {PATIENCE} seconds", PATIENCE)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return Ran(done.returncode, done.stdout, done.stderr, spent)


def _word(it: Ran, command: str) -> str:
    """Exit code 2 is an answer, 1 a fleet that does not build; anything else is a fault of ours."""
    words = {1: f"{command}: does not build", 2: f"{command}: asks"}
    return words.get(it.code, f"{command}: broke")


def _first(it: Ran) -> str:
    """The first line that says an error, else the last one that was said."""
    lines = [line for line in (it.err + it.out).splitlines() if line.strip()]
    errors = (line for line in lines if " error" in line or "does not build" in line)
    return next(errors, lines[-1] if lines else "")


def _driven(it: Ran) -> tuple[str, str]:
    try:
        found = json.loads(it.out)
    except json.JSONDecodeError:
        return "drive: not judged", _first(it)
    does: dict[str, str] = next(iter(found["robots"].values()), {})
    why = "; ".join(f"{each['robot']} {each['what']}: {each['why']}" for each in found["wrong"][:2])
    unknown = "; ".join(f"{what} {said}" for what, said in does.items() if "unknown" in said)
    yes = ", ".join(what for what, said in does.items() if said == "yes")
    if found["wrong"]:
        return "drive: wrong", why
    return ("drive: unknown", unknown) if unknown else (f"yes: {yes}", "")


def _table(rows: Sequence[Row]) -> Iterator[str]:
    yield "| repository | kind | happened | why | init, build (s) |"
    yield "|---|---|---|---|--:|"
    for it in rows:
        why = it.why.replace("|", "\\|")
        times = f"{it.init:.1f}, {it.build:.1f}"
        yield f"| {it.stranger.name} | {it.stranger.kind} | {it.word} | {why} | {times} |"


def main(words: Sequence[str]) -> int:
    """Run those that were asked for; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--half", choices=("work", "last"), default="work")
    parser.add_argument("--only", default="", help="a part of the names")
    parser.add_argument("--keep", type=Path, help="where to write fleets and folders")
    given = parser.parse_args(words)
    chosen = [it for it in strangers() if it.half == given.half and given.only in it.name]
    with tempfile.TemporaryDirectory() as scratch:
        kept = given.keep or Path(scratch)
        places = [it.name.replace("/", "+") for it in chosen]
        pairs = zip(chosen, places, strict=True)
        rows = []
        for it, place in pairs:
            rows.append(tried(it, given.folder / place, (kept / place).resolve()))
            print(*rows[-1][1:3], it.name, sep="\t", file=sys.stderr, flush=True)
    print(*_table(rows), sep=os.linesep)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
