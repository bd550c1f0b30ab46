# SPDX-License-Identifier: Apache-2.0
"""Which robot a name of the graph belongs to, and what it is called without the robot's name."""

from __future__ import annotations

import pytest

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.system.index import (
    Tree,
    index,
)
from multibot_rewrite.system.ownership import (
    ALONE,
    NameOwnership,
    whose_by_plan,
    without_name,
)
from multibot_rewrite.system.records import (
    OFF,
    PUBLISHES,
    SUBSCRIBES,
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


# What rules look up in a system: ends by name, trees by topic, whose each of them is.
TF, TWIST, TEXT = "tf2_msgs/msg/TFMessage", "geometry_msgs/msg/Twist", "std_msgs/msg/String"


def end(node: str, role: str, name: str, type_: str = TEXT, kind: str = TOPIC) -> End:
    return End(kind, role, name, type_, "", node, None, "")


def test_transforms_are_in_trees_by_their_topic() -> None:
    def edge(child: str, topic: str, *nodes: str, parent: str = "odom") -> Edge:
        return Edge(child, parent, topic, False, nodes)

    system = System(
        ends=(
            end("/a/ekf", PUBLISHES, "/a/tf", TF),
            end("/a/rsp", PUBLISHES, "/a/tf_static", TF),
            end("/a/nav", SUBSCRIBES, "/a/tf", TF),
            end("/a/map", SUBSCRIBES, "/a/tf_static", TF),
            end("/b/nav", SUBSCRIBES, "/b/tf", TF),
            end("/c/nav", SUBSCRIBES, "/c/tf", TEXT),
        ),
        edges=(
            edge("/base", "/a/tf", "/a/driver", "/a/ekf"),
            edge("lidar", "/a/tf_static", parent="/base"),
            edge("x", "/_hidden/tf"),
            edge("y", "/a/tf")._replace(sure=OFF),
        ),
    )
    base, lidar = edge("base", "/a/tf", "/a/driver", "/a/ekf"), edge("lidar", "/a/tf_static")
    assert index(system, ALONE).trees == [
        Tree(
            "/a/tf",
            (base, lidar._replace(parent="base")),
            ("/a/ekf", "/a/rsp", "/a/driver"),
            ("/a/nav",),
        ),
        Tree("/b/tf", (), (), ("/b/nav",)),
    ]
