# SPDX-License-Identifier: Apache-2.0
"""Measure the rewrite against its floors: ratios of CPU time, all taken in one run.

python benchmarks/bench_rewrite.py                    print the tables
python benchmarks/bench_rewrite.py --write        and put them into docs/contributing/measurements.md
python benchmarks/bench_rewrite.py --files FOLDER     with public URDFs of one's own

Without a folder the public files are those of the corpus beside the repository or, where there is none,
of the description wheels of the tests.
"""

from __future__ import annotations

import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as ET
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path

from lxml import etree
from one_page import write_section
from pairs import HOW, MACHINE, Row, as_installed, child, least_seconds, paired, seconds, table
from public_files import PublicFiles, public_files
from robots import robot

from multibot_rewrite import MultibotError
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.cli.files import write_all
from multibot_rewrite.description import pipeline
from multibot_rewrite.description.library import rewrite_all
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.steps.apply import cut, fill
from multibot_rewrite.description.steps.collect import collect
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.description.steps.plan import make_plan

ATTRIBUTES = {"name", "link", "joint", "reference"}
FLEET = 1000
MORE = 100
# From here on fewer rounds: each is a long one.
LARGE = 1_000_000
NOTE = """
A further robot is what a call for {MORE} more robots costs, for each of them. *Copying the bytes*
puts one text into one place again and again, which is in the processor's cache then: a real copy of
a fleet is slower. *Waited* is time on the wall clock, on a disk that others write to as well; the raw
writes wait for the last file alone, ours for all of them. The figures have the first robot of a fleet
and its verification: a seventh of a thousand robots in memory (tmpfs).

## Goals that are not reached

- **One robot.** Parsing and the offsets of start tags cost 0.9 of the floor, the walk and the
  names 1.05, plan and apply 1.4.
- **One robot, verified.** Verification reads the output twice and compares it (4.7); it is not
  optional.
- **The command.** Importing lxml and our modules is 1.3 of importing lxml.
- **1000 robots in memory.** A robot is one `bytes.join`, some 4 ns for each place of the robot's
  name.
"""


def unproved(source: bytes) -> bytes:
    """One robot without the proof: document, collect, plan, apply."""
    naming, tree = make_naming(), builtin_tree((), NEWEST_LTS)
    inventory = collect(read_document(source, "robot"), tree)
    return fill(cut(source, make_plan(inventory, naming).edits), "robot1")


def proved(source: bytes) -> bytes:
    """One robot as the library makes it: unclaimed mentions looked for, result proved."""
    return next(rewrite_all(source, ["robot1"])).data


def element_tree(source: bytes) -> bytes:
    """The loop people write by hand; it renames less and loses comments."""
    root = ET.fromstring(source)
    for element in root.iter():
        for key in ATTRIBUTES & element.attrib.keys():
            element.set(key, element.get(key, "") + "/robot1")
    return ET.tostring(root)


def floor(source: bytes) -> bytes:
    """What any program that reads and writes XML does."""
    return etree.tostring(etree.fromstring(source))


def expanded(source: bytes) -> str:
    """What xacro makes of it: it has nothing to expand."""
    import xacro

    with tempfile.NamedTemporaryFile(suffix=".xacro") as file:
        file.write(source)
        file.flush()
        return str(xacro.process_file(file.name).toprettyxml())


def size(source: bytes) -> str:
    """In the words of the table."""
    return f"{len(source) / 1000:.0f} kB" if len(source) < 1e6 else f"{len(source) / 1e6:.1f} MB"


def in_process(source: bytes) -> list[Row]:
    """One robot and further robots, against lxml's parse and serialize of the same bytes."""
    name, least = f"lxml parse + serialize, {size(source)}", partial(floor, source)
    jobs = unproved, proved, element_tree, expanded
    runs = 30 if len(source) < LARGE else 3
    bare, ours, trees, xacro, once = least_seconds(
        *(partial(it, source) for it in jobs), least, runs=runs
    )
    return [
        Row("one robot, without verification", name, bare / once, "1.7"),
        Row("one robot, verified", name, ours / once, "9"),
        Row("each further robot", name, further(source, runs), "0.01"),
        Row("ElementTree rename loop", name, trees / once, ""),
        Row("xacro API", name, xacro / once, ""),
    ]


def further(source: bytes, runs: int) -> float:
    """What each further robot of a call costs, against the floor."""
    (least,) = least_seconds(partial(floor, source), runs=runs)
    return min(_behind_the_first(source) for _ in range(runs)) / MORE / least


def _behind_the_first(source: bytes) -> float:
    """CPU seconds of a call's other robots."""
    rewrites = rewrite_all(source, [f"robot{number}" for number in range(1 + MORE)])
    next(rewrites)
    return seconds(partial(deque, rewrites, maxlen=0))


def in_public(public: PublicFiles) -> list[Row]:
    """One robot of each public file; a refusal of one counts like a rewrite.

    The least is taken of each file, since a pass over all of them is too long to be undisturbed; a
    file comes again only after all others, as files of other people do.
    """

    def tried(job: Callable[[bytes], object], source: bytes) -> None:
        with suppress(MultibotError, etree.XMLSyntaxError):
            job(source)

    def all_files(job: Callable[[bytes], object]) -> list[float]:
        return [seconds(partial(tried, job, source)) for source in public.files]

    jobs = proved, unproved, floor
    rounds = [[all_files(job) for job in jobs] for _ in range(8)]
    ours, bare, least = (
        sum(map(min, zip(*passes, strict=True))) for passes in zip(*rounds, strict=True)
    )
    name = f"lxml parse + serialize, {public}"
    return [
        Row("one robot, without verification", name, bare / least, ""),
        Row("one robot, verified", name, ours / least, "12"),
    ]


def in_memory(source: bytes) -> Row:
    """A thousand robots in memory against as many copies."""
    robots = [f"robot{number}" for number in range(FLEET)]
    pieces = pipeline.prepare(source, "robot", make_naming(), builtin_tree((), NEWEST_LTS)).pieces
    place, output = bytearray(source), fill(pieces, robots[0])

    def copy() -> None:
        for _ in robots:
            place[:] = output

    def ours() -> None:
        for name in robots:
            fill(pieces, name)

    what = f"{FLEET} robots of {size(source)} in memory"
    return Row(what, "copying the bytes", paired(ours, copy, 5), "1.5")


@contextmanager
def fresh_folders(where: str) -> Iterator[Callable[[], str]]:
    """Makes an empty folder for each call; those before it are gone, and their bytes off the way."""
    with tempfile.TemporaryDirectory(dir=where) as home:
        last = [tempfile.mkdtemp(dir=home)]

        def fresh() -> str:
            shutil.rmtree(last.pop())
            os.sync()
            last.append(tempfile.mkdtemp(dir=home))
            return last[0]

        yield fresh


def to_files(source: bytes, where: str, what: str) -> list[Row]:
    """A thousand robots to files, against writes of the same bytes and one fsync at the end."""
    robots = [f"robot{number}" for number in range(FLEET)]
    output = next(rewrite_all(source, robots)).data

    def ours(folder: str) -> None:
        write_all((f"{folder}/{it.robot}.urdf", it.data) for it in rewrite_all(source, robots))

    def raw(folder: str) -> None:
        for name in robots:
            handle = os.open(f"{folder}/{name}.urdf", os.O_WRONLY | os.O_CREAT)
            os.write(handle, output)
            if name == robots[-1]:
                os.fsync(handle)
            os.close(handle)

    with fresh_folders(where) as fresh:
        rounds = [[_cost(job, fresh()) for job in (ours, raw)] for _ in range(5)]
    cpu, wall = ([min(column) for column in zip(*it, strict=True)] for it in _turned(rounds))
    what, against = f"{FLEET} robots of {size(source)} to {what}", "raw writes, one fsync"
    return [
        Row(what, against, cpu[0] / cpu[1], "2"),
        Row(f"{what}, waited", against, wall[0] / wall[1], ""),
    ]


def _cost(job: Callable[[str], None], folder: str) -> tuple[float, float]:
    """CPU seconds and seconds waited."""
    cpu, wall = time.process_time(), time.perf_counter()
    job(folder)
    return time.process_time() - cpu, time.perf_counter() - wall


def _turned(rounds: list[list[tuple[float, float]]]) -> Iterator[list[list[float]]]:
    """The same by kind of cost, then by round."""
    for kind in (0, 1):
        yield [[cost[kind] for cost in row] for row in rounds]


def growth() -> Row:
    """Cost per byte of a 1,000-link robot against a 50-link one."""
    small, large = robot(50), robot(1000)
    ratio = paired(partial(proved, large), partial(proved, small), 5) / (len(large) / len(small))
    return Row(f"cost per byte at {size(large)}", f"at {size(small)}", ratio, "1 is linear")


def command(source: bytes) -> list[Row]:
    """The whole command and its peak memory, against importing lxml."""
    with tempfile.TemporaryDirectory() as folder:
        path = f"{folder}/robot.urdf"
        Path(path).write_bytes(source)
        program = f"{os.path.dirname(sys.executable)}/urdf-postfix"
        ours = [program, path, "robot1", "-o", f"{path}.out"]
        lxml = [sys.executable, "-c", "import lxml.etree"]
        ratio = paired(partial(child, ours), partial(child, lxml), 15)
        memory = statistics.median(peak(ours) for _ in range(3))
    return [
        Row(f"urdf-postfix, {size(source)}", "python -c 'import lxml.etree'", ratio, "3"),
        Row(f"urdf-postfix, {size(source)}, peak memory", "MiB", memory, "25"),
    ]


def peak(arguments: list[str]) -> float:
    """Peak memory of a process in MiB, taken by a small parent: a child starts with its parent's."""
    code = (
        "import os, sys; pid = os.posix_spawn(sys.argv[1], sys.argv[1:], os.environ);"
        "print(os.wait4(pid, 0)[2].ru_maxrss / 1024)"
    )
    python = [sys.executable, "-S", "-c", code, *arguments]
    result = subprocess.run(python, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True)
    return float(result.stdout)


def rows(public: PublicFiles) -> Iterator[Row]:
    """All measurements."""
    files, medium, large = robot(50), robot(78), robot(1000)
    for source in (robot(13), medium, large):
        yield from in_process(source)
    yield from in_public(public)
    yield growth()
    yield in_memory(files)
    yield from to_files(files, tempfile.gettempdir(), "the disk")
    yield from to_files(files, "/dev/shm", "memory (tmpfs)") if os.path.isdir("/dev/shm") else ()
    yield from command(medium)


def main(arguments: list[str]) -> None:
    """Run everything, print the table, write it where asked."""
    public = public_files(arguments)
    with as_installed():
        text = table(rows(public))
    print(text)
    if "--write" in arguments:
        made = f"Made by `python benchmarks/bench_rewrite.py --write` in one run: {HOW}."
        where = f"{MACHINE}, lxml {etree.__version__}. Public files: {public.source}."
        note = NOTE.format(FLEET=FLEET, MORE=MORE)
        write_section(f"# Benchmark of the rewrite\n\n{made}\n{where}\n\n{text}{note}")


if __name__ == "__main__":
    main(sys.argv[1:])
