# SPDX-License-Identifier: Apache-2.0
"""``multibot snapshot`` against real nodes, each test run in DDS domains of its own."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import live_commands
import live_fleet
import pytest
import tf2_build
from live_commands import PATIENTLY, domain
from waiting import wait_until

from multibot_rewrite.producers.ros import ros
from multibot_rewrite.producers.ros.assemble import ALL_KNOWN_SECONDS
from multibot_rewrite.producers.ros.child import observe
from multibot_rewrite.producers.ros.request import Request
from multibot_rewrite.system.json import from_json, to_json
from multibot_rewrite.system.records import EXPECTED, QUIET, TIMEOUT, Edge, End, System

pytestmark = pytest.mark.live

pytest.importorskip("rclpy", reason="no rclpy: pip install '.[ros]'", exc_type=ImportError)

COMMAND = [sys.executable, "-m", "multibot_rewrite.cli.multibot", "snapshot"]
TF_TYPE = "tf2_msgs/msg/TFMessage"
Build = dict[str, str]


def multibot(offset: int, *arguments: str, **more: str) -> subprocess.CompletedProcess[str]:
    env = {**live_fleet.environ(domain(offset)), **more}
    return live_commands.multibot("snapshot", *arguments, env=env)


@pytest.fixture(scope="module")
def has_tf(tf2: Build) -> bool:
    return bool(tf2) or find_spec("tf2_msgs") is not None


def robot(name: str) -> list[dict[str, Any]]:
    drive = {
        "name": "drive",
        "namespace": name,
        "publishers": [["odom", "String", "best_effort"], ["/heartbeat", "Empty", "deadline"]],
        "subscriptions": [["cmd_vel", "String"]],
        "services": [["reset", "Trigger"]],
    }
    pilot = {
        "name": "pilot",
        "namespace": name,
        "publishers": [["cmd_vel", "String", "latched"]],
        "subscriptions": [["odom", "String"]],
        "clients": [["reset", "Trigger"]],
    }
    return [drive, pilot]


def with_tf(nodes: list[dict[str, Any]], name: str) -> list[dict[str, Any]]:
    frames = [
        ["tf", False, ["odom", "base_link"]],
        ["/tf_static", True, ["base_link", "lidar"], ["base_link", f"{name}/imu"]],
    ]
    state = {"name": "state", "namespace": name, "frames": frames}
    docking = {"name": "dock", "namespace": name, "actions": [["go", "LookupTransform"]]}
    return [*nodes, state, docking]


@pytest.fixture(scope="module")
def fleet(tf2: Build, has_tf: bool) -> Iterator[Build]:
    """Two robots, a process each; a third process has a second /robot1/pilot and a bare node."""
    robots = [robot("robot1"), robot("robot2")]
    if has_tf:
        robots = [with_tf(nodes, f"robot{at}") for at, nodes in enumerate(robots, 1)]
    twin = {"name": "pilot", "namespace": "robot1", "publishers": [["twin", "String"]]}
    bare = {"name": "bare", "bare": True}
    with live_fleet.running(domain(0), *robots, [twin], [bare], **tf2):
        yield tf2


@pytest.fixture(scope="module")
def seen(fleet: Build, tmp_path_factory: pytest.TempPathFactory) -> System:
    """Return the whole graph as the command writes it."""
    file = tmp_path_factory.mktemp("graph") / "graph.json"
    result = multibot(0, "-o", str(file), *PATIENTLY, **fleet)
    assert result.returncode == 0, result.stderr
    return from_json(file.read_bytes(), str(file))


def ends(snapshot: System, name: str, role: str) -> list[End]:
    return [end for end in snapshot.ends if (end.name, end.role) == (name, role)]


def test_every_node_is_seen_but_the_observer(seen: System, has_tf: bool) -> None:
    names = [node.name for node in seen.nodes]
    own = ["drive", "pilot", *(["state", "dock"] if has_tf else [])]
    expected = [f"/robot{at}/{name}" for at in (1, 2) for name in own]
    assert names == sorted([*expected, "/robot1/pilot", "/bare"])
    assert not [end for end in seen.ends if "_multibot" in end.node]


def test_a_topic_has_both_sides_with_type_hash_and_process(seen: System) -> None:
    (sends,) = ends(seen, "/robot2/cmd_vel", "publishes")
    (reads,) = ends(seen, "/robot2/cmd_vel", "subscribes")
    assert (sends.node, reads.node) == ("/robot2/pilot", "/robot2/drive")
    assert sends.type == reads.type == "std_msgs/msg/String"
    assert sends.type_hash == reads.type_hash
    assert sends.type_hash.startswith("RIHS01_")
    assert len(sends.process) == 24
    assert sends.process == reads.process


def test_qos_is_in_the_snapshot(seen: System) -> None:
    (sends,) = ends(seen, "/robot1/odom", "publishes")
    (reads,) = ends(seen, "/robot1/odom", "subscribes")
    (keeps,) = ends(seen, "/robot1/cmd_vel", "publishes")
    assert sends.qos and reads.qos and keeps.qos
    assert (sends.qos.reliability, reads.qos.reliability) == ("BEST_EFFORT", "RELIABLE")
    assert (reads.qos.durability, keeps.qos.durability) == ("VOLATILE", "TRANSIENT_LOCAL")
    assert sends.qos.deadline == float("inf")


def test_services_and_their_clients_are_in_the_snapshot(seen: System) -> None:
    (serves,) = ends(seen, "/robot1/reset", "serves")
    assert (serves.kind, serves.node) == ("service", "/robot1/drive")
    assert serves.type == "std_srvs/srv/Trigger"
    (calls,) = ends(seen, "/robot2/reset", "calls")
    assert calls.node == "/robot2/pilot"


def test_two_nodes_of_one_name_are_two(seen: System) -> None:
    twins = [node for node in seen.nodes if node.name == "/robot1/pilot"]
    assert len({node.process for node in twins}) == 2
    (hidden,) = ends(seen, "/robot1/twin", "publishes")
    (shown,) = ends(seen, "/robot1/cmd_vel", "publishes")
    assert hidden.node == shown.node == "/robot1/pilot"
    assert {hidden.process, shown.process} == {node.process for node in twins}
    assert [c.code for c in seen.environment.caveats if c.code == "same-name"] == ["same-name"]


def test_the_environment_is_shown(seen: System) -> None:
    around = seen.environment
    assert (around.domain, around.range, around.rmw) == (domain(0), "LOCALHOST", "rmw_fastrtps_cpp")
    assert around.settled == QUIET
    assert around.seconds >= ALL_KNOWN_SECONDS
    # The bare node tells its process by its service only.
    assert around.participants == 4
    assert "" not in {node.process for node in seen.nodes}


def test_a_snapshot_of_real_nodes_survives_the_file(seen: System) -> None:
    assert from_json(to_json(seen), "again") == seen


def test_frames_have_topic_and_publishers(seen: System, has_tf: bool) -> None:
    if not has_tf:
        pytest.skip(f"tf2_msgs is not there and not built: {tf2_build.missing()}")
    states = ("/robot1/state", "/robot2/state")
    assert {it.transform for it in seen.edges} == {(1.5, 0, 0, 0, 0, 0, 1)}
    assert {it._replace(transform=(), rate=0.0) for it in seen.edges} == {
        Edge("base_link", "odom", "/robot1/tf", False, ("/robot1/state",)),
        Edge("base_link", "odom", "/robot2/tf", False, ("/robot2/state",)),
        Edge("lidar", "base_link", "/tf_static", True, states, several=True),
        Edge("robot1/imu", "base_link", "/tf_static", True, states),
        Edge("robot2/imu", "base_link", "/tf_static", True, states),
    }


def test_actions_are_in_the_snapshot(seen: System, has_tf: bool) -> None:
    if not has_tf:
        pytest.skip(f"no action type: tf2_msgs is not there: {tf2_build.missing()}")
    (serves,) = ends(seen, "/robot2/go", "serves")
    assert (serves.kind, serves.node) == ("action", "/robot2/dock")
    assert serves.type == "tf2_msgs/action/LookupTransform"


def test_frames_that_could_not_be_read_are_a_caveat(fleet: Build) -> None:
    if not fleet:
        pytest.skip("tf2_msgs was not built for this run, so it cannot be taken away")
    # On a busy machine the expected nodes are there before all of their topics.
    words = ("--expect", "/robot1/state,/robot2/state,/tf_static")
    result = multibot(0, *words, *PATIENTLY)
    assert re.search(
        r"the frames on (/robot1/tf, )?(/robot2/tf, )?/tf_static were not read: No module",
        result.stderr,
    )
    assert result.stdout.splitlines()[2].split()[:3] == ["node", "process", "publishes"]
    assert "/robot2/state" in result.stdout


def test_expected_nodes_end_the_observation_and_a_topic_is_queried(fleet: Build) -> None:
    names = ["/robot1/drive", "/robot2/drive"]

    def deadlines() -> list[float]:
        words = ("-o", "-", "--expect", ",".join([*names, "/heartbeat"]))
        result = multibot(0, *words, *PATIENTLY, **fleet)
        assert result.returncode == 0, result.stderr
        view = from_json(result.stdout.encode(), "stdout")
        if view.environment.settled != EXPECTED:
            return []
        qos = [end.qos for end in ends(view, "/heartbeat", "publishes") if end.node in names]
        assert None not in qos
        return [it.deadline for it in qos if it]

    # On a busy machine the second publisher may come long after its node: nobody can expect it.
    wait_until(lambda: deadlines() == [0.5, 0.5])


def test_what_is_seen_is_told_while_the_graph_is_waited_for(fleet: Build) -> None:
    told: list[str] = []
    observe(Request(15.0), {**live_fleet.environ(domain(0)), **fleet}, told.append)
    # Two nodes have one name, so there is a second look, which begins anew.
    most = max(told, key=lambda it: int(it.split()[0]))
    assert int(most.split()[0]) >= 6
    assert most.endswith(" nodes in robot1, robot2 so far")


def test_a_header_is_known_without_its_message_being_imported() -> None:
    from importlib import import_module

    for package, count in (("sensor_msgs", 27), ("geometry_msgs", 30), ("nav_msgs", 5)):
        module = import_module(f"{package}.msg")
        types = {name: it for name, it in vars(module).items() if isinstance(it, type)}
        assert len(types) >= count
        for name, type_ in types.items():
            first = next(iter(type_.get_fields_and_field_types().values()))
            found = ros.begins_with_header(f"{package}/msg/{name}")
            assert found == (first == "std_msgs/Header"), name
            assert ros.raw_message_class(f"{package}/msg/{name}")[0], name
    assert not ros.begins_with_header("no_such_package/msg/Scan")
    assert ros.raw_message_class("no_such_package/msg/Scan")[1]
    assert ros.raw_message_class("sensor_msgs/msg/NoSuchScan")[1]


def test_a_view_out_of_time_is_written_and_inconclusive(fleet: Build, tmp_path: Path) -> None:
    file = tmp_path / "graph.json"
    result = multibot(0, "-o", str(file), "--timeout", "0.3", **fleet)
    assert result.returncode == 3
    assert "incomplete: the graph was still changing" in result.stderr
    assert from_json(file.read_bytes(), "file").environment.settled == TIMEOUT


def test_an_empty_domain_is_inconclusive() -> None:
    result = multibot(50, "--timeout", "1")
    assert result.returncode == 3
    assert f"no node was seen (domain {domain(50)}, range LOCALHOST)" in result.stderr


def test_a_wrong_rmw_is_one_line() -> None:
    result = multibot(1, RMW_IMPLEMENTATION="rmw_nonsense_cpp")
    assert result.returncode == 4
    (line,) = result.stderr.splitlines()
    assert "RMW_IMPLEMENTATION='rmw_nonsense_cpp'" in line


@pytest.mark.parametrize("error", ["ModuleNotFoundError", "OSError"])
def test_a_missing_or_broken_rclpy_is_one_line(error: str, tmp_path: Path) -> None:
    (tmp_path / "rclpy.py").write_text(f"raise {error}('not here')\n")
    path = os.pathsep.join(filter(None, [str(tmp_path), os.environ.get("PYTHONPATH", "")]))
    file = tmp_path / "graph.json"
    result = multibot(1, "-o", str(file), PYTHONPATH=path)
    assert result.returncode == 4
    (line,) = result.stderr.splitlines()
    assert f"rclpy cannot be imported ({error}: not here)" in line
    assert "pip install 'multibot_rewrite[ros]'" in line
    assert not file.exists()


def test_a_domain_that_ends_rcl_without_a_word_has_a_message() -> None:
    for word in ("233", "abc", "-1"):
        result = multibot(1, ROS_DOMAIN_ID=word)
        assert result.returncode == 2
        (line,) = result.stderr.splitlines()
        assert word in line
        assert "give 0 to 232" in line


def children(pid: int) -> list[int]:
    """Return the processes that ``pid`` started."""
    found = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if int(fields[1]) == pid:
            found.append(int(stat.parent.name))
    return found


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="no /proc to look for children")
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT, signal.SIGKILL])
def test_no_child_is_left(number: signal.Signals) -> None:
    env = live_fleet.environ(domain(2))
    command = subprocess.Popen([*COMMAND], env=env, stderr=subprocess.PIPE, text=True)
    try:
        (child,) = wait_until(lambda: children(command.pid))
        # Long enough that rclpy is up.
        time.sleep(0.8)
        assert Path(f"/proc/{child}").exists()
        command.send_signal(number)
        _, said = command.communicate(timeout=15)
        assert command.returncode == (-number if number == signal.SIGKILL else 130)
        assert "Traceback" not in said
        wait_until(lambda: not Path(f"/proc/{child}").exists())
    finally:
        command.kill()
        command.wait()


GONE = """
import rclpy
from multibot_rewrite.producers.ros import ros
rclpy.init()
node = rclpy.create_node("looks")
for query in (ros.action_servers, ros.action_clients):
    assert query(node, "looks", "/") == []
    try:
        query(node, "left", "/robot1")
    except ros.node_gone_error() as error:
        print(error)
"""


def test_a_node_that_left_between_two_queries_is_no_failure() -> None:
    """Where several look at once, each sees the others come and go."""
    command = [sys.executable, "-c", GONE]
    env = live_fleet.environ(domain(49))
    done = subprocess.run(command, env=env, capture_output=True, text=True, check=False)
    assert done.stdout == "/robot1/left left the graph\n" * 2, done.stderr
