# SPDX-License-Identifier: Apache-2.0
"""``multibot snapshot --output-kind nodes`` of real nodes: its table's rules leave no leak."""

from __future__ import annotations

import subprocess
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import live_commands
import live_fleet
import pytest
from live_commands import PATIENTLY

from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.knowledge.node_library import nodes_of_set
from multibot_rewrite.knowledge.node_sets import user_library
from multibot_rewrite.planning.records import Run, Table
from multibot_rewrite.planning.table import build_table
from multibot_rewrite.planning.ways import arguments, started
from multibot_rewrite.system.json import from_json
from multibot_rewrite.system.records import System

pytestmark = pytest.mark.live

pytest.importorskip("rclpy", reason="no rclpy: pip install '.[ros]'", exc_type=ImportError)
ROBOTS = ("robot1", "robot2")
ALWAYS = {"/rosout", "/parameter_events"}
Build = dict[str, str]
# As people write them: some names with a slash, some without, some below the node's own.
DRIVER: dict[str, Any] = {
    "name": "driver",
    "publishers": [["odom", "String"], ["/heartbeat", "Empty"], ["~/state", "String"]],
    "subscriptions": [["/cmd_vel", "String"]],
    "services": [["reset", "Trigger"], ["/estop", "Trigger"], ["~/calibrate", "Trigger"]],
}
PILOT: dict[str, Any] = {
    "name": "pilot",
    "publishers": [["cmd_vel", "String"]],
    "subscriptions": [["/odom", "String"], ["driver/state", "String"]],
    "clients": [["/reset", "Trigger"], ["driver/calibrate", "Trigger"]],
}
# Only with tf2_msgs.
TF = {
    "frames": [["/tf", False, ["odom", "base_link"]], ["/tf_static", True, ["base_link", "eye"]]],
    "actions": [["look", "LookupTransform"], ["/watch", "LookupTransform"]],
}


def domain(offset: int) -> int:
    """Return a domain of this test's own."""
    return live_commands.domain(25 + offset)


def multibot(offset: int, *words: str, **more: str) -> subprocess.CompletedProcess[str]:
    env = {**live_fleet.environ(domain(offset)), **more}
    return live_commands.multibot(*words, env=env)


@pytest.fixture(scope="module")
def code(tf2: Build) -> list[dict[str, Any]]:
    """Return the nodes as they are written."""
    return [{**DRIVER, **TF} if tf2 or find_spec("tf2_msgs") else DRIVER, PILOT]


@pytest.fixture(scope="module")
def files(
    code: list[dict[str, Any]], tf2: Build, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[dict[str, Path]]:
    """Yield what is learned of nodes in the root, live, and in a namespace, by a snapshot."""
    folder = tmp_path_factory.mktemp("learned")
    below = [{**node, "namespace": "old"} for node in code]
    found = {name: folder / f"{name}.yaml" for name in ("root", "below")}
    shot, node_set = str(folder / "graph.json"), ["--node-set", "mine", "-o"]
    with live_fleet.running(domain(0), code, below, **tf2):
        words = (
            "snapshot",
            "--output-kind",
            "nodes",
            "--node",
            "/driver,/pilot",
            *node_set,
            str(found["root"]),
            *PATIENTLY,
        )
        live = multibot(0, *words, **tf2)
        seen = multibot(0, "snapshot", "-o", shot, *PATIENTLY, **tf2)
    words = (
        "snapshot",
        "--output-kind",
        "nodes",
        "--from",
        shot,
        "--namespace",
        "/old",
        *node_set,
        str(found["below"]),
    )
    later = multibot(0, *words)
    for done in (live, seen, later):
        assert done.returncode == 0, done.stderr
    yield found


def table(file: Path, layout: str) -> Table:
    """Return the table of two robots that run what was learned."""
    found = build_table(
        ROBOTS,
        nodes_of_set(user_library(str(file), NEWEST_LTS), "mine"),
        make_naming(layout),
        release=NEWEST_LTS,
    )
    assert found.problems == ()
    return found


def test_names_are_written_as_they_were_seen(files: dict[str, Path]) -> None:
    root, below = files["root"].read_text(), files["below"].read_text()
    for text in (root, below):
        for line in ("/heartbeat: std_msgs/msg/Empty", "~/state: std_msgs/msg/String"):
            assert f"      {line}\n" in text
        assert "~/calibrate: std_srvs/srv/Trigger" in text
        assert "get_parameters" not in text
        assert "_action" not in text
    assert "      /odom: std_msgs/msg/String\n" in root
    assert "      odom: std_msgs/msg/String\n" in below
    assert "      driver/state: std_msgs/msg/String\n" in below


@pytest.mark.parametrize(
    ("learned", "layout"),
    [
        pytest.param("root", "tf-per-robot", marks=pytest.mark.deep),
        pytest.param("root", "frames-per-robot", marks=pytest.mark.deep),
        ("root", "postfix"),
        pytest.param("below", "frames-per-robot", marks=pytest.mark.deep),
    ],
)
def test_started_with_the_rules_nothing_leaks(
    files: dict[str, Path],
    code: list[dict[str, Any]],
    tf2: Build,
    tmp_path: Path,
    learned: str,
    layout: str,
) -> None:
    rules = table(files[learned], layout)
    spec = {node["name"]: node for node in code}
    fleet = [[{**spec[it.node.node], "arguments": arguments(it)}] for it in started(rules)]
    file = tmp_path / "graph.json"
    with live_fleet.running(domain(1), *fleet, **tf2):
        done = multibot(1, "snapshot", "-o", str(file), *PATIENTLY, **tf2)
    assert done.returncode == 0, done.stderr
    graph = from_json(file.read_bytes(), str(file))
    assert said(rules) <= {(e.node, e.kind, e.role, e.name) for e in graph.ends}
    first, second = (names(graph, rules, robot) for robot in ROBOTS)
    assert len(first) > len(ALWAYS) + 10
    assert {name.replace(*ROBOTS) for name in first} == second
    one_tf = "frames" in layout and "frames" in spec["driver"]
    assert first & second == ALWAYS | ({"/tf", "/tf_static"} if one_tf else set())


def said(rules: Table) -> set[tuple[str, str, str, str]]:
    """Where the table says that names lead; what is under a condition may not be there."""
    ends = ((run, end, name) for run, end, name in rules.ends if not end.when)
    return {(run.full_name, end.kind, end.role, name) for run, end, name in ends}


def names(graph: System, rules: Table, robot: str) -> set[str]:
    """All names of a robot's nodes."""
    nodes = {full(node) for node in rules.runs if node.robot == robot}
    assert nodes <= {node.name for node in graph.nodes}
    return {end.name for end in graph.ends if end.node in nodes}


def full(node: Run) -> str:
    return f"{node.namespace.rstrip('/')}/{node.name}"


def test_where_nothing_runs_nothing_is_written(tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    done = multibot(2, "snapshot", "--output-kind", "nodes", "--timeout", "1", "-o", str(file))
    assert (done.returncode, file.exists()) == (2, False)
    assert "incomplete: no node was seen" in done.stderr
    assert "there is no node to learn in this graph" in done.stderr


def test_a_wrong_rmw_is_one_line() -> None:
    done = multibot(2, "snapshot", "--output-kind", "nodes", RMW_IMPLEMENTATION="rmw_nonsense_cpp")
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (4, "", 1)
