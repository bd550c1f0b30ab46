# SPDX-License-Identifier: Apache-2.0
"""The file of a system: its published schema, and what older versions wrote."""

from __future__ import annotations

import json
from importlib.resources import files
from typing import Any

import pytest
from graph_cases import CASES
from jsonschema import Draft202012Validator
from paths import ROOT

from multibot_rewrite import system_of_description
from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import Edit, InputError
from multibot_rewrite.system.json import from_json, to_json
from multibot_rewrite.system.records import (
    MAY,
    Controller,
    Edge,
    Heard,
    Node,
    Parameter,
    Robot,
    System,
)

TEXT = files("multibot_rewrite.system").joinpath("system.schema.json").read_text()
VALID = Draft202012Validator(json.loads(TEXT))
ALL = System(
    nodes=(Node("/r1/amcl", robot="r1", lifecycle="active", sure=MAY._replace(why="slam: false")),),
    heard=(Heard("/scan", "laser"),),
    parameters=(Parameter("/r1/amcl", "use_sim_time", "true"),),
    controllers=(Controller("/r1/controller_manager", "arm", "active", ("j1/position",)),),
    robots=(Robot("r1", ("r1/base_link",), "/r1/tf"),),
    # A plan: who sends a transform, not on which topic, and what is open.
    edges=(Edge("r1/base_link", "r1/odom", "", False, ("/r1/ekf",)),),
    gaps=(Finding("MG102", "warning", "nothing sends /scan", "start a driver", "a.yaml", 3, 1),),
)


@pytest.mark.sample(1)
@pytest.mark.parametrize("path", [f"{it.stem}.json" for it in CASES])
def test_what_is_written_is_valid(path: str) -> None:
    VALID.validate(json.loads((ROOT / path).read_bytes()))


def test_what_fixes_a_file_is_not_in_the_file_of_a_system() -> None:
    fixed = ALL.gaps[0]._replace(edits=(Edit(0, 1, b"a", b"b"),))
    assert to_json(ALL._replace(gaps=(fixed,))) == to_json(ALL)
    told = {"code": "MG102", "level": "warning", "message": "m", "edits": [[0, 1, "a", "b"]]}
    wrong = {**json.loads(to_json(ALL)), "gaps": [told]}
    assert not VALID.is_valid(wrong)
    with pytest.raises(InputError, match=r"g: gaps\[0\].edits: not a key of a file; leave it out"):
        from_json(json.dumps(wrong).encode(), "g")


def test_every_kind_of_record_is_valid_and_comes_back() -> None:
    VALID.validate(json.loads(to_json(ALL)))
    assert from_json(to_json(ALL), "g") == ALL


@pytest.mark.more
def test_a_plan_is_written_as_any_system() -> None:
    robots, policy = ["robot1", "robot2"], {"layout": "both"}
    rover = ROOT / "fixtures" / "robots" / "rover.urdf"
    plan = system_of_description(rover, robots, node_sets=["nav2"], policy=policy)
    assert any(not it.topic for it in plan.edges)
    VALID.validate(json.loads(to_json(plan)))
    assert from_json(to_json(plan), "plan") == plan


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("gaps", [{"code": "MG102", "level": "bad", "message": "m"}]),
        ("edges", [{"child": "a", "parent": "b", "topic": "tf", "static": True, "publishers": []}]),
        ("nodes", [{"name": "amcl"}]),
        ("nodes", [{"name": "/amcl", "pid": 3}]),
        ("nodes", [{"name": "/amcl", "sure": {"word": "perhaps"}}]),
        ("parameters", [{"node": "/amcl", "name": "rate", "value": 5}]),
        ("controllers", [{"manager": "/manager", "name": "arm"}]),
        ("ends", [{"kind": "topic"}]),
        ("endpoints", []),
        ("schema", 1),
    ],
)
def test_the_schema_refuses_what_the_reader_refuses(key: str, value: Any) -> None:
    wrong = {**json.loads(to_json(ALL)), key: value}
    assert not VALID.is_valid(wrong)
    with pytest.raises(InputError):
        from_json(json.dumps(wrong).encode(), "g")


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("nodes", 1, "nodes: expected a list, not 1"),
        ("nodes", [{"name": 7}], "nodes[0].name: expected a full name that starts with /, not 7"),
        ("nodes", [{"name": "/a"}, {"name": "a"}],
         'nodes[1].name: expected a full name that starts with /, not "a"'),
        ("nodes", [{"name": "/a", "process": 7}], "nodes[0].process: expected text, not 7"),
        ("environment", {"domain": True}, "environment.domain: expected a whole number, not true"),
        ("environment", {"super_client": 1}, "environment.super_client: expected true or false, not 1"),
        ("environment", {"seconds": "é"}, 'environment.seconds: expected a number or null, not "é"'),
        ("environment", {"seconds": True}, "environment.seconds: expected a number or null, not true"),
        ("environment", {"seconds": 1e301}, "environment.seconds: expected a number or null, not 1e+3"),
        ("edges", [{"child": "a", "parent": "b", "topic": "/tf", "static": True, "publishers": [],
                    "transform": [1]}],
         "edges[0].transform: expected 7 numbers: x, y, z and a quaternion x, y, z, w, not [1]"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said_with_its_keys(key: str, value: Any, said: str) -> None:
    with pytest.raises(InputError) as refused:
        from_json(json.dumps({**json.loads(to_json(ALL)), key: value}).encode(), "g")
    assert str(refused.value).startswith(f"g: {said}")
