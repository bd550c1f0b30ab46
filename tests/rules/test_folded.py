# SPDX-License-Identifier: Apache-2.0
"""One cause is one finding, and the likeliest cause comes first."""

from __future__ import annotations

from collections.abc import Iterable

import nav2_graphs
import pytest
from graph_calls import diagnose, seen_plan
from graph_examples import read_example, read_looks, read_system
from healthy_systems import nav2_with_tools

from multibot_rewrite.base.findings.finding import ERROR, INCONCLUSIVE, NOTE, WARNING, Finding
from multibot_rewrite.live.diagnose import survey
from multibot_rewrite.rules.check import check, judge
from multibot_rewrite.rules.folded import in_order
from multibot_rewrite.system.records import PUBLISHES, TOPIC, System

SCAN, CLOUD = "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/PointCloud2"
ODOM, TF = "nav_msgs/msg/Odometry", "tf2_msgs/msg/TFMessage"
CLOCK, STATE = "rosgraph_msgs/msg/Clock", "lifecycle_msgs/srv/ChangeState"
TWIST, MAP = "geometry_msgs/msg/Twist", "nav_msgs/msg/OccupancyGrid"


def found(*lines: str) -> list[Finding]:
    return judge(read_system("\n".join(f"running: {it}" for it in lines)))


def codes(it: Iterable[Finding]) -> list[str]:
    return [one.code for one in it]


def test_one_lidar_of_another_type_is_one_line() -> None:
    readers = ("amcl", "local_costmap", "monitor", "slam")
    (it,) = found(
        f"/robot1/lidar publishes /robot1/scan {CLOUD}",
        f"/rviz2 subscribes /robot1/scan {SCAN}",
        *(f"/robot1/{it} subscribes /robot1/scan {SCAN}" for it in readers),
    )
    # That of a viewer is a warning, and the worst comes first.
    assert (it.code, it.level, it.node) == ("MG306", ERROR, "/robot1/amcl")
    assert all(word in it.message for word in ("/robot1/slam", "/rviz2", "the same for"))


def test_one_clock_under_another_name_is_one_line_and_stays_everybodys() -> None:
    nodes = ("amcl", "slam", "pilot", "driver")
    (it,) = found(
        f"/sim publishes /clock {CLOCK}",
        *(f"/robot1/{it} subscribes /clock {CLOCK}" for it in nodes),
        *(f"/robot2/{it} subscribes /robot2/clock {CLOCK}" for it in nodes),
    )
    assert (it.code, {rule.node for rule in it.remaps}) == (
        "MG303", {f"/robot2/{it}" for it in nodes}
    )  # fmt: skip
    assert {(rule.old, rule.new) for rule in it.remaps} == {("/robot2/clock", "/clock")}
    assert "/clock:=/robot2" not in it.hint and "(MG503)" in it.hint


def test_one_manager_of_nodes_that_are_gone_is_one_line() -> None:
    gone = [f"server{it}" for it in range(9)]
    (it,) = found(
        "/robot1/lifecycle_manager publishes /robot1/bond bond/msg/Status",
        *(f"/robot1/lifecycle_manager calls /robot1/{it}/change_state {STATE}" for it in gone),
    )
    assert it.code == "MG304" and "/robot1/server0" in it.message and "the same for" in it.message
    assert len(it.names) == 9


def test_a_circle_of_one_robot_explains_nothing_of_another() -> None:
    """Their frames have the same names, on a tf topic of each robot."""
    told = found(
        "transform laser -> base_link on /robot1/tf by /robot1/rsp",
        "transform base_link -> laser on /robot1/tf by /robot1/rsp",
        "transform laser -> base_link on /robot2/tf by /robot2/rsp",
        "transform odom -> base_link on /robot2/tf by /robot2/driver",
        *(f"/robot{it}/{one}" for it in "12" for one in ("rsp", "driver")),
        *(
            f"/robot{it}/{one} publishes /robot{it}/tf {TF}"
            for it in "12"
            for one in ("rsp", "driver")
        ),
    )
    assert [(it.code, it.robot) for it in told] == [("MG401", "robot2"), ("MG403", "robot1")]


def test_a_topic_of_one_robot_does_not_explain_a_missing_node_of_another() -> None:
    plan = nav2_graphs.fleet(3, 2)
    graph = nav2_graphs.moved(nav2_graphs.healthy(plan), "/robot1/topic1", "/topic1")
    told = nav2_graphs.scene(plan, nav2_graphs.without_node(graph, "/robot2/driver")).findings
    assert {it.robot for it in told if it.code == "MG101"} == {"robot2"}


def test_data_of_two_robots_on_one_topic_explains_who_misses_it() -> None:
    told = found(
        *(f"/robot{it}/base publishes /odom {ODOM}" for it in "12"),
        *(f"/fleet subscribes /robot{it}/odom {ODOM}" for it in "12"),
    )
    assert codes(told) == ["MG320"]


FIX, POSE = "sensor_msgs/msg/NavSatFix", "geometry_msgs/msg/PoseWithCovarianceStamped"
JOINTS, GOAL = "sensor_msgs/msg/JointState", "moveit_msgs/action/MoveGroup"
READS_FIX = [f"/robot{it}/navsat subscribes /robot{it}/fix {FIX}" for it in "12"]
LOCALIZERS = [
    line
    for it in ("amcl", "slam")
    for line in (f"{it} publishes /robot1/tf {TF}", f"{it} subscribes /robot1/scan {SCAN}")
]
# The first finding, what it names and what comes of it, and the lines of the system.
CAUSES = {
    "a receiver sends on another robot's topic": (
        "MG311", "/robot1/fix:=fix to /robot2/gps", "MG320",
        *READS_FIX, *(f"/robot{it}/gps publishes /robot1/fix {FIX}" for it in "12"),
        "frame_id robot2/gps on /robot1/fix",
        *(f"transform robot{it}/base_link -> robot{it}/gps on /tf_static" for it in "12")),
    "two robots take start poses from one topic": ("MG310", "/initialpose", "(MG303)",
        *(f"/robot{it}/amcl subscribes /initialpose {POSE}" for it in "12"),
        *(f"/robot{it}/pilot publishes /robot{it}/initialpose {POSE}" for it in "12")),
    "SLAM beside a map server and amcl": ("MG323", "/robot1/slam", "(MG408)",
        f"/robot1/map_server publishes /robot1/map {MAP}", f"/robot1/slam publishes /robot1/map {MAP}",
        *(f"/robot1/{it}" for it in LOCALIZERS), f"/robot1/lidar publishes /robot1/scan {SCAN}",
        "transform map -> odom on /robot1/tf by /robot1/amcl, /robot1/slam twice",
        "transform odom -> base_link on /robot1/tf by /robot1/driver"),
    "a manager waits for the map server that a robot lacks": (
        "MG322", "robot2 has no map_server", "(MG304)",
        *(f"/robot{it}/amcl subscribes /robot{it}/map {MAP}" for it in "12"),
        *(f"/robot{it}/lifecycle_manager calls /robot{it}/map_server/change_state {STATE}"
          for it in "12"),
        f"/robot1/map_server publishes /robot1/map {MAP}",
        f"/robot1/map_server serves /robot1/map_server/change_state {STATE}"),
    "a localizer runs without its namespace": ("MG304", "__ns:=/robot1", "(MG303)",
        f"/amcl subscribes /scan {SCAN}", f"/amcl serves /amcl/change_state {STATE}",
        f"/robot1/lidar publishes /robot1/scan {SCAN}",
        f"/robot1/lifecycle_manager calls /robot1/amcl/change_state {STATE}"),
    "the same twice": ("MG301", "/move_group", "",
        "/move_group", "/move_group", f"/move_group subscribes /joint_states {CLOUD}",
        *(f"/robot{it}/jsb publishes /robot{it}/joint_states {CLOUD}" for it in "12")),
    "a frame is its own parent": ("MG416", "its own parent", "(MG403)",
        f"/stp publishes /tf_static {TF}", "transform map -> map on /tf_static by /stp"),
    "nothing of a robot's controllers runs": ("MG322", "robot1 has no a", "",
        *(f"/robot2/{it} publishes /robot2/{it}/joint_states {JOINTS}" for it in "abc"),
        *(f"/robot{at}/{it} subscribes /robot{at}/{part}/joint_states {JOINTS}"
          for at in "12" for it, part in zip(("rsp", "pilot", "eyes"), "abc", strict=True))),
    "a controller_manager is off": ("MG322", "no controller_manager, as robot2 has (/robot2/co", "",
        *(f"/robot2/{it} on machine 1" for it in ("controller_manager", *"abc")),
        *(f"/robot2/{it} publishes /robot2/{it}/joint_states {JOINTS}" for it in "abc"),
        *(f"/robot{at}/{it} subscribes /robot{at}/{part}/joint_states {JOINTS}"
          for at in "12" for it, part in zip(("rsp", "pilot", "eyes"), "abc", strict=True))),
    "one filter sends on a topic of its robot, all others on /tf": (
        "MG405", "/robot1/ekf sends tf on /robot1/tf, but the tf of robot1 is on /tf", "",
        *(f"/robot{at}/{it} publishes {topic} {TF}" for at, it, topic in (
           (1, "rsp", "/tf"), (1, "amcl", "/tf"), (1, "ekf", "/robot1/tf"),
           (2, "rsp", "/tf"), (2, "amcl", "/tf"), (2, "ekf", "/tf"))),
        *(f"transform {parent} -> robot{at}/{child} on /tf by /robot{at}/rsp, /robot{at}/amcl"
          for at in "12" for parent, child in (("map", "odom"), (f"robot{at}/base_link", "laser"))),
        "transform robot1/odom -> robot1/base_link on /robot1/tf by /robot1/ekf",
        "transform robot2/odom -> robot2/base_link on /tf by /robot2/ekf"),
    "a root hangs on nothing": ("MG328", "robot2 has no transform of base_link", "",
        *(f"/robot{at}/{it}" for at in "12" for it in ("rsp", "pilot", "eyes")),
        *(f"/robot{at}/rsp publishes /tf_static {TF}" for at in "12"),
        "transform world -> robot1/base_link on /tf_static by /robot1/rsp",
        *(f"transform robot{at}/base_link -> robot{at}/arm on /tf_static by /robot{at}/rsp"
          for at in "12")),
    "a planner outside calls below the server's node": (
        "MG304", "/robot1/move_group/move_action:=/robot1/move_action", "",
        f"/robot1/move_group serves /robot1/move_action {GOAL}", "/robot2/move_group",
        f"/robot2/move_group serves /robot2/move_action {GOAL}",
        f"/planner calls /robot1/move_group/move_action {GOAL}",
        f"/planner calls /robot2/move_action {GOAL}",
        *(f"/robot{at}/base subscribes /robot{at}/cmd_vel {TWIST}" for at in "12"),
        *(f"/robot{at}/pilot publishes /robot{at}/cmd_vel {TWIST}" for at in "12")),
    "static transforms come to nobody": ("MG307", "offers /robot1/tf_static", "(MG412)",
        f"/robot1/rsp publishes /robot1/tf_static {TF} volatile",
        f"/robot1/amcl subscribes /robot1/tf_static {TF} transient_local",
        f"/robot1/amcl subscribes /robot1/scan {SCAN}",
        f"/robot1/lidar publishes /robot1/scan {SCAN}", "frame_id laser on /robot1/scan",
        "transform odom -> base_link on /robot1/tf by /robot1/driver"),
    "a localizer moves another frame than the base": (
        "MG415", "odom_frame_id: odom of /robot1/amcl", "",
        f"/robot1/amcl subscribes /robot1/initialpose {POSE}",
        f"/robot1/amcl publishes /robot1/tf {TF}", "/robot2/amcl",
        "transform map -> robot1/odom on /robot1/tf by /robot1/amcl",
        "transform odom -> base_link on /robot1/tf by /robot1/driver"),
}  # fmt: skip


@pytest.mark.parametrize("name", CAUSES)
def test_one_cause_is_one_finding(name: str) -> None:
    code, words, below, *lines = CAUSES[name]
    (it,) = found(*lines)
    assert it.code == code and words in str(it) and below in it.hint


def test_another_robots_description_explains_its_frames() -> None:
    rsp = [f"/robot{it}/rsp publishes /tf_static {TF}" for it in "12"]
    both = "by /robot1/rsp, /robot2/rsp twice"
    told = found(
        *rsp,
        *(
            f"/robot{it}/rsp publishes /robot{it}/robot_description std_msgs/msg/String"
            for it in "12"
        ),
        f"transform robot1/base -> robot1/arm on /tf_static {both}",
        *(
            f"description on /robot{it}/robot_description: links robot1/base, robot1/arm"
            for it in "12"
        ),
    )
    assert codes(told) == ["MG420"] and told[0].node == "/robot2/rsp"


def test_a_node_that_is_not_planned_is_said_with_what_it_does() -> None:
    lines = [f"as before: /robot1/map_server publishes /robot1/map {MAP}"]
    lines += ["as before: /robot1/planner", "as before: /robot2/planner"]
    new = "running: /robot1/slam publishes /robot1/"
    before, after = read_looks("\n".join([*lines, f"{new}map {MAP}"]))
    (it,) = check(seen_plan(diagnose(before)), after)
    assert it.code == "MG323" and it.hint.endswith("/robot1/slam is not in the plan")
    _, alone = read_looks("\n".join([*lines, f"{new}x std_msgs/msg/Bool"]))
    assert codes(check(seen_plan(diagnose(before)), alone)) == ["MG108"]


def test_a_node_that_is_not_planned_is_named_once() -> None:
    maps = [f"/robot1/{it} {MAP}" for it in ("map", "floor_map")]
    lines = [f"as before: /robot1/map_server publishes {it}" for it in maps]
    lines += ["as before: /robot1/planner", "as before: /robot2/planner"]
    new = [f"running: /robot1/slam publishes {it}" for it in maps]
    before, after = read_looks("\n".join([*lines, *new]))
    told = check(seen_plan(diagnose(before)), after)
    assert codes(told) == ["MG323", "MG323"]
    assert ["not in the plan" in it.hint for it in told] == [True, False]


def test_a_missing_sender_explains_that_nobody_subscribes() -> None:
    lines = [f"planned: /robot1/lidar publishes /robot1/scan {SCAN}"]
    lines += [f"planned: /robot1/amcl subscribes /robot1/scan {SCAN}"]
    plan, graph = read_example(
        "\n".join([*lines, "as planned: /robot1/rsp", "running: /robot1/amcl"])
    )
    (it,) = check(plan, graph)
    assert it.code == "MG101" and "(MG102)" in it.hint


def test_a_missing_node_explains_the_tree_that_it_joins() -> None:
    plan, graph = read_example(
        "planned: frames of robot1 on /robot1/tf: base_link, laser\n"
        f"planned: /robot1/rsp publishes /robot1/tf_static {TF}\n"
        f"as planned: /robot1/amcl publishes /robot1/tf {TF}\n"
        "running: transform map -> odom on /robot1/tf by /robot1/amcl\n"
        "running: transform wheel -> base_link on /robot1/tf by /robot1/amcl"
    )
    assert codes(check(plan, graph))[0] == "MG101"


def test_several_nodes_that_do_not_run_are_one_line() -> None:
    nodes = ("controller_manager", "joint_state_broadcaster", "gripper_controller")
    lines = [f"planned: /robot1/{it}" for it in nodes] + [
        "as planned: /robot1/rsp",
        "planned: /robot2/x",
    ]
    plan, graph = read_example("\n".join([*lines, "running: /robot2/x"]))
    (it,) = check(plan, graph)
    assert it.code == "MG101" and all(f"/robot1/{one}" in it.message for one in nodes)
    plan, graph = read_example("\n".join([*lines[1:], "running: /robot2/x"]))
    assert codes(check(plan, graph)) == ["MG101", "MG101"]


def test_tf_that_a_node_lacks_explains_the_frames_that_are_missed() -> None:
    plan, graph = read_example(
        "planned: frames of robot1 on /robot1/tf: base_link, laser\n"
        f"planned: /robot1/rsp publishes /robot1/tf_static {TF}\n"
        f"as planned: /robot1/amcl publishes /robot1/tf {TF}\n"
        f"as planned: /robot1/lidar publishes /robot1/scan {SCAN}\n"
        f"as planned: /robot1/amcl subscribes /robot1/scan {SCAN}\n"
        "running: /robot1/rsp\n"
        "running: frame_id laser on /robot1/scan\n"
        "running: transform odom -> base_link on /robot1/tf by /robot1/amcl"
    )
    (it,) = check(plan, graph)
    assert (
        (it.code, it.node) == ("MG102", "/robot1/rsp") and "(MG" in it.hint and "; so " in it.hint
    )


def test_all_tf_rules_forgotten_is_not_more_with_a_plan() -> None:
    healthy = nav2_with_tools()

    def shared(name: str) -> str:
        return (
            f"/{name.rpartition('/')[2]}" if name in ("/robot1/tf", "/robot1/tf_static") else name
        )

    broken = healthy._replace(
        ends=tuple(it._replace(name=shared(it.name)) for it in healthy.ends),
        edges=tuple(it._replace(topic=shared(it.topic)) for it in healthy.edges),
    )
    without = diagnose(broken).findings
    held = check(seen_plan(diagnose(healthy)), broken)
    assert len(held) <= max(len(without), 2), [str(it) for it in held]
    assert {it.code for it in without} <= {it.code for it in held}


def test_the_order_is_by_cause_and_then_by_level() -> None:
    rows = [
        ("MG328", WARNING), ("MG402", WARNING), ("MG306", ERROR), ("MG303", NOTE), ("MG101", ERROR),
        ("MG303", WARNING), ("MG401", ERROR), ("MG501", ERROR), ("MG109", INCONCLUSIVE),
        ("MG303", ERROR),
    ]  # fmt: skip
    given = [Finding(code, level, "x") for code, level in rows]
    told = [(it.code, it.level) for it in in_order(read_system("running: /robot1/a"), given)]
    assert told == [
        ("MG501", ERROR), ("MG101", ERROR), ("MG109", INCONCLUSIVE), ("MG303", ERROR),
        ("MG303", WARNING), ("MG306", ERROR), ("MG401", ERROR), ("MG402", WARNING),
        ("MG328", WARNING), ("MG303", NOTE),
    ]  # fmt: skip


@pytest.mark.parametrize("topic", ["/{robot}/tf", "/tf", "/{other}/tf"])
def test_the_header_is_one_short_line_for_a_hundred_robots(topic: str) -> None:
    text = "\n".join(
        f"running: /robot{it}/{node} publishes {name} {TF}"
        for it in range(1, 101)
        for node in ("rsp", "amcl")
        for name in (topic.format(robot=f"robot{it}", other=f"robot{it % 100 + 1}"),)
    )
    told = survey(diagnose(read_system(text).system))
    assert told.startswith("100 robots by their namespaces: robot1, robot10, ")
    assert "\n" not in told and len(told) < 400
    assert ("97 more" in told) is (topic != "/tf")


def test_it_says_nothing_new_of_a_healthy_system() -> None:
    graph: System = nav2_with_tools()
    assert any((it.kind, it.role) == (TOPIC, PUBLISHES) for it in graph.ends)
    assert diagnose(graph).findings == ()
