# SPDX-License-Identifier: Apache-2.0
"""``multibot plan`` and ``multibot check``: the plan is a file, a snapshot is held against it."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from graph_cases import as_planned as planned_graph, environment, moved, without_node
from paths import FIXTURES
from plans import optional

from multibot_rewrite.base.model import InputError
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.planning.plan import read_plan, to_yaml
from multibot_rewrite.system.json import from_yaml, to_json
from multibot_rewrite.system.records import Caveat, System

ROVER = str(FIXTURES / "robots" / "rover.urdf")
FLEET = (
    *(ROVER, "robot1", "robot2", "--node-set", "nav2,robot_state", "--layout", "both"),
    *("--distro", "lyrical"),
)


@pytest.fixture(scope="module")
def nav2_plan(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """Return the plan of two rovers with Nav2."""
    path = tmp_path_factory.mktemp("plan") / "plan.yaml"
    assert main(["plan", *FLEET, "-o", str(path)]) == 0
    return path.read_bytes()


@pytest.fixture
def plan(tmp_path: Path, nav2_plan: bytes) -> Path:
    """Return the same as a file that a test may edit."""
    path = tmp_path / "plan.yaml"
    path.write_bytes(nav2_plan)
    return path


def as_planned(plan: Path) -> System:
    """Return a graph that is the plan; of tf nothing was heard."""
    return planned_graph(from_yaml(plan.read_bytes(), "plan"))._replace(edges=())


def held(plan: Path, graph: System, capture: pytest.CaptureFixture[str]) -> tuple[int, str, str]:
    """Exit code, output and messages of a check."""
    path = plan.with_name("graph.json")
    path.write_bytes(to_json(graph))
    capture.readouterr()
    code = main(["check", str(plan), "--from", str(path)])
    return code, *capture.readouterr()


@pytest.mark.more
def test_a_plan_is_read_back_as_it_was_written(plan: Path) -> None:
    wanted = from_yaml(plan.read_bytes(), "plan")
    # The first line names the schema for editors.
    assert to_yaml(wanted).encode() == plan.read_bytes().partition(b"\n")[2]
    assert [robot.name for robot in wanted.robots] == ["robot1", "robot2"]
    assert len(wanted.ends) > 200
    assert "base_link/robot1" in wanted.robots[0].frames


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("{", "{{", "plan.json:1:2: not valid JSON: "),
        ('"layout"', '"layoot"', "plan.json: layoot: unknown key; the keys are nodes, ends"),
        ('["publishes"', '["sends"', "plan.json: robots[0].nodes[0].ends[0].role: expected one of"),
        ('"/robot1/tf"', '"tf"', "plan.json: robots[0].tf_topic: expected a full name that starts"),
        ('"robots": [', '"robots": [{', "not valid JSON"),
        ("ros", "ros\xff", "not valid JSON"),
    ],
)
def test_a_wrong_plan_in_json_is_one_line(
    plan: Path, old: str, new: str, words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    written = plan.with_name("plan.json")
    assert main(["plan", *FLEET, "-o", str(written)]) == 0
    text = written.read_text()
    assert old in text
    written.write_bytes(text.replace(old, new, 1).encode("latin-1"))
    code, _, err = held(written, as_planned(plan), capsys)
    assert (code, err.count("\n")) == (2, 1)
    assert words in err


@pytest.mark.more
def test_an_earlier_snapshot_is_a_plan(plan: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = plan.with_name("before.json")
    graph = as_planned(plan)
    before.write_bytes(to_json(graph))
    assert held(before, graph, capsys)[:2] == (0, "")
    code, out, _ = held(before, without_node(graph, "/robot2/amcl"), capsys)
    assert code == 1 and "/robot2/amcl: error: MG101" in out and "robot1" not in out


def test_why_cmd_vel_never_comes(plan: Path, capsys: pytest.CaptureFixture[str]) -> None:
    graph = moved(as_planned(plan), "/robot1/cmd_vel", "/cmd_vel", "diff_drive")
    code, out, _ = held(plan, graph, capsys)
    assert code == 1
    assert "/robot1/diff_drive: error: MG303" in out
    assert "it subscribes to /cmd_vel instead" in out


@pytest.mark.more
def test_an_incomplete_view_is_inconclusive(plan: Path, capsys: pytest.CaptureFixture[str]) -> None:
    cut = Caveat("participants", True, "exactly 32 participants")
    graph = without_node(as_planned(plan), "/robot2/amcl")._replace(environment=environment(cut))
    code, out, err = held(plan, graph, capsys)
    assert code == 3
    assert "/robot2/amcl: inconclusive: MG101" in out
    assert "exactly 32 participants" in err


@pytest.mark.more
def test_an_edited_plan_is_what_counts(plan: Path, capsys: pytest.CaptureFixture[str]) -> None:
    graph = without_node(as_planned(plan), "/robot2/imu_driver")
    assert held(plan, graph, capsys)[0] == 1
    driver = re.compile(r"  - name: /robot2/imu_driver\n(?:    .*\n)*")
    plan.write_text(driver.sub("", plan.read_text()))
    assert "/robot2/imu_driver\n" not in plan.read_text()
    assert held(plan, graph, capsys)[0] == 0


@pytest.mark.more
@pytest.mark.sample(4)
@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        pytest.param("robots:", "robts:", "robts: unknown key", id="no-robots"),
        pytest.param("subscribes, topic", "hears, topic", 'not "hears"', id="role"),
        pytest.param("    ends:", "    end:", "nodes[0].end: unknown key", id="no-ends"),
        pytest.param(
            "[earth, map, utm, world]", "map", "shared_frames: expected a list", id="no-list"
        ),
        pytest.param("topic, /robot1", "topic, robot1", "expected a full name", id="relative"),
        pytest.param("layout:", "layout: [", "not valid YAML", id="no-yaml"),
        pytest.param("tf_topic: /robot1/tf", "tf_topic:", "tf_topic: expected a full", id="tf"),
        pytest.param("- name: /robot1/imu_d", "- name: imu_d", "expected a full name", id="n"),
        pytest.param(f"{ROVER}:88", "[1]", "plugin: expected an object, not [1]", id="place"),
        pytest.param("edges:\n- {", "edges:\n- odom -> {", "not valid YAML", id="edge"),
        pytest.param("    ends:\n    - [", "    ends:\n    - {[", "not valid YAML", id="row"),
        pytest.param("schema: 3", "schema: 1", "schema: expected 3, not 1", id="schema"),
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
        read_plan(plan.read_bytes(), "plan.yaml")
    capsys.readouterr()
    assert main(["check", str(plan), "--from", str(graph)]) == 2
    err = capsys.readouterr().err
    assert err.startswith(f"multibot: {plan}")
    assert err.count("\n") == 1


@pytest.mark.more
def test_a_file_that_is_not_a_snapshot(plan: Path, capsys: pytest.CaptureFixture[str]) -> None:
    capsys.readouterr()
    assert main(["check", str(plan), "--from", str(plan)]) == 2
    use = "use multibot check PLAN, which compares a snapshot with it"
    assert capsys.readouterr().err == f"multibot: {plan}: a plan; {use}\n"


# ---------------------------------------------------------------- where a node comes from


@pytest.mark.more
def test_a_cause_names_the_line(plan: Path, capsys: pytest.CaptureFixture[str]) -> None:
    graph = moved(as_planned(plan), "/robot1/cmd_vel", "/cmd_vel", "diff_drive")
    _, out, _ = held(plan, graph, capsys)
    assert f"plugin diff_drive has no namespace or remap rule for it, see {ROVER}:88" in out


# ---------------------------------------------------------------- what a plan has besides


@pytest.mark.more
@pytest.mark.parametrize("when", ["", "planning"])
def test_a_node_that_another_one_makes_is_optional_with_it(when: str, tmp_path: Path) -> None:
    nodes, plan = tmp_path / "nodes.yaml", tmp_path / "plan.yaml"
    nodes.write_text(
        "nodes:\n  planner:\n    package: own\n"
        "    subscribes: {scene: {type: std_msgs/msg/String, by: _private_*}}\n"
        f"node_sets:\n  own: {{about: x, nodes: [{{node: planner, when: {when!r}}}]}}\n"
    )
    words = ["--nodes", str(nodes), "--node-set", "own", "--layout", "frames-per-robot"]
    assert main(["plan", str(ROVER), "robot1", "robot2", *words, "-o", str(plan)]) == 0
    may_miss = optional(from_yaml(plan.read_bytes(), "plan"), "robot1")
    made = ("/robot1/planner", "/robot1/planner_private_*")
    assert set(made) & set(may_miss) == (set(made) if when else set())
