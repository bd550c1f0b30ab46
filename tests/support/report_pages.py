# SPDX-License-Identifier: Apache-2.0
"""Scenes for the tests of the report: one for each state that a reader may meet."""

from __future__ import annotations

import nav2_graphs
from nav2_graphs import TEXT
from plans import PlannedRobot, planned, planned_end

from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.live.diagnose import diagnose
from multibot_rewrite.live.seen_plan import seen_plan
from multibot_rewrite.live.watching import Outcome, Verdict
from multibot_rewrite.pages.scene import Scene, make_scene
from multibot_rewrite.rules.check import check
from multibot_rewrite.system.records import (
    PUBLISHES,
    SUBSCRIBES,
    TOPIC,
    Caveat,
    System,
    Topic,
)

FIRST, SECOND = "/fleet_a/robot1", "/fleet_a/robot2"
OPEN_END = Finding("MF801", WARNING, "/robot2/amcl reads scan2, which nothing sends")


def healthy() -> Scene:
    plan = nav2_graphs.nav2()
    return nav2_graphs.scene(plan, nav2_graphs.healthy(plan))


def tf_collision() -> Scene:
    """Both robots were started with the description as it was."""
    plan = nav2_graphs.nav2()
    graph = nav2_graphs.healthy(plan)
    bare = (
        it._replace(child=it.child.partition("/")[0], parent=it.parent.partition("/")[0])
        for it in graph.edges
    )
    return nav2_graphs.scene(plan, graph._replace(edges=tuple(bare)))


def twenty() -> Scene:
    """Return a scene in which the driver of every robot lacks the same rule."""
    plan = nav2_graphs.fleet(20, 4)
    graph = nav2_graphs.healthy(plan)
    for robot in plan.robots:
        graph = nav2_graphs.moved(graph, f"/{robot.name}/topic1", "/topic1", "driver")
    return nav2_graphs.scene(plan, graph)


def spoiled() -> Scene:
    plan = nav2_graphs.nav2()
    return nav2_graphs.scene(plan, nav2_graphs.spoiled(plan))


def inconclusive() -> Scene:
    plan = nav2_graphs.nav2()
    graph = nav2_graphs.without_node(nav2_graphs.healthy(plan), "/robot2/amcl")
    doubt = Caveat("not-settled", True, "the graph was still changing")
    return nav2_graphs.scene(plan, graph._replace(environment=nav2_graphs.environment(doubt)))


def not_closed() -> Scene:
    """Return a scene in which the graph is as planned and the plan has an open end."""
    plan = nav2_graphs.nav2()
    words = "nothing wrong seen, but the plan has faults"
    outcome = Outcome(Verdict.PLANNED, words)
    return make_scene(plan, nav2_graphs.healthy(plan), [OPEN_END], outcome)


def doctors(graph: System) -> Scene:
    """Return what the doctor draws of a graph."""
    seen = diagnose(graph)
    outcome = Outcome(Verdict.WRONG, "something is wrong", "multibot check", planned=False)
    return make_scene(seen_plan(seen), graph, seen.findings, outcome)


def rich_plan() -> System:
    """Namespaces of two levels, alternatives, topics over a bridge, shared nodes with endpoints."""
    small = nav2_graphs.fleet(2, 4)
    robots = tuple(
        PlannedRobot(
            space[1:],
            (*(f"{space}/{it}" for it in ("driver", "planner", *_OF_ONE)),),
            small.robots[at].frames,
            f"{space}/tf",
            optional=tuple(f"{space}/{it}" for it in _OF_ONE),
            tag=f"robot{at + 1}",
        )
        for at, space in enumerate((FIRST, SECOND))
    )
    moved = (it._replace(node=f"/fleet_a{it.node}", name=f"/fleet_a{it.name}") for it in small.ends)
    shared = (
        planned_end("/map_server", TOPIC, PUBLISHES, "/map", TEXT, "map"),
        planned_end("/manager", TOPIC, SUBSCRIBES, f"{FIRST}/topic0", TEXT, "topic0"),
    )
    bridged = (
        Topic(f"{space}/{name}", bridge=(role,), type=TEXT)
        for space in (FIRST, SECOND)
        for name, role in (("scan", PUBLISHES), ("cmd_vel", SUBSCRIBES))
    )
    return planned(
        small.layout,
        robots,
        ("/map_server", "/manager"),
        (*small.shared_topics, "/map"),
        small.shared_frames,
        (*moved, *shared),
        topics=tuple(bridged),
        one_of=tuple(tuple(f"{space}/{it}" for it in _OF_ONE) for space in (FIRST, SECOND)),
    )


_OF_ONE = ("amcl", "slam_toolbox")


def rich_graph() -> System:
    """As ``rich_plan`` has it; amcl runs, slam_toolbox does not."""
    graph = nav2_graphs.healthy(rich_plan())
    for space in (FIRST, SECOND):
        graph = nav2_graphs.without_node(graph, f"{space}/slam_toolbox")
    return graph


def rich(graph: System) -> Scene:
    return make_scene(rich_plan(), graph, check(rich_plan(), graph))
