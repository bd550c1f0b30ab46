# SPDX-License-Identifier: Apache-2.0
"""Measure how soon an editor is shown the findings of ``urdf-lint --lsp`` after a change.

python benchmarks/bench_lsp.py [FILE...]

A real client types into each file (by default a URDF of 100 kB, an SDF, a xacro and parameters, all
made here), waits for the findings, and types again. It prints seconds: of the first findings after the
file is opened, and of CHANGES changes the median and the slowest. While the findings of the first file
are awaited, the client asks for a hover: the last column is how long that takes.
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median

from robots import robot

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))
from editor import Editor, edited

CHANGES, SIZE, GOAL = 20, 100_000, 0.3
XACRO = """\
<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="base"/>
<xacro:macro name="leg" params="name"><link name="${name}"/><joint name="${name}_j" type="fixed">
<parent link="base"/><child link="${name}"/></joint></xacro:macro>
"""


def main() -> None:
    """Print the figures of the files."""
    with tempfile.TemporaryDirectory() as folder:
        files = [Path(it).resolve() for it in sys.argv[1:]] or made(Path(folder))
        with edited(Path(folder)) as editor:
            # The first start of a process loads the rules.
            print(f"first start {timed(lambda: editor.open(files[0], files[0].read_text())):.3f} s")
            editor.close(files[0])
            print(f"{'file':24}{'kB':>6}{'opened':>9}{'median':>9}{'slowest':>9}{'hover':>9}")
            for path in files:
                print(row(editor, path))


def row(editor: Editor, path: Path) -> str:
    """Return the figures of a file."""
    text = path.read_text()
    opened = timed(lambda: editor.open(path, text))
    each = [timed(lambda at=at: editor.change(path, text + "\n" * at)) for at in range(CHANGES)]
    editor.change(path, text + " ", wait=False)
    hover = timed(lambda: editor.hover(path, text, text[:9].split(" ")[0]))
    editor.close(path)
    late = "" if max(each) <= GOAL else f"  over {GOAL} s"
    times = "".join(f"{it:9.3f}" for it in (opened, median(each), max(each), hover))
    return f"{path.name:24}{len(text) / 1000:6.0f}{times}{late}"


def timed(job: Callable[[], object]) -> float:
    """Return the seconds that a job takes."""
    start = time.perf_counter()
    job()
    return time.perf_counter() - start


def made(folder: Path) -> list[Path]:
    """Return files of about SIZE bytes, apart: descriptions beside parameters are read with them."""
    one = len(robot(100)) / 100
    urdf = robot(int(SIZE / one)).decode()
    legs = "".join(f'<xacro:leg name="leg{at}"/>\n' for at in range(SIZE // 300))
    links = "".join(
        f'<link name="l{at}"><pose>0 0 {at} 0 0 0</pose></link>\n' for at in range(2000)
    )
    values = "".join(f"    value_{at}: {{gain: 0.{at}, limit: [0.0, {at}.5]}}\n" for at in range(9))
    nodes = "".join(
        f"node{at}:\n  ros__parameters:\n    robot_base_frame: l{at}\n{values}"
        for at in range(SIZE // 450)
    )
    texts = {
        "made.urdf": urdf,
        "made.urdf.xacro": f"{XACRO}{legs}<!--{' ' * (SIZE - 30 * SIZE // 300)}-->\n</robot>\n",
        "made.sdf": f'<sdf version="1.9"><model name="m">\n{links}</model></sdf>\n',
        "made.yaml": nodes,
    }
    for name, text in texts.items():
        (folder / name).mkdir()
        (folder / name / name).write_text(text)
    return [folder / it / it for it in texts]


if __name__ == "__main__":
    main()
