# SPDX-License-Identifier: Apache-2.0
"""What ``check`` without a plan says of a graph in its first lines: robots, layout, who sends tf."""

from __future__ import annotations

import pytest
import small_fleet

from multibot_rewrite.live.diagnose import diagnose, survey
from multibot_rewrite.system.records import PUBLISHES, TOPIC, Edge, End, Node, System

TF = "tf2_msgs/msg/TFMessage"
LOOKS = {
    "L1": "tf-per-robot (L1: tf topic per robot, bare frames)",
    "L2": "frames-per-robot (L2: one /tf, frames per robot)",
    "L3": "both (L3: tf topic and frames per robot)",
    "L4": "postfix (L4: everything renamed per robot, no namespaces)",
}
SENT = {
    "L1": ["tf on /robot1/tf: 1 node of robot1", "tf on /robot2/tf: 1 node of robot2"],
    "L2": ["tf on /tf: 2 nodes of robot1, robot2"],
    "L3": ["tf on /robot1/tf: 1 node of robot1", "tf on /robot2/tf: 1 node of robot2"],
    "L4": ["tf on /tf/robot1: 1 node of robot1", "tf on /tf/robot2: 1 node of robot2"],
}


def said(graph: System) -> list[str]:
    return [*survey(diagnose(graph))]


@pytest.mark.parametrize("layout", LOOKS)
def test_robots_and_their_layout(layout: str) -> None:
    where = "by the ends of names" if layout == "L4" else "by their namespaces"
    assert said(small_fleet.healthy(layout)) == [
        f"2 robots {where}: robot1, robot2",
        f"layout: looks like {LOOKS[layout]}",
        *SENT[layout],
    ]


def sends(node: str, topic: str = "/tf") -> End:
    return End(TOPIC, PUBLISHES, topic, TF, "", node, None, "")


def test_a_graph_without_a_robots_name() -> None:
    graph = System(
        (Node("/driver"), Node("/state")), (sends("/state"), sends("/state", "/tf_static"))
    )
    assert said(graph) == [
        "2 nodes, no name of a robot in them: one robot, or several that share all names",
        "tf on /tf: 1 node of no robot",
    ]
    assert said(System()) == [
        "0 nodes, no name of a robot in them: one robot, or several that share all names"
    ]


def test_robots_that_only_frames_name() -> None:
    edges = [
        Edge(f"{robot}/{child}", f"{robot}/{parent}", "/tf", False, ("/state",))
        for robot in ("robot1", "robot2")
        for child, parent in (("base_link", "odom"), ("laser", "base_link"))
    ]
    graph = System((Node("/state"),), (sends("/state"),), tuple(edges))
    assert said(graph) == [
        "2 robots by what their frames have: robot1, robot2",
        "layout: frames have the robot's name, topics and nodes have not",
        "tf on /tf: 1 node of no robot",
    ]


def test_one_robot_with_names_in_its_frames_is_enough() -> None:
    """A robot that sends no frames yet, and one of which there are only frames."""
    graph = small_fleet.healthy("L2")
    half = tuple(it for it in graph.edges if "robot2" not in it.child)
    third = Edge("base_link/robot3", "odom/robot3", "/tf", False, ())
    for edges in (half, (*graph.edges, third)):
        seen = diagnose(graph._replace(edges=edges))
        assert seen.layout is not None and seen.layout.name == "frames-per-robot"


def test_robots_that_share_all_frames() -> None:
    graph = small_fleet.healthy("L2")
    bare = (
        it._replace(child=it.child.split("/")[0], parent=it.parent.split("/")[0])
        for it in graph.edges
    )
    assert said(graph._replace(edges=tuple(bare)))[1] == (
        "layout: none of those known: neither tf topics nor frames have the robot's name"
    )
