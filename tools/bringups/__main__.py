# SPDX-License-Identifier: Apache-2.0
"""``python -m tools.bringups FOLDER``: compare what a fleet starts with the vendor's bringup.

FOLDER has a checkout of each repository of ``bringups.tsv``, called owner+name. The bringup is
started with stubs for its programs, and so is the fleet that ``multibot init`` and ``multibot build``
make of the repository. Printed is a table: of the bringup's processes how many start for each robot,
once for all, or not, and what differs. launch and launch_ros come from ROS or from PYTHONPATH;
without them the files are read by the package's stand-in. ``--sources`` are folders with packages
beside the repository's own.
"""

from __future__ import annotations

import argparse
import importlib.util
import json
import os
import re
import shlex
import shutil
import sys
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import yaml

from tools.bringups.choose import (
    Choice,
    chosen,
    launch_files,
    released,
    unfit,
    unread,
    unstarted,
)
from tools.bringups.compare import SHARED, SIMULATORS, Comparison, Match, compare
from tools.bringups.install import copied, install, merge, packages
from tools.bringups.reading import read
from tools.bringups.running import Process, Ran, start
from tools.strangers import MULTIBOT, run

# How a question which file is meant ends.
NAMED = re.compile(r"name one: multibot init (.+)")


class Made(NamedTuple):
    """A fleet that was made: what went wrong, all that was said, seconds of init and build."""

    fault: str = ""
    text: str = ""
    seconds: float = 0.0


class Verdict(NamedTuple):
    """What came out for a repository: the comparison, or why there is none."""

    choice: Choice
    comparison: Comparison
    made: Made

    @property
    def fault(self) -> str:
        """Return why there is no comparison, or what is wrong with it."""
        return self.made.fault

    def of(self, where: str) -> list[Match]:
        """Return the processes of the bringup that are there in a way."""
        return [it for it in self.comparison.matches if it.where == where]

    def named(self, named: bool) -> list[Match]:
        """Return the missing processes that init, build or the fleet file name, or do not name."""
        lost = [*self.of("missing"), *self.of("some")]
        return [it for it in lost if is_named(it.process, self.made.text) == named]


def is_named(process: Process, text: str) -> bool:
    """Return whether a text names the program of a process, or its node."""
    words = {process.program, Path(process.program).name, process.name}
    if Path(process.program).name in SIMULATORS:
        words.add("gzserver")  # as multibot calls what starts one
    if process.program == "spawner" and process.words:
        words = {process.words[0]}
    return any(re.search(rf"(?<!\w){re.escape(it)}(?!\w)", text) for it in words if it)


def ran(file: Path, given: Sequence[str], sources: Sequence[Path], folder: Path) -> Ran:
    """Return what a launch file starts; where launch is not installed, what it would start."""
    if importlib.util.find_spec("launch_ros"):
        return start(file, given, sources, folder)
    return read(file, given, sources)


def found_in(checkout: Path, sources: Sequence[Path], folder: Path) -> str:
    """Return the launch file that starts most of those that may be the bringup."""
    files = list(launch_files(checkout))
    files = [it for it in files if "bringup" in it] or files
    counts = {}
    for it in files:
        one = ran(checkout / it, (), sources, folder)
        counts[it] = 0 if one.fault else len(one.processes)
    best = max(counts, key=lambda it: (counts[it], it), default="")
    return best if counts.get(best) else ""


def judged(choice: Choice, checkout: Path, given: argparse.Namespace, folder: Path) -> Verdict:
    """Start a bringup and the fleet that is made of it, and compare what starts."""
    sources = [checkout, *(it.resolve() for it in given.sources)]
    if choice.file == "-":
        choice = choice._replace(file=found_in(checkout, sources, folder / "one"))
        if not choice.file:
            return Verdict(choice, Comparison((), ()), Made("no launch file of it starts a robot"))
    bringup = ran(checkout / choice.file, choice.arguments, sources, folder / "one")
    if bringup.fault:
        fault = f"the bringup does not start: {bringup.fault}"
        return Verdict(choice, Comparison((), ()), Made(fault))
    without = Comparison(tuple(Match(it, "missing") for it in bringup.processes), ())
    fleet = made(choice, checkout, given, folder)
    file = folder / "out" / "fleet.launch.py"
    if fleet.fault or not file.exists():
        fault = fleet.fault or "build wrote no launch file"
        return Verdict(choice, without, fleet._replace(fault=fault))
    started = ran(file, (), sources, folder / "two")
    rows = yaml.safe_load((folder / "fleet.yaml").read_text())["robots"]
    found = compare(bringup.processes, started.processes, [it["name"] for it in rows])
    fault = started.fault and f"the fleet does not start: {started.fault}"
    return Verdict(choice, found, fleet._replace(fault=fault))


def made(choice: Choice, checkout: Path, given: argparse.Namespace, folder: Path) -> Made:
    """Let multibot make a fleet of a checkout in a folder."""
    command, fleet = shlex.split(given.multibot), folder / "fleet.yaml"
    shutil.rmtree(folder / "out", ignore_errors=True)
    fleet.unlink(missing_ok=True)
    options = ["-n", "2", "--yes", "--force", "-o", str(fleet)]
    known = "--launch" in run([*command, "init", "--help"], choice.release).out
    told = known and not given.found
    launch = ["--launch", str(checkout / choice.file), *choice.arguments] if told else []
    words, text, seconds = [str(checkout), *launch], "", 0.0
    for _ in range(4):
        init = run([*command, "init", *words, *options], choice.release)
        text += init.err + init.out
        seconds += init.seconds
        named = NAMED.search(init.err)
        if named is None:
            break
        words = shlex.split(named[1])
        words += [] if "--launch" in words else launch
    if init.code not in (0, 1) or not fleet.exists():
        return Made(f"init {init.code}: {_last(init.err)}", text, seconds)
    if given.launched and "\nlaunch:" not in fleet.read_text():
        row = shlex.join([str(checkout / choice.file), *choice.arguments])
        with fleet.open("a") as out:
            print(f"launch: [{json.dumps(row)}]\nlaunch_roots: [{checkout}]", file=out)
    last = ["-o", str(folder / "out"), "--force"]
    build = run([*command, "build", str(fleet), *last], choice.release)
    text += fleet.read_text() + build.err + build.out
    (folder / "said.txt").write_text(text)
    fault = f"build {build.code}: {_last(build.err)}" if build.code else ""
    return Made(fault, text, seconds + build.seconds)


def _last(text: str) -> str:
    lines = [it for it in text.splitlines() if it.strip()]
    errors = [it for it in lines if " error" in it]
    return (errors or lines or [""])[-1][:300]


HEAD = (
    "repository",
    "processes",
    "each",
    "differ",
    "once",
    "named",
    "silent",
    "extra",
    "seconds",
    "why not",
)


def table(verdicts: Iterable[Verdict]) -> Iterator[str]:
    """Print a row for each repository, and the sums."""
    yield f"| {' | '.join(HEAD)} |"
    yield f"|---|{'--:|' * (len(HEAD) - 2)}---|"
    sums: dict[str, float] = {}
    for it in verdicts:
        each = it.of("each")
        row = {
            "processes": len(it.comparison.matches),
            "each": len(each),
            "differ": sum(bool(one.differs) for one in each),
            "once": len(it.of("once")),
            "named": len(it.named(True)),
            "silent": len(it.named(False)),
            "extra": len(it.comparison.extra),
            "seconds": round(it.made.seconds, 1),
        }
        sums = {name: round(sums.get(name, 0) + row[name], 1) for name in row}
        cells = [it.choice.name, *map(str, row.values()), it.fault]
        yield f"| {' | '.join(cells)} |"
    whole = (str(sums.get(it, 0)) for it in HEAD[1:-1])
    yield f"| sum | {' | '.join(whole)} | |"


def details(verdict: Verdict) -> Iterator[str]:
    """Print each process of a bringup with where it is, its reason and what differs."""
    yield f"## {verdict.choice.name}: {verdict.choice.file} {' '.join(verdict.choice.arguments)}"
    if verdict.fault:
        yield f"!! {verdict.fault}"
    for it in verdict.comparison.matches:
        where = it.where
        if where in ("missing", "some"):
            where += ", named" if is_named(it.process, verdict.made.text) else ", silent"
        shared = Path(it.process.program).name in SHARED
        if where == "once" and not shared and not is_named(it.process, verdict.made.text):
            where += ", no reason"
        first = f" {it.process.words[0]}" if it.process.program == "spawner" else ""
        yield f"{where:16} {it.process.label}{first}"
        yield from (f"                   - {line}" for line in it.differs)
    for one, count in Counter(it.label for it in verdict.comparison.extra).items():
        yield f"extra            {one} x{count}"


def fits(checkout: Path, known: set[str], folder: Path) -> str:
    """Return why a checkout is not taken into a set by ``bringups.tsv``, or its launch file."""
    if why := unfit(checkout):
        return f"no: {why}"
    file = found_in(checkout, [checkout], folder)
    if not file:
        return "no: no launch file of it starts a process"
    bringup = ran(checkout / file, (), [checkout], folder)
    if why := unstarted(bringup):
        return f"no: {why}"
    why = unread(bringup, known)
    return f"unread: {why}" if why else f"fits: {file}"


def installed(sources: Iterable[Path], prefix: Path) -> Path:
    """Return a prefix with copies of the packages below some folders, as a sourced workspace has them;
    their Python modules are in its folder ``site``."""
    shutil.rmtree(prefix, ignore_errors=True)
    index = prefix.resolve() / "share/ament_index/resource_index/packages"
    index.mkdir(parents=True)
    for source in sources:
        for name, place in packages(source.resolve()).items():
            (index / name).touch()
            install(name, place, prefix.resolve(), copied)
            if (place / name / "__init__.py").is_file():
                merge(place / name, prefix / "site" / name, copied)
    return prefix.resolve()


def main(words: Sequence[str]) -> int:
    """Judge the repositories that were asked for; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument(
        "--half",
        choices=sorted({it.half for it in chosen()}),
        default="work",
    )
    parser.add_argument("--only", nargs="*", default=[""], help="parts of the names")
    parser.add_argument("--sources", type=Path, nargs="*", default=[])
    parser.add_argument("--keep", type=Path, required=True, help="where to write")
    parser.add_argument(
        "--multibot", default=shlex.join(MULTIBOT), help="the command that is judged"
    )
    parser.add_argument(
        "--launched", action="store_true", help="add launch: to a fleet file that has it not"
    )
    parser.add_argument("--found", action="store_true", help="let init find the launch file")
    parser.add_argument(
        "--list", action="store_true", help="list launch files that may be bringups"
    )
    parser.add_argument("--fits", action="store_true", help="say which checkouts fit into a set")
    parser.add_argument("--released", type=Path, help="the distribution.yaml of a release")
    given = parser.parse_args(words)
    if given.fits:
        known = released(given.released)
        for it in sorted(it.resolve() for it in given.folder.iterdir()):
            if any(part in it.name for part in given.only):
                print(it.name, fits(it, known, (given.keep / it.name).resolve()), flush=True)
        return 0
    prefix = installed(given.sources, given.keep / "installed")
    os.environ |= {"AMENT_PREFIX_PATH": str(prefix), "PYTHONPATH": str(prefix / "site")}
    verdicts = []
    half = [it for it in chosen() if it.half == given.half]
    for choice in [it for part in given.only for it in half if part in it.name]:
        checkout = (given.folder / choice.name.replace("/", "+")).resolve()
        if given.list:
            print(choice.name, *launch_files(checkout), sep="\n  ")
            continue
        keep = (given.keep / checkout.name).resolve()
        verdicts.append(judged(choice, checkout, given, keep))
        keep.mkdir(parents=True, exist_ok=True)
        (keep / "details.txt").write_text("\n".join(details(verdicts[-1])) + "\n")
        print(choice.name, verdicts[-1].fault, file=sys.stderr, flush=True)
    print(*table(verdicts), sep="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
