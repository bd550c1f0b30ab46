# SPDX-License-Identifier: Apache-2.0
"""MR105 and MR103 by release: a rule in a plugin's tag that is meant for a controller."""

from __future__ import annotations

import pytest

from multibot_rewrite.base.naming import Policy
from multibot_rewrite.checks.judged_plan import make_fleet
from multibot_rewrite.knowledge.records import Endpoint, NodeFacts
from multibot_rewrite.planning.records import Run, Table
from multibot_rewrite.planning.way_checks import not_taken
from multibot_rewrite.system.records import ACTION, PUBLISHES, SUBSCRIBES, TOPIC

LAYOUT: Policy = {"layout": "tf-per-robot"}
NEITHER: Policy = {"layout": "postfix"}


def description(*rules: str) -> bytes:
    tags = "".join(f"<remapping>{rule}</remapping>" for rule in rules)
    return (
        '<robot name="rover"><link name="base_link"/><gazebo>'
        '<plugin name="control" filename="gz_ros2_control-system"><parameters>c.yaml</parameters>'
        f"<ros>{tags}</ros></plugin></gazebo></robot>"
    ).encode()


def codes(
    release: str, *rules: str, node_set: str = "", policy: Policy = LAYOUT
) -> list[tuple[str, str]]:
    node_sets = [node_set] if node_set else []
    made = make_fleet(description(*rules), ["robot1", "robot2"], node_sets, policy, release=release)
    return [(it.code, it.robot) for it in made.table.problems if it.code.startswith("MR1")]


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("release", "rule", "node_set", "found"),
    [
        # Forwarded to the controllers, one of which has the name.
        ("jazzy", "~/odom:=odom", "gz_ros2_control", []),
        ("humble", "~/odom:=odom", "gz_ros2_control", []),
        ("lyrical", "~/odom:=odom", "gz_ros2_control", ["MR103"]),
        ("jazzy", "diff_drive_controller:~/odom:=odom", "gz_ros2_control", []),
        ("jazzy", "joint_trajectory_controller:~/odom:=odom", "gz_ros2_control", ["MR103"]),
        ("jazzy", "~/odmo:=odom", "gz_ros2_control", ["MR103"]),
        # For a controller that other robots of the description have, or of another release.
        ("jazzy", "~/reference:=cmd_vel", "gz_ros2_control", []),
        ("jazzy", "drive_controller/cmd_vel:=cmd_vel", "gz_ros2_control", []),
        ("jazzy", "~/cmd_vel_unstamped:=cmd_vel", "gz_ros2_control", []),
        ("jazzy", "/diagnostics:=diagnostics", "gz_ros2_control", []),
        ("jazzy", "drive_controller/cmd_vle:=cmd_vel", "gz_ros2_control", ["MR103"]),
        ("lyrical", "drive_controller/cmd_vel:=cmd_vel", "gz_ros2_control", ["MR103"]),
        # Nobody knows the controllers.
        ("jazzy", "~/odom:=odom", "", []),
        ("lyrical", "~/odom:=odom", "", ["MR103", "MR105"]),
    ],
)
def test_a_rule_for_a_controller(release: str, rule: str, node_set: str, found: list[str]) -> None:
    assert sorted({code for code, _ in codes(release, rule, node_set=node_set)}) == found


def test_each_robot_of_a_description_is_looked_at() -> None:
    robots = [f"robot{at}" for at in range(1, 6)]
    node_sets = ["gz_ros2_control"]
    made = make_fleet(description(), robots, node_sets, NEITHER, release="humble")
    found = {it.robot for it in made.table.problems if it.code == "MR105"}
    assert found - {"robot1"} == {*robots[1:]}


Name = tuple[Endpoint, str]


def hosted(robot: str, *names: Name, **home: str) -> Table:
    """Return a node in another one's process, with a rule for ``/y`` alone."""
    fact = NodeFacts("map", "acme", (), **{"host": "server", **home})  # type: ignore[arg-type]
    return Table(
        "tf-per-robot",
        (
            Run(robot, "server", f"/{robot}", "server", ()),
            Run(robot, "map", f"/{robot}", "map", (("/y", "y"),), fact, names=names),
        ),
        (), "jazzy",
    )  # fmt: skip


def named(name: str, meant: str, **more: str) -> Name:
    end = {"kind": TOPIC, "role": PUBLISHES, "name": name, **more}
    return Endpoint(**end), meant


@pytest.mark.parametrize(
    ("name", "told"),
    [
        (named("/x", "/a/x"), ("/x",)),
        (named("/y", "/a/y"), ()),
        (named("/x", "/x"), ()),
        (named("/go", "/a/go", kind=ACTION), ("/go",)),
        # A rule cannot reach it, or it need not be there.
        (named("/x", "/a/x", fixed="in its code"), ()),
        (named("/x", "/a/x", when="x: true"), ()),
        # It is called otherwise, but like nothing that the code or another robot has.
        (named("/y", "/a/other"), ()),
        (named("/x", "/a/x", role=SUBSCRIBES), ("/x",)),
    ],
)
def test_a_name_that_its_rule_does_not_reach(name: Name, told: tuple[str, ...]) -> None:
    assert [it.names for it in not_taken(hosted("a", name))] == [told] * bool(told)
