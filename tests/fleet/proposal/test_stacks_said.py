# SPDX-License-Identifier: Apache-2.0
"""Which stacks files say, and which of several files goes with a description; by hand."""

from __future__ import annotations

from pathlib import Path

import pytest
from lxml import etree

from multibot_rewrite.fleet.proposal import companions
from multibot_rewrite.fleet.proposal.fitting import Fitting
from multibot_rewrite.fleet.proposal.looking import Looked
from multibot_rewrite.fleet.proposal.searching import search

STATE = ("robot_state", "joint_state_publisher sends the joints until a driver does")
EKF = ("ekf_filter_node_odom", "ekf_filter_node_map", "navsat_transform")


@pytest.mark.parametrize(
    ("nodes", "stacks"),
    [
        ("", []), ("controller_manager", []),
        ("amcl controller_server", ["nav2: amcl and controller_server"]),
        ("/a/amcl /a/controller_server", ["nav2: amcl and controller_server"]),
        ("amcl controller_server slam_toolbox", ["nav2: amcl and controller_server"]),
        ("slam_toolbox controller_server", ["nav2_slam: slam_toolbox and controller_server"]),
        ("controller_server", ["navigation: controller_server"]),
        ("amcl", ["localization: amcl"]), ("slam_toolbox", ["slam_toolbox: slam_toolbox"]),
        ("amcl slam_toolbox", ["localization: amcl", "slam_toolbox: slam_toolbox"]),
        ("ekf_node", ["robot_localization: ekf_node"]),
        ("ekf_filter_node", ["robot_localization: ekf_filter_node"]),
        ("ekf_node ekf_filter_node", ["robot_localization: ekf_node"]),
        (" ".join(EKF), [f"robot_localization_gps: {' and '.join(EKF)}"]),
        (f"ekf_filter_node {EKF[0]}", []),
        ("teleop_twist_joy_node", ["teleop: teleop_twist_joy_node"]),
    ],
)  # fmt: skip
def test_the_stacks_that_parameters_say(nodes: str, stacks: list[str]) -> None:
    robot = Looked("r.urdf")
    found = list(companions._stacks(robot, dict.fromkeys(nodes.split(), "p/a.yaml"), ""))
    said = [tuple(it.split(": ")) for it in stacks]
    assert found == [*((it, f"a.yaml has parameters of {by}") for it, by in said), STATE]


@pytest.mark.parametrize(
    ("simulator", "control", "manager", "found"),
    [
        ("none", True, False, [("ros2_control", "the description has <ros2_control>")]),
        ("gz", True, True,
         [("gz_ros2_control", "the description has <ros2_control> and c.yaml has controllers")]),
        ("classic", True, False, [("gazebo_ros2_control", "the description has <ros2_control>")]),
        ("gz", False, True, []), ("none", False, False, [STATE]),
    ],
)  # fmt: skip
def test_the_stacks_that_a_description_says(
    simulator: str, control: bool, manager: bool, found: list[tuple[str, str]]
) -> None:
    robot = Looked("r.urdf", simulator=simulator, control=control)
    nodes = {"controller_manager": "p/c.yaml"} if manager else {}
    assert list(companions._stacks(robot, nodes, "")) == found
    moveit = ("moveit", "there is r.srdf")
    assert list(companions._stacks(robot, nodes, "p/r.srdf")) == [*found, moveit]


def test_a_file_with_a_node_of_an_earlier_one_is_left_out() -> None:
    read = [
        Fitting("a/p.yaml", frozenset("ab"), frozenset()),
        Fitting("b/q.yaml", frozenset("bac"), frozenset()),
        Fitting("b/r.yaml", frozenset("c"), frozenset()),
    ]
    left: dict[str, str] = {}
    found = dict(companions._sections(read, left))
    assert found == {"a/p.yaml": frozenset("ab"), "b/r.yaml": frozenset("c")}
    assert left == {"b/q.yaml": "p.yaml has parameters of a, too"}


@pytest.mark.parametrize(
    ("simulator", "control", "reason"),
    [
        ("gz", True, ""), ("none", True, ""),
        ("gz", False, "no plugin of the simulated robot makes a controller manager"),
        ("none", False, "the description has no <ros2_control>"),
    ],
)  # fmt: skip
def test_controllers_that_nothing_runs_are_left_out(
    simulator: str, control: bool, reason: str
) -> None:
    robot = Looked("r.urdf", simulator=simulator, control=control)
    sections = {"c.yaml": frozenset({"controller_manager"}), "n.yaml": frozenset({"amcl"})}
    left = companions._controllers_of_others(robot, sections)
    assert left == ({"c.yaml": reason} if reason else {})


def test_a_bridge_is_for_a_robot_of_a_simulator() -> None:
    found = search([])._replace(bridge=("b.yaml",))
    none = "the description has nothing for a simulator"
    assert companions._bridges_of_others(Looked("r.urdf"), found) == {"b.yaml": none}
    assert companions._bridges_of_others(Looked("r.urdf", simulator="gz"), found) == {}


def test_the_nearest_file_is_the_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What the description loads, what a node gets, what is of its package, what a launch file names,
    what is called like it and less otherwise; then by name."""
    monkeypatch.chdir(tmp_path)
    for package in ("own", "zzz"):
        (tmp_path / package).mkdir()
        (tmp_path / package / "package.xml").write_text(
            f"<package><name>{package}</name></package>"
        )
    (tmp_path / "a.launch.py").write_text("'named.yaml'")
    inside = "<parameters> zzz/loaded.yaml </parameters><parameters/>"
    root = etree.fromstring(f"<robot>{inside}</robot>")
    wanted = [
        "zzz/loaded.yaml", "zzz/given.yaml", "own/named.yaml", "own/rover.yaml", "own/a_b_c.yaml",
        "zzz/named.yaml", "zzz/rover.yaml", "zzz/a.yaml", "zzz/b.yaml", "zzz/a_more_words.yaml",
    ]  # fmt: skip
    own = ["own/named.yaml", "own/rover.yaml", "own/a_b_c.yaml"]
    robot = Looked("own/rover.urdf", root=root)
    given = {"zzz/given.yaml"}
    found = companions._nearest(robot, sorted(wanted, reverse=True), ["a.launch.py"], given)
    assert found == wanted and found[2:5] == own
    bare = companions._nearest(Looked("own/rover.urdf"), sorted(wanted), (), ())
    assert bare[:3] == ["own/rover.yaml", "own/named.yaml", "own/a_b_c.yaml"]
