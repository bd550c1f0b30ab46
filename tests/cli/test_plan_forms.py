# SPDX-License-Identifier: Apache-2.0
"""``multibot plan --output-kind table`` as a person meets it."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from graph_cases import without_node
from healthy_systems import single
from paths import FIXTURES

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.planning.plan import read_plan
from multibot_rewrite.planning.table_formats import FORMS
from multibot_rewrite.system.json import to_json

ROVER = str(FIXTURES / "robots" / "rover.urdf")
GZ = str(FIXTURES / "robots" / "rover_gz.urdf")


def run(capture: pytest.CaptureFixture[str], *words: str) -> tuple[int, str, str]:
    code = main(["plan", "--output-kind=table", *words])
    return code, *capture.readouterr()


def test_a_postfix_names_six_rules_for_an_action(capsys: pytest.CaptureFixture[str]) -> None:
    _, out, _ = run(capsys, ROVER, "robot1", "--node-set", "nav2", "--output-kind", "ros-args")
    for part in ("", "/_action/send_goal", "/_action/cancel_goal", "/_action/feedback"):
        assert f"navigate_to_pose{part}:=navigate_to_pose/robot1{part}" in out, part


@pytest.mark.sample(1)
@pytest.mark.parametrize("form", sorted(FORMS))
def test_every_form_is_written_to_a_file(
    form: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    target = tmp_path / "out"
    words = (ROVER, "robot1", "--layout", "both", "--output-kind", form)
    code, out, _ = run(capsys, *words, "-o", str(target))
    assert (code, out) == (0, "")
    _, printed, _ = run(capsys, *words)
    assert target.read_text() == printed != ""


def test_the_bridge_of_a_fleet(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = run(capsys, GZ, "r1", "r2", "--layout", "both", "--output-kind", "bridge")
    assert code == 0, err
    rows = yaml.safe_load(out)
    assert "/clock" in {row["ros_topic_name"] for row in rows}
    assert {row["ros_topic_name"].split("/")[1] for row in rows} == {"clock", "r1", "r2"}


@pytest.mark.parametrize(
    ("words", "message"),
    [
        pytest.param((ROVER, "robot1", "--node-set", "nva2"), "nav2", id="node_sets"),
        pytest.param((ROVER, "robot-1"), "robot_1", id="robot"),
        pytest.param(("gone.urdf", "a"), "is not there", id="no-file"),
        pytest.param((ROVER, "a", "a"), "twice", id="robot-twice"),
        pytest.param(
            (ROVER, "a", "--output-kind", "json", "-o", ROVER), "rover.urdf", id="onto-input"
        ),
    ],
)
def test_wrong_use_is_one_line(
    words: tuple[str, ...], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    before = Path(ROVER).read_bytes()
    code, out, err = run(capsys, *words)
    assert (code, out) == (2, "")
    assert message in err
    assert err.count("\n") == 1
    assert Path(ROVER).read_bytes() == before


@pytest.mark.more
def test_a_robot_without_a_name_has_a_plan(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Its names are those of the code; the graph of such a robot is as planned, a lost node is not."""
    file = tmp_path / "plan.yaml"
    words = ("--node-set", "nav2", "--distro", "jazzy", "-o", str(file))
    assert main(["plan", ROVER, *words]) == 0
    plan = read_plan(file.read_bytes(), "plan.yaml")
    (own,) = plan.robots
    assert own.tf_topic == "/tf" and "base_link" in own.frames
    assert {"/amcl", "/bt_navigator", "/diff_drive"} <= {it.name for it in plan.nodes}
    assert "/robot1" not in file.read_text().partition("\nrobots:")[2]
    graph = single()
    for lost, code in (("", 0), ("/amcl", 1)):
        seen = tmp_path / "graph.json"
        seen.write_bytes(to_json(without_node(graph, lost)))
        capsys.readouterr()
        assert main(["check", str(file), "--from", str(seen)]) == code
        out = capsys.readouterr().out
        assert ("/amcl: error: MG101" in out) is bool(lost)
        assert "MG320" not in out and "MG305" not in out


def test_rules_are_of_a_robot_with_a_name(capsys: pytest.CaptureFixture[str]) -> None:
    code, _, err = run(capsys, ROVER, "--node-set", "nav2")
    assert code == 2 and "no ROBOT given; write robots' names after the input" in err
