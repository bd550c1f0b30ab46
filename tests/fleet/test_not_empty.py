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
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.description.library import rewrite
from multibot_rewrite.fleet.fleet import NO_STATE_PUBLISHER, expected, facts_of, make_fleet
from multibot_rewrite.spelling.plan import read_plan, to_yaml
from multibot_rewrite.system.json import from_json, from_yaml, to_json

COLLISION = FIXTURES / "graphs" / "MG402.json"
PUBLISHER = "robot_state_publisher"
NO_PLUGIN = "robots: [{name: a}, {name: b}]\ndescription: rover.urdf\nlayout: frames-per-robot\n"


@pytest.fixture
def rover(tmp_path: Path) -> str:
    """A description that starts no node itself."""
    path = tmp_path / "rover.urdf"
    path.write_text(ROVER)
    return str(path)


def run(capture: pytest.CaptureFixture[str], *words: str) -> tuple[int, str, str]:
    """Exit code, output and messages of a command."""
    capture.readouterr()
    code = main(list(words))
    return code, *capture.readouterr()


def test_a_plan_holds_what_robot_state_publisher_does(
    rover: str, capsys: pytest.CaptureFixture[str]
) -> None:
    code, out, _ = run(capsys, "plan", rover, "robot1", "robot2", "--layout", "both")
    plan = read_plan(out.encode(), "plan.yaml")
    assert code == 0
    assert [it.name for it in plan.robots] == ["robot1", "robot2"]
    assert plan.robots[1].frames == ("base_link/robot2", "lidar_link/robot2")
    assert own(plan, "robot2") == ("/robot2/robot_state_publisher",)
    assert {(it.role, it.name) for it in plan.ends if it.node.startswith("/robot2/")} == {
        ("publishes", "/robot2/robot_description"),
        ("subscribes", "/robot2/joint_states"),
        ("publishes", "/robot2/tf"),
        ("publishes", "/robot2/tf_static"),
    }


@pytest.mark.parametrize("layout", ["tf-per-robot", "frames-per-robot", "both", "postfix"])
def test_a_collision_is_found_without_any_stack(
    rover: str, layout: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plan = str(tmp_path / "plan.yaml")
    assert main(["plan", rover, "robot1", "robot2", "--layout", layout, "-o", plan]) == 0
    code, out, err = run(capsys, "check", plan, "--from", str(COLLISION))
    assert code == 1
    assert all(it in out for it in ("MG402 robot1 and robot2 send", "base_link"))
    assert err.endswith("not as planned (ROS 2 lyrical)\n")
    assert "2 robots" in err


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
    _, table, _ = run(capsys, "plan", "--form=table", file, "--form", "json")
    assert main(["build", file, "-o", str(tmp_path / "out")]) == 0
    schema, _, built = (tmp_path / "out" / "plan.yaml").read_text().partition("\n")
    assert (schema, built) == ("# yaml-language-server: $schema=.system.schema.json", planned)
    wanted = {f"/{robot}/{PUBLISHER}" for robot in "ab"}
    assert wanted <= nodes_of(planned)
    assert all(f'"{node}"' in table or PUBLISHER in table for node in wanted)
    graph = tmp_path / "graph.json"
    graph.write_bytes(to_json(as_planned(from_yaml(planned.encode(), "plan"))))
    assert run(capsys, "check", file, "--from", str(graph))[0] == 0


def test_a_state_publisher_of_the_users_own_is_the_only_one(tmp_path: Path, rover: str) -> None:
    nodes = tmp_path / "nodes.yaml"
    nodes.write_text(
        "stacks:\n  mine:\n    about: x\n    nodes: [{node: " + PUBLISHER + ", as: rsp}]\n"
    )
    fleet = make_fleet(rover, ["a"], ["mine"], {}, nodes=str(nodes), release=NEWEST_LTS)
    assert [it.name for it in fleet.facts] == ["rsp"]
    assert [
        it.name for it in make_fleet(rover, ["a"], ["robot_state"], {}, release=NEWEST_LTS).facts
    ] == [PUBLISHER, "joint_state_publisher"]


# ---------------------------------------------------------------- without it


def test_it_is_left_out_by_a_stack(tmp_path: Path, rover: str) -> None:
    assert PUBLISHER not in {
        it.name for it in facts_of(["teleop", NO_STATE_PUBLISHER], None, NEWEST_LTS)
    }
    nodes = tmp_path / "nodes.yaml"
    nodes.write_text(
        f"stacks:\n  mine:\n    about: x\n    include: [teleop, {NO_STATE_PUBLISHER}]\n"
    )
    assert PUBLISHER not in {it.name for it in facts_of(["mine"], str(nodes), NEWEST_LTS)}
    plan = expected(
        make_fleet(rover, ["a"], ["teleop", NO_STATE_PUBLISHER], {}, release=NEWEST_LTS)
    )
    assert plan.robots[0].frames == ("base_link/a", "lidar_link/a")


def test_it_cannot_be_asked_for_and_left_out() -> None:
    with pytest.raises(UsageError, match="asked for and left out; leave out one of the node sets"):
        facts_of([NO_STATE_PUBLISHER, "robot_state"], None, NEWEST_LTS)


NOTHING = "every graph would be as planned"


@pytest.mark.parametrize("command", ["plan", "rehearse"])
@pytest.mark.parametrize("stacks", [NO_STATE_PUBLISHER, f"{NO_STATE_PUBLISHER},rviz"])
def test_a_robot_without_a_node_of_its_own_is_an_error(
    command: str, stacks: str, rover: str, capsys: pytest.CaptureFixture[str]
) -> None:
    code, out, err = run(capsys, command, rover, "robot1", "robot2", "--stack", stacks)
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert err.startswith("multibot: robot1, robot2 have no node that must run")
    assert NOTHING in err and NO_STATE_PUBLISHER in err


def test_one_such_robot_among_others_is_an_error_of_every_command(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = NO_PLUGIN.replace("{name: b}", f"{{name: b, stack: {NO_STATE_PUBLISHER}}}")
    file = str(fleet_folder(tmp_path, text))
    for words in (["plan", file], ["check", file], ["build", file, "-o", str(tmp_path / "out")]):
        more = ["--from", str(COLLISION)] if words[0] == "check" else []
        code, out, err = run(capsys, *words, *more)
        assert (code, out, err.count("\n")) == (2, "", 1), words
        assert "b has no node that must run" in err
    assert not (tmp_path / "out").exists()


def test_a_table_of_nothing_says_so(rover: str, capsys: pytest.CaptureFixture[str]) -> None:
    words = ("plan", "--form=table", rover, "robot1", "--stack", NO_STATE_PUBLISHER)
    code, _, err = run(capsys, *words)
    assert (code, err.count("\n")) == (0, 1)
    assert "no node of robot1 is known, so no rule is for it" in err
    assert run(capsys, "plan", "--form=table", rover, "robot1")[2] == ""


# ---------------------------------------------------------------- files of plans


@pytest.fixture
def plan(rover: str) -> dict[str, Any]:
    """A plan of two robots as plain values."""
    made = expected(make_fleet(rover, ["robot1", "robot2"], [], {}, release=NEWEST_LTS))
    value: dict[str, Any] = yaml.safe_load(to_yaml(made))
    return value


def checked(plan: object, folder: Path, capture: pytest.CaptureFixture[str]) -> str:
    """The one line with which a check refuses a plan."""
    path = folder / "edited.yaml"
    path.write_text(yaml.safe_dump(plan))
    with pytest.raises(InputError):
        read_plan(path.read_bytes(), "edited.yaml")
    code, out, err = run(capture, "check", str(path), "--from", str(COLLISION))
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert NOTHING in err and str(path) in err
    return err


def test_a_plan_of_no_robot(
    plan: dict[str, Any], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert "no robot is planned" in checked({**plan, "robots": []}, tmp_path, capsys)


def test_a_plan_of_robots_without_nodes(
    plan: dict[str, Any], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    del plan["robots"][1]["nodes"]
    assert "robot2 has no node that must run" in checked(plan, tmp_path, capsys)


def test_a_plan_of_nodes_that_may_all_be_missing(
    plan: dict[str, Any], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for robot in plan["robots"]:
        for node in robot["nodes"]:
            node["sure"] = "may"
    assert "robot1, robot2 have no node" in checked(plan, tmp_path, capsys)


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
