# SPDX-License-Identifier: Apache-2.0
"""The doctor before real nodes: a healthy fleet, and faults put into it while it runs."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

import live_commands
import live_fleet
import live_graphs
import pytest
import tf2_build
from fault_changes import Fault, nav, shared_tf
from graph_cases import sent
from graph_faults import FAULTS, LIVE
from healthy_systems import SYSTEMS
from waiting import wait_until

from multibot_rewrite.live.diagnose import diagnose
from multibot_rewrite.producers.snapshot_file import read_snapshot
from multibot_rewrite.system.parameters import GET_PARAMETERS
from multibot_rewrite.system.records import System, clocks

pytestmark = pytest.mark.live

STATE_TYPE = "lifecycle_msgs.srv.GetState"
AT_ONCE, ROUNDS = 2, 6
# Nothing wrong; or a machine so busy that it cannot be said.
BUSY = 3
QUIET = (0, BUSY)
# Of each robot these are played; of a full system hundreds of endpoints more, which take their time.
PLAYED = (
    "robot_state_publisher", "diff_drive", "lidar_driver", "joint_states", "amcl", "map_server",
    "lifecycle_manager_localization", "collision_monitor", "controller_server", "velocity_smoother",
    "local_costmap", "rviz2", "servo_node",
)  # fmt: skip
HEALTHY = (
    "two arms with MoveIt",
    "SLAM with two filters and GPS",
    "five robots on simulated time",
    "namespaces of two levels",
    "one robot",
)
CODE = re.compile(r"MG\d{3}")
PLANNED = """\
schema: 3
layout: frames-per-robot
robots:
- name: robot1
  frames: [robot1/base_link]
  nodes: [{name: /robot1/amcl, lifecycle: active}]
- name: robot2
  frames: [robot2/base_link]
  nodes: [{name: /robot2/amcl}, {name: /robot2/silent}]
"""
PATIENTLY = ("--timeout", "40", "-v")


class Outcome(NamedTuple):
    code: int
    found: frozenset[str]
    said: str


@pytest.fixture(scope="module")
def needed(tf2: Mapping[str, str]) -> Mapping[str, str]:
    """Return what makes rclpy's children know tf2_msgs; a loud skip where one of the two is missing."""
    pytest.importorskip("rclpy", reason="no rclpy: pip install '.[ros]'", exc_type=ImportError)
    if not tf2 and not find_spec("tf2_msgs"):
        pytest.skip(f"tf2_msgs is not there and not built: {tf2_build.missing()}")
    return tf2


def looked_at(at: int, graph: System, more: Mapping[str, str]) -> Outcome:
    """Return what the command says while nodes play the graph."""
    domain = live_commands.domain(at)
    env = {**live_fleet.environ(domain), **more}
    with live_fleet.running(domain, *live_graphs.processes(graph), **more):
        done = live_commands.multibot("check", *PATIENTLY, env=env)
    lines = [line.partition(": ")[2].split() for line in done.stdout.splitlines()]
    codes = frozenset(words[1] for words in lines if len(words) > 1)
    return Outcome(done.returncode, codes, done.stdout + done.stderr)


def small(graph: System, healthy: System) -> System:
    """Return the graph with the nodes that are played, and those that the healthy system has not."""
    known = {it.name for it in healthy.nodes}
    left_out = {it for it in known if it.rpartition("/")[2] not in PLAYED}
    return sent(
        graph._replace(
            nodes=tuple(it for it in graph.nodes if it.name not in left_out),
            ends=tuple(it for it in graph.ends if it.node not in left_out),
        )
    )


def ill(fault: Fault) -> System:
    healthy = fault.system()
    return small(fault.change(healthy), healthy)


def side_by_side(graphs: Sequence[System], more: Mapping[str, str]) -> list[Outcome]:
    with ThreadPoolExecutor(AT_ONCE) as pool:
        return list(pool.map(lambda it: looked_at(20 + it[0] % 50, it[1], more), enumerate(graphs)))


def test_the_first_fault_live_and_no_fault(needed: Mapping[str, str]) -> None:
    fault = next(it for it in FAULTS if it.name == LIVE[0])
    well, wrong = side_by_side([small(nav(), nav()), ill(fault)], needed)
    assert (well.code, well.found) == (0, frozenset()), well.said
    assert (wrong.code, wrong.found) == (1, {fault.code}), wrong.said
    assert all(word in wrong.said for word in fault.words), wrong.said


@pytest.mark.deep
def test_odometry_of_two_senders_live(needed: Mapping[str, str]) -> None:
    """Which of the nodes sent a transform is nowhere said, that two did is heard."""
    fault = next(it for it in FAULTS if it.code == "MG408")
    (outcome,) = side_by_side([ill(fault)], needed)
    assert (outcome.code, outcome.found) == (1, {"MG408"}), outcome.said
    assert all(word in outcome.said for word in fault.words), outcome.said


def test_what_nodes_send_and_answer(needed: Mapping[str, str], tmp_path: Path) -> None:
    """Headers: best effort, large, latched before the look, another robot's, one that is no frame.
    States: the node that hangs, because nobody spins it, costs the time that is allowed and no more."""
    scan, image, map_, joints = (
        "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/Image", "nav_msgs/msg/OccupancyGrid",
        "sensor_msgs/msg/JointState",
    )  # fmt: skip
    simulated = ["--ros-args", "-p", "use_sim_time:=true"]
    tf = [[f"robot{at}/base", f"robot{at}/laser"] for at in (1, 2)]
    body = [["odom", "nav_msgs/msg/Odometry"], ["joint_states", joints]]
    nodes = [
        {"name": "tf", "frames": [["/tf_static", True, ["map", "robot1/base"], *tf]]},
        {"name": "map_server", "headers": [["/map", map_, "map", "latched"]],
         "subscriptions": [["/map", map_, "latched"]]},
        {"name": "lidar", "namespace": "/robot1", "publishers": body, "state": "active",
         "headers": [["scan", scan, "laser", "best_effort"], ["joints", joints, "hardware"]]},
        {"name": "camera", "namespace": "/robot2", "publishers": body,
         "headers": [["image", image, "robot1/laser", "best_effort"]]},
        {"name": "amcl", "namespace": "/robot1", "state": "inactive", "arguments": simulated},
    ]  # fmt: skip
    hangs = [{"name": "hangs", "namespace": "/robot1", "services": [["~/get_state", STATE_TYPE]]}]
    domain, file = live_commands.domain(18), str(tmp_path / "graph.json")
    env = {**live_fleet.environ(domain), **needed}
    heard = {("/robot1/scan", "laser"), ("/robot2/image", "robot1/laser"), ("/map", "map")}

    def look() -> System | None:
        """Return what is seen once all was heard and announced: a look waits for a message 1.5
        s, a busy machine longer."""
        live_commands.multibot("snapshot", "--state", "-o", file, "--timeout", "40", env=env)
        seen = read_snapshot(file)
        served = ("/robot1/hangs", GET_PARAMETERS) in {(it.node, it.type) for it in seen.ends}
        return seen if served and heard <= {it[:2] for it in seen.heard} else None

    with live_fleet.running(domain, nodes, hangs, **needed):
        seen = wait_until(look, 60)
    # Of joints their names are read, and no frame.
    assert seen and {it[:2] for it in seen.heard} == heard | {("/robot1/joints", "")}
    timed = clocks(seen)
    states = {it.name: (it.lifecycle, timed.get(it.name)) for it in seen.nodes}
    assert states["/robot1/amcl"] == ("inactive", True) and states.get(
        "/robot1/hangs", ("", None)
    ) == ("", None)
    assert states["/robot1/lidar"] == ("active", False) and states["/robot2/camera"] == ("", False)
    # It has parameter services, and nobody answers them.
    (hung,) = [it for it in seen.environment.caveats if it.code == "silent-nodes"]
    assert hung.incomplete and "/robot1/hangs did not answer --state" in hung.message
    said = [str(it) for it in diagnose(seen).findings]
    (bare,) = [it for it in said if "MG412" in it]
    assert "frame_id of /robot1/scan is laser" in bare and "to robot1/laser" in bare
    assert "/robot1/lidar" in bare
    (crossed,) = [it for it in said if "MG411" in it]
    assert "frame_id of /robot2/image is robot1/laser, a frame of robot1" in crossed
    assert {"MG501", "MG511", "MG514"} <= set(CODE.findall("".join(said)))


@pytest.mark.deep
def test_parameters_that_nodes_were_started_with(needed: Mapping[str, str], tmp_path: Path) -> None:
    """One with another value than its file, one as its file says, one that declares none of them."""
    given = {"base_frame": "base_link", "rate": 2.5, "list": ["a", "b"], "grid": [1, 2]}
    right = {**given, "base_frame": "robot2/base_link"}
    nodes = [
        {"name": "amcl", "namespace": "/robot1", "parameters": given, "state": "inactive"},
        {"name": "amcl", "namespace": "/robot2", "parameters": right, "state": "active"},
        {
            "name": "silent",
            "namespace": "/robot2",
            "state": "active",
            "headers": [["scan", "sensor_msgs/msg/LaserScan", "laser"]],
        },
    ]
    for robot in ("robot1", "robot2"):
        (tmp_path / robot).mkdir()
        own = f"{{base_frame: {robot}/base_link, rate: 2.5, list: [a, b], grid: [1, 2], more: 1}}"
        text = "".join(f"/{robot}/{it}: {{ros__parameters: {own}}}\n" for it in ("amcl", "silent"))
        (tmp_path / robot / "nav2.yaml").write_text(text)
    planned = tmp_path / "plan.yaml"
    planned.write_text(PLANNED)
    domain = live_commands.domain(16)
    env = {**live_fleet.environ(domain), **needed}
    with live_fleet.running(domain, nodes, **needed):
        done = live_commands.multibot("check", str(planned), "--state", *PATIENTLY, env=env)
    (differs,) = [it for it in done.stdout.splitlines() if "MG132" in it]
    assert 'base_frame is "base_link", planned is "robot1/base_link"' in differs, done.stdout
    assert "robot1/nav2.yaml:1" in differs and "rate" not in differs
    assert "error: MG511 /robot1/amcl is inactive, not active (see the log" in done.stdout
    assert done.stdout.count("MG511") == 1


@pytest.mark.deep
def test_faults_in_running_systems(needed: Mapping[str, str]) -> None:
    faults = [it for it in FAULTS if it.name in LIVE]
    assert len(faults) == len(LIVE) >= 20
    outcomes = dict(zip(faults, side_by_side([ill(it) for it in faults], needed), strict=True))
    # A process that got no processor may not have announced its nodes, or the look is inconclusive.
    late = [it for it, outcome in outcomes.items() if not outcome.found or outcome.code == BUSY]
    outcomes |= dict(zip(late, side_by_side([ill(it) for it in late], needed), strict=True))
    odd = [
        f"{fault.name}: {outcome.said}"
        for fault, outcome in outcomes.items()
        if fault.code not in outcome.found
        or not outcome.found <= {fault.code, *fault.also}
        or not all(word in outcome.said for word in fault.words)
    ]
    assert odd == [], "\n".join(odd)


@pytest.mark.deep
def test_healthy_systems_live(needed: Mapping[str, str]) -> None:
    graphs = [nav(), shared_tf(), *(SYSTEMS[name]() for name in HEALTHY)]
    outcomes = side_by_side(graphs, needed)
    assert [it.said for it in outcomes if it.found or it.code not in QUIET] == []


@pytest.mark.deep
def test_no_false_finding_in_many_rounds(needed: Mapping[str, str]) -> None:
    outcomes = side_by_side([small(nav(), nav())] * ROUNDS, needed)
    assert [it.said for it in outcomes if it.found or it.code not in QUIET] == []
