# SPDX-License-Identifier: Apache-2.0
"""A planned fleet on a real graph, as it should be and with one fault each: found and named.

Side by side, each on a domain of its own; in the deep run three looks at each.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple

import live_commands
import live_fleet
import live_graphs
import pytest
import tf2_build
from description_calls import NEWEST_LTS, builtin_tree, collect, edges_in, read_document
from paths import ROOT
from plans import own

from multibot_rewrite.description.library import rewrite
from multibot_rewrite.system.json import from_yaml
from multibot_rewrite.system.records import PUBLISHES, SERVES, SUBSCRIBES, System

pytestmark = pytest.mark.live

pytest.importorskip("rclpy", reason="no rclpy: pip install '.[ros]'", exc_type=ImportError)
GRAPHS = ROOT / "fixtures" / "graphs"
ROVER = str(ROOT / "fixtures" / "robots" / "rover.urdf")
LISTS = {PUBLISHES: "publishers", SUBSCRIBES: "subscriptions", SERVES: "services"}
TF = "tf2_msgs/msg/TFMessage"
LOOKS, AT_ONCE = 3, 6
# Robot -> node -> what it has, as live_fleet takes it.
Fleet = dict[str, dict[str, dict[str, Any]]]


class Scenario(NamedTuple):
    """A fault put into a fleet of a layout, and the findings it must come to: (code, who)."""

    name: str
    layout: str
    fault: Callable[[Fleet], None]
    found: frozenset[tuple[str, str]]


def plan_of(layout: str) -> Path:
    return GRAPHS / ("" if layout == "frames-per-robot" else layout) / "plan.yaml"


def fleet_of(layout: str) -> Fleet:
    """Return the fleet exactly as planned, its tf as the rewritten descriptions say."""
    path = plan_of(layout)
    plan = from_yaml(path.read_bytes(), str(path))
    nodes: dict[str, dict[str, Any]] = {}
    for robot in plan.robots:
        for node in own(plan, robot.name):
            space, _, name = node.rpartition("/")
            nodes[node] = {"name": name, "namespace": space, **_lists()}
    for it in plan.ends:
        if it.type != TF:
            latched = it.role == PUBLISHES and it.name.endswith(live_graphs.LATCHED)
            words = ["latched"] if latched else []
            nodes[it.node][LISTS[it.role]].append([it.name, it.type, *words])
    fleet = {
        robot.name: {node: nodes[node] for node in own(plan, robot.name)} for robot in plan.robots
    }
    for robot in plan.robots:
        state, drive = (
            next(n for n in own(plan, robot.name) if w in n) for w in ("state_pub", "diff_drive")
        )
        moving, fixed = edges(robot.name, layout)
        root = moving.pop()
        static = f"{robot.tf_topic}_static"
        nodes[state]["frames"] = [[robot.tf_topic, False, *moving], [static, True, *fixed]]
        nodes[drive]["frames"] = [[robot.tf_topic, False, root]]
    return fleet


def _lists() -> dict[str, list[Any]]:
    return {name: [] for name in (*LISTS.values(), "frames")}


def edges(robot: str, layout: str) -> tuple[list[list[str]], list[list[str]]]:
    """Return the rewritten rover's transforms, moving and fixed; the last moving one is odometry."""
    text = rewrite(ROVER, robot, layout=layout).text
    inventory = collect(read_document(text.encode(), ROVER), builtin_tree((), NEWEST_LTS))
    found = list(edges_in(inventory.document.root))
    moving = [[it.parent, it.child] for it in found if not it.static]
    fixed = [[it.parent, it.child] for it in found if it.static]
    odometry = [f"odom/{robot}", f"base_footprint/{robot}"]
    return [*moving, odometry], fixed


def healthy(fleet: Fleet) -> None:
    """No fault at all."""


def leak(fleet: Fleet) -> None:
    """Both drives: that is certain, also in a view that is cut off."""
    for robot in ("robot1", "robot2"):
        fleet[robot][f"/{robot}/diff_drive"]["subscriptions"] = [
            ["/cmd_vel", "geometry_msgs/msg/Twist"]
        ]


def cross_talk(fleet: Fleet) -> None:
    pilot = fleet["robot1"]["/robot1/pilot"]
    pilot["publishers"].append(["/robot2/cmd_vel", "geometry_msgs/msg/Twist"])


def clash(fleet: Fleet) -> None:
    pilot = fleet["robot1"]["/robot1/pilot"]
    fleet["again"] = {"/robot1/pilot": {"name": "pilot", "namespace": "/robot1"}}
    assert pilot["namespace"] == "/robot1"


def qos(fleet: Fleet) -> None:
    (odometry,) = fleet["robot2"]["/robot2/diff_drive"]["publishers"]
    odometry.append("best_effort")


def other_type(fleet: Fleet) -> None:
    (odometry,) = fleet["robot2"]["/robot2/diff_drive"]["publishers"]
    odometry[1] = "std_msgs/msg/String"
    # One process has no two types of a topic.
    fleet["pilot"] = {"/robot2/pilot": fleet["robot2"].pop("/robot2/pilot")}


def once_silent(fleet: Fleet) -> None:
    """Silence what was "as planned" for long: the other robot's description, lidars in two ways."""
    state = fleet["robot2"]["/robot2/robot_state_publisher"]
    moving, fixed = edges("robot1", L2)
    state["frames"] = [["/tf", False, *moving[:-1]], ["/tf_static", True, *fixed]]
    (scan,) = fleet["robot2"]["/robot2/lidar_driver"]["publishers"]
    scan[0] = "/robot2/lidar_driver/out"
    lidar = fleet["robot1"].pop("/robot1/lidar_driver")
    lidar["publishers"][0][1] = "sensor_msgs/msg/PointCloud2"
    # One process has no two types of a topic.
    fleet["lidar"] = {"/robot1/lidar_driver": lidar}


def two_parents(fleet: Fleet) -> None:
    edge = ["base_link/robot2", "imu_link/robot1"]
    fleet["robot2"]["/robot2/pilot"]["frames"] = [["/tf", False, edge]]


def missing_remap(fleet: Fleet) -> None:
    state = fleet["robot1"]["/robot1/robot_state_publisher"]
    state["frames"] = [["/tf", *state["frames"][0][1:]], ["/tf_static", *state["frames"][1][1:]]]


def not_started(fleet: Fleet) -> None:
    del fleet["robot2"]


def wrong_namespace(fleet: Fleet) -> None:
    fleet["robot2"]["/robot2/pilot"]["namespace"] = "/"


L2, L3 = "frames-per-robot", "both"
SCENARIOS = (
    Scenario("healthy L2", L2, healthy, frozenset()),
    Scenario("healthy L3", L3, healthy, frozenset()),
    Scenario(
        "leak", L2, leak,
        frozenset({("MG310", "/robot1/diff_drive")}),
    ),
    Scenario("cross-talk", L2, cross_talk, frozenset({("MG311", "/robot1/pilot")})),
    Scenario(
        "once silent", L2, once_silent,
        frozenset({
            ("MG208", "robot2"), ("MG303", "/robot2/pilot"), ("MG306", "/robot1/lidar_driver"),
            ("MG408", "robot1"),
        }),
    ),
    Scenario("clash", L2, clash, frozenset({("MG301", "/robot1/pilot")})),
    Scenario("qos", L2, qos, frozenset({("MG307", "/robot2/pilot")})),
    Scenario("type", L2, other_type, frozenset({("MG306", "/robot2/diff_drive")})),
    Scenario("two parents", L2, two_parents, frozenset({("MG401", "robot1")})),
    Scenario(
        "missing remap", L3, missing_remap,
        frozenset({("MG405", "/robot1/robot_state_publisher")}),
    ),
    Scenario("not started", L2, not_started, frozenset({("MG109", "robot2")})),
    Scenario("wrong namespace", L2, wrong_namespace, frozenset({("MG101", "/robot2/pilot")})),
)  # fmt: skip


# Enough for a usual run; the deep one has all.
USUAL = [it for it in SCENARIOS if it.name in ("healthy L3", "leak")]


class Outcome(NamedTuple):
    code: int
    found: frozenset[tuple[str, str]]
    said: str


def check(at: int, scenario: Scenario, more: Mapping[str, str], looks: int) -> list[Outcome]:
    """Return what the command finds while the scenario's processes run, one or several at once."""
    domain = live_commands.domain(at)
    fleet = fleet_of(scenario.layout)
    scenario.fault(fleet)
    env = {**live_fleet.environ(domain), **more}
    with live_fleet.running(domain, *(list(nodes.values()) for nodes in fleet.values()), **more):
        command = ("check", plan_of(scenario.layout), "-v", *live_commands.PATIENTLY)
        with ThreadPoolExecutor(looks) as pool:
            look = partial(live_commands.multibot, *command, env=env)
            ended = [it.result() for it in [pool.submit(look) for _ in range(looks)]]
    return [
        Outcome(it.returncode, frozenset(_found(it.stdout)), it.stdout + it.stderr) for it in ended
    ]


def _found(lines: str) -> Iterator[tuple[str, str]]:
    for line in lines.splitlines():
        who, _, rest = line.partition(": ")
        yield rest.split()[1], who


@pytest.fixture(scope="module")
def needed(tf2: Mapping[str, str]) -> Mapping[str, str]:
    """Return what makes tf2_msgs importable in children; a loud skip where it cannot be had."""
    if not tf2 and not find_spec("tf2_msgs"):
        pytest.skip(f"tf2_msgs is not there and not built: {tf2_build.missing()}")
    return tf2


def checked(
    scenarios: Sequence[Scenario], more: Mapping[str, str], looks: int = 1
) -> dict[str, list[Outcome]]:
    """Scenarios side by side: most of a check is waiting."""
    with ThreadPoolExecutor(AT_ONCE) as pool:
        found = pool.map(lambda it: check(it[0], it[1], more, looks), enumerate(scenarios))
        return {it.name: outcome for it, outcome in zip(scenarios, found, strict=True)}


@pytest.fixture(scope="module")
def once(needed: Mapping[str, str]) -> dict[str, list[Outcome]]:
    return checked(USUAL, needed)


@pytest.mark.parametrize("scenario", USUAL, ids=lambda scenario: scenario.name)
def test_a_fault_is_found_and_named_and_nothing_else(
    scenario: Scenario, once: dict[str, list[Outcome]]
) -> None:
    (outcome,) = once[scenario.name]
    assert outcome.found == scenario.found, outcome.said
    assert outcome.code == bool(scenario.found), outcome.said


@pytest.mark.deep
def test_several_who_look_at_once_find_the_same(needed: Mapping[str, str]) -> None:
    outcomes = checked(SCENARIOS, needed, LOOKS)
    looks = ((it, look) for it in SCENARIOS for look in outcomes[it.name])
    odd = [f"{it.name}: {look.said}" for it, look in looks if look.found != it.found]
    assert odd == [], "\n".join(odd)


def test_the_plans_are_those_of_the_rover() -> None:
    plan: System = from_yaml(plan_of(L2).read_bytes(), "plan.yaml")
    links = {child for moving_or_not in edges("robot1", L2) for _, child in moving_or_not}
    assert links | {"odom/robot1"} == set(plan.robots[0].frames)
