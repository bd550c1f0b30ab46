# SPDX-License-Identifier: Apache-2.0
"""``multibot rehearse`` on a real graph: every layout holds, what leaks is shown, nothing is left."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

import live_commands
import live_fleet
import pytest
import tf2_build
from paths import ROBOTS
from waiting import wait_until

from multibot_rewrite.system.json import from_json
from multibot_rewrite.system.records import System

pytestmark = pytest.mark.live

pytest.importorskip("rclpy", reason="no rclpy: pip install '.[ros]'", exc_type=ImportError)
COMMAND = [sys.executable, "-m", "multibot_rewrite.cli.multibot", "rehearse"]
ROVER = str(ROBOTS / "rover.urdf")
PAIR = (ROVER, "robot1", "robot2")
STATE = (*PAIR, "--node-set", "robot_state", "--layout")


def domain(offset: int) -> int:
    """Return a domain of this test's own."""
    return live_commands.domain(80 + offset)


def rehearse(offset: int, *arguments: str, **more: str) -> subprocess.CompletedProcess[str]:
    env = {**live_fleet.environ(domain(offset)), **more}
    words = ("rehearse", *arguments, "--domain", domain(offset), *live_commands.PATIENTLY)
    return live_commands.multibot(*words, env=env)


def words_for(layout: str, folder: Path) -> tuple[str, ...]:
    """Return a rehearsal of a layout, with what it writes."""
    written = ("--save-snapshot", str(folder / layout), "--report", str(folder / f"{layout}.html"))
    return (*PAIR, "--node-set", "nav2", "--layout", layout, "--distro", "lyrical", *written)


@pytest.mark.deep
@pytest.mark.parametrize("layout", ["L1", "L2", "L3", "L4"])
def test_every_layout_holds(layout: str, tmp_path: Path) -> None:
    done = rehearse(0, *words_for(layout, tmp_path))
    assert_it_holds(done, layout, tmp_path / layout)


def assert_it_holds(done: subprocess.CompletedProcess[str], layout: str, file: Path) -> None:
    assert (done.returncode, done.stdout) == (0, ""), done.stderr
    assert "2 robots, " in done.stderr
    assert ": all known, all seen; 0 findings: as planned" in done.stderr
    graph = from_json(file.read_bytes(), "graph")
    # The tree is on the graph, too: from the map to every link of both robots.
    assert len({frame.child for frame in graph.edges}) == (9 if layout == "L1" else 18)
    # Nodes that stand in for others do not know where a frame is.
    assert {frame.transform for frame in graph.edges} == {()}
    assert not [node for node in graph.nodes if not _of_a_robot(node.name)]
    # 18 of each robot: with those of route_server and of following_server, which is new in Lyrical.
    assert len(actions(graph)) == 36
    page = file.with_suffix(".html").read_text()
    assert "as planned" in page
    assert "/navigate_to_pose" in page


def _of_a_robot(name: str) -> bool:
    return "robot1" in name or "robot2" in name or "transform_listener_impl" in name


def actions(graph: System) -> set[str]:
    names = (end.name for end in graph.ends if end.role == "serves")
    return {name for name in names if name.endswith("/_action/send_goal")}


@pytest.mark.deep
def test_without_rules_it_leaks_and_is_reported() -> None:
    done = rehearse(1, *STATE, "tf-per-robot", "--without-rules", "all", "-v")
    assert done.returncode == 1, done.stderr
    assert "graph: error: MG402 robot1 and robot2 send frames without" in done.stdout
    assert "/robot2/robot_state_publisher" in done.stdout.partition("the same for ")[2]


@pytest.mark.deep
def test_a_node_set_that_leaks_is_shown_leaking(tmp_path: Path) -> None:
    own = tmp_path / "own.yaml"
    own.write_text(
        "nodes:\n"
        "  siren:\n"
        "    package: siren\n"
        "    publishes:\n"
        "      /alarm: {type: std_msgs/msg/String, fixed: it is written in its code}\n"
        "node_sets:\n"
        "  mine: {nodes: [siren]}\n"
    )
    done = rehearse(5, *PAIR, "--nodes", str(own), "--node-set", "mine", "--layout", "L2", "-v")
    assert done.returncode == 1
    several = "uses /alarm, which the plan has for several robots: robot1, robot2"
    assert f"/robot1/siren: error: MG320 {several}" in done.stdout
    assert "robot_state_publisher" not in done.stdout


@pytest.mark.deep
def test_many_robots_share_processes() -> None:
    names = [f"robot{at}" for at in range(1, 13)]
    done = rehearse(6, ROVER, *names, "--node-set", "robot_state", "--layout", "L2")
    assert (done.returncode, done.stdout) == (0, ""), done.stderr
    # Two of the node set and five plugins.
    assert "12 robots, 6 nodes each: all known, all seen; 0 findings: as planned" in done.stderr


def test_tf_is_its_own_type_where_it_is_installed(tf2: dict[str, str]) -> None:
    if not tf2 and not find_spec("tf2_msgs"):
        pytest.skip(f"tf2_msgs is not there and not built: {tf2_build.missing()}")
    done = rehearse(2, *STATE, "L3", **tf2)
    assert (done.returncode, done.stdout) == (0, ""), done.stderr
    assert "replaced by others" not in done.stderr


def test_a_missing_rclpy_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "rclpy.py").write_text("raise ImportError('not here')\n")
    path = os.pathsep.join(filter(None, [str(tmp_path), os.environ.get("PYTHONPATH", "")]))
    done = rehearse(8, *PAIR, "--layout", "L2", PYTHONPATH=path)
    assert done.returncode == 4
    assert "rclpy cannot be imported" in done.stderr.splitlines()[-1]
    assert "Traceback" not in done.stderr


def children(pid: int) -> Iterator[int]:
    """Yield the processes that ``pid`` started."""
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if int(fields[1]) == pid:
            yield int(stat.parent.name)


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="no /proc to look for children")
@pytest.mark.parametrize(
    "number", [signal.SIGINT, pytest.param(signal.SIGKILL, marks=pytest.mark.deep)]
)
def test_no_node_is_left(number: signal.Signals) -> None:
    command = [*COMMAND, *STATE, "L2", "--domain", str(domain(9))]
    env = live_fleet.environ(domain(9))
    play = subprocess.Popen(command, env=env, stderr=subprocess.PIPE, text=True)
    try:
        wait_until(lambda: len(list(children(play.pid))) >= 2)
        there = list(children(play.pid))
        play.send_signal(number)
        _, said = play.communicate(timeout=20)
        assert play.returncode == (-number if number == signal.SIGKILL else 130)
        assert "Traceback" not in said
        wait_until(lambda: not any(Path(f"/proc/{pid}").exists() for pid in there))
    finally:
        play.kill()
        play.wait()


@pytest.mark.deep
def test_no_fixed_transform_of_a_large_fleet_is_lost(tmp_path: Path) -> None:
    """Without tf2_msgs each is a message of its own, and all robots share /tf_static."""
    links = "".join(
        f'<link name="l{at}"/><joint name="j{at}" type="fixed">'
        f'<parent link="l{at - 1}"/><child link="l{at}"/></joint>'
        for at in range(1, 120)
    )
    robot = tmp_path / "long.urdf"
    robot.write_text(f'<robot name="long"><link name="l0"/>{links}</robot>')
    done = rehearse(7, str(robot), "robot1", "robot2", "--layout", "L2", "--distro", "jazzy")
    assert done.returncode == 0, done.stdout + done.stderr
