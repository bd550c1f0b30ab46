# SPDX-License-Identifier: Apache-2.0
"""The schema of plans that editors read: it takes what the reader takes, and nothing else."""

from __future__ import annotations

import json
from importlib.resources import files
from pathlib import Path
from typing import Any

import jsonschema
import pytest
import yaml
from paths import FIXTURES, ROOT

from multibot_rewrite.base import editors
from multibot_rewrite.base.model import InputError
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.spelling.plan_file import read_plan
from multibot_rewrite.spelling.plan_schema import schema

# Every key once, as the comment at the top of a plan has it.
WHOLE = """\
distro: jazzy
layout: tf-per-robot
shared_nodes: {/clock_bridge: [[publishes, topic, /clock, rosgraph_msgs/msg/Clock, clock]]}
shared_topics: [/clock]
shared_frames: [map]
ignored_nodes: [/rqt*]
domains: {robot1: 11, shared_nodes: 10}
robots:
  robot1:
    tf: /robot1/tf
    frames: [base_link]
    other_frames: [odom]
    optional: [/robot1/teleop]
    spelled: r1
    nodes: {/robot1/amcl: [[publishes, topic, /robot1/pose, a/msg/B | a/msg/C, pose]], /robot1/teleop: }
topics: {/robot1/cmd_vel: {senders: [/robot1/mux], one_sender: true, qos: {durability: volatile},
  bridge: [publishes, subscribes], type: geometry_msgs/msg/Twist}}
one_of: [[/robot1/a, /robot1/b]]
states: {/robot1/amcl: {lifecycle: active, host: pc, parameters: {use_sim_time: false, x: [1, 2.5]}}}
sources: {/robot1/amcl: 'rover.urdf:3'}
from: {/robot1/amcl: stack nav2}
ways: {/robot1/amcl: plugin}
sends: {/robot1/amcl: map -> odom}
open: [{code: MB101, level: warning, at: 'a.urdf:1', message: m, hint: h}]
"""
# What is wrong, and what of WHOLE it takes the place of.
WRONG = {
    "layuot: x\nlayout:": "layout:",
    "distro: jammy": "distro: jazzy",
    "[[publish, topic": "[[publishes, topic",
    "[[publishes, topics": "[[publishes, topic",
    "Clock, clock, more]]": "Clock, clock]]",
    "topic, clock,": "topic, /clock,",
    "tf: robot1/tf": "tf: /robot1/tf",
    "frames: base_link": "frames: [base_link]",
    "frame: [base_link]": "frames: [base_link]",
    "one_sender: maybe": "one_sender: true",
    "qos: {depth: '1'}": "qos: {durability: volatile}",
    "bridge: []": "bridge: [publishes, subscribes]",
    "lifecycle: running": "lifecycle: active",
    "states: {amcl: ": "states: {/robot1/amcl: ",
    "x: {y: 1}": "x: [1, 2.5]",
    "sends: {/robot1/amcl: [odom]}": "sends: {/robot1/amcl: map -> odom}",
    "level: bad": "level: warning",
    "domains: {robot1: 233,": "domains: {robot1: 11,",
    "domains: {robot1: true,": "domains: {robot1: 11,",
    "one_of: [a]": "one_of: [[/robot1/a, /robot1/b]]",
}


def wrong(text: str) -> list[Any]:
    return [*jsonschema.Draft202012Validator(schema()).iter_errors(yaml.safe_load(text))]


def test_the_file_is_what_the_reader_takes() -> None:
    text = (files("multibot_rewrite") / editors.PLAN).read_text()
    command = "python -m multibot_rewrite.spelling.plan_schema > multibot_rewrite/" + editors.PLAN
    assert json.loads(text) == schema(), command
    jsonschema.Draft202012Validator.check_schema(schema())


def test_every_key_is_taken_by_both() -> None:
    assert {*yaml.safe_load(WHOLE)} == {*schema()["properties"]}
    assert wrong(WHOLE) == []
    read_plan(WHOLE.encode(), "plan.yaml")


def test_plans_that_are_kept_follow_it() -> None:
    page = (ROOT / "docs" / "plan.md").read_text()
    example = page.partition("```yaml\n")[2].partition("```")[0]
    for text in (example, (FIXTURES / "graphs" / "plan.yaml").read_text()):
        assert wrong(text) == []


def test_a_plan_in_a_file_names_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["plan", str(FIXTURES / "robots" / "rover.urdf"), "robot1", "robot2"]
    plan = tmp_path / "plan.yaml"
    assert main([*words, "-o", str(plan)]) == 0
    first, text = plan.read_text().split("\n", 1)
    named = first.removeprefix("# yaml-language-server: $schema=")
    assert json.loads((tmp_path / named).read_text()) == schema()
    assert wrong(text) == []
    assert main([*words, "-o", str(tmp_path / "plan.json")]) == 0
    assert wrong((tmp_path / "plan.json").read_text()) == []
    assert read_plan(plan.read_bytes(), "") == read_plan(text.encode(), "")


def test_a_built_plan_names_the_schema_beside_it(tmp_path: Path) -> None:
    """A relative path: a build is the same on every machine."""
    out = tmp_path / "out"
    fleet = ROOT / "examples" / "launch_tutorial" / "fleet.yaml"
    assert main(["build", str(fleet), "-o", str(out)]) == 0
    first = (out / "plan.yaml").read_text().partition("\n")[0]
    named = out / first.removeprefix("# yaml-language-server: $schema=")
    assert named.parent == out
    jsonschema.validate(
        yaml.safe_load((out / "plan.yaml").read_text()), json.loads(named.read_text())
    )


@pytest.mark.parametrize("text", WRONG)
def test_what_the_reader_refuses_is_marked(text: str) -> None:
    assert WHOLE.count(WRONG[text]) >= 1
    bad = WHOLE.replace(WRONG[text], text, 1)
    assert wrong(bad)
    with pytest.raises(InputError):
        read_plan(bad.encode(), "plan.yaml")
