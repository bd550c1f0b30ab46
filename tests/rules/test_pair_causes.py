# SPDX-License-Identifier: Apache-2.0
"""What was probably meant, and what is to do about it: names beside names, and the whole sentences.

Of ``rules/system``: causes, planned_frames, planned_ends, similar_names.
"""

from __future__ import annotations

from typing import Any

import pytest
from graph_examples import read_example

from multibot_rewrite.rules.check import check
from multibot_rewrite.rules.system.causes import (
    Spelled,
    alike,
    caused,
    how_to_pass,
    how_to_remap,
    why_not_remapped,
    why_other_name,
)
from multibot_rewrite.rules.system.planned_ends import _why_besides, probable_matches, similar
from multibot_rewrite.system.index import Index, index
from multibot_rewrite.system.ownership import whose_by_plan
from multibot_rewrite.system.records import COMPONENT, HOST, PLUGIN, SPAWNER

FRAMES = "base, laser, front_laser, tool"
SCAN = "/robot1/lidar publishes /robot1/scan sensor_msgs/msg/LaserScan"
PLACE = "arm.urdf:12"


def plan_of(lines: str, **changes: Any) -> Index:
    """Return the plan of an example, with what is changed in the node of its first line."""
    plan, _ = read_example("\n".join(f"planned: {it}" for it in lines.splitlines()))
    name = lines.partition(" ")[0]
    nodes = tuple(it._replace(**changes) if it.name == name else it for it in plan.nodes)
    plan = plan._replace(nodes=nodes)
    return index(plan, whose_by_plan(plan))


@pytest.mark.parametrize(
    ("name", "known", "found"),
    [
        ("/scan", ["/scan_raw", "/odom"], "/scan_raw"),
        ("/scan_raw", ["/scan", "/odom"], "/scan"),
        # The shorter step of two.
        ("/scan", ["/scan_filtered", "/scan_raw"], "/scan_raw"),
        ("/scna", ["/odom", "/scan"], "/scan"),
        ("/scan", ["/odom"], ""),
        ("/scan", [], ""),
        ("/scan", ["/scan_raw", *(f"/other{it}" for it in range(49))], "/scan_raw"),
        # Of so many one is always like it.
        ("/scan", ["/scan_raw", *(f"/other{it}" for it in range(50))], ""),
    ],
)
def test_a_similar_name(name: str, known: list[str], found: str) -> None:
    assert similar(name, known) == found


def test_nothing_is_missing() -> None:
    assert probable_matches({}, ["/lidar"], ["/lidar"], plan_of(SCAN).of_names) == {}


MANY = "a, b, c, d, e, f"


@pytest.mark.parametrize(
    ("planned", "names", "found"),
    [
        (FRAMES, ["x/base", "x/laser"], {"x/base", "x/laser"}),
        # One alone may be a frame of its own, with a slash as well.
        (FRAMES, ["x/base"], set()),
        (FRAMES, ["front_laser"], set()),
        (FRAMES, ["x_base", "x_laser"], {"x_base", "x_laser"}),
        (FRAMES, ["x_base", "y_laser"], set()),
        (FRAMES, ["base", "other"], set()),
        # The longest: front_laser behind x/.
        (FRAMES, ["x/front_laser", "x/base"], {"x/front_laser", "x/base"}),
        # The robot's own name needs no second frame.
        (FRAMES, ["robot1_laser"], {"robot1_laser"}),
        (FRAMES, ["laser_robot1"], {"laser_robot1"}),
        # Of many frames half have the prefix, if it has no slash.
        (MANY, ["x_a", "x_b"], set()),
        (MANY, ["x/a", "x/b"], {"x/a", "x/b"}),
        (MANY, ["x_a", "x_b", "x_c"], {"x_a", "x_b", "x_c"}),
    ],
)
def test_a_prefix_in_front_of_planned_frames(
    planned: str, names: list[str], found: set[str]
) -> None:
    lines = f"as planned: /robot1/lidar\nplanned: frames of robot1 on /robot1/tf: {planned}"
    sent = (f"\nrunning: transform tool -> {it} on /robot1/tf_static" for it in names)
    findings = check(*read_example(lines + "".join(sent)))
    assert {name for it in findings if it.code == "MG407" for name in it.names} == found


@pytest.mark.parametrize(
    ("place", "file", "line"),
    [("a.urdf:12", "a.urdf", 12), ("node set nav2", "", 0), ("c:a.urdf:3", "c:a.urdf", 3)],
)
def test_a_cause_has_its_place(place: str, file: str, line: int) -> None:
    assert caused("why", place)[:3] == ("why", file, line)


@pytest.mark.parametrize(
    ("code", "hint"),
    [
        ("/scan", f"no remap rule /scan:=scan of plugin lidar is applied, see {PLACE}"),
        ("scan", f"plugin lidar has no namespace or remap rule for it, see {PLACE}"),
    ],
)
def test_a_rule_that_a_plugin_should_have(code: str, hint: str) -> None:
    plan = plan_of(SCAN, plugin=PLACE)
    end = plan.system.ends[0]._replace(code_name=code)
    assert why_not_remapped(plan, end)[:3] == (hint, "arm.urdf", 12)
    assert how_to_remap(plan, end) == ""


def test_why_a_node_uses_a_name_of_no_robot() -> None:
    def why(robots_last: bool = False, **changes: Any) -> tuple[object, ...]:
        node = ("/lidar/robot{}" if robots_last else "/robot{}/lidar").format
        plan = plan_of(f"{node(1)} publishes {node(1)}/out\n{node(2)}", **changes)
        end = plan.system.ends[0]._replace(name="/scan")
        return _why_besides(plan, end, "")

    given = "no namespace or remap rule for it, see arm.urdf:12"
    assert why(plugin=PLACE)[:3] == (f"plugin lidar has {given}", "arm.urdf", 12)
    passed = "an absolute name in its code or parameters; pass {0} with --ros-args -r {0}, or with"
    passed += " remappings=[('/scan', '{1}')] in the launch file"
    for last, name in ((False, "/robot1/scan"), (True, "/scan/robot1")):
        assert why(last)[:3] == (passed.format(f"/scan:={name}", name), "", 0)


PAIR = "remappings=[('/a', 'b')]"
ARGS = f"--ros-args -r /a:=b, or with {PAIR} in the launch file"


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({}, f"it with {ARGS}"),
        (
            {"way": COMPONENT},
            f"it where it is loaded into its container: {PAIR} of its ComposableNode",
        ),
        ({"way": SPAWNER}, 'it to its spawner: --controller-ros-args "-r /a:=b"'),
        (
            {"way": PLUGIN, "taker": "gazebo"},
            "it in the description: <remapping>/a:=b</remapping> in <ros> of the plugin of gazebo",
        ),
        (
            {"way": HOST, "taker": "/robot1/host"},
            "it to /robot1/host, whose process it is in: --ros-args -r lidar:/a:=b, or with"
            " remappings=[('lidar:/a', 'b')] in the launch file",
        ),
    ],
)
def test_where_a_rule_stands(changes: dict[str, str], said: str) -> None:
    plan = plan_of(SCAN, **changes)
    assert how_to_pass(plan, "/robot1/lidar", "/a:=b", "it") == said
    assert how_to_pass(plan, "/robot1/lidar", "/a:=b") == said.replace("it", "/a:=b", 1)


NO_SPACE = "/lidar is running: it was started without the robot's namespace; use"
NO_NAME = "/lidar is running: it was started without the robot's name; use"


@pytest.mark.parametrize(
    ("node", "match", "changes", "hint"),
    [
        (
            "/robot1/lidar",
            "/lidar",
            {},
            f"{NO_SPACE} namespace='robot1' in the launch file, or --ros-args -r __ns:=/robot1",
        ),
        (
            "/robot1/lidar",
            "/lidar",
            {"way": COMPONENT},
            f"{NO_SPACE} namespace='/robot1' of its ComposableNode",
        ),
        ("/lidar_robot1", "/lidar", {}, f"{NO_NAME} --ros-args -r __node:=lidar_robot1"),
        (
            "/lidar_robot1",
            "/lidar",
            {"way": COMPONENT},
            f"{NO_NAME} name='lidar_robot1' of its ComposableNode",
        ),
        (
            "/robot1/lidar",
            "/robot1/laser",
            {},
            "/robot1/laser is running; is it this node under another name?",
        ),
        (
            "/robot1/lidar",
            "/lidar",
            {"way": HOST, "taker": "/robot1/host"},
            "/lidar is running in the process of /robot1/host: start /robot1/host as planned",
        ),
        (
            "/robot1/lidar",
            "/lidar",
            {"plugin": PLACE},
            f"/lidar is running: plugin lidar has no namespace, see {PLACE}",
        ),
        (
            "/lidar_robot1",
            "/lidar",
            {"plugin": PLACE},
            f"/lidar is running: plugin lidar has no separate name for each robot, see {PLACE}",
        ),
    ],
)
def test_why_a_node_has_another_name(
    node: str, match: str, changes: dict[str, str], hint: str
) -> None:
    plan = plan_of(f"{node} publishes /robot1/scan", **changes)
    place = ("arm.urdf", 12) if "plugin" in changes else ("", 0)
    assert why_other_name(plan, node, match)[:3] == (hint, *place)


# Names that are another one but for a slip: expectations are what a person would call a slip.


@pytest.mark.parametrize(
    ("name", "known", "found"),
    [
        ("/r/Scan", ["/r/odom", "/r/scan"], "/r/scan"),
        ("/r/cmd-vel", ["/r/cmd_vel"], "/r/cmd_vel"),
        ("/r/odmo", ["/r/scan", "/r/odom"], "/r/odom"),
        # It is no slip of itself, and what it is there beside.
        ("/r/scan", ["/r/scan"], ""),
        ("/r/scan", ["/r/scan", "/r/Scan"], "/r/Scan"),
        # Two things: numbers, sides, another word.
        ("/r/scan1", ["/r/scan2"], ""),
        ("/r/lidar_l", ["/r/lidar_r"], ""),
        ("/r/odom", ["/r/map"], ""),
    ],
)
def test_a_slip_is_the_known_name(name: str, known: list[str], found: str) -> None:
    assert alike(name, Spelled(known), "acme/msg/A") == found
