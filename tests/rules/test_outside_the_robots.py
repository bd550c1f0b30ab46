# SPDX-License-Identifier: Apache-2.0
"""Readers outside of the robots, topics that robots share on purpose, commands carried to others."""

from __future__ import annotations

import pytest
from graph_calls import diagnose
from graph_examples import read_example, read_system

from multibot_rewrite.live.diagnose import diagnose_domains
from multibot_rewrite.rules.check import check, judge
from multibot_rewrite.system.records import System

SCAN, TWIST, ODOM = (
    "sensor_msgs/msg/LaserScan", "geometry_msgs/msg/Twist", "nav_msgs/msg/Odometry",
)  # fmt: skip
ROBOTS = [
    f"/robot{it}/{node} {does} /robot{it}/scan {SCAN}"
    for it in "12"
    for node, does in (("lidar", "publishes"), ("slam", "subscribes"))
]


def told(*lines: str) -> list[tuple[str, str, str]]:
    found = judge(read_system("\n".join(f"running: {it}" for it in lines)))
    return [(it.code, it.level, it.node) for it in found]


@pytest.mark.parametrize("robots", [ROBOTS[:2], ROBOTS])
def test_a_reader_outside_the_robots_is_told_whoever_else_reads(robots: list[str]) -> None:
    found = judge(
        read_system(
            "\n".join(f"running: {it}" for it in (*robots, f"/my_node subscribes /scan {SCAN}"))
        )
    )
    ((code, level, node, names, several),) = [
        (it.code, it.level, it.node, it.names, "another of the 2 robots" in it.message)
        for it in found
    ]
    assert (code, level, node) == ("MG303", "error", "/my_node")
    assert names == ("/scan", "/robot1/scan") and several == (len(robots) > 2)
    # Nobody knows which of two is meant.
    assert bool(found[0].remaps) is not several


def test_scans_that_robots_share_on_purpose() -> None:
    shared = [
        f"/robot{it}/slam_toolbox {does} /localized_scan {SCAN}"
        for it in "12"
        for does in ("publishes", "subscribes")
    ]
    assert told(*ROBOTS, *shared) == []
    other = [it.replace("localized_scan", "merged_scan") for it in shared]
    assert "MG320" in {code for code, *_ in told(*ROBOTS, *other)}


BASE = (f"/base subscribes /cmd_vel {TWIST}", f"/pilot publishes /cmd_vel {TWIST}")
CARRIED = f"/domain_bridge {{}} /cmd_vel {TWIST}"


def domain(*lines: str) -> System:
    return read_system("\n".join(f"running: {it}" for it in lines)).system


@pytest.mark.parametrize(
    ("first", "second", "found"),
    [
        ((*BASE, CARRIED.format("subscribes")), (*BASE, CARRIED.format("publishes")), True),
        ((*BASE, CARRIED.format("subscribes")), (BASE[0], CARRIED.format("publishes")), True),
        # An operator's domain has no driver, and what is carried to nobody drives nobody.
        ((BASE[1], CARRIED.format("subscribes")), (BASE[0], CARRIED.format("publishes")), False),
        ((*BASE, CARRIED.format("subscribes")), (BASE[1], CARRIED.format("publishes")), False),
        (BASE, BASE, False),
    ],
)
def test_commands_of_one_robot_carried_to_another(
    first: tuple[str, ...], second: tuple[str, ...], found: bool
) -> None:
    each = {it: diagnose(domain(*lines)) for it, lines in ((65, first), (66, second))}
    seen = [it for it in diagnose_domains(each).findings if it.node == "/domain_bridge"]
    assert [(it.code, it.level) for it in seen] == ([("MG310", "error")] if found else [])


def test_a_sender_of_commands_that_the_plan_has_not() -> None:
    lines = [
        f"as planned: /robot1/base subscribes /robot1/cmd_vel {TWIST}",
        f"as planned: /robot1/pilot publishes /robot1/cmd_vel {TWIST}",
    ]
    teleop = f"/robot1/teleop publishes /robot1/cmd_vel {TWIST}"
    new = check(*read_example("\n".join([*lines, f"running: {teleop}"])))
    assert [(it.code, it.level) for it in new] == [("MG312", "error")]
    assert check(*read_example("\n".join([*lines, f"as planned: {teleop}"]))) == []
