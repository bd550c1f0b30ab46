# SPDX-License-Identifier: Apache-2.0
"""What comes first and what comes inside: sections that count before others, tools in braces."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
import yaml
from fleet_folder import SMALL, fleet_folder

from multibot_rewrite.cli.multibot import main

EMPTY = "Visualization Manager:\n  Class: ''\n  Displays: []\n  Tools:\n"


def build(folder: Path, layout: str = "frames-per-robot", **files: str) -> int:
    """Build the small fleet with these files in the place of its own."""
    fleet = fleet_folder(folder, SMALL.replace("frames-per-robot", layout), **files)
    return main(["build", str(fleet), "-o", str(folder / "out"), "--quiet"])


# Which section of a parameter file counts.


def section(name: str, **parameters: object) -> str:
    return yaml.safe_dump({name: {"ros__parameters": parameters}})


AMCL, OTHER, ALL = section("amcl", alpha1=0.1), section("node", beta=1), section("/**", alpha1=0.2)


def shadowed(folder: Path, capsys: pytest.CaptureFixture[str], *sections: str) -> list[int]:
    """Return the lines of parameters that take the place of earlier ones."""
    assert build(folder, params__yaml="".join(sections)) == 0
    err = capsys.readouterr().err
    return [int(line) for line in re.findall(r"params\.yaml:(\d+):\d+: \w+: MB867\b", err)]


@pytest.mark.sample(4)
@pytest.mark.slow
@pytest.mark.parametrize(
    ("sections", "lines"),
    [
        pytest.param((AMCL, ALL), [6], id="a pattern after the node's own section"),
        pytest.param((ALL, AMCL), [], id="before it: the node's own section counts"),
        pytest.param((OTHER, ALL, AMCL), [], id="before it, and after one of another node"),
        pytest.param((OTHER, ALL, section("node", alpha1=1)), [], id="of a node that comes again"),
        pytest.param((AMCL, OTHER, ALL), [9], id="after it, and after one of another node"),
        pytest.param((AMCL, ALL, section("x", alpha1=1)), [6], id="between two nodes"),
        pytest.param((AMCL, OTHER), [], id="no pattern"),
        pytest.param((AMCL, section("/**", gamma=1)), [], id="a pattern with other parameters"),
        pytest.param((AMCL, section("/**/node", alpha1=1)), [], id="a pattern of another node"),
        pytest.param((OTHER, section("/**/amcl", alpha1=1.0), ALL), [], id="two patterns"),
    ],
)
def test_a_pattern_takes_the_place_of_earlier_sections_only(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], sections: tuple[str, ...], lines: list[int]
) -> None:
    """rcl goes through a file from top to bottom, and the last value counts."""
    assert shadowed(tmp_path, capsys, *sections) == lines


# Tools of RViz that are written in braces.


def tools(folder: Path, name: str = "one_robot.rviz") -> list[dict[str, Any]]:
    made = yaml.safe_load((folder / "out" / name).read_text())
    found: list[dict[str, Any]] = made["Visualization Manager"]["Tools"]
    return found


@pytest.mark.sample(3)
@pytest.mark.slow
@pytest.mark.parametrize(
    "written",
    [
        "- {Class: rviz_default_plugins/SetGoal}",
        "- {Class: rviz_default_plugins/SetGoal }  # a goal",
        "- {Class: rviz_default_plugins/SetGoal, Depth: {a: 1}}",
        "- { Depth: [1],\n     Class: rviz_default_plugins/SetGoal\n     }",
        "- Class: rviz_default_plugins/SetGoal",
        "- Class: rviz_default_plugins/SetGoal\n      Depth: {a: 1}",
    ],
)
def test_each_robots_tool_gets_its_topic_however_it_is_written(
    tmp_path: Path, written: str
) -> None:
    before = yaml.safe_load(f"{EMPTY}    {written}\n")["Visualization Manager"]["Tools"][0]
    last = "    - {Class: rviz_default_plugins/Measure}\n"
    assert build(tmp_path, one_robot__rviz=f"{EMPTY}    {written}\n{last}") == 0
    topics = ("/robot1/goal_pose", "/robot2/goal_pose")
    assert tools(tmp_path) == [
        *({**before, "Topic": topic} for topic in topics),
        {"Class": "rviz_default_plugins/Measure"},
    ]
