# SPDX-License-Identifier: Apache-2.0
"""The real rcl takes every rule of the tables and leads every name where the tables say."""

from __future__ import annotations

import importlib.util
import itertools
import shlex

import pytest
from named_ends import named_ends
from rcl_names import INSTALL, ask

from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.knowledge.node_sets import load_node_set
from multibot_rewrite.knowledge.records import Endpoint
from multibot_rewrite.planning.records import Run, Table
from multibot_rewrite.planning.table import build_table
from multibot_rewrite.planning.table_formats import ros_args
from multibot_rewrite.system.records import ACTION, SERVICE, TOPIC

pytestmark = [
    pytest.mark.live,
    pytest.mark.skipif(
        not importlib.util.find_spec("rclpy"),
        reason=f"tables are not compared with the real rcl: no rclpy here, {INSTALL} (CPython < 3.13)",
    ),
]
ROBOTS = ("robot1", "robot2")
NODE_SETS = ("nav2", "slam_toolbox", "robot_state", "teleop")
POLICIES = [
    ("L1", "postfix"),
    ("L2", "prefix"),
    ("L3", "postfix"),
    ("L4", "postfix"),
    ("L4", "prefix"),
]


@pytest.fixture(scope="module", params=POLICIES, ids="-".join)
def table(request: pytest.FixtureRequest) -> Table:
    layout, affix = request.param
    nodes = dict.fromkeys(node for name in NODE_SETS for node in load_node_set(name, NEWEST_LTS))
    return build_table(ROBOTS, list(nodes), make_naming(layout, affix), release=NEWEST_LTS)


def rules_of(lines: list[str], node: Run) -> list[str]:
    """Return what follows each ``-r`` in the line of the ros-args form of the node, or of its
    host, whose namespace and name are not its own."""
    own = f"# {node.robot}: {node.node}"
    if own not in lines:
        name = f"__node:={node.name}", f"__ns:={node.namespace}"
        rules = rules_of(lines, node._replace(node=node.fact.host))
        return [*name, *(it for it in rules if not it.startswith("__"))]
    at = lines.index(own)
    words = shlex.split(lines[at + 1]) if lines[at + 1] != "(no rule)" else []
    return [word for before, word in itertools.pairwise(words) if before == "-r"]


@pytest.mark.sample(3)
def test_every_name_leads_where_the_table_says(table: Table) -> None:
    lines = ros_args(table).splitlines()
    cases, wanted = [], []
    for node in (one for one in table.runs if one.robot):
        full = f"{node.namespace.rstrip('/')}/{node.name}"
        names = [
            name
            for name in named_ends(table)
            if (name.robot, name.node) == (node.robot, full) and not name.endpoint.fixed
        ]
        asked = [(kind_of(it.endpoint.kind), in_code(it.endpoint, node.namespace)) for it in names]
        cases.append(
            {
                "ask": "started",
                "node": node.node.rpartition("/")[2],
                "namespace": "",
                "process_rules": rules_of(lines, node),
                "node_rules": [],
                "use_process_rules": True,
                "names": asked,
            }
        )
        wanted.append([full, *(name.name for name in names)])
    assert len(cases) > 30
    assert ask(cases) == wanted


def in_code(end: Endpoint, namespace: str) -> str:
    """Return what the node asks for: a costmap's filter joins its topic with the namespace above
    (nav2_costmap_2d lyrical layer.cpp joinWithParentNamespace)."""
    above = namespace.rpartition("/")[0]
    return f"{above}/{end.name.lstrip('/')}" if end.above else end.name


def kind_of(kind: str) -> str:
    """rcl resolves the name of an action as a topic's."""
    return {ACTION: TOPIC, SERVICE: SERVICE}.get(kind, TOPIC)
