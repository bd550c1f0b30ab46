# SPDX-License-Identifier: Apache-2.0
"""The tf of a snapshot: trees where they were heard, and how far from the description."""

from __future__ import annotations

import json
from math import cos, radians, sin
from pathlib import Path
from typing import Any

import pytest
from graph_cases import healthy
from paths import ROBOTS
from view_pages import page, with_places

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.pages.view.models import Joint
from multibot_rewrite.pages.view.scene import LinkFrames, heard_trees, moved_links, offset_between
from multibot_rewrite.system.json import to_json
from multibot_rewrite.system.records import Edge

HERE = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
# A quarter turn around z.
TURNED = (1.0, 2.0, 3.0, 0.0, 0.0, sin(radians(45)), cos(radians(45)))
LINKS = [
    LinkFrames("robot1", "/tf", frozenset({"robot1/base", "robot1/scan"})),
    LinkFrames("robot2", "/tf", frozenset({"robot2/base"})),
    LinkFrames("robot3", "/robot3/tf", frozenset({"base"})),
]


def trees(*edges: str, topic: str = "/tf", **places: tuple[float, ...]) -> list[tuple[Any, ...]]:
    """Root, robot and frames of each tree of ``parent>child``; ``places`` by the last word."""
    heard = [
        Edge(child, parent, topic, False, (), False, places.get(child.split("/")[-1], HERE))
        for parent, child in (it.split(">") for it in edges)
    ]
    return [
        (it.root, it.robot, [one.name for one in it.frames])
        for it in heard_trees(heard, LINKS, frozenset({"depot"}))
    ]


def test_a_tree_of_one_robot_is_where_the_robot_is_planned() -> None:
    assert trees("robot1/scan>lens", "odom>robot1/base", "robot1/base>robot1/scan") == [
        ("odom", "robot1", ["robot1/base", "robot1/scan", "lens"])
    ]


@pytest.mark.parametrize("root", ["map", "world", "depot"])
def test_a_frame_of_all_is_the_worlds_origin(root: str) -> None:
    assert trees(f"{root}>robot1/base") == [(root, "", ["robot1/base"])]


def test_a_tree_of_two_robots_is_of_none() -> None:
    assert trees("hall>robot1/base", "hall>robot2/base")[0][1] == ""


def test_only_its_own_topic_has_a_robots_frames() -> None:
    assert trees("odom>base")[0][1] == ""
    assert trees("odom>base", topic="/robot3/tf_static")[0][1] == "robot3"


def test_what_was_not_heard_has_no_place() -> None:
    found = trees("odom>robot1/base", "robot1/base>robot1/scan", "robot1/scan>lens", scan=())
    assert found == [("odom", "robot1", ["robot1/base"])]
    assert trees("a>b", "b>a") == []


@pytest.mark.parametrize(
    ("heard", "metres", "angle"),
    [(TURNED, 0, 0), ((1, 2, 3.5, *TURNED[3:]), 0.5, 0), ((1, 2, 3, 0, 0, 0, 1), 0, 90)],
)
def test_how_far_a_frame_is_off(heard: tuple[float, ...], metres: float, angle: float) -> None:
    pose = ((0, -1, 0, 1), (1, 0, 0, 2), (0, 0, 1, 3), (0, 0, 0, 1))
    joint = Joint("mast", "fixed", "base", "scan", pose, (1, 0, 0), 0, 0, None)
    assert offset_between(joint, heard) == pytest.approx((metres, angle), abs=1e-6)


@pytest.mark.parametrize(
    ("kind", "heard", "said"),
    [
        ("fixed", (0, 0, 0.03, *HERE[3:]), ["scan by 0.030 m and 0.0 degrees"]),
        ("fixed", (0, 0, 0, *TURNED[3:]), ["scan by 0.000 m and 90.0 degrees"]),
        ("fixed", HERE, []),
        # A millimetre and a tenth of a degree are rounding.
        ("fixed", (0.0009, 0, 0, 0, 0, sin(radians(0.04)), cos(radians(0.04))), []),
        ("fixed", (0.0011, 0, 0, *HERE[3:]), ["scan by 0.001 m and 0.0 degrees"]),
        ("fixed", (), []),
        ("revolute", TURNED, []),
    ],
)
def test_what_is_said_of_a_joint(kind: str, heard: tuple[float, ...], said: list[str]) -> None:
    pose = ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1))
    joint = Joint("mast", kind, "base", "scan", pose, (1, 0, 0), 0, 0, None)
    assert [*moved_links([joint], {"scan": heard, "other": TURNED})] == said
    assert [*moved_links([joint], {})] == []


@pytest.mark.more
def test_fixed_joints_that_are_heard_elsewhere_are_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    graph = tmp_path / "graph.json"
    graph.write_bytes(to_json(with_places(healthy("postfix"))))
    words = ["view", str(ROBOTS / "rover.urdf"), "robot1", "robot2", "--from", str(graph)]
    assert main([*words, "-o", str(tmp_path / "view.html")]) == 0
    (said,) = [it for it in capsys.readouterr().err.splitlines() if "on tf" in it]
    assert "robot2: " in said and "(lidar_link/robot2 by 0.030 m and 0.0 degrees)" in said


@pytest.mark.more
def test_the_page_has_the_trees_and_the_transforms_of_links(tmp_path: Path) -> None:
    graph = tmp_path / "graph.json"
    graph.write_bytes(to_json(with_places(healthy("postfix"))))
    words = [ROBOTS / "rover.urdf", "robot1", "robot2", "--from", graph]
    made = page(tmp_path, *words)
    assert [it[:3] for it in made["trees"]] == [
        ["/tf/robot1", "odom/robot1", "robot1"],
        ["/tf/robot2", "odom/robot2", "robot2"],
    ]
    assert ["base_footprint/robot1", "odom/robot1", [1, 0, 0, 0, 0, 0, 1]] in made["trees"][0][3]
    heard = made["robots"][1]["transforms"]
    assert heard["lidar_link/robot2"][:3] == [0.1, 0, 0.09]


@pytest.mark.more
def test_a_snapshot_without_places_has_no_trees(tmp_path: Path) -> None:
    graph = tmp_path / "graph.json"
    graph.write_bytes(to_json(healthy("postfix")))
    assert "transform" not in json.loads(graph.read_bytes())["edges"][0]
    made = page(tmp_path, ROBOTS / "rover.urdf", "robot1", "--from", graph)
    assert made["trees"] == []
    assert made["robots"][0]["heard"]["base_link/robot1"] == "heard"


@pytest.mark.more
def test_a_frame_on_the_tf_of_another_robot_is_not_heard(tmp_path: Path) -> None:
    """Where each robot has its own tf, frames of all are called alike."""
    graph = healthy("tf-per-robot")
    frames = (it for it in graph.edges if it.topic.startswith("/robot2/"))
    (tmp_path / "graph.json").write_bytes(to_json(graph._replace(edges=tuple(frames))))
    words = [ROBOTS / "rover.urdf", "robot1", "robot2", "--layout", "tf-per-robot"]
    one, two = page(tmp_path, *words, "--from", tmp_path / "graph.json")["robots"]
    assert set(one["heard"].values()) == {"silent"}
    assert set(two["heard"].values()) == {"heard"}


@pytest.mark.more
def test_a_recording_has_places_too(tmp_path: Path) -> None:
    """The last of its transforms: 99 m ahead after 100 messages."""
    made_bags = pytest.importorskip("made_bags", reason="no rosbags")
    bag = made_bags.write(tmp_path / "bag", made_bags.healthy().values())
    words = [ROBOTS / "rover.urdf", "robot1", "--layout", "both", "--affix", "prefix"]
    found = page(tmp_path, *words, "--from", bag)["trees"]
    frames = {it[0]: it[2] for tree in found for it in tree[3]}
    assert frames["robot1/base_link"] == [99, 2, 3, 0, 0, 0, 1]
    page(tmp_path, *words, "--from", bag, "--from", "graph.json", code=2)
