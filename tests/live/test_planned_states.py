# SPDX-License-Identifier: Apache-2.0
"""States of the plan and parameters of built files, compared with what nodes answer."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import pytest
from graph_cases import environment
from graph_examples import read_example
from node_answers import told

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.cli import multibot
from multibot_rewrite.fleet.outputs.built_states import with_built
from multibot_rewrite.planning.plan import read_plan, to_yaml
from multibot_rewrite.producers.ros import ask
from multibot_rewrite.producers.ros.observe import AGAIN_SECONDS, Answers
from multibot_rewrite.rules.check import check
from multibot_rewrite.system.json import to_json
from multibot_rewrite.system.parameters import Answer, Question, with_answers
from multibot_rewrite.system.records import (
    PUBLISHES,
    SUBSCRIBES,
    TOPIC,
    End,
    Node,
    Parameter,
    Place,
    System,
)

PLAN = """\
schema: 3
layout: frames-per-robot
shared_topics: [/tf]
shared_frames: [map]
robots:
- name: robot1
  frames: [robot1/base_link]
  nodes: [{name: /robot1/amcl}, {name: /robot1/costmap/costmap}, {name: /robot1/driver}]
- name: robot2
  frames: [robot2/base_link]
  nodes: [{name: /robot2/amcl}]
"""
# Node -> what is planned of it besides.
STATES = {
    "/robot1/amcl": "lifecycle: active, host: robot1_pc, parameters: {use_sim_time: false, "
    'base_frame_id: robot1/base_link, "a.rate": 2.5, word: "true", list: [1, 2], names: [a, "1"]}',
    "/robot1/driver": "host: robot1_pc",
}
ALPHA = {"/robot1/amcl": "parameters: {alpha1: 0.3}"}
NO_STATES: Mapping[str, str] = {}
FILE = """\
# Comes with its comment.
/robot1/amcl:
  ros__parameters:
    base_frame_id: robot1/base_link
    alpha1: 0.2
    yaml: $(find-pkg-share maps)/a.yaml
/**:
  ros__parameters:
    use_sim_time: false
robot1:
  costmap:
    costmap:
      ros__parameters: {width: 3, plugins: [a, b], layer: {enabled: true}}
"""


def plan(states: Mapping[str, str] = NO_STATES) -> System:
    text = PLAN
    for node, more in states.items():
        text = text.replace(f"{{name: {node}}}", f"{{name: {node}, {more}}}")
    return read_plan(text.encode(), "plan.yaml")


def graph(*states: Answer) -> System:
    """All planned nodes, and what they answer."""
    names = ("/robot1/amcl", "/robot1/costmap/costmap", "/robot1/driver", "/robot2/amcl")
    nodes = tuple(Node(it, "") for it in names)
    return with_answers(System(nodes, (), (), environment()), states)


def parameters(system: System) -> dict[str, list[Parameter]]:
    found: dict[str, list[Parameter]] = {}
    for it in system.parameters:
        found.setdefault(it.node, []).append(it)
    return found


def having(node: str, **values: str) -> Answer:
    return told(node, parameters=values.items())


def found(planned: System, *states: Answer) -> list[Finding]:
    return [it for it in check(planned, graph(*states)) if it.code in ("MG511", "MG132", "MG514")]


@pytest.fixture
def built(tmp_path: Path) -> Path:
    (tmp_path / "robot1").mkdir()
    (tmp_path / "robot1" / "nav2.yaml").write_text(FILE)
    (tmp_path / "robot1" / "bridge.yaml").write_text("- {ros_topic_name: x}\n")
    (tmp_path / "robot2").mkdir()
    (tmp_path / "robot2" / "nav2.yaml").write_text(FILE.replace("robot1", "robot2"))
    return tmp_path


CLOCKS = {
    "/robot1/amcl": "parameters: {use_sim_time: true}",
    "/robot1/driver": "parameters: {use_sim_time: true}",
    "/robot2/amcl": "parameters: {use_sim_time: false}",
}


@pytest.mark.parametrize(
    ("timed", "published", "wanted"),
    [
        (("/robot1/amcl", "/robot1/driver"), True, []),
        (("/robot1/amcl",), True, [("MG503", "/robot1/driver", "true")]),
        (("/robot1/amcl", "/robot1/driver"), False, [("MG501", "/robot1/amcl", "no node")]),
        (
            ("/robot1/amcl", "/robot1/driver", "/robot2/amcl"),
            True,
            [("MG503", "/robot2/amcl", "false")],
        ),
    ],
)
def test_planned_clocks_are_seen_without_asking(
    timed: tuple[str, ...], published: bool, wanted: list[tuple[str, str, str]]
) -> None:
    """A node subscribes to the clock by ``use_sim_time`` alone (rclcpp time_source.cpp)."""
    ends = [(SUBSCRIBES, it) for it in timed] + [(PUBLISHES, "/bridge")] * published
    clock, type_ = "/clock", "rosgraph_msgs/msg/Clock"
    ways = tuple(End(TOPIC, role, clock, type_, "", it, None, "") for role, it in ends)
    seen = graph()._replace(ends=ways)
    codes = ("MG501", "MG503")
    said = [it for it in check(plan(CLOCKS), seen) if it.code in codes]
    assert [(it.code, it.node) for it in said] == [it[:2] for it in wanted]
    assert all(word in it.message for it, (_, _, word) in zip(said, wanted, strict=True))
    # Without a plan of them mixed clocks are a danger.
    unplanned = [it.node for it in check(plan(), seen) if it.code == "MG503"]
    assert bool(unplanned) == (published and len(timed) < 3)
    # What a node answers counts more.
    if wanted and wanted[0][0] == "MG503":
        known = with_answers(seen, [told(wanted[0][1], sim_time=wanted[0][2] == "true")])
        assert "MG503" not in {it.code for it in check(plan(CLOCKS), known)}


# ---------------------------------------------------------------- the plan's own


@pytest.mark.parametrize(
    ("name", "value", "differs"),
    [
        ("a.rate", "2.5", False),
        ("a.rate", "2.500001", True),
        ("list", "[1.0, 2.0]", False),
        ("list", "[2, 1]", True),
        ("word", '"true"', False),
        ("word", "true", True),
        ("names", '["a", "1"]', False),
        ("use_sim_time", "0", True),
        # What no node answers; a file that somebody wrote may have it.
        ("a.rate", "}", True),
        ("a.rate", "[" * 100_000, True),
    ],
)
def test_values_are_compared_as_values(name: str, value: str, differs: bool) -> None:
    state = told("/robot1/amcl", parameters=[(name, value)])
    assert [it.code for it in found(plan(STATES), state)] == ["MG132"] * differs


def test_two_planned_hosts_on_one_machine() -> None:
    lines = ("planned: host of {0}: pc{1}", "as planned: {0}", "running: {0} on machine 1")
    text = "".join(f"{it}\n".format(f"/robot{at}/a", at) for at in (1, 2) for it in lines)
    (it,) = [it for it in check(*read_example(text)) if it.code == "MG133"]
    assert "hosts pc1, pc2 are one machine" in it.message
    unknown = re.sub("running.*machine 1\n", "", text)
    assert [it for it in check(*read_example(unknown)) if it.code == "MG133"] == []


# ---------------------------------------------------------------- built files


def test_the_files_of_a_build_say_what_each_node_has(built: Path) -> None:
    planned = with_built(plan(ALPHA), str(built))
    states = parameters(planned)
    assert states.keys() == {"/robot1/amcl", "/robot1/costmap/costmap", "/robot2/amcl"}
    file = built / "robot1" / "nav2.yaml"
    assert set(states["/robot1/amcl"]) == {
        Parameter("/robot1/amcl", "alpha1", "0.3"),
        Parameter("/robot1/amcl", "base_frame_id", '"robot1/base_link"', Place(str(file), 4)),
        Parameter("/robot1/amcl", "use_sim_time", "false", Place(str(file), 9)),
    }
    costmap = {it.name: it.value for it in states["/robot1/costmap/costmap"]}
    assert costmap == {
        "use_sim_time": "false",
        "width": "3",
        "plugins": '["a", "b"]',
        "layer.enabled": "true",
    }
    # What is from a file stays that.
    again = read_plan(to_yaml(planned).encode(), "y").parameters
    assert {*again} == {*planned.parameters}


def test_two_files_that_disagree_plan_nothing(built: Path) -> None:
    (built / "robot1" / "other.yaml").write_text(FILE.replace("0.2", "0.7"))
    states = parameters(with_built(plan(), str(built)))
    assert {it.name for it in states["/robot1/amcl"]} == {
        "base_frame_id",
        "use_sim_time",
    }


def test_check_finds_the_files_beside_the_plan(
    built: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    (built / "plan.yaml").write_text(PLAN)
    state = having("/robot1/amcl", base_frame_id='"base_link"')
    (built / "g.json").write_bytes(to_json(graph(state)))
    (built / "silent.json").write_bytes(to_json(graph()))
    monkeypatch.chdir(built)
    assert multibot.main(["check", "plan.yaml", "--from", "g.json"]) == 1
    assert "MG132" in capsys.readouterr().out
    (built / "elsewhere").mkdir()
    (built / "elsewhere" / "plan.yaml").write_text(PLAN)
    assert multibot.main(["check", "elsewhere/plan.yaml", "--from", "g.json"]) == 0
    (built / "robot1" / "nav2.yaml").write_text("ros__parameters: [")
    assert multibot.main(["check", "plan.yaml", "--from", "silent.json"]) == 0
    capsys.readouterr()
    assert multibot.main(["check", "plan.yaml", "--from", "g.json"]) == 2
    assert "robot1/nav2.yaml:1:19: not valid YAML" in capsys.readouterr().err


class Asked:
    """Nodes that answer with what is in ``states``; how often they were asked."""

    def __init__(self, *states: Answer) -> None:
        self.states, self.times = states, 0

    def __call__(self, asked: object) -> tuple[Answer, ...]:
        self.times += 1
        return self.states


A, B = Answer("/a", "active"), Answer("/b", "active")
BOTH = System((Node("/a", ""), Node("/b", "")), (), (), environment())


def test_a_watched_graph_is_asked_when_it_is_quiet_and_again_after_a_while() -> None:
    nodes = Asked(B, A)
    answers = Answers(nodes, {})
    assert answers.old(0.0)
    assert not answers.update(BOTH, quiet=False, now=1.0) and nodes.times == 0
    assert answers.update(BOTH, quiet=True, now=4.0) and answers.states == (A, B)
    assert not answers.old(4.0 + AGAIN_SECONDS - 1) and answers.old(4.0 + AGAIN_SECONDS)
    nodes.states = (A, B)
    assert not answers.update(BOTH, quiet=True, now=20.0)
    nodes.states = (A._replace(lifecycle="inactive"), B)
    assert answers.update(BOTH, quiet=True, now=30.0) and answers.states == nodes.states


def test_a_node_that_hangs_keeps_its_answer_and_one_that_left_has_none() -> None:
    nodes = Asked(A, B)
    answers = Answers(nodes, {})
    answers.update(BOTH, quiet=True, now=4.0)
    nodes.states = (B,)
    assert not answers.update(BOTH, quiet=True, now=14.0) and answers.states == (A, B)
    assert answers.update(BOTH._replace(nodes=BOTH.nodes[1:]), quiet=False, now=15.0)
    assert answers.states == (B,)


def test_nobody_is_asked_without_state() -> None:
    nodes = Asked(A)
    answers = Answers(nodes, None)
    assert not answers.old(100.0) and not answers.update(BOTH, quiet=True, now=100.0)
    assert nodes.times == 0


def test_a_node_that_lacks_one_parameter_is_asked_for_the_others() -> None:
    """rclcpp answers such a question with no value at all."""

    class Answer(NamedTuple):
        values: list[object]

    asked = Question("/a", "/a/get_parameters", "t", ("x", "y", "z"))
    halves = ask.halves(asked, Answer([]))
    assert [it.parameters for it in halves] == [("x",), ("y", "z")]
    assert ask.halves(asked, Answer([1, 2, 3])) == []
    assert ask.halves(halves[0], Answer([])) == []
    assert ask.halves(Question("/a", "/a/get_state", "t"), object()) == []
