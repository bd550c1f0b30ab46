"""``multibot plan`` and ``multibot check``: the plan is a file, a snapshot is held against it."""

from __future__ import annotations

from pathlib import Path

import pytest
from robots import FIXTURES
from test_graph_check import environment, moved, without_node

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.graph.plan_file import from_yaml, to_yaml
from multibot_rewrite.graph.snapshot import (
    Caveat,
    GraphEndpoint,
    GraphNode,
    Snapshot,
    to_json,
)
from multibot_rewrite.model import InputError

ROVER = str(FIXTURES / "robots" / "rover.urdf")
FLEET = (ROVER, "robot1", "robot2", "--stack", "nav2", "--layout", "both")


@pytest.fixture
def plan(tmp_path: Path) -> Path:
    """The plan of two rovers with Nav2."""
    path = tmp_path / "plan.yaml"
    assert main(["plan", *FLEET, "-o", str(path)]) == 0
    return path


def as_planned(plan: Path) -> Snapshot:
    """A graph that is the plan, type by type; unknown types left out."""
    wanted = from_yaml(plan.read_bytes(), "plan")
    types: dict[str, str] = {}
    for end in wanted.endpoints:
        types[end.name] = types.get(end.name) or end.type
    ends = [
        GraphEndpoint(e.kind, e.role, e.name, types[e.name], "", e.node, None, "")
        for e in wanted.endpoints
    ]
    nodes = [GraphNode(node, node) for robot in wanted.robots for node in robot.nodes]
    return Snapshot(tuple(nodes), tuple(ends), (), environment())


def held(plan: Path, graph: Snapshot, capture: pytest.CaptureFixture[str]) -> tuple[int, str, str]:
    """Exit code, output and messages of a check."""
    path = plan.with_name("graph.json")
    path.write_bytes(to_json(graph))
    capture.readouterr()
    code = main(["check", str(plan), "--snapshot", str(path)])
    return code, *capture.readouterr()


def test_a_plan_is_read_back_as_it_was_written(plan: Path) -> None:
    wanted = from_yaml(plan.read_bytes(), "plan")
    assert to_yaml(wanted).encode() == plan.read_bytes()
    assert [robot.name for robot in wanted.robots] == ["robot1", "robot2"]
    assert len(wanted.endpoints) > 200
    assert "base_link/robot1" in wanted.robots[0].frames


def test_a_fleet_as_planned(plan: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = held(plan, as_planned(plan), capsys)
    assert (code, out) == (0, "")
    assert err == "multibot: 2 robots, 0 findings: as planned\n"


def test_why_cmd_vel_never_comes(plan: Path, capsys: pytest.CaptureFixture[str]) -> None:
    graph = moved(as_planned(plan), "/robot1/cmd_vel", "/cmd_vel", "diff_drive")
    code, out, _ = held(plan, graph, capsys)
    assert code == 1
    assert "/robot1/diff_drive: error: MG102" in out
    assert "it subscribes /cmd_vel instead" in out


def test_an_incomplete_view_is_inconclusive(plan: Path, capsys: pytest.CaptureFixture[str]) -> None:
    cut = Caveat("participants", True, "exactly 32 participants")
    graph = without_node(as_planned(plan), "/robot2/amcl")._replace(environment=environment(cut))
    code, out, err = held(plan, graph, capsys)
    assert code == 3
    assert "/robot2/amcl: inconclusive: MG101" in out
    assert "exactly 32 participants" in err


def test_an_edited_plan_is_what_counts(plan: Path, capsys: pytest.CaptureFixture[str]) -> None:
    graph = without_node(as_planned(plan), "/robot2/imu_driver")
    assert held(plan, graph, capsys)[0] == 1
    plan.write_text(plan.read_text().replace("      /robot2/imu_driver: []\n", ""))
    assert "/robot2/imu_driver: []" not in plan.read_text()
    assert held(plan, graph, capsys)[0] == 0


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        pytest.param("robots:", "robts:", "'robots' is missing", id="no-robots"),
        pytest.param("subscribes, topic", "hears, topic", "'hears'", id="role"),
        pytest.param("    tf: ", "    tfs: ", "'tf' is missing", id="no-tf"),
        pytest.param("[map, world]", "map", "shared_frames is no list", id="no-list"),
        pytest.param("topic, /robot1", "topic, robot1", "no full name", id="relative"),
        pytest.param("layout:", "layout: [", "not YAML", id="no-yaml"),
    ],
)
def test_a_wrong_plan_is_one_line(
    plan: Path, capsys: pytest.CaptureFixture[str], old: str, new: str, words: str
) -> None:
    text = plan.read_text()
    assert old in text
    graph = plan.with_name("graph.json")
    graph.write_bytes(to_json(as_planned(plan)))
    plan.write_text(text.replace(old, new, 1))
    with pytest.raises(InputError, match=words.replace("[", r"\[")):
        from_yaml(plan.read_bytes(), "plan.yaml")
    capsys.readouterr()
    assert main(["check", str(plan), "--snapshot", str(graph)]) == 2
    err = capsys.readouterr().err
    assert err.startswith(f"multibot: {plan}")
    assert err.count("\n") == 1


def test_a_snapshot_that_is_none(plan: Path, capsys: pytest.CaptureFixture[str]) -> None:
    capsys.readouterr()
    assert main(["check", str(plan), "--snapshot", str(plan)]) == 2
    assert "not JSON" in capsys.readouterr().err
