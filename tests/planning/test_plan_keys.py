# SPDX-License-Identifier: Apache-2.0
"""A plan as a file: every key is written, comes back, and is refused where it is wrong.

The schema that editors read marks what the reader refuses.
"""

from __future__ import annotations

import json
from importlib.resources import files
from pathlib import Path
from typing import Any

import pytest
import yaml
from hypothesis import assume, given, strategies as st
from jsonschema import Draft202012Validator
from paths import FIXTURES, ROOT, fixture_text

from multibot_rewrite.base import editors
from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import InputError
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.planning.plan import HEAD, read_plan, to_yaml
from multibot_rewrite.system.json import to_json
from multibot_rewrite.system.parameters import parameter_text
from multibot_rewrite.system.records import (
    CALLS,
    MAY,
    PUBLISHES,
    RUNS,
    SERVES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    Domain,
    Edge,
    End,
    Node,
    Parameter,
    Place,
    Robot,
    System,
    Topic,
)

STRING = "std_msgs/msg/String"
EITHER = ("/r1/drive", "/r1/spare")
DRIVE = Node(
    "/r1/drive",
    robot="r1",
    lifecycle="active",
    host="pc",
    way="plugin",
    taker="/r1/gz",
    sure=RUNS._replace(instead=EITHER),
    place=Place("../a.yaml", 3),
    plugin=Place("r.urdf", 7),
)
# What has more than its short form says stands where it is said whole.
WITH_RATE = MAY._replace(why="rate set")
PLAN = System(
    nodes=(
        DRIVE,
        Node("/r1/arm", robot="r1", sure=MAY, node_set="nav2", way="spawner"),
        Node("/r1/spare", robot="r1", sure=MAY._replace(instead=EITHER)),
        Node("/map_server"),
    ),
    ends=(
        End(TOPIC, PUBLISHES, "/r1/x", STRING, node="/r1/drive", code_name="x", also=("a/msg/B",)),
        End(TOPIC, SUBSCRIBES, "/r1/y", STRING, node="/r1/drive", sure=MAY),
        End(SERVICE, CALLS, "/r1/go", "a/srv/Go", "", "/r1/drive", None, "", "go", (), WITH_RATE),
        End(SERVICE, SERVES, "/map", "", node="/map_server", code_name="/map"),
        End(TOPIC, PUBLISHES, "/z", STRING, node="/gone", place=Place("odd:1")),
    ),
    edges=(
        Edge("base", "odom", publishers=("/r1/drive",)),
        Edge("lidar", "base", "/tf_static", True, (), transform=(0.5, -1, 1e-7, 0, 0, 0, 1)),
    ),
    parameters=(
        Parameter("/r1/drive", "use_sim_time", "false"),
        Parameter("/r1/drive", "rates", '[1, 2.5, "no"]'),
        Parameter("/r1/drive", "gain", "1.0"),
        Parameter("/r1/drive", "is_on", "true"),
        Parameter("/r1/arm", "rate", "5", Place("p.yaml", 2)),
    ),
    robots=(Robot("r1", ("b1/base",), "/r1/tf", ("b1/gps",), "b1"),),
    topics=(
        Topic("/r1/x", ("/r1/d*",), True, (("durability", "VOLATILE"),), (PUBLISHES,), STRING),
    ),
    layout="tf-per-robot",
    release="jazzy",
    shared_topics=("/clock",),
    shared_frames=("map",),
    ignored_nodes=("helper*",),
    gaps=(Finding("MG102", "warning", "nothing sends", "start it", "a.yaml", 3, 5, node="/r1/x"),),
    domains=(Domain("r1", 11), Domain("", 10)),
)
TEXT = fixture_text("plan_keys_text.yaml")
SCHEMA = json.loads((files("multibot_rewrite") / editors.PLAN).read_text())


def marked(text: str) -> list[Any]:
    """Return what an editor marks in a plan."""
    value = json.loads(text) if text.startswith("{") else yaml.safe_load(text)
    return [*Draft202012Validator(SCHEMA).iter_errors(value)]


def test_every_key_of_a_plan_is_written_and_comes_back() -> None:
    assert to_yaml(PLAN) == HEAD + TEXT
    assert yaml.safe_load(TEXT) == json.loads(to_json(PLAN))
    for text in (TEXT, to_json(PLAN).decode()):
        assert read_plan(text.encode(), "plan") == PLAN
        assert marked(text) == []


# What YAML takes for something else, and what no one line holds.
ODD = st.text(st.characters(codec="utf-8"), max_size=6) | st.sampled_from(
    ["no", "~", "1e3", "0x1", "- a", "a: b", "#", "a | b", "a:1", "..", "[]", "\x85", "\ufeff"]
)


@pytest.mark.more
@given(ODD, ODD, ODD, st.booleans() | st.integers() | st.floats(allow_nan=False) | ODD)
def test_any_text_comes_back(name: str, word: str, type_: str, value: object) -> None:
    assume(" | " not in f"{type_}{name}")
    node = Node(
        f"/{name}", robot=f"{word}1", host=word, node_set=name, place=Place(word, 2), sure=MAY
    )
    end = End(TOPIC, PUBLISHES, f"/{word}", type_, node=node.name, code_name=name, also=(name,))
    plan = System(
        (node, Node("/runs", robot=f"{word}1")),
        (end, end._replace(sure=MAY._replace(why=word))),
        parameters=(Parameter(node.name, name, parameter_text(value)),),
        robots=(Robot(f"{word}1", (name, type_)),),
        layout="both",
        ignored_nodes=(type_,),
    )
    for data in (to_yaml(plan).encode(), to_json(plan)):
        assert read_plan(data, "plan") == plan


DRIVES, R1 = "robots[0].nodes[0]", "robots[0]"


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("layout:", "layuot:", "layuot: unknown key; the keys are nodes, ends, edges"),
        ("schema: 3", "schema: 4", "schema: expected 3, not 4; write it again with multibot plan"),
        ("release: jazzy", "release: jammy", "release: expected one of"),
        ("[publishes, topic", "[publish, topic", f"{DRIVES}.ends[0].role: expected one of publ"),
        ("[publishes, topic", "[publishes, topics", f"{DRIVES}.ends[0].kind: expected one of topic"),
        ("topic, /r1/x", "topic, r1/x", f"{DRIVES}.ends[0].name: expected a full name that starts"),
        ("a/msg/B, x]", "a/msg/B]", f"{DRIVES}.ends[0]: expected [role, kind, name, type, name in"),
        ("a/msg/B, x]", "a/msg/B, 1]", f"{DRIVES}.ends[0]: expected [role, kind, name, type, name"),
        ("y, type: std_msgs/msg/String, ", "y, ", f"{DRIVES}.ends[1].type: missing; it is needed"),
        ("node: /gone, ", "", "ends[0].node: missing; it is needed"),
        ("- name: /r1/drive", "- name: drive", f'{DRIVES}.name: expected a full name that starts'),
        ("  - {name: /r1/arm,", "  - [/r1/arm]\n  - {name: /r1/arm,", "nodes[1]: expected an object"),
        ("    - [publ", "    - publ\n    - [publ", f"{DRIVES}.ends[0]: expected an object, not"),
        ("lifecycle: active", "life: active", f"{DRIVES}.life: unknown key; the keys are name, pro"),
        ("host: pc", "host: 1", f"{DRIVES}.host: expected text, not 1"),
        ("nav2, sure: may", "nav2, sure: perhaps", "nodes[1].sure.word: expected one of runs, may"),
        ("{use_sim_time: false,", "{use_sim_time: {},", f"{DRIVES}.parameters.use_sim_time: write a"),
        ("[1, 2.5,", "[null, 2.5,", f"{DRIVES}.parameters.rates: write a text, a number, true or f"),
        ('{use_sim_time: false, rates: [1, 2.5, "no"], gain: 1.0, is_on: true}', "[1]",
         f"{DRIVES}.parameters: expected a mapping of names to values, not [1]"),
        ("tf_topic: /r1/tf", "tf_topic: r1/tf", f"{R1}.tf_topic: expected a full name that starts"),
        ("frames: [b1/base]", "frames: b1/base", f"{R1}.frames: expected a list"),
        ("- name: r1\n", "-\n", f"{R1}.name: missing; it is needed"),
        ("- name: r1\n", "- nam: r1\n", f"{R1}.nam: unknown key; the keys are name, frames, tf_topic"),
        ("    ends:\n    - [publ", "    end:\n    - [publ", "plugin, known, untold, ends, parameters"),
        ("[/clock]", "/clock", 'shared_topics: expected a list, not "/clock"'),
        ("one_sender: true", "one_sender: 1", "topics[0].one_sender: expected true or false, not 1"),
        ("{durability: VOLATILE}", "[]", "topics[0].qos: expected a mapping, as {durability: trans"),
        ("durability: V", "depth: V", "topics[0].qos.depth: write words of history, reliability, d"),
        ("durability: VOLATILE", "durability: 1", "topics[0].qos.durability: write words of histor"),
        ("bridge: [publishes]", "bridge: [sends]", "topics[0].bridge[0]: expected one of publishes"),
        ("name: /r1/x, s", "name: x, s", "topics[0].name: expected a full name that starts with /"),
        ("level: warning", "level: bad", "gaps[0].level: expected one of error, warning, note"),
        ("number: 11", "number: true", "domains[0].number: expected a whole number, not true"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said_with_its_place_and_marked(old: str, new: str, said: str) -> None:
    assert old in TEXT
    wrong = TEXT.replace(old, new, 1)
    with pytest.raises(InputError) as refused:
        read_plan(wrong.encode(), "p.yaml")
    assert str(refused.value).startswith("p.yaml: ")
    assert said in str(refused.value) and "\n" not in str(refused.value)
    assert marked(wrong)


@pytest.mark.parametrize(
    ("plan", "said"),
    [
        (PLAN._replace(robots=()), "no robot is planned, so every graph would be as planned"),
        (PLAN._replace(nodes=PLAN.nodes[1:2]), "r1 has no node that must run, so every graph"),
        (PLAN._replace(robots=PLAN.robots * 2), "robots: r1 is there twice; join the two"),
        (PLAN._replace(domains=(Domain("r2", 1),)), "domains: robot 'r2' is not known"),
        (PLAN._replace(domains=(Domain("r1", 233),)), "domains: 233: write a ROS_DOMAIN_ID, 0 to 232"),
        (PLAN._replace(nodes=(DRIVE._replace(lifecycle="on"), *PLAN.nodes[1:])),
         "/r1/drive: lifecycle: state 'on' is not known; known: active, finalized"),
        (PLAN._replace(nodes=(DRIVE, PLAN.nodes[2]._replace(sure=MAY))),
         "/r1/spare: sure: of these nodes one runs, or another group; write instead: [/r1/driv"),
    ],
)  # fmt: skip
def test_what_no_graph_or_every_graph_is_like(plan: System, said: str) -> None:
    for data in (to_yaml(plan).encode(), to_json(plan)):
        with pytest.raises(InputError) as refused:
            read_plan(data, "p")
        assert said in str(refused.value)


def test_a_plan_without_a_layout_is_none() -> None:
    with pytest.raises(InputError, match="p: layout: missing; it is needed"):
        read_plan(TEXT.replace("layout: tf-per-robot\n", "").encode(), "p")


OLD = """\
distro: jazzy
layout: both
shared_nodes: {}
shared_topics: [/clock]
shared_frames: [map]
ignored_nodes: []
robots:
  robot1: {tf: /tf, frames: [], nodes: {/robot1/amcl: []}}
"""


@pytest.mark.parametrize("name", ["plan.yaml", "plan.json"])
def test_a_plan_of_an_earlier_version_is_refused_with_the_command_that_makes_it(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = json.dumps(yaml.safe_load(OLD)) if name.endswith("json") else OLD
    (tmp_path / name).write_text(text)
    file = str(tmp_path / name)
    for words in (
        ["check", file, "--from", f"{FIXTURES}/graphs/healthy.json"],
        ["check-launch", str(ROOT / "tests/support/launched_here.py"), "--plan", file],
    ):
        assert main(words) == 2
        said = capsys.readouterr().err
        assert f"{file}: a plan of an earlier version" in said
        assert f"multibot plan fleet.yaml -o {file}" in said
        assert said.count("\n") == 1


def test_a_plan_is_no_graph(capsys: pytest.CaptureFixture[str]) -> None:
    """It would be as planned, whatever runs."""
    plan = f"{FIXTURES}/graphs/plan.yaml"
    assert main(["check", plan, "--from", plan]) == 2
    assert "plan.yaml: a plan; use multibot check" in capsys.readouterr().err


def test_a_plan_in_json_is_no_graph(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    plan = tmp_path / "plan.json"
    plan.write_bytes(to_json(PLAN))
    assert main(["check", str(plan), "--from", str(plan)]) == 2
    assert "plan.json: a plan; use multibot check" in capsys.readouterr().err
