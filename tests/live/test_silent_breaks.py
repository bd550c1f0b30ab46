# SPDX-License-Identifier: Apache-2.0
"""Launches broken on purpose, each of which once ended in "as planned"; as snapshots, in four layouts.

robot2 alone is broken in each; the finding has to say that, and who or what it is.
"""

from __future__ import annotations

from collections.abc import Callable

import pytest
from graph_cases import (
    healthy,
    read_plan,
    reframed,
    sent,
    without_node,
)
from graph_examples import read_example

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.rules.check import check, side_by_side
from multibot_rewrite.rules.system.tf_pieces import tf_tree_in_pieces
from multibot_rewrite.system.records import PUBLISHES, Edge, System, Topic

LAYOUTS = ("frames-per-robot", "tf-per-robot", "both", "postfix")
# Those in which frames have the robot's name.
NAMED = ("frames-per-robot", "both", "postfix")


def named(layout: str, name: str) -> str:
    """Return a topic or node of robot2 in a layout."""
    if layout != "postfix":
        return f"/robot2/{name}"
    return (
        f"/{name}_robot2" if name.endswith(("driver", "drive", "publisher")) else f"/{name}/robot2"
    )


def is_of(robot: str, frame: Edge) -> bool:
    return any(robot in it for it in (frame.child, frame.parent, frame.topic))


def hints(layout: str, graph: System, code: str) -> list[Finding]:
    return [it for it in check(read_plan(layout), graph) if it.code == code]


@pytest.mark.parametrize("layout", NAMED)
def test_the_description_of_robot1_is_recognized_by_its_frames(layout: str) -> None:
    """They come twice, or on the topic of robot2."""

    def lost(frame: Edge) -> Edge | None:
        if not is_of("robot2", frame):
            return frame._replace(several=True) if layout == "frames-per-robot" else frame
        if frame.child.startswith("base_footprint"):
            return frame
        if layout == "frames-per-robot":
            return None
        parent, child = (it.replace("robot2", "robot1") for it in (frame.parent, frame.child))
        return frame._replace(parent=parent, child=child)

    (finding,) = hints(layout, reframed(lost)(healthy(layout)), "MG208")
    publisher = named(layout, "robot_state_publisher")
    assert finding.hint.startswith(f"{publisher} has the description of robot1")


# Causes name the node, by the plan, and its line; nothing points to other findings.


def torn(layout: str, change: Callable[[Edge], Edge | None]) -> list[Finding]:
    """Return findings where robot2 has a pose in the world, so that its odom is in the tree."""
    plan = read_plan(layout)
    odom = next(it for it in plan.robots[1].frames if "odom" in it)
    tf = plan.robots[1].tf_topic.replace("tf", "tf_static", 1)
    graph = reframed(change, Edge(odom, "world", tf, True, ()))(healthy(layout))
    return check(plan, sent(graph))


def spelled(layout: str, frame: str) -> str:
    plan = read_plan(layout)
    return next(it for it in plan.robots[1].frames if frame in it)


@pytest.mark.sample(1)
@pytest.mark.parametrize("layout", NAMED)
def test_a_bare_odom_of_a_plugin(layout: str) -> None:
    def bare(frame: Edge) -> Edge:
        mine = frame.child == spelled(layout, "base_footprint")
        return frame._replace(parent="odom") if mine else frame

    (finding,) = (it for it in torn(layout, bare) if it.code == "MG406")
    drive = named(layout, "diff_drive")
    assert f"odom and {spelled(layout, 'odom')} are one frame" in finding.hint
    assert f"by the plan {drive} sends" in finding.hint
    assert finding.line == 88
    assert "other findings" not in finding.hint


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize("layout", NAMED)
def test_a_bare_odom_where_nothing_else_has_it(layout: str) -> None:
    def bare(frame: Edge) -> Edge:
        mine = frame.child == spelled(layout, "base_footprint")
        return frame._replace(parent="odom") if mine else frame

    (finding,) = hints(layout, reframed(bare)(healthy(layout)), "MG207")
    drive = named(layout, "diff_drive")
    assert f"expected {spelled(layout, 'odom')}: by the plan {drive} sends" in finding.hint
    assert finding.line == 88


@pytest.mark.parametrize("layout", ["both", "postfix"])
def test_the_transform_of_robot1_on_the_tf_topic_of_robot2(layout: str) -> None:
    def swapped(frame: Edge) -> Edge:
        if frame.child != spelled(layout, "base_footprint"):
            return frame
        parent, child = (it.replace("robot2", "robot1") for it in (frame.parent, frame.child))
        return frame._replace(parent=parent, child=child)

    (finding,) = (it for it in torn(layout, swapped) if it.code == "MG406")
    assert finding.hint.endswith("it has the parameters of robot1")


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_drive_that_does_not_run(layout: str) -> None:
    drive = named(layout, "diff_drive")
    footprint = spelled(layout, "base_footprint")
    plan = read_plan(layout)
    odom = spelled(layout, "odom")
    own = plan.robots[1].tf_topic
    graph = reframed(
        lambda it: None if (it.child, it.topic) == (footprint, own) else it,
        Edge(odom, "world", own.replace("tf", "tf_static", 1), True, ()),
    )(without_node(healthy(layout), drive))
    (finding,) = tf_tree_in_pieces.check(side_by_side(plan, graph)[1])  # type: ignore[misc]
    assert finding.hint.startswith(f"{drive}, which sends {odom} -> {footprint}, does not run")
    # The node that is missing is the finding.
    told = [it for it in check(plan, graph) if it.code in ("MG101", "MG406")]
    assert [(it.code, it.node) for it in told] == [("MG101", drive)]
    assert "(MG406" in told[0].hint


@pytest.mark.sample(1)
@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("type_", ["tf2_msgs/msg/TFMessage", "sensor_msgs/msg/JointState"])
def test_a_bridge_that_was_not_started(layout: str, type_: str) -> None:
    """In gz odometry and joint states come over the bridge; the plan has no node that sends them."""
    footprint, own = spelled(layout, "base_footprint"), read_plan(layout).robots[1].tf_topic
    name = named(layout, "pose/tf")
    topic = Topic(name, bridge=(PUBLISHES,), type=type_)
    plan = read_plan(layout)._replace(topics=(topic,), edges=())
    odom = Edge(spelled(layout, "odom"), "world", own.replace("tf", "tf_static", 1), True, ())
    graph = reframed(lambda it: None if (it.child, it.topic) == (footprint, own) else it, odom)
    (finding,) = (it for it in check(plan, graph(healthy(layout))) if it.code == "MG406")
    assert f"nothing publishes {name}, which a ros_gz_bridge has to bridge" in finding.hint


ONE_TF = """\
planned: frames of robot1 on /tf: robot1_base_link, robot1_arm, robot1_hand
planned: frames of robot2 on /tf: robot2_base_link, robot2_arm, robot2_hand
as planned: /robot1/robot_state_publisher publishes /tf
as planned: /robot2/robot_state_publisher publishes /tf
running: transform robot1_base_link -> robot1_arm on /tf
running: transform robot1_arm -> robot1_hand on /tf
"""


def said(lines: str) -> dict[str, str]:
    """Return the hint of each code."""
    return {it.code: it.hint for it in check(*read_example(lines))}


def test_another_robots_description_beside_the_own_odometry() -> None:
    """The root of the description comes with the odometry, so not all of its frames are missing."""
    found = said(
        ONE_TF
        + "running: transform robot2_odom -> robot2_base_link on /tf\n"
        + "running: transform robot1_base_link -> robot1_sensor on /tf_static twice\n"
    )
    assert "has the description of robot1" in found["MG208"]


LOOSE = ONE_TF.replace("on /tf: robot1_", "on /tf: robot1_odom, robot1_x, robot1_y, robot1_").replace(
    "on /tf: robot2_", "on /tf: robot2_odom, robot2_"
) + "".join(
    f"running: transform {one} -> {other} on /tf\n"
    for one, other in (
        ("map", "robot1_odom"), ("robot2_base_link", "robot2_arm"),
        ("map", "robot2_odom"), ("robot2_odom", "robot2_base_link"),
    )
)  # fmt: skip
READ = "as planned: /robot1/robot_state_publisher subscribes /robot1/joints {}\n"


@pytest.mark.parametrize(
    ("more", "said_"),
    [
        ("", "no node sends robot1_odom -> robot1_base_link: is odometry started, are its frames"),
        (
            READ.format("sensor_msgs/msg/JointState"),
            "no node sends robot1_odom -> robot1_base_link",
        ),
        ("running: transform robot1_odom -> robot1_x on /tf\n", "a transform between them is miss"),
        # Of three roots odometry is not the only thing that is missing.
        ("running: transform robot1_x -> robot1_y on /tf\n", "a transform between them is miss"),
    ],
)
def test_odometry_that_nobody_sends_is_the_cause(more: str, said_: str) -> None:
    """Of the robot itself: robot2's odometry is sent, and its frames are no cause."""
    assert said(LOOSE + more)["MG406"].startswith(said_)
