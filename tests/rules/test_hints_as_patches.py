# SPDX-License-Identifier: Apache-2.0
"""The remap rules and values that a hint names are given to the system, and the rules are asked again:
the finding is gone, and nothing else is wrong. A hint that names one has it as a record."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cache

import pytest
from fault_changes import nav, shared_tf
from graph_calls import RULES, diagnose, seen_plan
from graph_examples import read_system
from graph_faults import FAULTS, Fault
from healthy_systems import nav2_with_tools
from patches import patched
from paths import FIXTURES
from told_faults import Told, by_check, by_doctor, faults

from multibot_rewrite.base.conventions import STAMP_SWITCHES, TF_SWITCHES, switches
from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.rules.check import check, judge
from multibot_rewrite.system.records import Node, System
from tools.interfaces.table import read_packed

TWIST, SCAN = "geometry_msgs/msg/Twist", "sensor_msgs/msg/LaserScan"


Ask = Callable[[System, str], Sequence[Finding]]


def about(it: Finding) -> tuple[str, str, str]:
    return it.code, it.robot, it.node


def alone(_: System) -> Ask:
    return lambda graph, hint: diagnose(graph).findings


def by_plan(healthy: System) -> Ask:
    """With the plan of a healthy system. Nodes that are not in it are added where the hint says so."""
    plan = seen_plan(diagnose(healthy))

    def ask(graph: System, hint: str) -> Sequence[Finding]:
        own = {it.name for it in plan.nodes}
        new = {it.name for it in graph.nodes if "not in the plan" in hint} - own
        robots = [it.name for it in plan.robots]
        nodes = (Node(it, next((one for one in robots if one in it.split("/")), "")) for it in new)
        ends = (it for it in graph.ends if it.node in new)
        return check(plan._replace(nodes=(*plan.nodes, *nodes), ends=(*plan.ends, *ends)), graph)

    return ask


def followed(it: Finding, graph: System, healthy: System) -> System:
    """Return the system after a hint was followed: who gets a name back sends what it sent by it."""
    mended = patched(graph, it.remaps, it.settings)
    there, nodes = {one[:3] for one in graph.edges}, {one.node for one in it.remaps}
    back = (one for one in healthy.edges if one[:3] not in there and nodes & {*one.publishers})
    return mended._replace(edges=(*mended.edges, *back))


def is_patch(it: Finding) -> bool:
    return bool(it.remaps or it.settings)


def mends(graph: System, healthy: System, ask: Ask) -> None:
    """Each finding with a patch is gone after it, and no other has come."""
    found = ask(graph, "")
    for it in filter(is_patch, found):
        after = ask(followed(it, graph, healthy), it.hint)
        known = {about(one) for one in found if one is not it}
        left = [one for one in after if (about(one), one.names) == (about(it), it.names)]
        assert [str(one) for one in after if one in left or about(one) not in known] == [], it
        targets = {(rule.node, rule.old) for rule in it.remaps}
        assert len(targets) == len({*it.remaps}), "two rules for one name of a node"


@cache
def told(fault: Fault, kind: Callable[[System], Ask]) -> Sequence[Finding]:
    healthy = fault.system()
    return kind(healthy)(fault.change(healthy), "")


def test_many_faults_have_such_a_hint() -> None:
    found = [one for it in FAULTS for one in told(it, alone)]
    codes = {it.code for it in found if it.remaps}
    assert codes >= {"MG303", "MG304", "MG308", "MG310", "MG315", "MG320", "MG402", "MG405"}
    assert {it.code for it in found if it.settings} >= {"MG411", "MG412", "MG503"}
    assert sum(map(is_patch, found)) > 70
    planned = [one for it in FAULTS for one in told(it, by_plan) if is_patch(one)]
    assert len(planned) > 55 and any("by the plan" in it.hint for it in planned)
    for it in found:
        assert all(rule.old.rpartition("/")[2] in it.hint for rule in it.remaps), "not in the hint"
        # Of a list it says which to leave out.
        values = (one for one in it.settings if not one.value.startswith("["))
        assert all(one.value in it.hint for one in values), "not in the hint"
        assert all(one.name in it.hint or one.topic for one in it.settings), "nor the name"


BOTH_WAYS = pytest.mark.parametrize("kind", [alone, by_plan])


@BOTH_WAYS
@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name)
def test_a_hint_mends_the_fault(fault: Fault, kind: Callable[[System], Ask]) -> None:
    healthy = fault.system()
    mends(fault.change(healthy), healthy, kind(healthy))


@pytest.mark.more
@pytest.mark.sample(16)
@BOTH_WAYS
@pytest.mark.parametrize("fault", faults(), ids=lambda fault: fault.name)
def test_a_hint_mends_the_fault_in_words(fault: Told, kind: Callable[[System], Ask]) -> None:
    mends(fault.faulty(), fault.healthy(), kind(fault.healthy()))


LAYOUTS = {nav: "L1", shared_tf: "L2"}
OLDER_AND_NEWER = ("humble", "kilted", "lyrical", "rolling")


@pytest.mark.more
@pytest.mark.sample(16)
@BOTH_WAYS
@pytest.mark.parametrize("release", OLDER_AND_NEWER)
@pytest.mark.parametrize(
    "fault", [it for it in FAULTS if it.system in LAYOUTS], ids=lambda fault: fault.name
)
def test_a_hint_mends_the_fault_in_each_release(
    fault: Fault, release: str, kind: Callable[[System], Ask]
) -> None:
    """Other releases have other nodes and topics beside the fault."""
    healthy = nav2_with_tools(LAYOUTS[fault.system], release)
    mends(fault.change(healthy), healthy, kind(healthy))


# Of rules that stand in the plan, which is no part of the system.
OF_THE_PLAN = {
    "MG108": "a node that the plan lacks: --node-set and --nodes are options that write one"
}
NAMES = re.compile(
    r":=|(?<![\w-])--[a-z][\w-]*|(?<!\w)-r /|\.ya?ml\b|\bROS_[A-Z_]+|</?[a-z_]+>|[a-z]+(?:_[a-z0-9]+)+"
)


@cache
def parameters(release: str) -> frozenset[tuple[str, str]]:
    """Package and name of each parameter that a release declares."""
    lines = read_packed(FIXTURES / "interfaces" / f"parameters_{release}.tsv.xz").splitlines()
    rows = (it.split("\t") for it in lines if it.count("\t") > 2)
    return frozenset((row[0], row[2].rpartition(".")[2]) for row in rows)


RELEASES = ("humble", "jazzy", "kilted", "lyrical", "rolling")


def named_in(finding: Finding) -> list[str]:
    """Return what the hint names of a rule, switch, file or parameter, besides what is in the graph."""
    hint = finding.hint
    for it in sorted({finding.node, finding.robot, *finding.names} - {""}, key=len, reverse=True):
        hint = hint.replace(it, "")
    hint = re.sub(r"(?<![\w:=])/[\w/~]+", "", hint)
    declared = {name for release in RELEASES for _, name in parameters(release)}
    return [it for it in NAMES.findall(hint) if not it.isidentifier() or it in declared]


def as_text(found: Iterable[Finding]) -> list[str]:
    own = (it for it in found if not (it.remaps or it.settings))
    return [str(it) for it in own if named_in(it) and it.code not in OF_THE_PLAN]


@pytest.mark.more
def test_what_a_hint_names_is_a_record() -> None:
    """Of all faults, without a plan and with one."""
    every = [told(it, kind) for it in FAULTS for kind in (alone, by_plan)]
    every += [by_doctor(it.faulty()) for it in faults()]
    every += [by_check(it.healthy(), it.faulty()) for it in faults()]
    assert [it for found in every for it in as_text(found)] == []
    assert sum(is_patch(it) for found in every for it in found) > 210


# The packages that declare what hints name, and the release from which on.
SWITCHED = {
    "tf_broadcast": ("nav2_amcl", "humble"),
    "publish_tf": ("robot_localization", "humble"),
    "enable_odom_tf": ("diff_drive_controller", "humble"),
    "enable_stamped_cmd_vel": ("nav2_util", "jazzy"),
    "frame_prefix": ("robot_state_publisher", "humble"),
    "map_subscribe_transient_local": ("nav2_costmap_2d", "humble"),
    "node_names": ("nav2_lifecycle_manager", "humble"),
    "odom_frame_id": ("nav2_amcl", "humble"),
}


@pytest.mark.parametrize("release", RELEASES)
def test_parameters_of_hints_are_declared_in_each_release(release: str) -> None:
    """A hint with one that not every release has says so."""
    assert {*switches(TF_SWITCHES), *switches(STAMP_SWITCHES)} <= {*SWITCHED}
    for name, (package, since) in SWITCHED.items():
        there = RELEASES.index(release) >= RELEASES.index(since)
        assert ((package, name) in parameters(release)) is there, name
    found = judge(read_system("\n".join(f"running: {it}" for it in STAMPS)))
    assert [it.hint for it in found if "enable_stamped_cmd_vel" in it.hint and "Jazzy" in it.hint]


STAMPS = [
    f"/robot1/collision_monitor publishes /robot1/cmd_vel {TWIST}",
    f"/robot1/driver subscribes /robot1/cmd_vel {TWIST}Stamped",
]


WITHOUT_PLAN = [
    code
    for code, it in RULES.items()
    if not it.options["planned"] and it.page.bad and "planned: " not in it.page.bad
]


@pytest.mark.parametrize("code", WITHOUT_PLAN)
def test_the_example_of_a_rule_is_mended_by_its_records(code: str) -> None:
    seen = read_system(RULES[code].page.bad)
    mends(seen.system, seen.system, lambda graph, _: judge(seen._replace(system=graph, memo={})))
    for it in judge(seen):
        assert not named_in(it) or it.remaps or it.settings or it.code in OF_THE_PLAN, it


def said(*lines: str) -> Iterator[tuple[str, str, bool]]:
    for it in judge(read_system("\n".join(f"running: {it}" for it in lines))):
        yield it.code, it.hint, bool(it.remaps)


TWO = [
    f"/robot{at}/{node} {does} /robot{at}/{name} {type_}"
    for at in (1, 2)
    for node, does, name, type_ in (
        ("collision_monitor", "subscribes", "cmd_vel_smoothed", TWIST),
        ("collision_monitor", "publishes", "cmd_vel", TWIST),
        ("driver", "subscribes", "cmd_vel", TWIST),
    )
]


def test_no_hint_leads_a_robots_commands_to_another_robot() -> None:
    """robot1's smoother has no namespace in its topic; robot2's collision monitor waits as well."""
    lines = [*TWO, f"/robot1/velocity_smoother publishes /cmd_vel_smoothed {TWIST}"]
    found = [hint for _, hint, _ in said(*lines) if ":=" in hint]
    assert found and all("robot2" not in hint for hint in found)


def test_no_hint_goes_past_what_limits_velocities() -> None:
    smoothers = (
        f"/robot{it}/velocity_smoother publishes /robot{it}/cmd_vel_smoothed {TWIST}" for it in "12"
    )
    found = [*said(*TWO, *smoothers, f"/robot1/teleop_node publishes /robot1/cmd_vel_joy {TWIST}")]
    assert [(code, is_patch) for code, _, is_patch in found if code == "MG308"] == [
        ("MG308", False)
    ]
    assert not [hint for *_, hint, _ in found if "cmd_vel_joy:=" in hint]


@pytest.mark.parametrize(
    ("lines", "hint"),
    [
        (
            [f"/lidar publishes /scan {SCAN}",
             *(f"/robot{it}/amcl subscribes /scan {SCAN}" for it in "12")],
            "/lidar sends it to all robots: start one for each, in its namespace",
        ),
        (
            [f"/robot{it}/lidar publishes /robot2/scan {SCAN}" for it in "12"],
            "correct the namespace, remap rule or parameter of robot1 that names robot2; pass the rule"
            " /robot2/scan:=scan to /robot1/lidar",
        ),
    ],
)  # fmt: skip
def test_who_has_to_change(lines: list[str], hint: str) -> None:
    assert [it for code, it, _ in said(*lines) if code == "MG320"] == [hint]


ODOM, JOY = "nav_msgs/msg/Odometry", "sensor_msgs/msg/Joy"
IMAGE, CLOUD = "sensor_msgs/msg/Image", "sensor_msgs/msg/PointCloud2"


@pytest.mark.parametrize(
    ("wanted", "offered", "type_", "is_joined"),
    [
        ("ekf_node wheel/odom", "navsat_transform odometry/gps", ODOM, False),
        ("ekf_node wheel/odom", "diff_drive odom", ODOM, True),
        ("ekf_node visual/odom", "diff_drive wheel/odom", ODOM, False),
        ("navsat_transform odometry/filtered", "ekf_node odometry/global", ODOM, True),
        ("navsat_transform odometry/filtered", "diff_drive odom", ODOM, False),
        ("controller_server odom", "navsat_transform odometry/gps", ODOM, False),
        ("controller_server odom", "ekf_node odometry/filtered", ODOM, True),
        ("fusion odometry/global", "ekf_local odometry/local", ODOM, False),
        ("amcl scan_front", "rear_lidar scan_rear", SCAN, False),
        ("amcl scan", "front_lidar scan_front", SCAN, True),
        ("stereo left/image_raw", "camera right/image_raw", IMAGE, False),
        ("costmap camera/depth/points", "velodyne velodyne_points", CLOUD, False),
        ("costmap points", "camera camera/depth/points", CLOUD, True),
        ("navsat_transform gps/fix", "nmea_driver fix", "sensor_msgs/msg/NavSatFix", True),
    ],
)
def test_no_rule_joins_two_sensors_or_places(
    wanted: str, offered: str, type_: str, is_joined: bool
) -> None:
    (reader, name), (sender, other) = wanted.split(), offered.split()
    for robot in ("", "/robot1"):
        ((_, hint, is_patch),) = said(
            f"{robot}/{reader} subscribes {robot}/{name} {type_}",
            f"{robot}/{sender} publishes {robot}/{other} {type_}",
        )
        assert is_patch is is_joined and other in hint


ONE_EACH = "{} sends it to all robots: start one for each, in its namespace"


@pytest.mark.parametrize(
    ("sender", "name", "type_", "more", "hint"),
    [
        ("/bridge", "model/box/pose", "geometry_msgs/msg/PoseStamped", "",
         "pass the rule /robot1/model/box/pose:=/model/box/pose, or put /model/box/pose in"
         " shared_topics of the fleet file"),
        ("/panel", "e_stop", "std_msgs/msg/Bool", "", ONE_EACH.format("/panel")),
        ("/lidar", "scan", SCAN, "", ONE_EACH.format("/lidar")),
        ("/joy_node", "joy", JOY, "", ONE_EACH.format("/joy_node")),
        ("/teleop", "cmd_vel", TWIST, "", ONE_EACH.format("/teleop")),
        # robot2 has its own, so this is robot1's.
        ("/lidar", "scan", SCAN, "/robot2/lidar publishes /robot2/scan",
         "pass the rule /scan:=/robot1/scan to /lidar, or start it in the namespace"),
        # Each has its own sender.
        ("/robot1/finder", "model/box/pose", "geometry_msgs/msg/PoseStamped",
         "/robot2/finder publishes /model/box/pose",
         "pass the rule /model/box/pose:=/robot1/model/box/pose to /robot1/finder, or start it in the"
         " namespace"),
    ],
)  # fmt: skip
def test_what_is_everybodys_stays(sender: str, name: str, type_: str, more: str, hint: str) -> None:
    lines = [f"{sender} publishes /{name} {type_}", *[f"{more} {type_}"] * bool(more)]
    readers = (f"/robot{it}/node subscribes /robot{it}/{name} {type_}" for it in "12")
    found = [it for code, it, _ in said(*readers, *lines) if code == "MG303"]
    assert found[0] == hint
