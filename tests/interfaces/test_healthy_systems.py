"""A healthy system of a release has no finding: its endpoints are what the sources declare.

Each node has what ``fixtures/interfaces/RELEASE.tsv`` says of it, in its robot's namespace and with
the remap rules of the table. Only values of parameters are taken from the stack.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache

import pytest
from nav2_graphs import environment
from paths import FIXTURES

from multibot_rewrite.graph.check import check
from multibot_rewrite.graph.expectation import Expectation, expect
from multibot_rewrite.graph.snapshot import GraphEndpoint, GraphNode, Snapshot
from multibot_rewrite.interfaces.compare import is_same
from multibot_rewrite.interfaces.records import Fact
from multibot_rewrite.interfaces.table import from_table
from multibot_rewrite.naming import make_naming
from multibot_rewrite.releases import NEWEST_LTS, RELEASES
from multibot_rewrite.remap.node_library import stack_of
from multibot_rewrite.remap.records import ACTION, SERVICE, TOPIC, NodeFacts, NodeTable, Table
from multibot_rewrite.remap.stacks import built_in
from multibot_rewrite.remap.table import build_table, parsed
from multibot_rewrite.rosnames import bind, resolve_bound

SYSTEMS = {
    "nav2": ("robot_state", "nav2", "ros2_control"),
    "arms": ("robot_state", "moveit", "ros2_control"),
    "gps": ("robot_state", "slam_toolbox", "robot_localization_gps"),
}
# The usual names of nodes that a stack calls otherwise.
KINDS = {
    "lifecycle_manager_localization": "lifecycle_manager",
    "lifecycle_manager_navigation": "lifecycle_manager",
    "ekf_filter_node_odom": "ekf_filter_node",
    "ekf_filter_node_map": "ekf_filter_node",
    "navsat_transform": "navsat_transform_node",
}
# What rclcpp gives every node, and rclcpp_lifecycle those that have it (their node.cpp).
SERVICES = ("get_parameters", "set_parameters", "list_parameters", "describe_parameters",
            "get_parameter_types", "set_parameters_atomically")  # fmt: skip
STATES = {"change_state": "ChangeState", "get_state": "GetState",
          "get_available_states": "GetAvailableStates",
          "get_available_transitions": "GetAvailableTransitions",
          "get_transition_graph": "GetAvailableTransitions"}  # fmt: skip
# One of two: without stamped commands, with laser scanners, and no mode that is not started.
DEFAULT = re.compile(r"not \((is_stamped_|subscribe_to_stamped_footprint_)\)")
OFF = (
    "is_stamped_",
    "params_.use_local_topics",
    "class ",
    'source_type == "p',
    'source_type == "r',
    'source_type == "c',
    "not (data_type ==",
    "enable_path_lookahead_",
    "subscribe_to_stamped_footprint_",
    'command_out_type == "std_msgs/Float64MultiArr',
)
# moveit_servo/src/utils/common.cpp:509 gives its own name where the monitor has a default.
GIVEN = {("servo_node", "publishes", "monitored_planning_scene"): "~/publish_planning_scene"}


@cache
def facts(release: str) -> dict[str, list[Fact]]:
    found: dict[str, list[Fact]] = {}
    for fact in from_table((FIXTURES / "interfaces" / f"{release}.tsv").read_text()):
        if not any(it in DEFAULT.sub("", fact.condition) for it in OFF):
            name = GIVEN.get((fact.node, fact.role, fact.name), fact.name)
            found.setdefault(fact.node, []).append(fact._replace(name=name))
    return found


def system(release: str, name: str) -> tuple[list[tuple[str, NodeFacts]], Table, Expectation]:
    """The nodes with the names that they have in the tables, the remap table, the plan."""
    library = built_in(release)
    nodes = tuple(dict.fromkeys(it for stack in SYSTEMS[name] for it in stack_of(library, stack)))
    naming = make_naming("L2")
    table = build_table(("robot1", "robot2"), nodes, naming, release=NEWEST_LTS)
    kinds = [(KINDS.get(it.name, it.name), it) for it in nodes]
    return kinds, table, expect(table, naming, {"robot1": (), "robot2": ()}, nodes)


def names(fact: Fact, node: NodeFacts) -> list[str]:
    """The names of an endpoint, with the values that the stack gives parameters."""
    if "<" not in fact.name and not fact.parameter:
        return [fact.name]
    alike = [it for it in node.endpoints if is_same(fact._replace(name="<any>"), it)]
    given = [it.name for it in alike if "<" in fact.name or it.parameter == fact.parameter]
    same = [it.name for it in node.endpoints if is_same(fact, it)]
    return same or given or ([fact.name] if "<" not in fact.name else [])


def endpoints(
    kind: str, node: NodeFacts, placed: NodeTable, release: str
) -> Iterator[GraphEndpoint]:
    """What a node has by its sources."""
    bound = bind(placed.name, placed.namespace, parsed(placed.rules))
    full = f"{placed.namespace.rstrip('/')}/{placed.name}"
    lifecycle = any(it.name == "~/get_state" for it in node.endpoints)
    declared = [
        (it.role, name, it.type, it.way)
        for it in facts(release)[kind]
        for name in names(it, node)
        if "<" not in name and "/" in it.type and it.way in ("", "helper", "private _")
    ]
    declared += [
        (
            "serves",
            f"~/{it}",
            "rcl_interfaces/srv/" + "".join(part.title() for part in it.split("_")),
            "",
        )
        for it in SERVICES
    ]
    if lifecycle:
        declared += [
            ("serves", f"~/{it}", f"lifecycle_msgs/srv/{t}", "") for it, t in STATES.items()
        ]
        declared += [("publishes", "~/transition_event", "lifecycle_msgs/msg/TransitionEvent", "")]
    for role, name, type_, way in declared:
        is_topic = role in ("publishes", "subscribes")
        sort = TOPIC if is_topic else ACTION if "/action/" in type_ else SERVICE
        owner = full
        if way == "helper":
            owner = f"{placed.namespace.rstrip('/')}/transform_listener_impl_55d0"
        elif way:
            owner = f"{full}_private_1407"
        resolved = resolve_bound(name, TOPIC if sort == ACTION else sort, bound)
        yield GraphEndpoint(sort, role, resolved, type_, "", owner, None, "")


def graph(release: str, name: str) -> tuple[Expectation, Snapshot]:
    kinds, table, plan = system(release, name)
    by_name = {(it.name): (kind, it) for kind, it in kinds}
    ends = []
    nodes = []
    for placed in table.nodes:
        kind, node = by_name[placed.node]
        if kind not in facts(release):
            assert node.when, f"{release} has no facts of {kind}"
            continue
        nodes.append(f"{placed.namespace.rstrip('/')}/{placed.name}")
        ends += endpoints(kind, node, placed, release)
    owners = dict.fromkeys([*nodes, *(it.node for it in ends)])
    around = environment()
    return plan, Snapshot(tuple(GraphNode(it, it) for it in owners), tuple(ends), (), around)


@pytest.mark.parametrize("release", RELEASES)
@pytest.mark.parametrize("name", SYSTEMS)
def test_a_healthy_system_has_no_finding(release: str, name: str) -> None:
    found = [f"{it.code} {it.node} {it.message}" for it in check(*graph(release, name))]
    assert found == []


@pytest.mark.parametrize("name", ["/robot1/initialpose", "/tf", "/robot1/follow_path"])
def test_what_a_node_lacks_is_found(name: str) -> None:
    plan, seen = graph("jazzy", "nav2")
    left = tuple(it for it in seen.endpoints if it.name != name)
    assert {it.code for it in check(plan, seen._replace(endpoints=left))} >= {"MG102"}


def test_the_private_node_is_needed() -> None:
    plan, seen = graph("jazzy", "arms")
    gone = "/robot1/move_group_private_1407"
    left = seen._replace(
        nodes=tuple(it for it in seen.nodes if it.name != gone),
        endpoints=tuple(it for it in seen.endpoints if it.node != gone),
    )
    (found,) = check(plan, left)
    assert (found.code, found.node) == ("MG101", "/robot1/move_group_private_*")
