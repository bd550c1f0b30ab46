# SPDX-License-Identifier: Apache-2.0
"""``python -m tools.strangers FOLDER``: what a new user would get with public robots.

FOLDER has a checkout of each repository of ``strangers.tsv``, called owner+name, at the branch that is
called as its release where there is one. Each is given to
``multibot init``, what that wrote to ``multibot build``, and the built folder to the drive test, with
ROS_DISTRO as the repository's users have it. Printed is a table; times are those of the processor.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
import threading
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import IO, NamedTuple

LIST = Path(__file__).with_name("strangers.tsv")
DRIVE = Path(__file__).parents[1] / "tests" / "drive"
MULTIBOT = (sys.executable, "-m", "multibot_rewrite.cli.multibot")
# What stands for a release that is no longer kept, or where the repository names none.
RELEASE = {"foxy": "humble", "galactic": "humble", "iron": "humble", "-": "jazzy"}
# How a question which file is meant ends: a user names the one that is meant.
_NAMED = re.compile(r"name one: multibot init (.+)")
# Questions after each other that are answered.
_QUESTIONS = 4
# Where compiled modules are kept from run to run.
COMPILED = os.path.join(tempfile.gettempdir(), "multibot_strangers_compiled")
# Seconds after which a command is ended.
PATIENCE = 1800
# Letters of a reason in the table.
LONGEST = 200


class Stranger(NamedTuple):
    """A repository of the list; ``half`` is the part of the list that it is of."""

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
    """Return the repositories of the list."""
    lines = [it for it in path.read_text().splitlines() if not it.startswith("#")]
    return [Stranger(*it.split("\t")) for it in lines[1:]]


def tried(it: Stranger, checkout: Path, folder: Path) -> Row:
    """Init, build and drive one repository; everything is written below ``folder``. Where init asks
    which robot or file is meant, the first that it names is."""
    folder.mkdir(parents=True, exist_ok=True)
    fleet, release = folder / "fleet.yaml", RELEASE.get(it.release, it.release)
    words = ["-n", "2", "--yes", "--force", "-o", str(fleet)]
    made = run([*MULTIBOT, "init", str(checkout), *words], release)
    first, asked = made.seconds, ""
    for _ in range(_QUESTIONS):
        named = _NAMED.search(made.err)
        if named is None:
            break
        what = "robot" if "descriptions" in made.err else "file"
        asked += f"asks which {what}; the first: "
        made = run([*MULTIBOT, "init", *shlex.split(named[1]), *words], release)
    row = _built(it, made, fleet, release, checkout)
    return row._replace(word=f"{asked}{row.word}", init=first)


def _built(it: Stranger, made: Ran, fleet: Path, release: str, checkout: Path) -> Row:
    """Build what init has written, and drive it."""
    if made.code:
        return Row(it, _word(made, "init"), _first(made), made.seconds, 0.0)
    out = fleet.parent / "out"
    built = run([*MULTIBOT, "build", str(fleet), "-o", str(out), "--force"], release)
    if built.code:
        return Row(it, _word(built, "build"), _first(built), made.seconds, built.seconds)
    driven = run([sys.executable, str(DRIVE), str(out), "--json"], release)
    word, why = _driven(driven, built.err + built.out)
    return Row(it, word, _with_owners(why, checkout), made.seconds, built.seconds)


def run(command: Sequence[str], release: str) -> Ran:
    """Run a command without a terminal."""
    # An installed package has its modules compiled.
    compiled = {"PYTHONPYCACHEPREFIX": COMPILED, "PYTHONDONTWRITEBYTECODE": ""}
    environ = {**os.environ, **compiled, "ROS_DISTRO": release}
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err:
        child = subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=out, stderr=err, env=environ
        )
        end = threading.Timer(PATIENCE, child.kill)
        end.start()
        # The time of this process alone, whatever else runs.
        _, status, spent = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        end.cancel()
        said, faults = (_text(it) for it in (out, err))
    return Ran(child.returncode, said, faults, spent.ru_utime + spent.ru_stime)


def _text(file: IO[str]) -> str:
    file.seek(0)
    return file.read()


def _word(it: Ran, command: str) -> str:
    """Exit code 2 is an answer, 1 a fleet that does not build; anything else is a fault of ours."""
    words = {1: f"{command}: does not build", 2: f"{command}: says what is missing"}
    return words.get(it.code, f"{command}: broke")


def _first(it: Ran) -> str:
    """Return the first line that says an error, else the last one that was said."""
    lines = [line for line in (it.err + it.out).splitlines() if line.strip()]
    errors = (line for line in lines if " error" in line or "does not build" in line)
    return next(errors, lines[-1] if lines else "")


def _driven(it: Ran, told: str) -> tuple[str, str]:
    """Return the word and why: what is wrong was told by the build (``told``), or it is silent."""
    try:
        found = json.loads(it.out)
    except json.JSONDecodeError:
        return "drive: not judged", _first(it)
    does: dict[str, str] = next(iter(found["robots"].values()), {})
    silent = [each for each in found["wrong"] if not _is_told(each["why"], told)]
    if found["wrong"]:
        shown = (silent or found["wrong"])[:2]
        why = "; ".join(f"{each['robot']} {each['what']}: {each['why']}" for each in shown)
        return ("drive: wrong in silence" if silent else "drive: the build says what is wrong"), why
    unknown = next((said for said in does.values() if "unknown" in said), "")
    yes = ", ".join(what for what, said in does.items() if said == "yes")
    return _unread(unknown, told) if unknown else (f"yes: {yes}", "")


def _unread(unknown: str, told: str) -> tuple[str, str]:
    """Return what nobody has read: the build says each by its name, or not."""
    names = unknown.removeprefix("unknown: ").split(", ")
    silent = [it for it in names if it.rpartition(" ")[2] not in told]
    return ("drive: unknown" if silent else "drive: the build says what is not known"), unknown


def _with_owners(why: str, checkout: Path) -> str:
    """Return what nobody has read, each with the package of the checkout that has its sources."""
    if not why.startswith("unknown: "):
        return why
    return ", ".join(f"{it} ({_owner(it, checkout)})" for it in why[len("unknown: ") :].split(", "))


def _owner(name: str, checkout: Path) -> str:
    """Return the package whose CMakeLists.txt builds a library, or whose XML exports a class."""
    words = name.removeprefix("lib").removesuffix(".so")
    for pattern in ("CMakeLists.txt", "*.xml", "setup.py"):
        for file in sorted(checkout.rglob(pattern)):
            if file.is_file() and words in file.read_text(errors="replace"):
                return f"of {_package(file.parent, checkout)}"
    return "of no package here"


def _package(folder: Path, checkout: Path) -> str:
    above = [folder, *folder.parents]
    has = (it for it in above if (it / "package.xml").is_file() or it == checkout)
    return next(has, checkout).name


def _is_told(why: str, told: str) -> bool:
    """Return whether the build names the topic, controller or frame that this is about, as a
    whole word. The name of the node that reads or sends it does not count."""
    if " has no type for " in why and "it makes no controller_manager" in told:
        return True
    if re.search(" moves |two nodes are called", why) and "has parameters of ROS 1" in told:
        return True
    if " looks for " in why:
        node = why.partition(" ")[0].rpartition("/")[2]
        return any(node in line and "frame" in line for line in told.splitlines())
    about = re.sub(r"^/\S+ |\b\w+/msg/\w+", "", why)
    names = re.findall(r"/?[\w/]*[/_]\w+|(?<=ROS 2 has )\w+", about)
    bare = {re.sub(r"^/?robot\d+/", "", name).lstrip("/") for name in names}
    words = {word.strip("/") for word in re.findall(r"[\w/]+", told)}
    said = {re.sub(r"^robot\d+/", "", word) for word in words}
    # That a topic of tf is named somewhere says nothing of a frame.
    return not said.isdisjoint(bare - {"", "robot1", "robot2", "tf", "tf_static"})


def short(why: str, it: Stranger) -> str:
    """Return a reason without the place of the checkout, and no longer than a table takes."""
    place = re.sub(rf"\S*/{re.escape(it.name.replace('/', '+'))}(/|: )", "", why)
    plain = place.removeprefix("multibot: ")
    return plain if len(plain) <= LONGEST else f"{plain[: LONGEST - 3]}..."


def _table(rows: Sequence[Row]) -> Iterator[str]:
    yield "| repository | kind | happened | why | init, build (s) |"
    yield "|---|---|---|---|--:|"
    for it in rows:
        why = short(it.why, it.stranger).replace("|", "\\|")
        times = f"{it.init:.1f}, {it.build:.1f}"
        yield f"| {it.stranger.name} | {it.stranger.kind} | {it.word} | {why} | {times} |"


def _noted(it: Row) -> Row:
    print(it.word, it.why, it.stranger.name, sep="\t", file=sys.stderr, flush=True)
    return it


def main(words: Sequence[str]) -> int:
    """Run those that were asked for; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument(
        "--half", choices=dict.fromkeys(it.half for it in strangers()), default="work"
    )
    parser.add_argument("--only", default="", help="a part of the names")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--keep", type=Path, help="where to write fleets and folders")
    given = parser.parse_args(words)
    chosen = [it for it in strangers() if it.half == given.half and given.only in it.name]
    with tempfile.TemporaryDirectory() as scratch:
        kept = given.keep or Path(scratch)
        places = [it.name.replace("/", "+") for it in chosen]
        folders = [(given.folder / it, (kept / it).resolve()) for it in places]
        with ThreadPoolExecutor(given.jobs) as pool:
            rows = list(pool.map(lambda it, two: _noted(tried(it, *two)), chosen, folders))
    print(*_table(rows), sep=os.linesep)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
