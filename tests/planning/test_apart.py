# SPDX-License-Identifier: Apache-2.0
"""Nodes whose code sets their names: costmaps, and the servers of Nav2 that make them.

Costmap2DROS gives its node ``__ns:=<namespace of the server>/<name>`` and ``<name>:__node:=<name>`` as
arguments of the node itself (navigation2 1.1.20 and 1.4.2 nav2_costmap_2d/src/costmap_2d_ros.cpp, 1.5.1
in getChildNodeOptions), and rcl takes a node's own arguments before those of its process.
"""

from __future__ import annotations

import pytest

from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.knowledge.node_sets import load_node_set
from multibot_rewrite.live.rehearsal import stub_nodes
from multibot_rewrite.planning.records import Run, Table
from multibot_rewrite.planning.table import build_table

ROBOTS = ("robot1", "robot2")


def made(release: str, node_set: str = "nav2") -> Table:
    return build_table(ROBOTS, load_node_set(node_set, release), make_naming("L4"), release=release)


def found(table: Table, node: str) -> Run:
    return next(it for it in table.runs if it.node == node and it.robot == "robot1")


@pytest.mark.more
@pytest.mark.parametrize("release", RELEASES)
def test_the_lifecycle_manager_finds_a_server_in_its_namespace(release: str) -> None:
    rules = dict(found(made(release), "lifecycle_manager_navigation").rules)
    assert rules["controller_server/change_state"] == "/robot1/controller_server/change_state"
    assert rules["smoother_server/change_state"] == "smoother_server_robot1/change_state"


def test_a_rehearsal_places_a_costmap_as_its_code_does() -> None:
    """A plan that says another name of it is found out."""
    table = made("jazzy")
    costmap = found(table, "local_costmap/local_costmap")
    nodes = [
        it._replace(namespace="/elsewhere", name="costmap_robot1") if it == costmap else it
        for it in table.runs
    ]
    stubs = [stub for stub, _ in stub_nodes(table._replace(runs=tuple(nodes)), {})]
    own = next(it for it in stubs if it.code_name == "local_costmap" and it.robot == "robot1")
    assert own.arguments[:3] == ("--ros-args", "-r", "__ns:=/robot1/local_costmap")
    assert not any("__node" in word for word in own.arguments)


@pytest.mark.more
@pytest.mark.parametrize(
    ("release", "rule"),
    [("jazzy", None), ("kilted", "/speed_limit/robot1"), ("lyrical", "/speed_limit/robot1")],
)
def test_a_name_that_is_joined_with_the_namespace_above(release: str, rule: str | None) -> None:
    """SpeedFilter: from Kilted on it publishes where the controller_server listens."""
    table = made(release)
    rules = dict(found(table, "global_costmap/global_costmap").rules)
    assert rules.get("/robot1/speed_limit") == rule
    assert rules["speed_limit"] == "/global_costmap/speed_limit/robot1"
    server = dict(found(table, "controller_server").rules)
    assert server["speed_limit"] == "/speed_limit/robot1"
