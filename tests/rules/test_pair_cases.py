# SPDX-License-Identifier: Apache-2.0
"""Small plans beside small graphs: what is said of them, and what is right and stays unsaid."""

from __future__ import annotations

import pytest
from graph_examples import read_example

from multibot_rewrite.rules.check import check
from multibot_rewrite.rules.pair.silent_topics import silent_topics
from multibot_rewrite.system.index import beside, index
from multibot_rewrite.system.ownership import whose_by_plan

TWIST, TEXT = "geometry_msgs/msg/Twist", "std_msgs/msg/String"


@pytest.mark.parametrize(
    ("running", "found"),
    [
        ("/robot1/gripper", ["/robot1/gripper"]),
        ("/gripper", ["/gripper"]),
        # What comes and goes beside any fleet.
        ("/rviz2", []),
        ("/robot1/rviz2", []),
        ("/_ros2cli_12", []),
        ("/rosbag2_recorder", []),
        # A planned one is no tool, whatever it is called.
        ("/robot1/driver", []),
    ],
)
def test_a_node_that_is_in_no_plan_and_no_tool(running: str, found: list[str]) -> None:
    plan, graph = read_example(f"as planned: /robot1/driver\nrunning: {running}")
    assert [it.node for it in check(plan, graph) if it.code == "MG108"] == found


@pytest.mark.parametrize(
    ("lines", "silent"),
    [
        (f"planned: /robot1/a subscribes /robot1/cmd {TWIST}", {"/robot1/cmd"}),
        (f"as planned: /robot1/a publishes /robot1/cmd {TWIST}", set()),
        (f"planned: /robot1/a subscribes /robot1/cmd {TEXT}", set()),
        (f"planned: /robot2/a subscribes /robot2/cmd {TWIST}", set()),
        (
            f"planned: /robot1/a subscribes /robot1/cmd {TWIST}\n"
            f"running: /x publishes /robot1/cmd {TWIST}",
            set(),
        ),
        (
            "planned: /robot1/b publishes /robot1/x\n"
            f"planned: topic /robot1/cmd over a bridge that publishes {TWIST}",
            {"/robot1/cmd"},
        ),
        (
            "planned: /robot1/b publishes /robot1/x\n"
            f"planned: topic /robot1/cmd over a bridge that subscribes {TWIST}",
            set(),
        ),
        (
            "planned: /robot1/b publishes /robot1/x\n"
            f"planned: topic /robot1/cmd over a bridge that publishes {TEXT}",
            set(),
        ),
    ],
)
def test_topics_that_a_robot_needs_and_nobody_sends(lines: str, silent: set[str]) -> None:
    made, graph = read_example(f"planned: /robot1/driver\nplanned: /robot2/driver\n{lines}")
    plan = index(made, whose_by_plan(made))
    seen = beside(plan, graph)
    assert silent_topics(plan, seen, plan.declared["robot1"], TWIST) == silent
