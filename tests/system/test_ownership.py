# SPDX-License-Identifier: Apache-2.0
"""Which robot a name of the graph belongs to, and what it is called without the robot's name."""

from __future__ import annotations

import pytest

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.system.ownership import (
    NameOwnership,
    name_ownership,
    whose_by_plan,
    without_name,
)
from multibot_rewrite.system.records import (
    PUBLISHES,
    TOPIC,
    Edge,
    End,
    Node,
    Parameter,
    Robot,
    System,
    Topic,
)


def by_tags(*robots: str, last: bool = False, words: tuple[str, ...] = ()) -> NameOwnership:
    levels = max(it.count("/") + 1 for it in robots)
    return NameOwnership({}, {}, {it: it for it in robots}, frozenset(words), last, levels=levels)


@pytest.mark.parametrize(
    ("owner", "name", "robot"),
    [
        (by_tags("a"), "/a/scan", "a"),
        (by_tags("a"), "/scan/a", "a"),
        # A node or topic of the root that is called like a robot.
        (by_tags("a"), "/a", ""),
        (by_tags("a"), "/b/scan", ""),
        (by_tags("a"), "/b/a_scan", "a"),
        (by_tags("a"), "/scan_a", "a"),
        (by_tags("a"), "/x-a", "a"),
        (by_tags("a"), "/x.a", "a"),
        (by_tags("a"), "/ab", ""),
        # Each at its own end.
        (by_tags("a", "b"), "/a/b", "a"),
        (by_tags("a", "b", last=True), "/a/b", "b"),
        (by_tags("a", "b", last=True), "/b/scan", "b"),
        # The longest of several.
        (by_tags("arm", "arm_left"), "/arm_left_scan", "arm_left"),
        (by_tags("fleet", "fleet/a"), "/fleet/a/scan", "fleet/a"),
        (by_tags("fleet", "fleet/a"), "/fleet/scan", "fleet"),
        (by_tags("fleet/a"), "/fleet/a", ""),
        # A robot that is called like an ordinary word has only what is at its place.
        (by_tags("scan", words=("scan",)), "/x/scan", ""),
        (by_tags("scan", words=("scan",)), "/scan/x", "scan"),
    ],
)
def test_a_tag_in_a_name_shows_the_robot(owner: NameOwnership, name: str, robot: str) -> None:
    assert owner.robot(name) == robot


@pytest.mark.parametrize(
    ("owner", "name", "tag", "plain"),
    [
        (by_tags("a"), "/a/scan", "a", "/scan"),
        (by_tags("a"), "a/scan", "a", "scan"),
        (by_tags("a", last=True), "/scan/a", "a", "/scan"),
        (by_tags("a"), "/scan/a", "a", "/scan"),
        (by_tags("a", last=True), "/a/scan", "a", "/scan"),
        (by_tags("a"), "/x/a/y/a/z", "a", "/x/y/a/z"),
        (by_tags("a", last=True), "/x/a/y/a/z", "a", "/x/a/y/z"),
        (by_tags("a"), "/a", "a", "/a"),
        (by_tags("a"), "/a_scan", "a", "/scan"),
        (by_tags("a"), "/scan-a", "a", "/scan"),
        (by_tags("a"), "/scan", "a", "/scan"),
        (by_tags("a"), "/scan", "", "/scan"),
        (by_tags("f/a"), "/f/a/scan", "f/a", "/scan"),
        (by_tags("f/a"), "f/a/scan", "f/a", "scan"),
        (by_tags("f/a"), "/x/f/a/scan", "f/a", "/x/f/a/scan"),
    ],
)
def test_a_name_without_its_robot(owner: NameOwnership, name: str, tag: str, plain: str) -> None:
    assert owner.without_robot(name, tag) == plain


def node(name: str, robot: str = "") -> Node:
    return Node(name, robot=robot)


def topic(node: str, name: str, code: str = "") -> End:
    return End(TOPIC, PUBLISHES, name, "", "", node, None, "", code)


PLAN = System(
    nodes=(node("/a/driver", "a"), node("/scan/driver", "scan"), node("/map_server")),
    ends=(
        topic("/a/driver", "/elsewhere", "/scan"),
        topic("/a/driver", "/of_both"),
        topic("/scan/driver", "/of_both"),
    ),
    robots=(
        Robot("scan", ("s/base_link",), "/scan/tf", ("gps",), "s"),
        Robot("a", ("a/base_link", "a/s"), "/a/tf", ("gps", "camera")),
    ),
    shared_topics=("/a/shared",),
)


@pytest.mark.parametrize(
    ("name", "robot", "plain"),
    [
        ("/a/driver", "a", "/driver"),
        ("/elsewhere", "a", "/elsewhere"),
        ("/of_both", "", "/of_both"),
        ("/map_server", "", "/map_server"),
        ("/a/shared", "", "/a/shared"),
        # A word of the code is no robot's, but at its place.
        ("/x_scan", "", "/x_scan"),
        ("/scan/odom", "scan", "/odom"),
    ],
)
def test_a_plan_says_whose_a_name_is(name: str, robot: str, plain: str) -> None:
    whose = whose_by_plan(PLAN)
    assert (whose.robot(name), whose.plain(name)) == (robot, plain)


@pytest.mark.parametrize(
    ("frame", "robot", "plain"),
    [
        ("s/base_link", "scan", "base_link"),
        ("a/odom", "a", "odom"),
        ("camera", "a", "camera"),
        ("gps", "", "gps"),
        ("map", "", "map"),
    ],
)
def test_a_plan_says_whose_a_frame_is(frame: str, robot: str, plain: str) -> None:
    whose = whose_by_plan(PLAN)
    assert (whose.frame_robot(frame), whose.plain_frame(frame)) == (robot, plain)


BARE = System(
    robots=(
        Robot("barrow", ("base_link", "axle")),
        Robot("link", ("base_link", "lidar_link", "left_wheel")),
        Robot("lidar", ("base_link", "lidar_link", "left_wheel")),
        Robot("rover", ("base_link", "laser")),
    )
)


@pytest.mark.parametrize(
    ("frame", "robot"),
    [
        # Of the second and third robot, whose names are in it, though the first has no such frame.
        ("lidar_link", ""),
        # Gazebo calls the frames of a sensor by its model, which may be called as a robot is and more.
        ("rover_2/base_link/lidar", ""),
        ("rover_2_base_link", ""),
        # Another robot's frame, with its name as a whole or glued.
        ("rover/base_link/lidar", "rover"),
        ("rover/laser", "rover"),
        ("rover_laser", "rover"),
        ("rover_odom", "rover"),
        ("laser", "rover"),
    ],
)
def test_a_part_of_a_word_is_a_robot_if_the_rest_is_a_frame(frame: str, robot: str) -> None:
    assert whose_by_plan(BARE).frame_robot(frame) == robot


@pytest.mark.parametrize(
    ("names", "last"),
    [
        ("/lidar/max /lidar/rex", True),
        ("/max/lidar /rex/lidar", False),
        # More at the end than at the beginning.
        ("/lidar/max /lidar/rex /max/arm", True),
        ("/lidar/max /max/arm", False),
    ],
)
def test_where_most_names_have_their_robot(names: str, last: bool) -> None:
    nodes = tuple(Node(it, robot="max" if "max" in it else "rex") for it in names.split())
    plan = System(nodes=nodes, robots=(Robot("max", tf_topic="/tf"), Robot("rex", tf_topic="/tf")))
    assert name_ownership(plan).robot_is_last is last


def test_a_plan_of_one_robot_without_its_namespace() -> None:
    """All that has the namespace loses it; what only begins with the same letters does not."""
    end = End("topic", "publishes", "/r/scan", "", "", "/r/lidar", None, "")
    finding = Finding("MG103", "error", "in /r/x and /rover", "see /r/y", node="/r/lidar")
    plan = System(
        nodes=(Node("/r/lidar", robot="r", taker="/r/box"), Node("/rover/arm"), Node("/r")),
        ends=(end, end._replace(name="/rover/scan", node="/rover/arm")),
        edges=(Edge("b", "a", "/r/tf", False, ("/r/lidar", "/rover/arm")),),
        robots=(Robot("r", tf_topic="/r/tf"),),
        gaps=(finding._replace(names=("/r/scan", "/rover/scan")),),
        parameters=(Parameter("/r/lidar", "a", "1"),),
        topics=(Topic("/r/scan", ("/r/lidar",)),),
    )
    assert without_name(plan) == System(
        nodes=(Node("/lidar", robot="r", taker="/box"), Node("/rover/arm"), Node("/")),
        ends=(end._replace(name="/scan", node="/lidar"),
              end._replace(name="/rover/scan", node="/rover/arm")),
        edges=(Edge("b", "a", "/tf", False, ("/lidar", "/rover/arm")),),
        robots=(Robot("r", tf_topic="/tf"),),
        gaps=(finding._replace(message="in /x and /rover", hint="see /y", node="/lidar",
                               names=("/scan", "/rover/scan")),),
        parameters=(Parameter("/lidar", "a", "1"),),
        topics=(Topic("/scan", ("/lidar",)),),
    )  # fmt: skip
