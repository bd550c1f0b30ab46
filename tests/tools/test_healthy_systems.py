# SPDX-License-Identifier: Apache-2.0
"""A healthy system of a release has no finding: its endpoints are what the sources declare.

Each node has what ``fixtures/interfaces/RELEASE.tsv.xz`` says of it, in its robot's namespace and with
the remap rules of the table. Only values of parameters are taken from the node set.
"""

from __future__ import annotations

import pytest
from declared_graph import endpoints, facts
from nav2_graphs import environment

from multibot_rewrite import compare
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.releases import NEWEST_LTS, RELEASES
from multibot_rewrite.knowledge.node_library import nodes_of_set
from multibot_rewrite.knowledge.node_sets import built_in
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.planning.planned_system import expect
from multibot_rewrite.planning.records import Table
from multibot_rewrite.planning.table import build_table
from multibot_rewrite.system.records import Node, System

SYSTEMS = {
    "nav2": ("robot_state", "nav2", "ros2_control"),
    "arms": ("robot_state", "moveit", "ros2_control"),
    "gps": ("robot_state", "slam_toolbox", "robot_localization_gps"),
}
# The usual names of nodes that a node set calls otherwise.
KINDS = {
    "lifecycle_manager_localization": "lifecycle_manager",
    "lifecycle_manager_navigation": "lifecycle_manager",
    "ekf_filter_node_odom": "ekf_filter_node",
    "ekf_filter_node_map": "ekf_filter_node",
    "navsat_transform": "navsat_transform_node",
}
# What Nav2 reads, and what is published below another name: no rule of these node sets joins them.
ODOMETRY = {(f"/{it}/odom", f"/{it}/diff_drive_controller/odom") for it in ("robot1", "robot2")}
# Humble's speed filter has no default with the namespace of its costmap's parent (speed_filter.cpp).
SPEED = {(f"/{it}/speed_limit", f"/{it}/local_costmap/speed_limit") for it in ("robot1", "robot2")}
UNFED = {
    (name, release): ODOMETRY | (SPEED if release == "humble" else set())
    if name == "nav2"
    else set()
    for name in SYSTEMS
    for release in RELEASES
}


def system(release: str, name: str) -> tuple[list[tuple[str, NodeFacts]], Table, System]:
    """Return the nodes with the names that they have in the tables, the remap table, the plan."""
    library = built_in(release)
    nodes = tuple(dict.fromkeys(it for word in SYSTEMS[name] for it in nodes_of_set(library, word)))
    naming = make_naming("L2")
    table = build_table(("robot1", "robot2"), nodes, naming, release=NEWEST_LTS)
    kinds = [(KINDS.get(it.name, it.name), it) for it in nodes]
    return kinds, table, expect(table, naming, {"robot1": (), "robot2": ()})


def graph(release: str, name: str) -> tuple[System, System]:
    kinds, table, plan = system(release, name)
    by_name = {(it.name): (kind, it) for kind, it in kinds}
    ends = []
    nodes = []
    for placed in table.runs:
        kind, node = by_name[placed.node]
        if kind not in facts(release):
            assert node.when, f"{release} has no facts of {kind}"
            continue
        nodes.append(f"{placed.namespace.rstrip('/')}/{placed.name}")
        ends += endpoints(kind, node, placed, release)
    owners = dict.fromkeys([*nodes, *(it.node for it in ends)])
    around = environment()
    return plan, System(tuple(Node(it, it) for it in owners), tuple(ends), (), around)


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize("release", RELEASES)
@pytest.mark.parametrize("name", SYSTEMS)
def test_a_healthy_system_has_no_finding(release: str, name: str) -> None:
    """But for what is not fed there, which is true."""
    found = compare(*graph(release, name))
    unfed = UNFED[name, release]
    assert [f"{it.code} {it.node} {it.message}" for it in found if it.names not in unfed] == []
    assert {it.names for it in found} == unfed


@pytest.mark.slow
@pytest.mark.parametrize("name", ["/robot1/initialpose", "/tf", "/robot1/follow_path"])
def test_what_a_node_lacks_is_found(name: str) -> None:
    plan, seen = graph("jazzy", "nav2")
    left = tuple(it for it in seen.ends if it.name != name)
    assert {it.code for it in compare(plan, seen._replace(ends=left))} >= {"MG102"}


def test_the_private_node_is_needed() -> None:
    plan, seen = graph("jazzy", "arms")
    gone = "/robot1/move_group_private_1407"
    left = seen._replace(
        nodes=tuple(it for it in seen.nodes if it.name != gone),
        ends=tuple(it for it in seen.ends if it.node != gone),
    )
    (found,) = compare(plan, left)
    assert (found.code, found.node) == ("MG101", "/robot1/move_group_private_*")
