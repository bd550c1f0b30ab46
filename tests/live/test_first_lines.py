# SPDX-License-Identifier: Apache-2.0
"""What ``check`` without a plan says of a graph in its first line: robots, layout, who sends tf."""

from __future__ import annotations

from multibot_rewrite.live.diagnose import diagnose, survey
from multibot_rewrite.system.records import PUBLISHES, TOPIC, Edge, End, Node, System

TF = "tf2_msgs/msg/TFMessage"


def said(graph: System) -> list[str]:
    return survey(diagnose(graph)).split("; ")


def sends(node: str, topic: str = "/tf") -> End:
    return End(TOPIC, PUBLISHES, topic, TF, "", node, None, "")


def test_robots_that_only_frames_name() -> None:
    edges = [
        Edge(f"{robot}/{child}", f"{robot}/{parent}", "/tf", False, ("/state",))
        for robot in ("robot1", "robot2")
        for child, parent in (("base_link", "odom"), ("laser", "base_link"))
    ]
    graph = System((Node("/state"),), (sends("/state"),), tuple(edges))
    # Its node is of none of them.
    assert [(it.robot, it.nodes) for it in diagnose(graph).coverage.robots] == [("", 1)]
    assert said(graph) == [
        "2 robots by what their frames have: robot1, robot2",
        "layout: frames have the robot's name, topics and nodes have not",
        "tf on /tf: 1 node of no robot",
    ]
    # Names of nodes have their names as well: whose each topic is says only a plan.
    more = tuple(Node(f"/{it}_state") for it in ("robot1", "robot2"))
    assert said(graph._replace(nodes=graph.nodes + more)) == [
        "2 robots by what their frames have: robot1, robot2",
        "layout: not known without its plan (check PLAN, check-launch --plan PLAN)",
        "tf on /tf",
    ]
    assert said(graph._replace(nodes=graph.nodes + more[:1]))[2] == "tf on /tf: 1 node of no robot"
