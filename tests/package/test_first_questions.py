# SPDX-License-Identifier: Apache-2.0
"""What people ask first about two robots, from their files to the answer."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from graph_cases import as_planned, sent
from healthy_systems import TWIST, with_node
from paths import ROBOTS, ROOT

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.planning.plan import read_plan
from multibot_rewrite.system.json import to_json
from multibot_rewrite.system.records import PUBLISHES, System

EXAMPLE = ROOT / "examples" / "namespace_and_prefix"


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the two robots of the example, whose namespaces, prefixes and models all differ."""
    out = tmp_path_factory.mktemp("built")
    assert main(["build", str(EXAMPLE / "fleet.yaml"), "-o", str(out), "-q"]) == 0
    return out


def running(built: Path) -> System:
    """Return the graph that the plan of a build describes."""
    return sent(as_planned(read_plan((built / "plan.yaml").read_bytes(), "plan.yaml")))


def doctor(graph: System, folder: Path, capsys: pytest.CaptureFixture[str]) -> list[str]:
    (folder / "graph.json").write_bytes(to_json(graph))
    main(["check", "--from", str(folder / "graph.json")])
    return [line for line in capsys.readouterr().out.splitlines() if " MG" in line]


@pytest.mark.more
def test_why_does_cmd_vel_never_come(
    built: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The teleop of the manual drives nobody; the doctor names what the line of the build has."""
    graph = running(built)
    assert doctor(graph, tmp_path, capsys) == []
    bare = with_node(graph, "/teleop_twist_keyboard", (PUBLISHES, "/cmd_vel", TWIST))
    (said,) = doctor(bare, tmp_path, capsys)
    assert "publishes /cmd_vel, which no node reads" in said
    lines = (built / "commands.md").read_text().splitlines()
    (line,) = (it for it in lines if "teleop" in it and "/robot1/" in it)
    name = line.split("cmd_vel:=")[1].split()[0]
    assert f"reads {name}" in said, said


@pytest.mark.slow
@pytest.mark.parametrize(
    ("layout", "windows"), [("frames-per-robot", ["one"]), ("tf-per-robot", ["robot1", "robot2"])]
)
def test_one_rviz_for_all_and_one_for_each(layout: str, windows: list[str], tmp_path: Path) -> None:
    """Where each robot has its own /tf, no window can show both."""
    shutil.copy(ROBOTS / "rover.urdf", tmp_path)
    config = (ROOT / "examples" / "multibot_example" / "config" / "rover.rviz").read_text()
    (tmp_path / "one.rviz").write_text(config)
    (tmp_path / "fleet.yaml").write_text(
        f"layout: {layout}\ndescription: rover.urdf\nrelated_files: {{rviz: one.rviz}}\n"
        "robots: [{name: robot1}, {name: robot2, pose: {y: 2.0}}]\n"
    )
    out = tmp_path / "out"
    assert main(["build", str(tmp_path / "fleet.yaml"), "-o", str(out), "-q"]) == 0
    text = (out / "fleet.launch.py").read_text()
    assert ("executable='rviz2'" in text) == bool(windows)
    for window in windows:
        assert list(out.rglob(f"{window}*rviz")) or (out / window / "one.rviz").exists()
