"""nav2.launch.py as ``check-launch`` reads it, without the real launch: what is started, and how.

The names are those of the layout; programs and what a lifecycle manager is told are those of
nav2_bringup's launch files, the numbers those of lifecycle_msgs msg/Transition.msg.
"""

from __future__ import annotations

import pytest
import yaml
from nav2_fleet import FILE, written

from multibot_rewrite.launch import nav2_programs
from multibot_rewrite.producers.launch.child import launch_graph
from multibot_rewrite.producers.launch.records import LaunchedNode, LaunchOrder

BESIDE = ["map_server", "amcl"]


@pytest.fixture(scope="module")
def nodes(tmp_path_factory: pytest.TempPathFactory) -> dict[str, LaunchedNode]:
    """By full name, postfix."""
    fleet = written(tmp_path_factory.mktemp("fleet")) / "fleet.yaml"
    words = (("fleet", str(fleet)), ("map", "/depot.yaml"))
    found = launch_graph(LaunchOrder(str(FILE), words, trusted=True)).nodes
    return {f"{it.namespace.rstrip('/')}/{it.name}": it for it in found}


def own(node: LaunchedNode) -> dict[str, object]:
    """What the launch file itself sets."""
    texts = (yaml.safe_load(it.text) for it in node.parameters if it.text.startswith("/**"))
    return {name: value for it in texts for name, value in it["/**"]["ros__parameters"].items()}


@pytest.mark.slow
@pytest.mark.parametrize("robot", ["robot1", "robot2"])
def test_a_manager_has_the_nodes_that_it_manages_by_their_names(
    robot: str, nodes: dict[str, LaunchedNode]
) -> None:
    manager = nodes[f"/lifecycle_manager_localization_{robot}"]
    assert (manager.package, manager.executable) == ("nav2_lifecycle_manager", "lifecycle_manager")
    wanted = [f"{it}_{robot}" for it in BESIDE]
    assert own(manager) == {"autostart": True, "node_names": wanted}
    moving = own(nodes[f"/lifecycle_manager_navigation_{robot}"])["node_names"]
    assert {"controller_server", f"bt_navigator_{robot}"} <= {*moving}  # type: ignore[misc]


@pytest.mark.slow
def test_a_map_server_gets_its_map_and_no_node_is_told_of_others(
    nodes: dict[str, LaunchedNode],
) -> None:
    assert own(nodes["/map_server_robot1"]) == {"yaml_filename": "/depot.yaml"}
    told = {
        name for name, it in nodes.items() if any("node_names" in one.text for one in it.parameters)
    }
    assert all(it.startswith("/lifecycle_manager_") for it in told) and len(told) == 4


def test_a_node_is_configured_and_then_activated() -> None:
    assert dict(nav2_programs.TRANSITIONS) == {"configure": 1, "activate": 3}
