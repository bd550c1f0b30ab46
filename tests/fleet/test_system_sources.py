# SPDX-License-Identifier: Apache-2.0
"""The library's calls: a system from each source, the rules on it, two compared."""

from __future__ import annotations

from pathlib import Path

import pytest
from paths import FIXTURES, ROOT

from multibot_rewrite import (
    InputError,
    System,
    compare,
    judge,
    system_of_bag,
    system_of_files,
    system_of_fleet,
    system_of_folder,
    system_of_graph,
)
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.producers.ros import child

ROVER = FIXTURES / "robots" / "rover.urdf"
GRAPHS = FIXTURES / "graphs"
ROBOTS = ["robot1", "robot2"]


def healthy() -> System:
    return system_of_files(GRAPHS / "both" / "healthy.json")


@pytest.mark.more
def test_a_plan_as_json_too(tmp_path: Path) -> None:
    file = tmp_path / "plan.json"
    words = ["plan", str(ROVER), *ROBOTS, "--node-set", "nav2", "--layout", "both", "-o", str(file)]
    assert main(words) == 0
    assert system_of_files(file).layout == "both"


@pytest.mark.parametrize(("words", "asked"), [({}, 0), ({"states": True}, 1)])
def test_nodes_of_a_graph_are_asked_only_if_that_is_wanted(
    words: dict[str, bool], asked: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    questions: list[object] = []
    monkeypatch.setattr(child, "observe", lambda request, around: healthy())
    monkeypatch.setattr(child, "ask", lambda *it: questions.append(it) or ())
    assert system_of_graph(**words) == healthy()
    assert len(questions) == asked


def test_what_is_wrong_is_what_the_commands_say(capsys: pytest.CaptureFixture[str]) -> None:
    broken = GRAPHS / "MG320.json"
    plan = GRAPHS / "plan.yaml"
    assert main(["check", str(plan), "--from", str(broken)]) == 1
    said = capsys.readouterr().out.splitlines()
    assert [str(it) for it in compare(system_of_files(plan), system_of_files(broken))] == said
    main(["check", "--from", str(broken)])
    said = capsys.readouterr().out.splitlines()
    assert [str(it) for it in judge(system_of_files(broken))] == said


@pytest.mark.more
def test_a_fleet_file_is_a_plan() -> None:
    plan = system_of_fleet(ROOT / "examples" / "two_robots_nav2" / "fleet.yaml")
    assert len(plan.robots) == 2
    assert {it.robot for it in plan.nodes} >= {it.name for it in plan.robots}


def test_what_cannot_be_read_is_said(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"none\.json"):
        system_of_files(tmp_path / "none.json")
    with pytest.raises(InputError, match="there is no such bag"):
        system_of_bag(tmp_path / "bag")


@pytest.mark.slow
def test_a_built_folder_runs_as_its_plan_says(tmp_path: Path) -> None:
    robots = "".join(f"  - {{name: {it}, description: {ROVER}}}\n" for it in ROBOTS)
    text = f"layout: frames-per-robot\nnode_sets: [robot_localization]\nrobots:\n{robots}"
    text += "related_files: {params: ekf.yaml}\n"
    (tmp_path / "fleet.yaml").write_text(text)
    # The plugin of the drive sends it.
    frame = "{odom0: odom, publish_tf: false}"
    (tmp_path / "ekf.yaml").write_text(f"ekf_filter_node: {{ros__parameters: {frame}}}\n")
    assert main(["build", str(tmp_path / "fleet.yaml"), "-o", str(tmp_path / "built")]) == 0
    seen = system_of_folder(tmp_path / "built")
    names = {it.name for it in seen.nodes}
    edges = {(it.parent, it.child) for it in seen.edges}
    assert {f"/{it}/robot_state_publisher" for it in ROBOTS} <= names
    assert {(f"base_link/{it}", f"lidar_link/{it}") for it in ROBOTS} <= edges


def test_a_folder_without_a_launch_file_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="py: cannot be read: No such file"):
        system_of_folder(tmp_path)
