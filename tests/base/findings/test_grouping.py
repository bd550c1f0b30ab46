# SPDX-License-Identifier: Apache-2.0
"""What is the same for many robots is said once, and names them in every format."""

from __future__ import annotations

import pytest

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding, Remap, Setting, same_for
from multibot_rewrite.base.findings.selection import grouped

ROBOTS = [f"robot{number}" for number in range(1, 21)]
NAMES = {robot: robot for robot in ROBOTS}


def lost(robot: str, topic: str = "cmd_vel", **more: str) -> Finding:
    """A node of the robot that does not subscribe its topic."""
    message = f"it should subscribe topic /{robot}/{topic}, and does not"
    cause = f"its rule /{topic}:=/{robot}/{topic} did not reach it"
    node = f"/{robot}/driver"
    rule = Remap(node, f"/{topic}", f"/{robot}/{topic}")
    found = Finding("MG102", ERROR, message, cause, robot=robot, node=node, remaps=(rule,))
    return found._replace(names=(f"/{robot}/{topic}",), **more)  # type: ignore[arg-type]


def test_twenty_robots_with_one_fault_are_one_finding() -> None:
    (one,) = grouped([lost(robot) for robot in ROBOTS], NAMES)
    assert (one.robot, one.robots) == ("robot1", tuple(ROBOTS))
    assert same_for(one) == "; the same for robot2 and 18 more"
    # A check has them by the names of nodes: robot10 before robot2.
    assert grouped([lost(robot) for robot in sorted(ROBOTS)], NAMES) == [one]


def test_what_is_grouped_already_keeps_its_robots() -> None:
    first = grouped([lost(robot) for robot in ROBOTS[:2]], NAMES)
    assert grouped(first, NAMES) == first
    (one,) = grouped([*first, lost("robot3")], NAMES)
    assert one.robots == ("robot1", "robot2", "robot3")
    assert str(one).count("; the same for robot2 and 1 more (its rule") == 1


def test_two_robots_are_named_both() -> None:
    (one,) = grouped([lost("robot2"), lost("robot7")], NAMES)
    assert same_for(one) == "; the same for robot7"


@pytest.mark.parametrize(
    "other",
    [
        pytest.param(lost("robot2", "scan"), id="topic"),
        pytest.param(lost("robot2", level=WARNING), id="level"),
        pytest.param(lost("robot2", code="MG310"), id="code"),
        pytest.param(lost("robot2", file="rover.urdf"), id="file"),
        pytest.param(lost("robot2")._replace(hint=""), id="cause"),
        pytest.param(lost("robot2")._replace(message="/robot1/cmd_vel is lost"), id="robot"),
    ],
)
def test_another_fault_is_another_finding(other: Finding) -> None:
    assert grouped([lost("robot1"), other], NAMES) == [lost("robot1"), other]


def test_a_name_inside_another_name_is_not_a_robot() -> None:
    apart = [lost("robot1"), lost("robot11")]
    assert grouped(apart, {"robot1": "robot1"}) == apart


def test_the_word_of_a_robot_in_frames_is_the_robot() -> None:
    words = {"fleet_a": "a", "a1": "a", "fleet_b": "b", "b1": "b"}
    found = [
        Finding("MG207", ERROR, f"{word}/odom is bare", robot=robot, node=f"/fleet_{robot}/amcl")
        for robot, word in (("a", "a1"), ("b", "b1"))
    ]
    (one,) = grouped(found, words)
    assert one.robots == ("a", "b")


def test_findings_of_a_file_that_speak_of_one_robot_are_grouped() -> None:
    found = [
        Finding("MF701", WARNING, f"robot {robot!r}: no transform", file="fleet.yaml", line=4)
        for robot in ROBOTS[:3]
    ]
    (one,) = grouped(found, NAMES)
    assert (one.robots, one.place) == (("robot1", "robot2", "robot3"), "fleet.yaml:4:0")


def test_the_order_is_that_of_the_first() -> None:
    scan = [lost(robot, "scan") for robot in ROBOTS[:2]]
    command = [lost(robot) for robot in ROBOTS[:2]]
    found = grouped([scan[0], command[0], command[1], scan[1]], NAMES)
    assert [it.names for it in found] == [("/robot1/scan",), ("/robot1/cmd_vel",)]


def test_what_mends_each_of_several_robots_alike_is_one_finding() -> None:
    found = [
        lost(robot)._replace(settings=(Setting(f"/{robot}/amcl", "use_sim_time", "true"),))
        for robot in ROBOTS[:2]
    ]
    assert len(grouped(found, NAMES)) == 1
