# SPDX-License-Identifier: Apache-2.0
"""Trees of transforms: two that nodes of a robot send are apart; a driver may join the description."""

from __future__ import annotations

from pathlib import Path

import open_findings
import pytest
from closed_robot import FILES
from given_parameters import run_given
from paths import fixture_text, write_files

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.checks.closed_plan import gaps_of
from multibot_rewrite.checks.judged_plan import plan_fleet
from multibot_rewrite.checks.robot_system import DRIVERS
from multibot_rewrite.fleet.file.fleet_file import read_fleet
from multibot_rewrite.knowledge.node_sets import load_nodes
from multibot_rewrite.planning.records import Given, Run
from multibot_rewrite.producers.ends import edge, edges_off
from multibot_rewrite.rules.system.tf_pieces import tf_tree_in_pieces
from multibot_rewrite.system.index import index
from multibot_rewrite.system.ownership import ALONE
from multibot_rewrite.system.records import Edge, Place, System, edge_of


def pair(text: str) -> Edge:
    parent, child = text.split(">")
    return edge_of(parent, child)


def told(*edges: Edge) -> list[Finding]:
    assert tf_tree_in_pieces.check
    return list(tf_tree_in_pieces.check(index(System(edges=edges, environment=DRIVERS), ALONE)))


@pytest.mark.parametrize(
    ("description", "senders", "apart"),
    [
        ("base>lidar", {"slam": "map>odom", "ekf": "odom>base"}, []),
        ("base>lidar", {"slam": "map>odom", "ekf": "odom2>base"}, ["/ekf"]),
        ("base>lidar", {"slam": "map>odom"}, []),
        ("base>lidar base>mast mast>head", {"slam": "map>odom", "head": "head>eye"}, []),
        (
            "base>mast",
            {"slam": "map>odom", "ekf": "odom2>base", "eye": "mast>eye"},
            ["/ekf", "/eye"],
        ),
        ("odom>base", {"slam": "map>odom", "arm": "base>hand"}, []),
        ("", {"a": "x>y", "b": "y>z", "c": "p>q"}, ["/c"]),
        ("", {"a": "x>y", "b": "p>q", "c": "q>y"}, []),
    ],
)
def test_nodes_whose_transforms_are_apart(
    description: str, senders: dict[str, str], apart: list[str]
) -> None:
    tree = (edge(pair(it), "/robot_state_publisher") for it in description.split())
    sent = (edge(pair(text), f"/{node}") for node, text in senders.items())
    assert [it.node for it in told(*tree, *sent)] == apart


@pytest.mark.more
def test_a_tree_that_the_rewrite_has_cut_is_an_error(tmp_path: Path) -> None:
    write_files(tmp_path, FILES)
    plan = plan_fleet(read_fleet(str(tmp_path / "fleet.yaml"), "", {}))
    key = ("robot1", "ekf_filter_node")
    assert plan.fleet.edges[key]
    for cut, levels in (([pair("x>y")], ["error"]), (plan.fleet.edges[key], [])):
        fleet = plan.fleet._replace(edges={**plan.fleet.edges, key: cut})
        found = [it.level for it in gaps_of(plan, fleet, []) if it.code == "MG406"]
        assert found == levels


HERE = Place("ekf.yaml", 5)


def ekf(name: str = "ekf", **values: object) -> Run:
    given = {it: Given(value, HERE) for it, value in values.items()}  # type: ignore[arg-type]
    return run_given(name, "ekf_filter_node", "", given, HERE)  # type: ignore[arg-type]


OFF = ekf(publish_tf=False, odom_frame="odom", base_link_frame="base", world_frame="odom")


def off(*given: Run) -> list[Edge]:
    return list(edges_off(given, load_nodes(NEWEST_LTS)))


def test_a_transform_that_is_switched_off_and_that_nobody_sends() -> None:
    one, both = told(*off(OFF)), told(*off(OFF, OFF._replace(name="second")))
    for (found,), level in ((one, "warning"), (both, "error")):
        assert (found.names, found.node, found.level) == (("base",), "/ekf", level)
        assert (found.file, found.line) == HERE[:2]


def test_a_transform_that_another_one_sends_is_whole() -> None:
    assert told(*off(OFF), edge(pair("odom>base"), "/driver")) == []


def test_a_filter_of_the_map_would_send_another_one() -> None:
    of_map = OFF._replace(values={**OFF.values, "world_frame": Given("map", HERE)})  # type: ignore[arg-type]
    assert [it.names for it in told(*off(of_map))] == [("odom",)]


DRIVE = fixture_text("frames_drive.urdf")
AMCL = (
    "amcl: {ros__parameters: {base_frame_id: base_link, odom_frame_id: ODOM, scan_topic: scan}}\n"
)
SIMULATED = """\
description: r.urdf
simulator: gazebo
node_sets: [navigation]
related_files: {params: [p.yaml]}
robots: [{name: r1}, {name: r2}]
"""


@pytest.mark.parametrize("layout", ["postfix", "frames-per-robot"])
@pytest.mark.parametrize(("odom", "levels"), [("odom", []), ("other", ["warning"])])
def test_what_the_sources_cut_from_a_simulators_odometry_is_no_error(
    layout: str, odom: str, levels: list[str], tmp_path: Path
) -> None:
    files = {"r.urdf": DRIVE, "p.yaml": AMCL.replace("ODOM", odom), "fleet.yaml": SIMULATED}
    built, _ = open_findings.found(tmp_path, files, layout)
    cut = [it for it in built if it.code == "MG406"]
    assert [it.level for it in cut] == levels
    assert all("sends map -> other, apart from odom -> base_link" in it.message for it in cut)
