# SPDX-License-Identifier: Apache-2.0
"""What cannot be told from a view is called inconclusive; what keeps from looking has one line."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import IO, Any

import live_fleet
import pytest
from live_commands import (
    COMMAND,
    PATIENTLY,
    assert_inconclusive,
    domain,
    multibot,
    node,
    write_plan,
)
from network_hosts import THIS, discovery_server

from multibot_rewrite.system.environment import setting_caveats, settings, view_caveats
from multibot_rewrite.system.json import to_json
from multibot_rewrite.system.records import (
    PUBLISHES,
    QUIET,
    TOPIC,
    UNKNOWN_NODE,
    Caveat,
    End,
    Environment,
    Node,
    System,
)

pytestmark = pytest.mark.live

ROBOTS = ("robot1", "robot2")
LIMIT = 32
# What rmw keeps of a process that did not say good-bye, with some slack.


@pytest.fixture
def ros() -> None:
    """rclpy for the children, or a skip."""
    pytest.importorskip("rclpy", reason="no rclpy: pip install '.[ros]'", exc_type=ImportError)


@pytest.fixture
def plan(tmp_path: Path) -> Path:
    return write_plan(tmp_path / "plan.yaml", ROBOTS)


def check(
    plan: Path, offset: int, *arguments: str, **more: str
) -> subprocess.CompletedProcess[str]:
    return multibot("check", plan, *arguments, env={**live_fleet.environ(domain(offset)), **more})


# --- more participants than are looked for


def crowd(count: int) -> tuple[list[str], list[dict[str, Any]]]:
    """Robots with two nodes each, every node a participant; the second nodes come last."""
    names = [f"robot{number}" for number in range(1, count // 2 + 1)]
    return names, [node(robot, it, alone=True) for it in ("drive", "pilot") for robot in names]


Done = subprocess.CompletedProcess[str]


def at_a_crowd(folder: Path) -> Done:
    names, nodes = crowd(36)
    plan = write_plan(folder / "crowd.yaml", names, ("drive", "pilot"))
    with live_fleet.running(domain(80), nodes):
        return check(plan, 80, "-v", *PATIENTLY)


def elsewhere(folder: Path) -> Done:
    plan = write_plan(folder / "plan.yaml", ROBOTS)
    with live_fleet.running(domain(85), [node("robot1")], [node("robot2")]):
        return check(plan, 86)


@pytest.mark.deep
def test_the_participants_beyond_32_are_not_called_missing(ros: None, tmp_path: Path) -> None:
    done = at_a_crowd(tmp_path)
    assert_inconclusive(done)
    assert done.stdout.count(": inconclusive: MG101 node /robot") == 36 - LIMIT
    *reasons, verdict, _ = done.stderr.splitlines()
    (limit,) = (it for it in reasons if "32 participants of one machine under LOCALHOST" in it)
    # On a busy machine there are more reasons.
    assert f"{LIMIT} of about 36 nodes seen: 4 of 36 programs" in "\n".join(reasons)
    assert "use range SUBNET for all, or a discovery server with ROS_SUPER_CLIENT=TRUE" in limit
    assert verdict.endswith("inconclusive, the view may be incomplete")


@pytest.mark.deep
@pytest.mark.parametrize("count", [30, 32, 34])
def test_how_many_participants_are_seen(ros: None, count: int, tmp_path: Path) -> None:
    names, nodes = crowd(count)
    plan = write_plan(tmp_path / "plan.yaml", names, ("drive", "pilot"))
    with live_fleet.running(domain(81), nodes):
        done = check(plan, 81, "-v")
    # Of a robot without any node that alone is told.
    absent = done.stdout.count("MG101") + 2 * done.stdout.count("MG109")
    assert absent == max(0, count - LIMIT)
    if count < LIMIT:
        assert done.returncode == 0, done.stdout + done.stderr
    else:
        assert_inconclusive(done)


def seen(*machines: tuple[str, int], **environ: str) -> list[str]:
    """Return the caveats where so many Fast DDS participants of these machines are seen."""
    names = [f"010f{machine}{at:016x}" for machine, count in machines for at in range(count)]
    nodes = [Node(f"/{name}", name) for name in names]
    ends = [end(f"/{name}", name) for name in names]
    return [caveat.code for caveat in view_caveats(nodes, ends, settings(environ), QUIET)]


def end(owner: str, process: str = "") -> End:
    type_ = "std_msgs/msg/Empty"
    return End(TOPIC, PUBLISHES, "/heartbeat", type_, "", owner, None, process)


def test_the_limit_is_that_of_each_machine() -> None:
    local = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST", "ROS_STATIC_PEERS": "one;two"}
    assert seen(("aaaa", 20), ("bbbb", 20), **local) == []
    assert seen(("aaaa", 20), ("bbbb", 32), **local) == ["participant-limit"]


def test_few_participants_of_a_peer_may_not_be_all() -> None:
    peers = {"ROS_STATIC_PEERS": "one;two"}
    assert seen(("aaaa", 5), ("bbbb", 4), **peers) == ["peer-limit"]
    assert seen(("aaaa", 5), ("bbbb", 3), **peers) == ["peer-limit"]
    assert seen(("aaaa", 5), ("bbbb", 5), **peers) == []
    assert seen(("aaaa", 3)) == []
    assert seen(("aaaa", 3), **peers, ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST") == []
    assert seen(("aaaa", 3), **peers, ROS_DISCOVERY_SERVER="a:1") == []


def test_peers_that_are_not_read_are_a_caveat() -> None:
    environ = {"ROS_STATIC_PEERS": "one", "ROS_AUTOMATIC_DISCOVERY_RANGE": "SYSTEM_DEFAULT"}
    assert [(it.code, it.incomplete) for it in setting_caveats(environ)] == [("peers-unread", True)]
    assert list(setting_caveats({**environ, "ROS_STATIC_PEERS": ""})) == []


# --- what died without a good-bye


@contextmanager
def watching(plan: Path, offset: int) -> Iterator[IO[str]]:
    """Yield the lines of ``check --watch`` as they come."""
    env = {**live_fleet.environ(domain(offset)), "PYTHONUNBUFFERED": "1"}
    command = [*COMMAND, "check", str(plan), "--watch", "--timeout", "90"]
    with subprocess.Popen(command, env=env, stdout=subprocess.PIPE, text=True) as watch:
        assert watch.stdout is not None
        try:
            yield watch.stdout
        finally:
            watch.send_signal(signal.SIGINT)


def wait_for(lines: IO[str], *words: str) -> str:
    """Return the next line with all these words; the watch itself ends after a while."""
    for line in lines:
        if all(word in line for word in words):
            return line
    raise AssertionError(f"never seen: {words}")


@contextmanager
def one_robot_killed(plan: Path, offset: int) -> Iterator[IO[str]]:
    """Yield what a watch tells after a robot was killed before its eyes and started again."""
    own = domain(offset)
    with live_fleet.running(own, [node("robot1")], [node("robot2")]) as (one, _), ExitStack() as up:
        lines = up.enter_context(watching(plan, offset))
        wait_for(lines, "2 robots, 1 node each: all known, all seen; ")
        one.kill()
        up.enter_context(live_fleet.running(own, [node("robot1")]))
        yield lines


@pytest.mark.deep
def test_a_killed_node_stays_visible_to_who_saw_it_alive(ros: None, plan: Path) -> None:
    """Who looks later does not see it."""
    with one_robot_killed(plan, 82) as lines:
        twins = wait_for(lines, "+ /robot1/drive", "MG301 2 nodes have the name")
        fresh = check(plan, 82)
    assert "a node that was killed stays visible for 20 s" in twins
    assert (fresh.returncode, fresh.stdout) == (0, ""), fresh.stderr


@pytest.mark.deep
def test_after_its_lease_a_dead_node_is_gone(ros: None, plan: Path) -> None:
    with one_robot_killed(plan, 83) as lines:
        wait_for(lines, "+ /robot1/drive", "MG301")
        wait_for(lines, "- /robot1/drive", "MG301")
        wait_for(lines, "2 robots, 1 node each: all known, all seen; ", "0 findings", "as planned")


@pytest.mark.deep
def test_a_node_killed_while_it_is_observed_is_not_there_twice(ros: None, plan: Path) -> None:
    own = domain(88)
    robots = [node("robot1")], [node("robot2")]
    command = [*COMMAND, "check", str(plan), *PATIENTLY]
    with live_fleet.running(own, *robots) as (one, _), ExitStack() as up:
        env = live_fleet.environ(own)
        look = subprocess.Popen(command, env=env, stdout=subprocess.PIPE, text=True)
        up.enter_context(look)
        time.sleep(3.4)
        one.kill()
        up.enter_context(live_fleet.running(own, [node("robot1")]))
        out, _ = look.communicate()
    # Killed before it told its name, it is endpoints without a node: inconclusive, no error either.
    assert look.returncode in (0, 3)
    assert out == ""


# --- a looking process that is held up


def child_of(pid: int) -> int:
    """Return the one child of a process, waited for."""
    children = Path(f"/proc/{pid}/task/{pid}/children")
    while not children.read_text():
        time.sleep(0.01)
    return int(children.read_text())


@pytest.mark.deep
@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="no /proc to look for children")
def test_a_pause_of_the_observing_process_is_not_quiet_time(ros: None, tmp_path: Path) -> None:
    """A busy machine may hold it up while the graph comes in."""
    names, nodes = crowd(30)
    plan = write_plan(tmp_path / "plan.yaml", names, ("drive", "pilot"))
    with live_fleet.running(domain(89), nodes):
        command = [*COMMAND, "check", str(plan), *PATIENTLY]
        env = live_fleet.environ(domain(89))
        with subprocess.Popen(command, env=env, stdout=subprocess.PIPE, text=True) as look:
            child = child_of(look.pid)
            time.sleep(0.7)
            os.kill(child, signal.SIGSTOP)
            time.sleep(4)
            os.kill(child, signal.SIGCONT)
            out, _ = look.communicate()
    assert (look.returncode, out) == (0, "")


def test_a_program_that_is_stopped_makes_the_view_incomplete(ros: None) -> None:
    """Its ports are open, and it answers nobody: neither fine nor missing."""
    env = live_fleet.environ(domain(92))
    with live_fleet.running(domain(92), *([node(it)] for it in ROBOTS)) as (first, _):
        first.send_signal(signal.SIGSTOP)
        try:
            done = multibot("check", *PATIENTLY, env=env)
        finally:
            first.send_signal(signal.SIGCONT)
        again = multibot("check", *PATIENTLY, env=env)
    assert_inconclusive(done)
    said = "incomplete: 1 of about 2 nodes seen: 1 of 2 programs in this domain on this machine"
    assert said in done.stderr
    assert again.returncode == 0, again.stderr


def free_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind((THIS.address, 0))
        port: int = probe.getsockname()[1]
        return port


@pytest.mark.deep
def test_a_dead_node_behind_a_server_is_endpoints_without_a_name(ros: None, plan: Path) -> None:
    """A server keeps endpoints of the dead for newcomers, but not whose they were."""
    own = domain(84)
    with discovery_server(THIS, free_port()) as address:
        server = {"ROS_DISCOVERY_SERVER": address}
        with live_fleet.running(own, [node("robot1")], [node("robot2")], **server) as (one, _):
            # The server has nothing to keep of a node it has not been told of.
            env = {**live_fleet.environ(own), **server, "ROS_SUPER_CLIENT": "TRUE"}
            there = multibot("snapshot", "--expect", "/robot1/drive", *PATIENTLY, env=env)
            one.kill()
            done = check(plan, 84, **server, ROS_SUPER_CLIENT="TRUE")
    assert there.returncode == 0, there.stderr
    assert_inconclusive(done)
    assert "robot1: inconclusive: MG109" in done.stdout
    assert "endpoints whose node is not known yet" in done.stderr


def test_endpoints_without_a_name_in_a_file(plan: Path, tmp_path: Path) -> None:
    nobody = f"/{UNKNOWN_NODE}"
    caveats = tuple(view_caveats([Node("/robot2/drive", "")], [end(nobody)], settings({}), QUIET))
    file = tmp_path / "graph.json"
    file.write_bytes(to_json(snapshot(caveats)))
    done = multibot("check", plan, "--from", file, env=os.environ)
    assert_inconclusive(done)
    assert "robot1: inconclusive: MG109" in done.stdout
    assert "/robot2/drive: inconclusive: MG102" in done.stdout
    assert "endpoints whose node is not known yet: /heartbeat; look again" in done.stderr


def snapshot(caveats: tuple[Caveat, ...]) -> System:
    around = Environment(0, "SUBNET", (), "rmw_fastrtps_cpp", "", False, 1, QUIET, 4.0, caveats)
    nodes = (Node("/robot2/drive", ""),)
    return System(nodes, (end(f"/{UNKNOWN_NODE}"),), (), around)


# --- looking elsewhere, or not at all


def test_another_domain_is_named(ros: None, tmp_path: Path) -> None:
    done = elsewhere(tmp_path)
    assert_inconclusive(done)
    nothing, _ = done.stderr.splitlines()
    assert f"no node was seen (domain {domain(86)}, range LOCALHOST)" in nothing
    assert "do the robots use this ROS_DOMAIN_ID and discovery range?" in nothing


@pytest.mark.parametrize(
    ("environ", "words"),
    [
        ({}, "(domain 0, range SUBNET); do the robots use this ROS_DOMAIN_ID"),
        ({"ROS_STATIC_PEERS": "a;b"}, "(domain 0, range SUBNET, peers a b); do the robots"),
        ({"ROS_DISCOVERY_SERVER": "a:1"}, "discovery server a:1); is the server running there"),
        ({"ROS_LOCALHOST_ONLY": "1"}, "For robots on other machines set ROS_STATIC_PEERS"),
    ],
)
def test_a_view_without_nodes_has_its_environment(environ: dict[str, str], words: str) -> None:
    (nothing,) = view_caveats([], [], settings(environ), QUIET)
    assert words in nothing.message


def test_a_wrong_rmw(ros: None, plan: Path) -> None:
    done = check(plan, 87, RMW_IMPLEMENTATION="rmw_nonsense")
    assert (done.returncode, done.stdout) == (4, "")
    (line,) = done.stderr.splitlines()
    assert "RMW_IMPLEMENTATION='rmw_nonsense' is not available to this rclpy; unset it" in line


@pytest.mark.parametrize("error", ["ModuleNotFoundError", "OSError"])
def test_a_missing_or_broken_rclpy(error: str, plan: Path, tmp_path: Path) -> None:
    (tmp_path / "rclpy.py").write_text(f"raise {error}('not here')\n")
    path = os.pathsep.join(filter(None, [str(tmp_path), os.environ.get("PYTHONPATH", "")]))
    done = check(plan, 87, PYTHONPATH=path)
    assert (done.returncode, done.stdout) == (4, "")
    (line,) = done.stderr.splitlines()
    assert f"rclpy cannot be imported ({error}: not here)" in line
    assert "pip install 'multibot_rewrite[ros]'" in line


@pytest.mark.parametrize("word", ["abc", "233"])
def test_an_invalid_domain(word: str, plan: Path) -> None:
    done = check(plan, 87, ROS_DOMAIN_ID=word)
    assert (done.returncode, done.stdout) == (2, "")
    (line,) = done.stderr.splitlines()
    assert word in line
    assert "give 0 to 232" in line


@pytest.mark.parametrize("peers", ["10.0.0.1,10.0.0.2", "10.0.0.1; 10.0.0.2", "one two"])
def test_invalid_peers(peers: str, plan: Path) -> None:
    """rmw gives up on these without a message of its own."""
    done = check(plan, 87, ROS_STATIC_PEERS=peers)
    assert (done.returncode, done.stdout) == (2, "")
    (line,) = done.stderr.splitlines()
    assert f"ROS_STATIC_PEERS={peers!r}" in line
    assert "with only ; between them" in line
