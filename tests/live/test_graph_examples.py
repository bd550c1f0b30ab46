# SPDX-License-Identifier: Apache-2.0
"""The lines in which examples of graph rules are written say what they seem to say."""

from __future__ import annotations

import pytest
from graph_examples import read_example, read_system
from plans import own

from multibot_rewrite.lint import catalogue
from multibot_rewrite.rules.check import RULES, check, judge
from multibot_rewrite.system.records import ACTION, CALLS, SERVICE, Edge

# Rules that a lint of a description has as well.
OF_DESCRIPTIONS = {"MB229", "MB240", "MB412"}
EXAMPLE = """\
planned: frames of robot1 on /robot1/tf: base_link, laser
planned: shared topic /map
planned: /map_server publishes /map nav_msgs/msg/OccupancyGrid
as planned: /robot1/nav calls /robot1/go nav2_msgs/action/NavigateToPose
running: /robot1/nav publishes /robot1/plan nav_msgs/msg/Path best_effort transient_local
running: transform odom -> base_link on /robot1/tf_static by /robot1/a, /robot1/b
running: /robot1/nav
"""


def test_the_plan_of_an_example() -> None:
    plan, _ = read_example(EXAMPLE)
    (robot,) = plan.robots
    assert (robot.name, robot.tf_topic, robot.frames) == (
        "robot1",
        "/robot1/tf",
        ("base_link", "laser"),
    )
    assert (own(plan, "robot1"), own(plan)) == (("/robot1/nav",), ("/map_server",))
    assert "/map" in plan.shared_topics and "/robot1/plan" not in plan.shared_topics
    _, goal = plan.ends
    assert (goal.kind, goal.role, goal.name, goal.code_name) == (ACTION, CALLS, "/robot1/go", "/go")


def test_the_graph_of_an_example() -> None:
    _, graph = read_example(EXAMPLE)
    assert [node.name for node in graph.nodes] == ["/robot1/nav"]
    goal, path = graph.ends
    assert (goal.kind, goal.qos, path.type) == (ACTION, None, "nav_msgs/msg/Path")
    assert path.qos is not None
    assert (path.qos.reliability, path.qos.durability) == ("BEST_EFFORT", "TRANSIENT_LOCAL")
    senders = ("/robot1/a", "/robot1/b")
    assert graph.edges == (Edge("base_link", "odom", "/robot1/tf_static", True, senders),)


def test_two_lines_of_a_node_are_two_nodes() -> None:
    _, graph = read_example("running: /robot1/nav\nrunning: /robot1/nav\n")
    assert [node.name for node in graph.nodes] == ["/robot1/nav", "/robot1/nav"]


def test_a_service_needs_no_type() -> None:
    plan, graph = read_example("as planned: /robot1/nav serves /robot1/stop\n")
    assert plan.ends[0].kind == graph.ends[0].kind == SERVICE
    assert check(plan, graph) == []


@pytest.mark.parametrize(
    "line",
    [
        "/robot1/nav",
        "seen: /robot1/nav",
        "planned: robot1/nav",
        "planned: /robot1/nav subscribes to /robot1/scan",
        "running: transform odom to base_link on /tf",
        "running: /robot1/nav has use_sim_time yes",
        "planned: frames of robot1: base_link",
    ],
)
def test_a_line_of_another_language_is_refused(line: str) -> None:
    with pytest.raises(AssertionError):
        read_example(f"{line}\n")


def test_every_declared_rule_is_asked() -> None:
    """Those of launch files have a command of their own (`check-launch`), and its tests."""
    declared = {code for code in catalogue.rules() if code.startswith("MG")}
    launched = {code for code in declared if code.startswith("MG7")}
    assert launched and (declared - launched) | OF_DESCRIPTIONS == RULES.keys()


@pytest.mark.parametrize("code", sorted(OF_DESCRIPTIONS))
def test_a_rule_for_descriptions_finds_it_in_a_system(code: str) -> None:
    rule = RULES[code]
    (finding,) = (it for it in judge(read_system(rule.page.bad)) if it.code == code)
    assert finding.node in rule.page.bad.splitlines()[rule.page.line - 1]
    assert [it for it in judge(read_system(rule.page.good)) if it.code == code] == []
