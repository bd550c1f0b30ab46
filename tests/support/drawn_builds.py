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
from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis import strategies as st

from multibot_rewrite import load_fleet
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.description.sources.release_said import MANIFEST
from multibot_rewrite.producers.launch import child
from multibot_rewrite.producers.launch.read import read_own
from multibot_rewrite.producers.launch.records import LaunchGraph


def write(fleet: DrawnFleet, folder: Path) -> Path:
    """Write a fleet and its files; returns the path of the fleet file."""
    for path, text in fleet.files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text)
    file = folder / "fleet.yaml"
    text = yaml.safe_dump(fleet.data, sort_keys=False, default_flow_style=None, width=120)
    # PyYAML names what is there twice; a person writes it twice.
    file.write_text(text if "&id" not in text else _written_out(fleet.data))
    return file


def _written_out(data: Data) -> str:
    dumper = type("Dumper", (yaml.SafeDumper,), {"ignore_aliases": lambda *_: True})
    return yaml.dump(data, Dumper=dumper, sort_keys=False, default_flow_style=None, width=120)


def judge(fleet: DrawnFleet, folder: Path) -> None:
    """Build a fleet and assert that it is as it has to be by what was drawn."""
    file, out = write(fleet, folder), folder / "out"
    code, said = run("build", str(file), "-o", str(out), "--fail-on", "error", "-q")
    causes = causes_of(fleet)
    if causes:
        assert code in (1, 2), f"builds, in spite of: {causes}"
        assert not out.exists()
        return
    assert code == 0, said
    _assert_started(fleet, out, folder)
    _assert_same_by_library(file, out)


def run(*words: str) -> tuple[int, str]:
    """The exit code of a command, and all that it says."""
    said = io.TextIOWrapper(io.BytesIO(), encoding="utf-8")
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        code = main(list(words))
    said.seek(0)
    return code, said.read()


def _assert_same_by_library(file: Path, out: Path) -> None:
    """Text, dict and command give the same files."""
    written = {
        it.relative_to(out).as_posix(): _without_paths(it.read_bytes())
        for it in out.rglob("*")
        if it.is_file() and it.name != MANIFEST
    }
    made = {it.path: _without_paths(it.data) for it in load_fleet(str(file)).made.files}
    assert made.keys() == written.keys()
    for path, data in made.items():
        assert data == written[path], path


def _without_paths(data: bytes) -> bytes:
    """A file without the lines that name the folder, which a library call has not."""
    return b"".join(it for it in data.splitlines(True) if b"<parameters>" not in it)


def _assert_started(fleet: DrawnFleet, out: Path, folder: Path) -> None:
    """The launch file starts each robot under its names, and all that is planned.

    A domain_bridge calls its nodes by the domains in its file, which check-launch does not read.
    """
    launch = str(out / "fleet.launch.py")
    graph = read_own(launch, str(folder))
    if "domains" not in fleet.data:
        with _read_here(graph):
            code, said = run("check-launch", launch, "--plan", str(out / "plan.yaml"))
        # 3: what is not known may hide something.
        assert code in (0, 3), said
        assert " error: " not in said, said
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
    """The models that the launch file spawns, by their names."""
    for it in graph.nodes:
        for flag, word in zip(it.arguments, it.arguments[1:], strict=False):
            if flag in ("-name", "-entity"):
                yield word


@contextlib.contextmanager
def _read_here(graph: LaunchGraph) -> Iterator[None]:
    """A command that reads a launch file gets what was read here, and starts no process."""
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
    @given(strategy)
    def each(fleet: DrawnFleet) -> None:
        with tempfile.TemporaryDirectory(prefix="drawn_") as folder:
            judge(fleet, Path(folder))

    each()


if __name__ == "__main__":
    os.environ.pop("ROS_DISTRO", None)
    number = int(sys.argv[2]) if len(sys.argv) > 2 else random.randrange(10**9)
    print(f"seed {number}", flush=True)
    judge_many(drawn, int(sys.argv[1]) if len(sys.argv) > 1 else 300, number)
