# SPDX-License-Identifier: Apache-2.0
"""The files that ``check --suggest`` begins a fleet with, for graphs whose robots are known here."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import graph_cases
import pytest
import small_fleet
from graph_calls import GuessedRobot, diagnose

from multibot_rewrite.knowledge.node_sets import built_in
from multibot_rewrite.live.suggestion import suggestion
from multibot_rewrite.system.records import System


def suggested(graph: System) -> dict[str, str]:
    return suggestion(diagnose(graph), built_in("jazzy"))


def test_of_robots_with_bare_frames_the_first_ones_tree_is_written() -> None:
    """One tf topic each, and no frame has a robot's name: robot2 has a second laser."""
    graph = small_fleet.healthy("L1")
    more = next(it for it in graph.edges if it.topic.startswith("/robot2/"))
    graph = graph._replace(edges=(*graph.edges, more._replace(child="laser2")))
    root = ET.fromstring(suggested(graph)["robot.urdf"])
    assert {it.attrib["name"] for it in root.iter("link")} == {"base_link", "laser"}


AB = "robots:\n  - {name: a}\n  - {name: b}\n"


@pytest.mark.parametrize(
    ("robots", "layout", "more"),
    [
        ((GuessedRobot("a", "/a"), GuessedRobot("b", "")), "tf-per-robot", ""),
        ((GuessedRobot("a", ""), GuessedRobot("b", "")), "frame-prefix", ""),
        ((GuessedRobot("a", "", before="a_"), GuessedRobot("b", "")), "frame-prefix",
         "affix: prefix\nseparators: {link: '_', frame: '_'}\n"),
        ((GuessedRobot("a", "", behind="-a"), GuessedRobot("b", "", behind="-b")), "frame-prefix",
         "separators: {link: '-', frame: '-'}\n"),
        ((GuessedRobot("a", "", before="a/"), GuessedRobot("b", "", before="b/")), "frame-prefix",
         "affix: prefix\n"),
        ((GuessedRobot("a", "", before="a_"), GuessedRobot("b", "", behind="-b")), "frame-prefix",
         "affix: prefix\n"),
    ],
)  # fmt: skip
def test_a_fleet_file_of_what_the_names_of_robots_show(
    robots: tuple[GuessedRobot, ...], layout: str, more: str
) -> None:
    seen = diagnose(System(environment=graph_cases.environment()))._replace(robots=robots)
    found = suggestion(seen, built_in("jazzy"))
    text = found["fleet.yaml"].partition("runs\n")[2]
    assert text == f"layout: {layout}\n{more}description: robot.urdf\n{AB}"
    assert found["robot.urdf"] == (
        '<?xml version="1.0"?>\n'
        "<!-- The frames that were heard on tf: put your own description in its place. -->\n"
        '<robot name="seen">\n  <link name="base_link"/>\n</robot>\n'
    )
    assert {*found} == {"fleet.yaml", "robot.urdf", "plan.yaml"}
