"""Measure the rewrite against its floor: ratios, all taken in pairs in one run.

python benchmarks/bench_rewrite.py            print the table
python benchmarks/bench_rewrite.py --write    and put it into docs/benchmark.md
"""

from __future__ import annotations

import os
import platform
import statistics
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ET
from pathlib import Path

from lxml import etree
from pairs import Row, child, paired, table
from robots import robot

from multibot_rewrite import pipeline
from multibot_rewrite.cli.files import write_all
from multibot_rewrite.library import rewrite_all
from multibot_rewrite.naming import make_naming
from multibot_rewrite.rewriters.builtin import builtin_tree
from multibot_rewrite.steps.apply import cut, fill
from multibot_rewrite.steps.collect import collect
from multibot_rewrite.steps.document import read_document
from multibot_rewrite.steps.plan import make_plan

PAGE = Path(__file__).parent.parent / "docs" / "benchmark.md"
ATTRIBUTES = {"name", "link", "joint", "reference"}
FLEET = 1000
NOTE = """
## Goals that are not reached

- **One robot.** Parsing costs 0.55 of the floor, start-tag offsets 0.3, walking the tree beside the
  vocabulary 0.6: with lxml's tree and one Python object a name, plan and apply would have 0.2 left for
  hundreds of names. They take about 1.2. A loop that merges the steps measured no faster.
- **The command.** Importing lxml and our modules is 1.3 of importing lxml; the rewrite and its proof
  are the rest.
- **A further robot at 2 MB** is one `bytes.join` of some 20,000 pieces; at 75 kB it is about its goal.

The proof reads, walks and strips the output anew, so it costs more than the rewrite. It is not
optional.
"""


def unproved(source: bytes) -> bytes:
    """One robot without the proof: document, collect, plan, apply."""
    naming, tree = make_naming(), builtin_tree()
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


def in_process(source: bytes, size: str) -> list[Row]:
    """One robot and further robots, against lxml's parse and serialize of the same bytes."""
    import xacro

    def floor() -> bytes:
        return etree.tostring(etree.fromstring(source))

    def expand() -> str:
        with tempfile.NamedTemporaryFile(suffix=".xacro") as file:
            file.write(source)
            file.flush()
            return str(xacro.process_file(file.name).toprettyxml())

    template = pipeline.prepare(source, "robot", make_naming(), builtin_tree())
    name = f"lxml parse + serialize, {size}"
    return [
        Row("one robot, without the proof", name, paired(lambda: unproved(source), floor), "1.7"),
        Row("one robot, proved", name, paired(lambda: proved(source), floor), ""),
        Row("each further robot", name, paired(lambda: fill(template.pieces, "r2"), floor), "0.01"),
        Row("ElementTree rename loop", name, paired(lambda: element_tree(source), floor), ""),
        Row("xacro API", name, paired(expand, floor, 3), ""),
    ]


def fleet(source: bytes) -> list[Row]:
    """A thousand robots in memory and on a memory file system."""
    robots = [f"robot{number}" for number in range(FLEET)]
    template = pipeline.prepare(source, "robot", make_naming(), builtin_tree())
    pieces = template.pieces
    copies = [bytearray(source) for _ in range(2)]

    def copy() -> None:
        for _ in robots:
            copies[0][:] = source

    def memory() -> None:
        for name in robots:
            fill(pieces, name)

    where = "/dev/shm" if os.path.isdir("/dev/shm") else None
    with tempfile.TemporaryDirectory(dir=where) as folder:

        def ours() -> None:
            fresh = tempfile.mkdtemp(dir=folder)
            items = ((r.robot, r.data) for r in rewrite_all(source, robots))
            write_all((f"{fresh}/{name}.urdf", data) for name, data in items)

        output = fill(pieces, "robot1")

        def raw() -> None:
            fresh = tempfile.mkdtemp(dir=folder)
            for name in robots:
                handle = os.open(f"{fresh}/{name}.urdf", os.O_WRONLY | os.O_CREAT)
                os.write(handle, output)
                os.close(handle)

        files = paired(ours, raw, 5)
    return [
        Row(f"{FLEET} robots in memory", "copying the bytes", paired(memory, copy, 5), "4"),
        Row(f"{FLEET} robots to files", "raw writes, same folder", files, "1.6"),
    ]


def growth() -> Row:
    """Cost per byte of a 1,000-link robot against a 50-link one."""
    small, large = robot(50), robot(1000)
    ratio = paired(lambda: proved(large), lambda: proved(small), 5) / (len(large) / len(small))
    return Row(f"cost per byte at {len(large) / 1e6:.1f} MB", "at 0.1 MB", ratio, "1 is linear")


def command(source: bytes) -> list[Row]:
    """The whole command, wall time and peak memory, against importing lxml."""
    folder = tempfile.mkdtemp()
    path = f"{folder}/robot.urdf"
    Path(path).write_bytes(source)
    ours = [f"{os.path.dirname(sys.executable)}/urdf-postfix", path, "robot1", "-o", f"{path}.out"]
    lxml = [sys.executable, "-c", "import lxml.etree"]
    ratio = paired(lambda: child(ours), lambda: child(lxml), 25)
    memory = statistics.median(peak(ours) for _ in range(3))
    size = f"{len(source) / 1000:.0f} kB"
    return [
        Row(f"urdf-postfix, {size}, wall", "python -c 'import lxml.etree'", ratio, "1.3"),
        Row(f"urdf-postfix, {size}, peak memory", "MiB", memory, "25"),
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


def main() -> None:
    """Run everything, print the table, write it where asked."""
    medium = robot(50)
    rows = [*in_process(medium, f"{len(medium) / 1000:.0f} kB"), *in_process(robot(1000), "2 MB")]
    rows += [*fleet(medium), growth(), *command(medium)]
    text = table(rows)
    print(text)
    if "--write" in sys.argv:
        where = (
            f"CPython {platform.python_version()}, lxml {etree.__version__}, {os.cpu_count()} cores"
        )
        how = "python benchmarks/bench_rewrite.py --write"
        PAGE.write_text(
            f"# Benchmark\n\nMade by `{how}` in one run: medians of pairwise ratios, lower is better."
            f"\n{where}; a shared machine, so a digit more or less is noise.\n\n{text}{NOTE}"
        )


if __name__ == "__main__":
    main()
