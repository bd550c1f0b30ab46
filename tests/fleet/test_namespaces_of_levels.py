# SPDX-License-Identifier: Apache-2.0
"""Namespaces of two and more levels, as /fleet_a/robot1: from the fleet file to the check."""

from __future__ import annotations

from pathlib import Path

import pytest
from fleet_folder import planned_fleet
from nav2_graphs import ROVER, healthy, moved, with_end, without_node

from multibot_rewrite import compare
from multibot_rewrite.base.model import InputError
from multibot_rewrite.fleet.file.fleet_file import read_fleet
from multibot_rewrite.fleet.fleet import expected
from multibot_rewrite.planning.plan import to_yaml
from multibot_rewrite.system.coverage import coverage
from multibot_rewrite.system.json import from_yaml
from multibot_rewrite.system.records import Node, Robot, System

# Two fleets with robots of one name, and a robot beside them.
FLEET = """\
layout: {layout}
description: {rover}
node_sets: nav2
distro: jazzy
robots:
- {{name: a1, namespace: /fleet_a/robot1}}
- {{name: b1, namespace: fleet_b/robot1}}
- {{name: guard}}
"""


def planned(folder: Path, layout: str) -> System:
    """Return the plan of the fleet, through its file."""
    file = folder / "fleet.yaml"
    file.write_text(FLEET.format(layout=layout, rover=ROVER))
    plan = expected(planned_fleet(file).fleet)
    return from_yaml(to_yaml(plan).encode(), "plan.yaml")


@pytest.mark.slow
def test_faults_name_the_robot(tmp_path: Path) -> None:
    """A leak, another robot's scan, a node without its namespace and a node of nobody's plan."""
    plan = planned(tmp_path, "both")
    graph = moved(healthy(plan), "/fleet_a/robot1/cmd_vel", "/cmd_vel", "robot1/collision_monitor")
    graph = moved(graph, "/fleet_b/robot1/scan", "/fleet_a/robot1/scan", "fleet_b/robot1/amcl")
    graph = without_node(graph, "/guard/bt_navigator")
    graph = with_end(graph, "/fleet_b/robot1/gripper", "/fleet_b/robot1/open")
    found = {(it.code, it.robot, it.node) for it in compare(plan, graph)}
    assert ("MG308", "a1", "/fleet_a/robot1/collision_monitor") in found
    assert ("MG321", "b1", "/fleet_b/robot1/amcl") in found
    assert ("MG101", "guard", "/guard/bt_navigator") in found
    assert ("MG108", "b1", "/fleet_b/robot1/gripper") in found
    hints = " ".join(it.hint for it in compare(plan, graph))
    assert "robot1/fleet_" not in hints


@pytest.mark.parametrize(("own", "other"), [("fleet/a", "fleet/b"), ("r2", "r1")])
def test_a_robot_is_called_by_its_name(own: str, other: str) -> None:
    """Whatever its namespace, which may be another robot's name; its nodes get the namespace."""
    robots = (Robot("r1", namespace=own), Robot("r2", namespace=other))
    names = ("driver", "lidar")
    nodes = [Node(f"/{it.space}/{name}", robot=it.name) for name in names for it in robots]
    plan = System(tuple(nodes), robots=robots, layout="both")
    (missed,) = compare(plan, System((Node("/driver"), *nodes[1:])))
    assert (missed.code, missed.robot, missed.node) == ("MG101", "r1", f"/{own}/driver")
    assert f"namespace='{own}' in the launch file" in missed.hint
    assert [it.new for it in missed.remaps] == [f"/{own}"]
    assert [it.robot for it in coverage(plan, plan).robots] == ["r1", "r2"]


def test_the_layout_without_namespaces_refuses_them(tmp_path: Path) -> None:
    file = tmp_path / "fleet.yaml"
    file.write_text(FLEET.format(layout="postfix", rover=ROVER))
    with pytest.raises(InputError) as refused:
        read_fleet(str(file), "", {})
    assert f"{file}:6: 'a1' has the namespace 'fleet_a/robot1'" in str(refused.value)
    assert "take a layout with namespaces" in str(refused.value)
