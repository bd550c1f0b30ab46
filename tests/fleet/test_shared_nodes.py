# SPDX-License-Identifier: Apache-2.0
"""Nodes and topics that all robots of a fleet share: one map_server, one map."""

from __future__ import annotations

from pathlib import Path

import pytest
from fleet_folder import planned_fleet
from nav2_graphs import ROVER
from plans import own

from multibot_rewrite.base.model import InputError
from multibot_rewrite.checks.build import make_outputs
from multibot_rewrite.checks.closed_plan import closed_plan
from multibot_rewrite.fleet.fleet import expected
from multibot_rewrite.system.records import System

LAYOUTS = ("tf-per-robot", "frames-per-robot", "both", "postfix")
FLEET = """\
layout: {layout}
description: {rover}
node_sets: nav2
distro: jazzy
shared_topics: [/map, /clock, /rosout, /parameter_events, /diagnostics]
shared_nodes: {shared}
robots: [{{name: robot1}}, {{name: robot2}}]
"""


def planned(folder: Path, layout: str, shared: str = "map_server") -> System:
    file = folder / "fleet.yaml"
    file.write_text(FLEET.format(layout=layout, rover=ROVER, shared=shared))
    made = planned_fleet(file).fleet
    assert [it for it in made.table.problems if it.level == "error"] == []
    return expected(made)


@pytest.mark.slow
@pytest.mark.parametrize("layout", LAYOUTS)
def test_each_amcl_reads_the_map_of_the_one_map_server(tmp_path: Path, layout: str) -> None:
    plan = planned(tmp_path, layout)
    assert own(plan) == ("/map_server",)
    ends = [it for it in plan.ends if it.name == "/map"]
    senders = [it.node for it in ends if it.role == "publishes"]
    readers = {it.node for it in ends if it.role == "subscribes" and "amcl" in it.node}
    assert senders == ["/map_server"]
    assert len(readers) == 2
    assert not [it.name for it in plan.ends if it.name.endswith("/map") and it.name != "/map"
                and it.kind == "topic"]  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("layout", LAYOUTS)
def test_no_robot_has_a_copy_of_it_or_manages_it(tmp_path: Path, layout: str) -> None:
    plan = planned(tmp_path, layout)
    below = {it.name for it in plan.ends if "map_server" in it.name}
    assert below
    assert all(name.startswith("/map_server/") for name in below)
    managers = {it.node for it in plan.ends if "amcl" in it.name and it.role == "calls"}
    assert len(managers) == 2
    callers = {it.node for it in plan.ends if "map_server" in it.name and it.role == "calls"}
    assert callers == set()


@pytest.mark.slow
def test_a_client_of_a_shared_node_calls_the_one_there_is(tmp_path: Path) -> None:
    """A service below a node that is shared is that node's, in every layout."""
    nodes = tmp_path / "nodes.yaml"
    nodes.write_text(
        "nodes:\n"
        "  atlas: {package: acme, serves: {~/load: std_srvs/srv/Trigger}}\n"
        "  reader: {package: acme, calls: {atlas/load: std_srvs/srv/Trigger}}\n"
        "node_sets: {acme: {nodes: [atlas, reader]}}\n"
    )
    for layout in LAYOUTS:
        file = tmp_path / "fleet.yaml"
        text = FLEET.format(layout=layout, rover=ROVER, shared="atlas")
        file.write_text(text.replace("node_sets: nav2", "node_sets: acme\nnodes: nodes.yaml"))
        plan = expected(planned_fleet(file).fleet)
        names = {it.name for it in plan.ends if "load" in it.name}
        assert names == {"/atlas/load"}, layout


def test_a_name_that_no_robot_runs_is_refused(tmp_path: Path) -> None:
    with pytest.raises(
        InputError, match=r"shared_nodes: no robot has a node 'map_servr'.*map_server"
    ):
        planned(tmp_path, "both", "map_servr")


@pytest.mark.parametrize(("value", "is_told"), [("map.yaml", False), ("''", True), (None, True)])
def test_a_map_server_without_a_map_is_told(
    value: str | None, is_told: bool, tmp_path: Path
) -> None:
    """nav2_map_server map_server.cpp: with an empty yaml_filename it waits for a service call."""
    text = FLEET.format(layout="tf-per-robot", rover=ROVER, shared="map_server")
    if value is not None:
        own_file = f"map_server: {{ros__parameters: {{yaml_filename: {value}}}}}\n"
        (tmp_path / "own.yaml").write_text(own_file)
        text += "related_files: {params: own.yaml}\n"
    (tmp_path / "fleet.yaml").write_text(text)
    found = make_outputs(planned_fleet(tmp_path / "fleet.yaml")).findings
    assert [it.level for it in found if it.code == "MF857"] == ["note"] * is_told


def test_what_a_shared_node_sends_is_not_moved_to_a_robot(tmp_path: Path) -> None:
    """A build judges one robot at a time: it has to know who sends for all."""
    box = "{/box: geometry_msgs/msg/PoseStamped}"
    (tmp_path / "nodes.yaml").write_text(
        f"nodes:\n  boxes: {{package: acme, publishes: {box}}}\n"
        f"  picker: {{package: acme, subscribes: {box.replace('/box', 'box')}}}\n"
        "node_sets: {acme: {nodes: [boxes, picker]}}\n"
    )
    file = tmp_path / "fleet.yaml"
    text = FLEET.format(layout="tf-per-robot", rover=ROVER, shared="boxes")
    file.write_text(text.replace("node_sets: nav2", "node_sets: acme\nnodes: nodes.yaml"))
    (found,) = (it for it in closed_plan(planned_fleet(file)).gaps if it.code == "MG303")
    assert found.hint.startswith("pass the rule /robot1/box:=/box, or put /box in shared_topics")
