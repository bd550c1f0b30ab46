# SPDX-License-Identifier: Apache-2.0
"""Drawn fleets are built: each builds as its file says, or ends with an error that is in its input.

python tests/support/drawn_builds.py [COUNT] [SEED]     with a fresh seed, which is printed
"""

from __future__ import annotations

import contextlib
import io
import os
import random
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
import yaml
from drawn_fleets import Data, DrawnFleet, causes_of, drawn, simulated
from drawn_spellings import FILE, SITE
from hypothesis import HealthCheck, Phase, given, seed, settings, strategies as st
from paths import write_files

from multibot_rewrite import load_fleet
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.checks import read_back
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.description.sources.release_said import MANIFEST
from multibot_rewrite.fleet.file.fleet_data import DICT
from multibot_rewrite.fleet.file.fleet_file import FleetFile, read_fleet
from multibot_rewrite.producers.launch import child
from multibot_rewrite.producers.launch.read import read_own
from multibot_rewrite.producers.launch.records import LaunchGraph

# What tells of a fault of the build itself. As a note it says that a stand-in read a launch file.
FAULT = "error: MF823"
# Of so many fleets one is built a second time, as a whole.
WHOLE = 8
# In memory where there is such a folder: a build waits until its files are on the disk.
FOLDER = "/dev/shm" if os.path.isdir("/dev/shm") else None
# The lines of a plan that say where in a fleet file a finding is.
PLACE = (b"line: ", b"column: ")
# Where the findings of a plan begin.
GAPS = b"gaps:"


def write(fleet: DrawnFleet, folder: Path) -> None:
    """Write a fleet file, those that it includes, and the files that they name."""
    texts = {path: _yaml(data) for path, data in (fleet.written or {FILE: fleet.data}).items()}
    write_files(folder, {**fleet.files, **texts})


def _yaml(data: Data) -> str:
    """As a person writes it: what is there twice is written twice, and PyYAML would name it."""
    return yaml.dump(data, Dumper=_WrittenOut, sort_keys=False, default_flow_style=None, width=120)


class _WrittenOut(getattr(yaml, "CSafeDumper", yaml.SafeDumper)):  # type: ignore[misc]
    def ignore_aliases(self, _: object) -> bool:
        return True


def judge(fleet: DrawnFleet, folder: Path, whole: bool = True) -> None:
    """Build a fleet and assert that it is as it has to be by what was drawn.

    ``build`` compares each value of the launch file with the plan, and ends with MF823 on a difference.
    The ``whole`` is also to build a second time, by a library call with a dict, and to be read by
    ``check-launch``.
    """
    write(fleet, folder)
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        _judge(fleet, whole)


def _judge(fleet: DrawnFleet, whole: bool) -> None:
    out = Path("out")
    with _seen_by_build() as seen:
        code, said = run("build", FILE, "-o", str(out), "--fail-on", "error", *trusted(fleet))
    lines = said.splitlines()
    assert sorted(lines) == sorted({*lines}), "a line is said twice"
    causes = causes_of(fleet)
    if causes:
        assert code in (1, 2), f"builds, in spite of: {causes}"
        assert not out.exists()
        # A fault of the build has this code, whatever the fleet is.
        assert FAULT not in said, said
        return
    assert code == 0, said
    _assert_meant(fleet)
    launch = out / "fleet.launch.py"
    # What the build has read of the same text is not read again, but for the whole: its parameter files
    # were those of a folder that is gone.
    graph = None if whole else seen.get(_in(out, launch.read_text()))
    graph = graph or read_own(str(launch), "")
    _assert_started(fleet, graph)
    if whole:
        _assert_as_checked(fleet, graph, out)
        _assert_same_by_library(fleet, out)


@contextlib.contextmanager
def _seen_by_build() -> Iterator[dict[str, LaunchGraph]]:
    """Yield what the build reads back, by the text of each launch file without its folder."""
    found: dict[str, LaunchGraph] = {}

    def reading(file: str, folder: str) -> LaunchGraph:
        graph = read_own(file, folder)
        found[_in(Path(file).parent, Path(file).read_text())] = graph
        return graph

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(read_back, "read_own", reading)
        yield found


def _in(folder: Path, text: str) -> str:
    return text.replace(f"{folder.absolute()}/", "")


def trusted(fleet: DrawnFleet) -> list[str]:
    """Return what lets launch files run that a fleet file names."""
    return ["--trust"] * any("launch" in row for row in fleet.data["robots"])


def run(*words: str) -> tuple[int, str]:
    """Return the exit code of a command, and all that it says."""
    said = io.TextIOWrapper(io.BytesIO(), encoding="utf-8")
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        code = main(list(words))
    said.seek(0)
    return code, said.read()


def _assert_meant(fleet: DrawnFleet) -> None:
    """Assert that the fleet file, however written, means the same as a dict with all keys at the
    robots."""
    read, given = (read_fleet(it, "", {}) for it in (FILE, fleet.data))
    assert _meaning(read) == _meaning(given)


def _meaning(it: FleetFile) -> dict[str, object]:
    """Return a fleet file without the places of what it says."""
    robots = [
        row._replace(
            file="", line=0,
            # What is joined is called by the file that lists its parts.
            description="" if row.parts else row.description,
            related_files={
                kind: [path.replace(row.file, "FLEET") for path in paths]
                for kind, paths in row.related_files.items()
            },
            filled=tuple((path.replace(row.file, "FLEET"), text) for path, text in row.filled),
        )
        for row in it.robots
    ]  # fmt: skip
    policy = make_naming(**it.policy)
    places = {"file": "", "files": (), "world_place": (), "shared_places": ()}
    apart = it.apart._replace(place=("", 1))
    cell = it.cell._replace(place="") if it.cell else None
    return it._replace(policy={}, robots=(), apart=apart, cell=cell, **places)._asdict() | {
        "robots": robots, "policy": policy,
    }  # fmt: skip


def _assert_same_by_library(fleet: DrawnFleet, out: Path) -> None:
    """Assert that a library call with a dict gives the command's files, but for the fleet file's
    name."""
    written = {
        it.relative_to(out).as_posix(): _without_paths(it.read_bytes())
        for it in out.rglob("*")
        if it.is_file() and it.name != MANIFEST
    }
    made = {
        it.path: _without_paths(it.data) for it in load_fleet(fleet.data, trust=True).made.files
    }
    assert made.keys() == written.keys(), made.keys() ^ written.keys()
    for path, data in made.items():
        assert data == written[path], path


def _without_paths(data: bytes) -> bytes:
    """Return a file without comments, and without lines that name its folder, the fleet file or
    a place in it: a library call has none."""
    named = (b"<parameters>", FILE.encode(), SITE.encode(), DICT.encode())
    lines = (it for it in data.splitlines() if not it.lstrip().startswith((b"#", *PLACE)))
    kept = [it for it in lines if not any(one in it for one in named)]
    # Findings are in the order of their files, and the fleet file has two names.
    first = next((at for at, it in enumerate(kept) if it.startswith(GAPS)), len(kept))
    return b"\n".join([*kept[:first], *sorted(kept[first:])])


def _assert_as_checked(fleet: DrawnFleet, graph: LaunchGraph, out: Path) -> None:
    """``check-launch`` finds no error between what is started and what is planned. A vendor's
    launch files start what the fleet's own one does not."""
    if {"shape", "params_style"}.isdisjoint(fleet.data):
        with _read_here(graph):
            code, said = run(
                "check-launch", str(out / "fleet.launch.py"), "--plan", str(out / "plan.yaml")
            )
        # 3: what is not known may hide something.
        assert code in (0, 3), said
        assert " error: " not in said, said


def _assert_started(fleet: DrawnFleet, graph: LaunchGraph) -> None:
    """Assert that the launch file starts and spawns each robot under its names."""
    found = [it for it in graph.nodes if it.executable == "robot_state_publisher"]
    where = {f"{it.namespace.rstrip('/')}/{it.name}" for it in found}
    assert where == {*map(_publisher(fleet), fleet.data["robots"])}
    models = [row.get("model", row["name"]) for row, _ in simulated(fleet)]
    assert sorted(_spawned(graph)) == sorted(models)


def _publisher(fleet: DrawnFleet) -> Callable[[Data], str]:
    """How each robot's robot_state_publisher is called, by the layout."""

    def name(row: Data) -> str:
        space = row.get("namespace", row["name"]).strip("/")
        if fleet.data["layout"] != "postfix":
            return f"/{space}/robot_state_publisher"
        is_first = fleet.data["affix"] == "prefix"
        return f"/{space}_robot_state_publisher" if is_first else f"/robot_state_publisher_{space}"

    return name


def _spawned(graph: LaunchGraph) -> Iterator[str]:
    """Yield the models that the launch file spawns, by their names."""
    for it in graph.nodes:
        for flag, word in zip(it.arguments, it.arguments[1:], strict=False):
            if flag in ("-name", "-entity"):
                yield word


@contextlib.contextmanager
def _read_here(graph: LaunchGraph) -> Iterator[None]:
    """Let commands that read a launch file get what was read here, and start no process."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(child, "launch_graph", lambda order: graph)
        yield


def judge_many(
    strategy: st.SearchStrategy[DrawnFleet], count: int, start: int, shrink: bool = True
) -> None:
    """Draw so many fleets by a seed and judge each."""
    phases = (Phase.generate, Phase.shrink) if shrink else (Phase.generate,)

    @seed(start)
    @settings(
        max_examples=count, database=None, deadline=None, phases=phases,
        suppress_health_check=[*HealthCheck],
    )  # fmt: skip
    @given(strategy, st.integers(0, WHOLE - 1))
    def each(fleet: DrawnFleet, one_of: int) -> None:
        with tempfile.TemporaryDirectory(prefix="drawn_", dir=FOLDER) as folder:
            judge(fleet, Path(folder), one_of == WHOLE - 1)

    each()


def drawn_by(strategy: st.SearchStrategy[DrawnFleet], count: int, start: int) -> list[DrawnFleet]:
    """So many fleets, by a seed; they are not built."""
    found: list[DrawnFleet] = []

    @seed(start)
    @settings(
        max_examples=count, database=None, deadline=None, phases=(Phase.generate,),
        suppress_health_check=[*HealthCheck],
    )  # fmt: skip
    @given(strategy)
    def each(fleet: DrawnFleet) -> None:
        found.append(fleet)

    each()
    return found


if __name__ == "__main__":
    os.environ.pop("ROS_DISTRO", None)
    number = int(sys.argv[2]) if len(sys.argv) > 2 else random.randrange(10**9)
    print(f"seed {number}", flush=True)
    judge_many(drawn, int(sys.argv[1]) if len(sys.argv) > 1 else 300, number)
