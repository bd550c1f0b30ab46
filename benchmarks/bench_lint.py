# SPDX-License-Identifier: Apache-2.0
"""Measure the lint against its floor and other linters: ratios and files a second, in one run.

python benchmarks/bench_lint.py            print the tables
python benchmarks/bench_lint.py --write    and put them into docs/contributing/measurements.md

check_urdf (liburdfdom-tools), ign (ignition-tools, libsdformat-dev), urdf_validate (pip install
urdf-validator), linkforge (pip install linkforge-core) and simcheck are measured where they are on the
PATH; MULTIBOT_PEERS may name one more folder of programs, that of another environment. Public files
are those of ``--files FOLDER``, else of the corpus beside the repository or the description wheels of
the tests.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import NamedTuple
from xml.parsers.expat import ExpatError, ParserCreate

from lxml import etree
from one_page import write_section
from pairs import HOW, MACHINE, Job, Row, as_installed, child, least_seconds, paired, seconds, table
from public_files import PublicFiles, public_files
from robots import robot

from multibot_rewrite.base.lazy import gc_paused
from multibot_rewrite.lint.check import lint_data
from multibot_rewrite.rules.settings import Settings

FILES = 1000
# Files of which nothing changed.
UNCHANGED = 500
# Of trusted files nothing is kept, and nothing kept is taken.
NO_CACHE = "--trust"
FOLDER = "MULTIBOT_PEERS"
LINT = os.path.join(os.path.dirname(sys.executable), "urdf-lint")


# urdf_validate reads transmissions of one spelling only and refuses the others unread.
_TRANSMISSION = re.compile(rb"  <transmission.*?</transmission>\n", re.DOTALL)
VERSION = "import sys; from importlib.metadata import version; print(version(sys.argv[1]))"
NOTES = """\
The goals in process and of the command are missed.

Half of the time in one process is rules. An unchanged file loads neither lxml nor a rule.
"""


class Peer(NamedTuple):
    """Another linter: how it is called for some files, how many of them it is given, the exit codes
    that are right beside 0, and the call that prints its version; ``program`` is what to look for if
    it is not called so."""

    name: str
    calls: Callable[[str, list[str]], list[list[str]]]
    files: int
    codes: tuple[int, ...]
    version: Callable[[str], list[str]]
    program: str = ""


def one_by_one(path: str, files: list[str]) -> list[list[str]]:
    """Return a process a file: it takes no more."""
    return [[path, file] for file in files]


def converted(path: str, files: list[str]) -> list[list[str]]:
    """libsdformat reads a URDF as Gazebo does, and checks the model."""
    return [[path, "sdf", "-k", file] for file in files]


def validated(path: str, files: list[str]) -> list[list[str]]:
    """linkforge has no command: one process for all files, in the Python that it is installed with."""
    return [[path, "-c", LINKFORGE, *files]]


LINKFORGE = """\
import sys
from pathlib import Path
from linkforge.core.parsers.urdf_parser import URDFParser
from linkforge.core.validation import RobotValidator
for path in sys.argv[1:]:
    RobotValidator().validate(URDFParser().parse(Path(path)))
"""


def at_once(path: str, files: list[str]) -> list[list[str]]:
    """simcheck checks a list of files in one call."""
    return [[path, "check", *files]]


def debian(path: str) -> list[str]:
    """check_urdf does not know its own version."""
    return ["dpkg-query", "-W", "-f", "${Version}", "liburdfdom-tools"]


def sdformat(path: str) -> list[str]:
    """Return the library behind ``ign sdf``."""
    return ["dpkg-query", "-W", "-f", "${Version}", "libsdformat12-12"]


def installed(name: str, path: str) -> list[str]:
    """Asks the Python that a program is installed with."""
    return [os.path.join(os.path.dirname(path), "python"), "-c", VERSION, name]


PEERS = (
    Peer("check_urdf", one_by_one, 200, (), debian),
    Peer("ign", converted, 100, (255,), sdformat),
    Peer("linkforge", validated, 200, (), partial(installed, "linkforge-core"), "python"),
    Peer("urdf_validate", one_by_one, 10, (1,), partial(installed, "urdf-validator")),
    Peer("simcheck", at_once, 3, (1,), partial(installed, "simcheck")),
)


def floor(source: bytes) -> int:
    """Every start tag with its line, and the names that joints refer to: the least a lint can do."""
    with gc_paused():  # as in the lint
        return _loose(source)


def _loose(source: bytes) -> int:
    tags: list[tuple[str, int, dict[str, str]]] = []
    parser = ParserCreate()
    parser.StartElementHandler = lambda tag, attributes: tags.append(
        (tag, parser.CurrentLineNumber, attributes)
    )
    parser.Parse(source, True)
    parser.StartElementHandler = None  # which knows the parser: nothing is left to be collected
    links = {attributes.get("name") for tag, _, attributes in tags if tag == "link"}
    return sum(a.get("link") not in links for tag, _, a in tags if tag in ("parent", "child"))


def in_process(source: bytes) -> Row:
    """One file, all rules."""
    what = f"one file of {len(source) / 1000:.0f} kB, in process"
    ratio = paired(partial(linted, source), partial(floor, source), 31)
    return Row(what, "expat with line numbers", ratio, "4")


def linted(source: bytes) -> None:
    """All rules on one text."""
    lint_data("robot.urdf", source, Settings())


def in_public(public: PublicFiles) -> Row:
    """Every public file, all rules; one that cannot be read counts for both."""

    def each(job: Callable[[bytes], object]) -> None:
        for source in public.files:
            with suppress(ExpatError):
                job(source)

    ours, least = least_seconds(partial(each, linted), partial(each, floor), runs=3)
    return Row(f"{public}, in process", "expat with line numbers", ours / least, "4")


def _files_a_second(public: PublicFiles) -> float:
    def every() -> None:
        for source in public.files:
            linted(source)

    (ours,) = least_seconds(every, runs=3)
    return len(public.files) / ours


def command(source: bytes) -> Row:
    """One file, the command."""
    what = f"urdf-lint, one file of {len(source) / 1000:.0f} kB, nothing kept"
    return _command(what, source, 1, "3", NO_CACHE)


def unchanged(source: bytes, files: int) -> Row:
    """Files that were linted before."""
    size = f"{files} files" if files > 1 else "one file"
    return _command(
        f"urdf-lint, {size} of {len(source) / 1000:.0f} kB, unchanged", source, files, ""
    )


def _command(what: str, source: bytes, files: int, goal: str, *options: str) -> Row:
    with tempfile.TemporaryDirectory() as folder:
        for number in range(files):
            Path(folder, f"robot{number}.urdf").write_bytes(source)
        lint = [LINT, folder, *options]
        lxml = [sys.executable, "-c", "import lxml.etree"]
        # There, as in most packages of ROS, is no pyproject.toml to be read.
        ours, least = partial(child, lint, 1, folder=folder), partial(child, lxml, folder=folder)
        found = paired(ours, least, 25)
    return Row(what, "python -c 'import lxml.etree'", found, goal)


def throughput(source: bytes) -> str:
    """How much every linter that is there does, on copies of one file."""
    lines = ["| linter | files | files a second of CPU |", "|---|--:|--:|"]
    with tempfile.TemporaryDirectory() as folder:
        files = [os.path.join(folder, f"robot{number}.urdf") for number in range(FILES)]
        for file in files:
            Path(file).write_bytes(source)
        lint = ["taskset", "-c", "0", LINT, folder]
        lines.append(_rate("urdf-lint", FILES, lambda: child([*lint, NO_CACHE], 1)))
        child(lint, 1)
        lines.append(_rate("urdf-lint, unchanged files", FILES, lambda: child(lint, 1)))
        lines += [_peer(it, files[: it.files]) for it in PEERS]
    return "\n".join(lines) + "\n"


def _peer(peer: Peer, files: list[str]) -> str:
    places = os.pathsep.join([os.environ.get(FOLDER, ""), os.environ["PATH"]])
    path = shutil.which(peer.program or peer.name, path=places)
    told = path and subprocess.run(peer.version(path), capture_output=True, text=True, check=False)
    if not path or not told or told.returncode:
        return f"| {peer.name} | not installed | |"

    def run() -> None:
        for call in peer.calls(path, files):
            child(call, *peer.codes)

    return _rate(f"{peer.name} {told.stdout.strip()}", len(files), run)


def _rate(name: str, files: int, job: Job) -> str:
    return f"| {name} | {files} | {files / seconds(job):.3g} |"


def report(public: PublicFiles) -> str:
    """All tables."""
    medium, small = robot(78), _TRANSMISSION.sub(b"", robot(20))
    large, every = in_process(robot(1000)), in_public(public)
    again = [unchanged(medium, 1), unchanged(small, UNCHANGED)]
    text = table([in_process(medium), large, every, command(medium), *again])
    rate = f"{_files_a_second(public):.0f} public files a second of CPU in one process (goal: 250)."
    return (
        f"{text}\n{rate}\n\nCopies of a file of {len(small) / 1000:.0f} kB:\n\n{throughput(small)}"
    )


def main(arguments: list[str]) -> None:
    """Run everything, print the tables, write them where asked."""
    public = public_files(arguments)
    with as_installed(), tempfile.TemporaryDirectory() as cache:
        os.environ["XDG_CACHE_HOME"] = cache
        text = report(public)
    print(text)
    if "--write" in arguments:
        made = f"Made by `python benchmarks/bench_lint.py --write` in one run: {HOW}."
        where = f"{MACHINE}, lxml {etree.__version__}. Public files: {public.source}."
        write_section(f"# Benchmark of the lint\n\n{made}\n{where}\n\n{text}\n{NOTES}")


if __name__ == "__main__":
    main(sys.argv[1:])
