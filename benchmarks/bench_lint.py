"""Measure the lint against its floor and other linters: ratios and files a second, in one run.

python benchmarks/bench_lint.py            print the tables
python benchmarks/bench_lint.py --write    and put them into docs/benchmark-lint.md

check_urdf (liburdfdom-tools), urdf_validate (pip install urdf-validator) and simcheck are measured
where they are on the PATH.
"""

from __future__ import annotations

import os
import platform
import shutil
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple
from xml.parsers.expat import ParserCreate

from lxml import etree
from pairs import Job, Row, child, paired, seconds, table
from robots import robot

from multibot_rewrite.lint.check import lint_data
from multibot_rewrite.lint.settings import Settings

PAGE = Path(__file__).parent.parent / "docs" / "benchmark-lint.md"
FILES = 1000
LINT = os.path.join(os.path.dirname(sys.executable), "urdf-lint")


class Peer(NamedTuple):
    """Another linter: how it is called for some files, and how many of them it is given."""

    name: str
    calls: Callable[[str, list[str]], list[list[str]]]
    files: int
    codes: tuple[int, ...]


def one_by_one(path: str, files: list[str]) -> list[list[str]]:
    """A process a file: it takes no more."""
    return [[path, file] for file in files]


def at_once(path: str, files: list[str]) -> list[list[str]]:
    """simcheck checks a list of files in one call."""
    return [[path, "check", *files]]


PEERS = (
    Peer("check_urdf", one_by_one, FILES, ()),
    Peer("urdf_validate", one_by_one, 20, (1, 2)),
    Peer("simcheck", at_once, 20, (1, 2)),
)


def floor(source: bytes) -> int:
    """Every start tag with its line, and the names that joints refer to: the least a lint can do."""
    tags: list[tuple[str, int, dict[str, str]]] = []
    parser = ParserCreate()
    parser.StartElementHandler = lambda tag, attributes: tags.append(
        (tag, parser.CurrentLineNumber, attributes)
    )
    parser.Parse(source, True)
    links = {attributes.get("name") for tag, _, attributes in tags if tag == "link"}
    return sum(a.get("link") not in links for tag, _, a in tags if tag in ("parent", "child"))


def in_process(source: bytes) -> Row:
    """One file, all rules."""
    what = f"one file of {len(source) / 1000:.0f} kB, in process"
    job: Job = lambda: lint_data("robot.urdf", source, Settings())  # noqa: E731
    return Row(what, "expat with line numbers", paired(job, lambda: floor(source), 41), "3")


def command(source: bytes) -> Row:
    """One file, the command."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "robot.urdf")
        Path(path).write_bytes(source)
        lxml = [sys.executable, "-c", "import lxml.etree"]
        ratio = paired(lambda: child([LINT, path], 1), lambda: child(lxml), 25)
    what = f"urdf-lint, one file of {len(source) / 1000:.0f} kB"
    return Row(what, "python -c 'import lxml.etree'", ratio, "1.5")


def throughput(source: bytes) -> str:
    """Files a second of every linter that is there, on copies of one file."""
    lines = ["| linter | files | files a second |", "|---|--:|--:|"]
    with tempfile.TemporaryDirectory() as folder:
        files = [os.path.join(folder, f"robot{number}.urdf") for number in range(FILES)]
        for file in files:
            Path(file).write_bytes(source)
        lines.append(_rate("urdf-lint", FILES, lambda: child([LINT, folder], 1)))
        lines.append(
            _rate("urdf-lint --jobs 1", FILES, lambda: child([LINT, folder, "--jobs", "1"], 1))
        )
        lines += [_peer(it, files[: it.files]) for it in PEERS]
    return "\n".join(lines) + "\n"


def _peer(peer: Peer, files: list[str]) -> str:
    path = shutil.which(peer.name)
    if path is None:
        return f"| {peer.name} | not installed | |"

    def run() -> None:
        for call in peer.calls(path, files):
            child(call, *peer.codes)

    return _rate(peer.name, len(files), run)


def _rate(name: str, files: int, job: Job) -> str:
    return f"| {name} | {files} | {files / seconds(job):.3g} |"


def main() -> None:
    """Run everything, print the tables, write them where asked."""
    medium, small = robot(78), robot(20)
    text = table([in_process(medium), in_process(robot(1000)), command(medium)])
    text += f"\nCopies of a file of {len(small) / 1000:.0f} kB:\n\n{throughput(small)}"
    print(text)
    if "--write" in sys.argv:
        where = (
            f"CPython {platform.python_version()}, lxml {etree.__version__}, {os.cpu_count()} cores"
        )
        how = "python benchmarks/bench_lint.py --write"
        made = f"Made by `{how}` in one run: medians of pairwise ratios, lower is better."
        noise = "a shared machine, so a digit more or less is noise"
        PAGE.write_text(f"# Benchmark of the lint\n\n{made}\n{where}; {noise}.\n\n{text}")


if __name__ == "__main__":
    main()
