# SPDX-License-Identifier: Apache-2.0
"""No verdict about nothing: a plan holds every robot, its frames and its robot_state_publisher."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml
from fleet_folder import ROVER, fleet_folder
from graph_cases import as_planned
from paths import FIXTURES
from plans import own

from multibot_rewrite import compare
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.checks.judged_plan import make_fleet
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.description.library import rewrite
from multibot_rewrite.fleet.fleet import NO_STATE_PUBLISHER, expected, facts_of
from multibot_rewrite.planning.plan import to_yaml
from multibot_rewrite.system.json import from_json, from_yaml, to_json

COLLISION = FIXTURES / "graphs" / "MG402.json"
PUBLISHER = "robot_state_publisher"
NO_PLUGIN = "robots: [{name: a}, {name: b}]\ndescription: rover.urdf\nlayout: frames-per-robot\n"


@pytest.fixture
def rover(tmp_path: Path) -> str:
    """Return a description that starts no node itself."""
    path = tmp_path / "rover.urdf"
    path.write_text(ROVER)
    return str(path)


def run(capture: pytest.CaptureFixture[str], *words: str) -> tuple[int, str, str]:
    """Exit code, output and messages of a command."""
    capture.readouterr()
    code = main(list(words))
    return code, *capture.readouterr()


def test_the_frames_of_another_robot_are_not_missed_but_its_node_is(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "arm.urdf").write_text('<robot name="arm"><link name="foot"/></robot>')
    plan = str(tmp_path / "plan.yaml")
    assert main(["plan", str(tmp_path / "arm.urdf"), "robot1", "robot2", "-o", plan]) == 0
    code, out, _ = run(capsys, "check", plan, "--from", str(COLLISION))
    assert (code, "MG109" in out) == (1, True)


# ---------------------------------------------------------------- every command has the same nodes


def nodes_of(plan: str) -> set[str]:
    return {it.name for it in from_yaml(plan.encode(), "plan").nodes if it.robot}


@pytest.mark.slow
@pytest.mark.parametrize("poses", ["", "one", "both"])
def test_all_commands_have_the_same_robots(
    poses: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = NO_PLUGIN.replace("{name: a}", "{name: a, pose: {x: 1}}") if poses else NO_PLUGIN
    text = text.replace("{name: b}", "{name: b, pose: {x: 2}}") if poses == "both" else text
    file = str(fleet_folder(tmp_path, text))
    _, planned, _ = run(capsys, "plan", file)
    _, table, _ = run(capsys, "plan", "--output-kind=table", file, "--output-kind", "json")
    assert main(["build", file, "-o", str(tmp_path / "out")]) == 0
    schema, _, built = (tmp_path / "out" / "plan.yaml").read_text().partition("\n")
    assert (schema, built) == ("# yaml-language-server: $schema=.system.schema.json", planned)
    wanted = {f"/{robot}/{PUBLISHER}" for robot in "ab"}
    assert wanted <= nodes_of(planned)
    assert all(f'"{node}"' in table or PUBLISHER in table for node in wanted)
    graph = tmp_path / "graph.json"
    graph.write_bytes(to_json(as_planned(from_yaml(planned.encode(), "plan"))))
    assert run(capsys, "check", file, "--from", str(graph))[0] == 0


# ---------------------------------------------------------------- without it


def test_it_cannot_be_asked_for_and_left_out() -> None:
    with pytest.raises(UsageError, match="asked for and left out; leave out one of the node sets"):
        facts_of([NO_STATE_PUBLISHER, "robot_state"], None, NEWEST_LTS)


def test_one_such_robot_among_others_is_an_error_of_every_command(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = NO_PLUGIN.replace("{name: b}", f"{{name: b, node_sets: {NO_STATE_PUBLISHER}}}")
    file = str(fleet_folder(tmp_path, text))
    for words in (["plan", file], ["check", file], ["build", file, "-o", str(tmp_path / "out")]):
        more = ["--from", str(COLLISION)] if words[0] == "check" else []
        code, out, err = run(capsys, *words, *more)
        assert (code, out, err.count("\n")) == (2, "", 1), words
        assert "b has no node that must run" in err
    assert not (tmp_path / "out").exists()


def test_a_table_of_nothing_says_so(rover: str, capsys: pytest.CaptureFixture[str]) -> None:
    words = ("plan", "--output-kind=table", rover, "robot1", "--node-set", NO_STATE_PUBLISHER)
    code, _, err = run(capsys, *words)
    assert (code, err.count("\n")) == (0, 1)
    assert "no node of robot1 is known, so no rule is for it" in err
    assert run(capsys, "plan", "--output-kind=table", rover, "robot1")[2] == ""


# ---------------------------------------------------------------- files of plans


@pytest.fixture
def plan(rover: str) -> dict[str, Any]:
    """Return a plan of two robots as plain values."""
    made = expected(make_fleet(rover, ["robot1", "robot2"], [], {}, release=NEWEST_LTS))
    value: dict[str, Any] = yaml.safe_load(to_yaml(made))
    return value


def test_a_fleet_file_of_no_robot(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = str(fleet_folder(tmp_path, "robots: []\ndescription: rover.urdf\n"))
    for command in ("plan", "check", "rehearse"):
        code, out, err = run(capsys, command, file)
        assert (code, out, err.count("\n")) == (2, "", 1), command


# ---------------------------------------------------------------- public descriptions


@pytest.mark.deep
def test_no_public_description_makes_an_empty_plan(corpus: dict[str, Path]) -> None:
    """Each plan has both robots and their nodes; none finds a graph of other robots as planned."""
    graph, made, mixed = from_json(COLLISION.read_bytes(), "graph"), 0, 0
    for path in corpus.values():
        try:
            rewrite(path, "robot1", again=True)
            fleet = make_fleet(path, ["robot1", "robot2"], [], {}, release=NEWEST_LTS)
        except (InputError, UsageError):
            continue
        except Exception as error:
            assert "MB" in str(error), path
            continue
        plan = expected(fleet)
        made += 1
        assert [it.name for it in plan.robots] == ["robot1", "robot2"]
        assert all(any(PUBLISHER in node for node in own(plan, it.name)) for it in plan.robots)
        found = {it.code for it in compare(plan, graph) if it.level == "error"}
        assert found, path
        frames = plan.robots[0].frames
        # A joint below a link that is nowhere makes a frame without the robot's name.
        if "base_link/robot1" in frames and all(it.endswith("/robot1") for it in frames):
            mixed += 1
            assert "MG402" in found, path
    assert made > 900
    assert mixed > 100
