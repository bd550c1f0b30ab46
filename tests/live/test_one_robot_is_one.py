# SPDX-License-Identifier: Apache-2.0
"""One robot is one robot: the frames of any public description, as robot_state_publisher and an EKF
send them on one tf, are not taken for those of several."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain
from pathlib import Path
from xml.etree import ElementTree

import pytest
from graph_cases import sent
from healthy_systems import JOINTS, ODOMETRY, TF, System, plan, with_node
from nav2_graphs import healthy as as_planned
from paths import CORPUS

from multibot_rewrite.live.diagnose import diagnose
from multibot_rewrite.system.guess import guess_robots
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES, Edge

# Ends of files that hold several bodies side by side in the world, or the names of two robots.
OF_SEVERAL = (
    "rexrov_oberon7_sl3__ns.urdf",  # links of rexrov and of robot1
    "rexrov_predator__ns.urdf",  # the same
    "dg5f_both_gz.urdf",  # two hands, each below the world
    "aloha_v2.urdf",  # four arms, each below the world
    "three_robots.urdf",
    "daVinci.urdf",  # two mountings, each below the world
    "both_psms.classic.urdf",  # two arms, each below the world
)


def joined(file: Path) -> list[tuple[str, str]]:
    """Parent and child of each joint, read without the program; none of what is no URDF."""
    try:
        root = ElementTree.parse(file).getroot()
    except ElementTree.ParseError:
        return []
    joints = root.iter("joint") if root.tag == "robot" else ()
    ends = ((it.find("parent"), it.find("child")) for it in joints)
    return [
        (a.get("link", ""), b.get("link", "")) for a, b in ends if a is not None and b is not None
    ]


def running(joints: list[tuple[str, str]]) -> System:
    """Return the nodes of one robot without a name, with a filter above the root of its description."""
    empty = System((), (), (), as_planned(plan(("nav2",))).environment)
    graph = with_node(
        empty, "/robot_state_publisher", (SUBSCRIBES, "/joint_states", JOINTS),
        (PUBLISHES, "/tf", TF), (PUBLISHES, "/tf_static", TF),
        (PUBLISHES, "/robot_description", "std_msgs/msg/String"),
    )  # fmt: skip
    graph = with_node(graph, "/joint_state_broadcaster", (PUBLISHES, "/joint_states", JOINTS))
    graph = with_node(graph, "/wheels", (PUBLISHES, "/odom", ODOMETRY))
    graph = with_node(
        graph, "/ekf_filter_node", (SUBSCRIBES, "/odom", ODOMETRY), (PUBLISHES, "/tf", TF),
        (PUBLISHES, "/odometry/filtered", ODOMETRY),
    )  # fmt: skip
    children = {child for _, child in joints}
    roots = sorted({parent for parent, _ in joints if parent not in children})
    edges = chain(joints, (("odom", root) for root in roots[:1]))
    own = (Edge(child, parent, "/tf", False, ()) for parent, child in edges)
    return sent(graph._replace(edges=tuple(own)))


def descriptions() -> Iterator[Path]:
    return (it for it in sorted(CORPUS.glob("urdf/**/*.urdf")) if it.is_file())


@pytest.mark.deep
@pytest.mark.skipif(not CORPUS.is_dir(), reason="no corpus beside the repository")
def test_no_public_description_is_taken_for_several_robots() -> None:
    taken, read = {}, 0
    for file in descriptions():
        joints = joined(file)
        read += bool(joints)
        robots = guess_robots(running(joints)) if joints else ()
        if robots and not file.name.endswith(OF_SEVERAL):
            taken[file.name] = [it.name for it in robots]
    assert read > 1000
    assert taken == {}


@pytest.mark.more
def test_what_hangs_on_a_body_is_a_part_and_what_stands_beside_it_is_none() -> None:
    laser = [("summit_base_link", "summit_laser_base_link")]
    assert guess_robots(running(laser)) == ()
    beside = [("map", "summit_base_link"), ("map", "husky_base_link")]
    assert [it.name for it in guess_robots(running(beside))] == ["husky", "summit"]
    assert [it.name for it in guess_robots(running([*beside, *laser]))] == ["husky", "summit"]


@pytest.mark.more
def test_wheels_and_arms_are_parts() -> None:
    joints = [("base_link", f"{side}_wheel") for side in ("fl", "fr")]
    joints += [(f"arm_{it}/base_link", f"arm_{it}/tip") for it in "lr"]
    joints += [("base_link", f"arm_{it}/base_link") for it in "lr"]
    graph = running(joints)
    assert guess_robots(graph) == ()
    assert diagnose(graph).findings == ()
