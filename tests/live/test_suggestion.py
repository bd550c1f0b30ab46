# SPDX-License-Identifier: Apache-2.0
"""The files that ``check --suggest`` begins a fleet with, for graphs whose robots are known here."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import graph_cases
import pytest
import small_fleet
import yaml
from graph_calls import GuessedRobot, diagnose

from multibot_rewrite.knowledge.stacks import built_in
from multibot_rewrite.live.suggestion import suggestion
from multibot_rewrite.system.records import System

# Child -> parent and type; wheels turn, and what is below the world is not the robot's.
ROVER = {
    "base_link": ("base_footprint", "fixed"),
    "left_wheel": ("base_link", "continuous"),
    "right_wheel": ("base_link", "continuous"),
    "lidar_link": ("base_link", "fixed"),
    "imu_link": ("base_link", "fixed"),
    "camera_link": ("base_link", "fixed"),
    "camera_optical_frame": ("camera_link", "fixed"),
}


def suggested(graph: System) -> dict[str, str]:
    return suggestion(diagnose(graph), built_in("jazzy"))


def attribute(element: ET.Element, path: str, name: str) -> str:
    found = element.find(path)
    assert found is not None
    return found.attrib[name]


@pytest.mark.parametrize("layout", graph_cases.FOLDERS)
def test_the_description_has_the_tree_that_was_heard(layout: str) -> None:
    root = ET.fromstring(suggested(graph_cases.healthy(layout))["robot.urdf"])
    links = [it.attrib["name"] for it in root.iter("link")]
    assert links[0] == "base_footprint" and {*links[1:]} == {*ROVER}
    joints = {
        attribute(it, "child", "link"): (attribute(it, "parent", "link"), it.attrib["type"])
        for it in root.iter("joint")
    }
    assert joints == ROVER and len(links) == len(ROVER) + 1
    assert {it.attrib["name"] for it in root.iter("joint")} == {f"{it}_joint" for it in ROVER}


def test_of_robots_with_bare_frames_the_first_ones_tree_is_written() -> None:
    """One tf topic each, and no frame has a robot's name: robot2 has a second laser."""
    graph = small_fleet.healthy("L1")
    more = next(it for it in graph.edges if it.topic.startswith("/robot2/"))
    graph = graph._replace(edges=(*graph.edges, more._replace(child="laser2")))
    root = ET.fromstring(suggested(graph)["robot.urdf"])
    assert {it.attrib["name"] for it in root.iter("link")} == {"base_link", "laser"}


def test_parents_stand_above_their_children() -> None:
    root = ET.fromstring(suggested(graph_cases.healthy("postfix"))["robot.urdf"])
    links = [it.attrib["name"] for it in root.iter("link")]
    assert all(links.index(parent) < links.index(it) for it, (parent, _) in ROVER.items())


@pytest.mark.parametrize("layout", graph_cases.FOLDERS)
def test_the_fleet_file_has_the_layout_and_the_robots(layout: str) -> None:
    made = yaml.safe_load(suggested(graph_cases.healthy(layout))["fleet.yaml"])
    assert (made["layout"], made["description"]) == (layout, "robot.urdf")
    assert made["robots"] == [{"name": "robot1"}, {"name": "robot2"}]


def test_nodes_are_learned_where_names_show_the_codes() -> None:
    """Not behind a robot's word, and not the robot_state_publisher, which every fleet has."""
    files = suggested(small_fleet.healthy("L2"))
    made = yaml.safe_load(files["fleet.yaml"])
    assert (made["nodes"], made["stack"]) == ("nodes.yaml", ["seen"])
    learned = yaml.safe_load(files["nodes.yaml"])
    assert [*learned["nodes"]] == learned["stacks"]["seen"]["nodes"] == ["driver"]
    assert learned["nodes"]["driver"]["subscribes"] == {"cmd_vel": "geometry_msgs/msg/Twist"}
    assert "nodes.yaml" not in suggested(small_fleet.healthy("L4"))
    without = graph_cases.without_node(small_fleet.healthy("L2"), "/robot1/robot_state_publisher")
    made = yaml.safe_load(suggested(without)["fleet.yaml"])
    assert made["stack"] == ["seen", "no_robot_state_publisher"]


def test_a_word_in_front_is_said_with_what_separates_it() -> None:
    def spelled(name: str) -> str:
        plain, _, robot = name.rpartition("/")
        return f"{robot}_{plain}" if plain and robot.startswith("robot") else name

    graph = graph_cases.healthy("frames-per-robot")
    frames = [it._replace(child=spelled(it.child), parent=spelled(it.parent)) for it in graph.edges]
    made = yaml.safe_load(suggested(graph._replace(edges=tuple(frames)))["fleet.yaml"])
    assert (made.get("affix"), made.get("separators")) == (
        "prefix",
        {"link": "_", "frame": "_"},
    )


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


def test_a_namespace_of_two_levels_is_one_name() -> None:
    robots = (GuessedRobot("fleet/a", "/fleet/a"),)
    seen = diagnose(System(environment=graph_cases.environment()))._replace(robots=robots)
    assert "  - {name: fleet_a}\n" in suggestion(seen, built_in("jazzy"))["fleet.yaml"]
