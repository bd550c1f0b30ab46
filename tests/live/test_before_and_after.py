# SPDX-License-Identifier: Apache-2.0
"""``multibot check before.json --from after.json``: two looks are held against each other as wholes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from graph_calls import diagnose, seen_plan
from graph_examples import read_looks

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.cli.multibot import main as multibot
from multibot_rewrite.rules.check import check
from multibot_rewrite.system.json import to_json
from multibot_rewrite.system.records import Description, Heard, Parameter, System

TWIST, ODOM, SCAN = (
    "geometry_msgs/msg/Twist", "nav_msgs/msg/Odometry", "sensor_msgs/msg/LaserScan",
)  # fmt: skip
TF = "tf2_msgs/msg/TFMessage"
MODEL = "/robot1/robot_description"
PATH = "/robot1/follow_path nav2_msgs/action/FollowPath"
GOAL, STOP = "geometry_msgs/msg/PoseStamped", "std_msgs/msg/Bool"
ROBOTS = [
    line.format(it)
    for it in ("robot1", "robot2")
    for line in (
        f"/{{0}}/driver subscribes /{{0}}/cmd_vel {TWIST}",
        f"/{{0}}/driver publishes /{{0}}/odom {ODOM}",
        f"/{{0}}/driver publishes /tf {TF}",
        f"/{{0}}/lidar publishes /{{0}}/scan {SCAN}",
        f"/{{0}}/pilot subscribes /{{0}}/scan {SCAN}",
        f"/{{0}}/pilot subscribes /{{0}}/odom {ODOM}",
        f"/{{0}}/pilot subscribes /{{0}}/goal_pose {GOAL}",
        f"/{{0}}/pilot publishes /{{0}}/cmd_vel {TWIST}",
        f"/{{0}}/rsp publishes /tf_static {TF}",
        f"/{{0}}/rsp subscribes /tf {TF}",
        "/{0}/pilot serves /{0}/follow_path nav2_msgs/action/FollowPath",
        "transform world -> {0}/base_link on /tf_static by /robot1/rsp, /robot2/rsp",
        "transform {0}/base_link -> {0}/laser on /tf_static at 0 0 1 by /robot1/rsp, /robot2/rsp",
    )
]


def held(*lines: str, change: Callable[[System], System] = lambda it: it) -> list[Finding]:
    """Return what is found of these lines besides the robots, held against them."""
    text = "\n".join((*(f"as before: {it}" for it in ROBOTS), *lines))
    before, after = read_looks(text)
    return check(seen_plan(diagnose(before)), change(after), before=before)


def codes(found: list[Finding]) -> list[tuple[str, str, str]]:
    return [(it.code, it.level, it.node) for it in found]


@pytest.mark.parametrize(
    ("line", "node"),
    [
        (f"running: /foxglove_bridge publishes /robot1/cmd_vel {TWIST}", "/foxglove_bridge"),
        (f"running: /teleop_node publishes /robot1/cmd_vel {TWIST}", "/teleop_node"),
        (f"running: /rqt_gui_py_node_12 publishes /robot2/cmd_vel {TWIST}", "/rqt_gui_py_node_12"),
        (f"running: /rviz2 publishes /robot1/goal_pose {GOAL}", "/rviz2"),
        (f"running: /domain_bridge publishes /robot1/goal_pose {GOAL}", "/domain_bridge"),
        (f"running: /zenoh_bridge_ros2dds publishes /robot1/odom {ODOM}", "/zenoh_bridge_ros2dds"),
        (f"running: /foxglove_bridge calls {PATH}", "/foxglove_bridge"),
    ],
)  # fmt: skip
def test_a_tool_that_commands_a_robot_is_a_new_sender(line: str, node: str) -> None:
    (it,) = held(line)
    assert it.level == ERROR and node in f"{it.node}: {it.message}"


def test_what_a_tool_sends_to_a_robot_is_new() -> None:
    """Not what choosers read, which is for one of several senders, nor what other tools read."""
    sent = f"running: /rosbridge_websocket publishes /robot1/e_stop {STOP}"
    for reader, found in (
        ("/robot1/driver", [("MG130", WARNING, "/rosbridge_websocket")]),
        ("/robot1/twist_mux", []),
        ("/domain_bridge", []),
    ):
        assert codes(held(sent, f"as before: {reader} subscribes /robot1/e_stop {STOP}")) == found


@pytest.mark.parametrize(
    "line",
    [
        f"running: /rviz2 subscribes /robot1/scan {SCAN}",
        "running: /rviz2 publishes /clicked_point geometry_msgs/msg/PointStamped",
        f"running: /rosbag2_recorder subscribes /robot1/cmd_vel {TWIST}",
        "running: /robot1/pilot serves /robot1/pilot/get_parameters rcl_interfaces/srv/GetParameters",
        "running: /robot1/pilot publishes /parameter_events rcl_interfaces/msg/ParameterEvent",
    ],
)
def test_the_plumbing_of_tools_and_nodes_is_no_change(line: str) -> None:
    assert held(line) == []


@pytest.mark.parametrize(
    ("line", "node"),
    [
        ("running: /robot1/pilot serves /robot1/dock std_srvs/srv/Trigger", "/robot1/pilot"),
        (f"running: /robot1/lidar publishes /robot1/low_scan {SCAN}", "/robot1/lidar"),
        ("running: transform world -> gantry on /tf_static", ""),
    ],
)
def test_a_new_end_or_transform(line: str, node: str) -> None:
    assert codes(held(line)) == [("MG130", WARNING, node)]


IMU = "sensor_msgs/msg/Imu"
BRIDGE = [
    f"{{}}: /ros_gz_bridge publishes /robot1/imu {IMU}",
    f"{{}}: /ros_gz_bridge publishes /robot1/depth {SCAN}",
    "{}: /ros_gz_bridge serves /robot1/reset std_srvs/srv/Empty",
    f"{{}}: /ros_gz_bridge publishes /robot1/goal_pose {GOAL}",
    "as before: /robot1/pilot calls /robot1/reset std_srvs/srv/Empty",
]


@pytest.mark.parametrize(
    ("read", "lost"),
    [
        (f"as before: /robot1/pilot subscribes /robot1/imu {IMU}", ("/robot1/imu", "/robot1/reset")),
        (f"as before: /rviz2 subscribes /robot1/imu {IMU}", ("/robot1/reset",)),
        (f"as before: /robot1/mux subscribes /robot1/imu {IMU}", ("/robot1/reset",)),
        (f"as before: /robot1/pilot subscribes /robot1/depth {SCAN}",
         ("/robot1/depth", "/robot1/reset")),
    ],
)  # fmt: skip
def test_a_bridge_that_is_gone_is_missed_by_those_who_use_what_it_gave(
    read: str, lost: tuple[str, ...]
) -> None:
    """Not what a person may send, whatever reads it, nor what displays and choosers read."""
    gone = [it.format("earlier") for it in BRIDGE]
    told = [it for it in held(*gone, read) if it.node == "/ros_gz_bridge"]
    assert [(it.code, it.level, tuple(sorted(it.names))) for it in told] == [("MG130", ERROR, lost)]
    assert held(*(it.format("as before") for it in BRIDGE), read) == []
    other = f"running: /gz_bridge publishes /robot1/imu {IMU}"
    reset = "running: /gz_bridge serves /robot1/reset std_srvs/srv/Empty"
    for more in ((other,), (other, reset)):
        given = {line.split()[3] for line in more}
        rest = [it for it in (tuple(it for it in lost if it not in given),) if it]
        found = [it for it in held(*gone, read, *more) if it.node == "/ros_gz_bridge"]
        assert [tuple(sorted(it.names)) for it in found] == rest


def test_a_node_of_a_robot_that_is_gone_is_one_finding() -> None:
    used = f"as before: /robot1/pilot subscribes /robot1/imu {IMU}"
    found = held(f"earlier: /robot1/imu_driver publishes /robot1/imu {IMU}", used)
    assert codes(found) == [("MG101", ERROR, "/robot1/imu_driver")]


def test_a_root_that_all_share_is_missed() -> None:
    def cut(graph: System) -> System:
        left = (it for it in graph.edges if it.child != "robot1/base_link")
        return graph._replace(edges=tuple(left))

    (it,) = held(change=cut)
    # The plan that is made of the earlier look has it, so it is told as with any plan.
    assert (it.code, it.level, it.robot) == ("MG406", ERROR, "robot1")
    assert "world -> robot1/base_link, and does not" in it.hint


def test_transforms_that_are_gone_are_one_finding() -> None:
    """The senders on a topic of all are known, not which of them sent a transform."""
    sent = "earlier: transform world -> {} on /tf_static by /robot1/rsp, /robot2/rsp"
    (it,) = held(*map(sent.format, ("dock", "gate")))
    assert (it.code, it.node, it.robot, it.names) == ("MG130", "", "", ("dock", "gate"))
    assert "world -> dock, world -> gate on /tf_static are gone" in it.message
    (own,) = held(sent.format("dock").replace("/tf_static", "/robot1/tf_static"))
    assert (own.code, own.robot) == ("MG130", "robot1")
    # What a node that is gone may have sent is gone with it.
    dead = sent.format("dock").replace("/robot1/rsp", "/robot2/mapper")
    found = held(dead, f"earlier: /robot2/mapper subscribes /tf {TF}")
    assert {it.code for it in found} == {"MG101"}


def test_a_part_is_elsewhere() -> None:
    def moved(graph: System) -> System:
        turned = (0.0, 0.0, 1.2, 0.0, 0.0, 0.0, 1.0)
        edges = (
            it._replace(transform=turned) if it.child == "robot2/laser" else it
            for it in graph.edges
        )
        return graph._replace(edges=tuple(edges))

    assert [(it.code, it.names) for it in held(change=moved)] == [("MG130", ("robot2/laser",))]


def test_other_qos_frames_and_parameters() -> None:
    text = "\n".join(f"as before: {it}" for it in ROBOTS)
    before, after = read_looks(text)
    own = Parameter("/robot1/pilot", "max_speed", "0.5")
    before = before._replace(
        parameters=(own,),
        heard=(Heard("/robot1/scan", "robot1/laser"),),
        descriptions=(Description(MODEL, ("robot1/base_link", "robot1/laser")),),
    )
    lidar = f"earlier: /robot2/lidar publishes /robot2/low_scan {SCAN} best_effort"
    was, _ = read_looks(lidar)
    now, _ = read_looks(lidar.replace("best_effort", "reliable"))
    before = before._replace(ends=(*before.ends, *was.ends))
    after = after._replace(
        ends=(*after.ends, *now.ends),
        parameters=(own._replace(value="2.0"),),
        heard=(Heard("/robot1/scan", "robot1/base_link"),),
        descriptions=(Description(MODEL, ("robot1/base_link", "robot1/lidar")),),
    )
    found = check(seen_plan(diagnose(before)), after, before=before)
    assert {(it.code, it.node, it.names): it.message for it in found} == {
        ("MG130", "/robot2/lidar", ("/robot2/low_scan",)): "publishes /robot2/low_scan as"
        f" {SCAN} RELIABLE VOLATILE, and did as {SCAN} BEST_EFFORT VOLATILE",
        (
            "MG130",
            "",
            ("/robot1/scan",),
        ): "messages on /robot1/scan are of robot1/base_link, and were of robot1/laser",
        (
            "MG130",
            "",
            (MODEL,),
        ): f"messages on {MODEL} are of robot1/lidar, and were of robot1/laser",
        ("MG130", "/robot1/pilot", ()): "max_speed is 2.0, and was 0.5",
    }


def own_tf(graph: System) -> System:
    """Return the system in which robot1's publisher sends on a topic of its own."""
    own, node = "/robot1/tf_static", "/robot1/rsp"
    ends = (it._replace(name=own) if (it.node, it.type) == (node, TF) else it for it in graph.ends)
    edges = (
        it._replace(topic=own, publishers=(node,))
        if it.child.startswith("robot1/") and it.static
        else it._replace(publishers=tuple(one for one in it.publishers if one != node))
        for it in graph.edges
    )
    return graph._replace(ends=tuple(ends), edges=tuple(edges))


def base_of_another(graph: System) -> System:
    edges = (it._replace(child=it.child.replace("robot1/fo", "robot2/fo")) for it in graph.edges)
    return graph._replace(edges=tuple(edges))


ODOMETRY = [
    line.format(it)
    for it in ("robot1", "robot2")
    for line in (
        "as before: transform {0}/odom -> {0}/foot on /tf by /robot1/driver, /robot2/driver",
        "as before: transform {0}/foot -> {0}/tip on /tf_static by /robot1/rsp, /robot2/rsp",
    )
]


@pytest.mark.parametrize(
    ("lines", "change", "code"), [([], own_tf, "MG405"), (ODOMETRY, base_of_another, "MG414")]
)
def test_what_another_finding_explains_is_no_change_of_its_own(
    lines: list[str], change: Callable[[System], System], code: str
) -> None:
    found = {it.code for it in held(*lines, change=change)}
    assert code in found and "MG130" not in found


def test_a_node_that_is_no_longer_on_simulated_time_is_one_finding() -> None:
    clock = "/clock rosgraph_msgs/msg/Clock"
    lines = [f"as before: {it} subscribes {clock}" for it in ("/robot1/pilot", "/robot1/amcl")]
    lines += [f"as before: /sim publishes {clock}", f"earlier: /robot1/ekf_node subscribes {clock}"]
    lines += [f"as before: /robot1/ekf_node publishes /robot1/odom_filtered {ODOM}"]
    before, after = (
        graph._replace(parameters=(Parameter("/robot1/ekf_node", "use_sim_time", value),))
        for graph, value in zip(read_looks("\n".join(lines)), ("true", "false"), strict=True)
    )
    found = check(seen_plan(diagnose(before)), after, before=before)
    assert [it.code for it in found] == ["MG503"]


def test_the_command_says_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    new = f"running: /teleop_twist_keyboard publishes /robot1/cmd_vel {TWIST}"
    before, after = read_looks("\n".join((*(f"as before: {it}" for it in ROBOTS), new)))
    files = [tmp_path / "before.json", tmp_path / "after.json"]
    for file, graph in zip(files, (before, after), strict=True):
        file.write_bytes(to_json(graph))
    assert multibot(["check", str(files[0]), "--from", str(files[0])]) == 0
    capsys.readouterr()
    assert multibot(["check", str(files[0]), "--from", str(files[1])]) == 1
    out, err = capsys.readouterr()
    assert "/teleop_twist_keyboard: error:" in out and "as planned" not in err.replace(
        "not as planned", ""
    )
