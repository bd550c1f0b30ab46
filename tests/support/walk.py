# SPDX-License-Identifier: Apache-2.0
"""The way of a new user from one description to robots that run as planned, by ``--help`` alone.

``python tests/support/walk.py REPOSITORY [DESCRIPTION]`` walks it in a copy of a checkout and prints
tests/support/walk.md. It needs launch, launch_ros and rclpy; neither ROS's programs nor a simulator:
the programs of the launch file write down what they are told, and nodes that do as they are told stand
where they would be.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

from launched_programs import launched
from paths import fixture_text
from told_nodes import nodes_of, words_of

from multibot_rewrite import load_fleet
from multibot_rewrite.live.rehearsal import graph_of_stubs, isolated_environment
from multibot_rewrite.system.json import to_json

REPOSITORY = "nav2_minimal_turtlebot_simulation"
ORIGIN = f"https://github.com/ros-navigation/{REPOSITORY}"
TURTLEBOT = "nav2_minimal_tb4_description/urdf/standard/turtlebot4.urdf.xacro"
OUT = "out"
# What is asked for help, and how many lines of it are shown; 0 for all.
HELP = (
    ("What is there?", "multibot --help", 0),
    ("How do I begin?", "multibot init --help", 13),
    ("What is it built with?", "multibot build --help", 22),
)
HEAD = fixture_text("walk_head.txt")
_SECONDS = re.compile(r"\d+\.\d s")


class Step(NamedTuple):
    """What the user does, the command, what it shows, and how long it took."""

    title: str
    command: str
    shown: str
    seconds: float
    after: str = ""


def page(repository: Path, description: str = TURTLEBOT) -> str:
    """Return the walk in a copy of this checkout, Markdown."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / repository.name
        shutil.copytree(repository, folder, ignore=shutil.ignore_patterns(".git"))
        steps = tuple(walk(folder, description, Path(name)))
    table = "\n".join(("| step | command | time |", "|---|---|--:|", *map(_row, steps)))
    head = HEAD.format(name=repository.name, origin=ORIGIN, table=table)
    return "\n".join((head, *map(section, steps)))


def in_words(text: str) -> str:
    """Return a page without its seconds."""
    return _SECONDS.sub("... s", text)


def walk(folder: Path, description: str, beside: Path) -> Iterator[Step]:
    """Yield the steps; what is made is in ``folder``, what stands for ROS is ``beside`` it."""
    for title, command, lines in HELP[:2]:
        yield shell(title, command, folder, lines)
    yield shell("A fleet file", f"multibot init {description}", folder)
    yield shell("What it says, and why", "cat fleet.yaml", folder)
    title, command, lines = HELP[2]
    yield shell(title, command, folder, lines)
    yield shell("All files of the robots", f"multibot build fleet.yaml -o {OUT}", folder)
    told, step = _launch(folder, beside)
    yield step
    (folder / "graph.json").write_bytes(_seen(told, folder))
    check = f"multibot check {OUT}/plan.yaml --from graph.json"
    yield shell("Do they run as planned?", check, folder)


def shell(title: str, command: str, folder: Path, lines: int = 0) -> Step:
    """Return what a command prints, the first ``lines`` of it or all."""
    program = f"import sys; sys.argv[0] = 'multibot'; {_MAIN}"
    words = command.split()
    own = [sys.executable, "-c", program, *words[1:]] if words[0] == "multibot" else words
    given = {**os.environ, "COLUMNS": "80"}
    given.pop("ROS_DISTRO", None)
    begun = time.monotonic()
    done = subprocess.run(
        own, cwd=folder, env=given, text=True, check=False, timeout=120,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip
    seconds = time.monotonic() - begun
    assert done.returncode == 0, done.stdout
    shown = done.stdout.splitlines()
    kept = [*shown[:lines], "..."] if lines else shown
    return Step(title, command, "\n".join(kept), seconds)


_MAIN = "from multibot_rewrite.cli.multibot import main; sys.exit(main())"


def _launch(folder: Path, beside: Path) -> tuple[list[dict[str, Any]], Step]:
    """Return what the programs of the launch file were told."""
    file = folder / OUT / "fleet.launch.py"
    pairs = re.findall(r"package='(\w+)',\s+executable='([\w.]+)'", file.read_text())
    programs = {executable: package for package, executable in pairs}
    begun = time.monotonic()
    told, said = launched(file, beside, programs=programs)
    seconds = time.monotonic() - begun
    started = re.findall(r"\[INFO\] \[([\w.]+)-\d+\]: process started", said)
    lines = [f"[INFO] [{name}-{at}]: process started" for at, name in enumerate(started, 1)]
    command = f"ros2 launch {OUT}/fleet.launch.py"
    after = (
        "\nWhat the programs are told of names:\n\n```text\n" + "\n".join(_told(told)) + "\n```\n"
    )
    return told, Step("Start them", command, "\n".join(lines), seconds, after)


def _told(every: list[dict[str, Any]]) -> list[str]:
    """Return the programs with their namespaces, names and remap rules."""
    rows = (words_of(it) for it in every)
    return sorted(
        f"{name}: {' '.join(it for it in ros if ':=' in it)}" for name, _, ros in rows if ros
    )


def _seen(told: list[dict[str, Any]], folder: Path) -> bytes:
    """Return the graph of nodes that obey their commands, as ``multibot snapshot`` writes it.

    Messages that are not installed here are replaced by others, and have their names again here.
    """
    fleet, environ = load_fleet(folder / "fleet.yaml"), isolated_environment(None)
    graph, replaced = graph_of_stubs(nodes_of(told, fleet), environ, 40.0)
    seen = to_json(graph)
    for real, other in replaced.items():
        seen = seen.replace(json.dumps(other).encode(), json.dumps(real).encode())
    return seen


def _row(it: Step) -> str:
    return f"| {it.title} | `{it.command}` | {it.seconds:.1f} s |"


def section(it: Step) -> str:
    kind = "yaml" if it.command.startswith("cat ") else "console"
    prompt = "" if kind == "yaml" else f"$ {it.command}\n"
    before = f"`{it.command}`\n\n" if kind == "yaml" else ""
    return f"## {it.title}\n\n{before}```{kind}\n{prompt}{it.shown}\n```\n{it.after}"


if __name__ == "__main__":
    sys.stdout.write(page(Path(sys.argv[1]).resolve(), *sys.argv[2:]))
