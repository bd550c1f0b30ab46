# SPDX-License-Identifier: Apache-2.0
"""Where the rules about a graph make an exception, and where the exception ends."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from graph_cases import (
    CASES,
    Case,
    as_planned,
    environment,
    healthy as planned,
    read_plan,
    sent,
    with_node,
)
from plans import PlannedRobot, planned as as_plan, planned_end

from multibot_rewrite.base.findings.finding import ERROR, INCONCLUSIVE, WARNING
from multibot_rewrite.live.watching import Verdict, WatchState, with_found
from multibot_rewrite.rules.check import check
from multibot_rewrite.system.coverage import coverage
from multibot_rewrite.system.records import PUBLISHES, TOPIC, Caveat, Edge, System

TEXT, TF = "std_msgs/msg/String", "tf2_msgs/msg/TFMessage"
CUT_OFF = environment(Caveat("participants", True, "the view may be cut off"))


def fleet(tf: str, **frames: Sequence[str]) -> System:
    """Return a plan: each robot with one node, which publishes its tf topics, and its frames.

    ``ROBOT`` in ``tf`` stands for the robot.
    """
    robots, ends = [], []
    for name, own in frames.items():
        node, topic = f"/{name}/driver", tf.replace("ROBOT", name)
        robots.append(PlannedRobot(name, (node,), tuple(own), topic))
        both = (topic, topic.replace("tf", "tf_static"))
        ends += [planned_end(node, TOPIC, PUBLISHES, it, TF, it) for it in both]
    return as_plan("frames-per-robot", tuple(robots), (), ("/rosout",), ("map",), tuple(ends))


def graph(plan: System, *more: Edge) -> System:
    """As planned: each robot's frames below its first one, and transforms besides."""
    edges = [
        Edge(frame, robot.frames[0], robot.tf_topic.replace("tf", "tf_static"), True, ())
        for robot in plan.robots
        for frame in robot.frames[1:]
    ]
    return sent(as_planned(plan)._replace(edges=(*edges, *more)))


def below(parent: str, *frames: str, topic: str = "/tf_static") -> list[Edge]:
    return [Edge(frame, parent, topic, True, ()) for frame in frames]


def found(plan: System, seen: System) -> list[tuple[str, str, tuple[str, ...]]]:
    return [(it.code, it.robot, tuple(it.names)) for it in check(plan, seen)]


# Whose a name is, where one robot's name begins another's.


ARMS = fleet("/ROBOT/tf", arm=("base",), arm_left=("base",))


@pytest.mark.parametrize(
    ("name", "owner"),
    [
        ("/x/arm_left_joint", "arm_left"),
        ("/x/joint_arm_left", "arm_left"),
        ("/x/arm_joint", "arm"),
        ("/x/left_arm", "arm"),
        ("/arm_left_joint", "arm_left"),
    ],
)
def test_the_longer_robot_name_owns_a_name(name: str, owner: str) -> None:
    """Who is not the owner and publishes there speaks under another robot's name."""
    for robot in ("arm", "arm_left"):
        seen = with_node(graph(ARMS), f"/{robot}/driver", (PUBLISHES, name, TEXT))
        seen = seen._replace(nodes=seen.nodes[:-1])  # the node is there already
        codes = {it.code for it in check(ARMS, seen)}
        assert ("MG311" in codes) == (robot != owner)


# A robot whose name is an ordinary word of its frames.


@pytest.mark.parametrize(
    ("robot", "code"),
    [
        pytest.param("amr", "MG407", id="no link of it is called amr"),
        pytest.param(
            "arm", "MG204", id="one is called arm_upper: an arm in a frame may be its own"
        ),
    ],
)
def test_a_robots_name_that_is_a_word_of_its_frames_is_not_there_twice(
    robot: str, code: str
) -> None:
    own = {name: (f"base/{name}", f"arm_upper/{name}") for name in (robot, "other")}
    plan = fleet("/ROBOT/tf", **own)
    frame = f"{robot}_base_{robot}"
    seen = graph(plan, *below(f"base/{robot}", frame, topic=f"/{robot}/tf_static"))
    assert found(plan, seen) == [(code, robot, (frame,))]


# What a view that may be incomplete cannot tell.


# Each is told because something was not seen.
NOT_SEEN = {"MG101", "MG102", "MG109", "MG303", "MG406", "MG207"}


@pytest.mark.sample(1)
@pytest.mark.parametrize("case", CASES, ids=lambda it: it.stem)
def test_nothing_is_called_missing_in_an_incomplete_view(case: Case) -> None:
    plan, seen = read_plan(case.layout), case.broken(planned(case.layout))
    whole = check(plan, seen)
    partial = check(plan, seen._replace(environment=CUT_OFF))
    assert [it.code for it in partial] == [it.code for it in whole]
    assert all(it.level in (ERROR, WARNING) for it in whole)
    expected = [INCONCLUSIVE if it.code in NOT_SEEN else it.level for it in whole]
    assert [it.level for it in partial] == expected


def _state(plan: System, graph: System, before: WatchState | None) -> WatchState:
    return with_found(graph, coverage(plan, graph), check(plan, graph), before)


def test_a_frame_without_the_robots_name_may_still_come_while_a_fleet_starts() -> None:
    """Before everything was there once it does not count as the worst that was seen."""
    plan = read_plan("both")
    broken = next(it for it in CASES if (it.layout, it.code) == ("both", "MG207"))
    first = _state(plan, broken.broken(planned("both")), None)
    assert {it.code for it in first.findings} == {"MG207"}
    assert (first.complete, first.worst) == (False, Verdict.PLANNED)
    later = _state(plan, planned("both"), first)
    again = _state(plan, broken.broken(planned("both")), later)
    assert (later.complete, again.worst) == (True, Verdict.WRONG)
