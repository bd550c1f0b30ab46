# SPDX-License-Identifier: Apache-2.0
"""Robots that are chosen when a fleet starts: as a text with poses, as a number, as a dict."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import pytest
import yaml

from multibot_rewrite import InputError, UsageError, load_fleet
from multibot_rewrite.fleet.file.fleet_file import read_fleet
from multibot_rewrite.fleet.file.robot_choice import Choice

URDF = '<robot name="r"><link name="base_link"/></robot>'
PATTERN = {"name": "robot", "count": 3, "pose": {"x": 1}, "step": {"x": 0.5, "y": 2}}


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "r.urdf").write_text(URDF)
    (tmp_path / "own.urdf").write_text(URDF)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def poses(robots: list[dict[str, Any]], choice: Choice) -> dict[str, tuple[float, float] | None]:
    fleet = read_fleet({"description": "r.urdf", "robots": robots}, "jazzy", {}, choice)
    return {it.name: (it.pose.x, it.pose.y) if it.pose else None for it in fleet.robots}


def test_a_fleet_of_a_dict_is_that_of_its_file(here: Path) -> None:
    data = {"description": "r.urdf", "layout": "frames-per-robot", "robots": [PATTERN]}
    (here / "fleet.yaml").write_text(yaml.safe_dump(data))
    made, read = load_fleet(data), load_fleet("fleet.yaml")
    assert [it.description for it in made.robots] == [it.description for it in read.robots]
    assert made.robot("robot3").pose == read.robot("robot3").pose
    names = [it.name for it in load_fleet("fleet.yaml", robots="a={x: 1}; b={x: 2}").robots]
    assert names == ["a", "b"]
    assert len(load_fleet(data, count=2).robots) == 2
    assert [it.name for it in pickle.loads(pickle.dumps(made)).robots] == list(
        poses([PATTERN], Choice())
    )


def test_numbered_robots_go_on(here: Path) -> None:
    two = [{"name": "r1", "pose": {"x": 1.0}}, {"name": "r2", "pose": {"x": 1.5, "y": 2.0}}]
    four = poses(two, Choice(number=4))
    assert list(four) == ["r1", "r2", "r3", "r4"]
    assert four["r4"] == (2.5, 6.0)
    assert list(poses(two, Choice(number=1))) == ["r1"]
    kinds = [{"name": it} for it in ("arm2", "r1", "arm1")]
    assert list(poses(kinds, Choice(number=5))) == ["arm2", "r1", "arm1", "arm3", "arm4"]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("robot1={x: 1.0; robot2={}", "is no pose"),
        ("robot1={height: 1.0}", "'height' is none of x, y"),
        ("robot1={x: far}", "'far'; write a number"),
        ("robot1={x: true}", "True; write a number"),
        ("robot1=[1, 2]", "is no pose"),
        ("robot 1={}", "robot 1"),
        ("={x: 1}", "has no name"),
        ("a; a={}", "a is there twice"),
    ],
)
def test_a_wrong_text_is_one_line(here: Path, text: str, said: str) -> None:
    with pytest.raises(UsageError) as error:
        poses([{"name": "robot1"}], Choice(text))
    assert said in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("robots", "choice", "said"),
    [
        ([{"name": "a"}], Choice(number=2), "does not say what more robots are called"),
        ([{"name": "a1"}], Choice(number=2), "write count: 2 into one of its robots"),
        (
            [{"name": "a1"}, {"name": "b"}],
            Choice(number=3),
            "or end the name of the last one with a",
        ),
        ([{"name": "a1"}, {"name": "a2"}], Choice(number=20_000), "from 1 to"),
        ([PATTERN], Choice(number=-1), "from 1 to"),
        ([{"name": "a", "step": {"x": 1}}], Choice(), "step is of a robot with count"),
        ([{"name": "a", "count": 0}], Choice(), "count"),
        ([{**PATTERN, "namespace": "one"}], Choice(), "cannot share a namespace"),
        ([{"name": "robot", "count": 2, "pose": {"x": 1}}], Choice(), "has the pose of"),
        ([PATTERN, {"name": "robot2"}], Choice(), "'robot2' is repeated"),
        ([{"name": object()}], Choice(), "the fleet's dict"),
    ],
)
def test_a_wrong_pattern_is_one_line(
    here: Path, robots: list[dict[str, Any]], choice: Choice, said: str
) -> None:
    with pytest.raises((InputError, UsageError)) as error:
        poses(robots, choice)
    assert said in str(error.value)
    assert "\n" not in str(error.value)
