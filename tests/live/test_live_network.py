# SPDX-License-Identifier: Apache-2.0
"""``multibot`` and the robots on different hosts: what is seen, and what is said of what is not.

Every host is a network namespace with a /dev/shm of its own (see ``network``).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, ExitStack, contextmanager
from pathlib import Path
from subprocess import CompletedProcess, Popen
from typing import Any

import live_fleet
import pytest
from live_commands import PATIENTLY, assert_inconclusive, multibot, node, write_plan
from network_hosts import Host, discovery_server, hosts, lose_packets, lost_packets
from paths import ROOT

from multibot_rewrite.system.environment import LOCAL_LIMIT

pytestmark = pytest.mark.live
pytest.importorskip("rclpy", reason="no rclpy: pip install '.[ros]'", exc_type=ImportError)
# The hosts are alone in their network, so any will do.
DOMAIN = 7
SUBNET = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"}
LOCALHOST = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
# More than a participant on LOCALHOST looks for.
MANY = [f"robot{number}" for number in range(1, 41)]


@pytest.fixture
def plan(tmp_path: Path) -> Path:
    return write_plan(tmp_path / "plan.yaml", ("robot1", "robot2"))


@contextmanager
def fleet(*places: tuple[Host, list[dict[str, Any]]], **settings: str) -> Iterator[None]:
    """Yield a process on each of these hosts."""
    with ExitStack() as stack:
        for host, nodes in places:
            stack.enter_context(live_fleet.running(DOMAIN, nodes, inside=host.inside, **settings))
        yield


def crowd(
    host: Host, names: Sequence[str], **settings: str
) -> AbstractContextManager[list[Popen[str]]]:
    """All these robots on one host, each a participant."""
    nodes = [node(name, alone=True) for name in names]
    return live_fleet.running(DOMAIN, nodes, inside=host.inside, **settings)


def run(host: Host, *arguments: object, **settings: str) -> CompletedProcess[str]:
    env = {**live_fleet.environ(DOMAIN), **settings}
    return multibot(*arguments, *PATIENTLY, env=env, inside=host.inside)


def test_robots_on_two_hosts_are_checked_from_a_third_by_multicast(plan: Path) -> None:
    with hosts(3) as (one, two, base):
        robots = (one, [node("robot1")]), (two, [node("robot2")])
        with fleet(*robots, **SUBNET):
            done = run(base, "check", plan, "-v", **SUBNET)
    assert (done.returncode, done.stdout) == (0, ""), done.stderr
    assert "2 robots, 1 node each: all known, all seen; 0 findings: as planned" in done.stderr


@pytest.mark.deep
def test_a_leak_on_another_host_is_named(plan: Path) -> None:
    with hosts(3) as (one, two, base):
        leaky = node("robot2", subscriptions=[["/cmd_vel", "String"]])
        with fleet((one, [node("robot1")]), (two, [leaky]), **SUBNET):
            done = run(base, "check", plan, "-v", **SUBNET)
    assert done.returncode == 1, done.stderr
    # A String moves nothing.
    assert "/robot2/drive: error: MG320 should subscribe to topic /robot2/cmd_vel" in done.stdout
    assert "/robot1/drive" not in done.stdout


@pytest.mark.deep
def test_peers_are_named_on_one_side_only(plan: Path) -> None:
    """Robots that speak on their own machine only: who names their machines sees them."""
    with hosts(3) as (one, two, base):
        robots = (one, [node("robot1")]), (two, [node("robot2")])
        with fleet(*robots, **LOCALHOST):
            alone = run(base, "check", plan, "-v", **LOCALHOST)
            peers = f"{one.address};{two.address}"
            named = run(base, "check", plan, "-v", **LOCALHOST, ROS_STATIC_PEERS=peers)
    assert_inconclusive(alone)
    assert f"no node was seen (domain {DOMAIN}, range LOCALHOST)" in alone.stderr
    assert "For robots on other machines set ROS_STATIC_PEERS" in alone.stderr
    assert (named.returncode, named.stdout) == (0, ""), named.stderr


@pytest.mark.deep
def test_peers_where_multicast_is_lost(tmp_path: Path) -> None:
    """Under SUBNET Fast DDS asks 4 participants of a peer."""
    plan = write_plan(tmp_path / "plan.yaml", MANY[:6])
    with hosts(2, multicast=False) as (robots, base), crowd(robots, MANY[:6], **SUBNET):
        done = run(base, "check", plan, "-v", **SUBNET, ROS_STATIC_PEERS=robots.address)
    assert_inconclusive(done)
    assert len(done.stdout.splitlines()) == 2
    assert "use ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST" in done.stderr


@pytest.mark.deep
def test_peers_under_localhost_where_multicast_is_lost(tmp_path: Path) -> None:
    """What the message above advises: 32 participants of a peer are asked."""
    plan = write_plan(tmp_path / "plan.yaml", MANY[:31])
    with hosts(2, multicast=False) as (robots, base), crowd(robots, MANY[:31], **SUBNET):
        done = run(base, "check", plan, "-v", **LOCALHOST, ROS_STATIC_PEERS=robots.address)
    assert (done.returncode, done.stdout) == (0, ""), done.stderr


@pytest.mark.deep
def test_a_super_client_sees_forty_participants_and_a_plain_one_has_a_caveat(
    tmp_path: Path,
) -> None:
    plan = write_plan(tmp_path / "plan.yaml", MANY)
    graph = tmp_path / "graph.json"
    with hosts(2) as (robots, base), discovery_server(robots) as address:
        server = {**SUBNET, "ROS_DISCOVERY_SERVER": address}
        with crowd(robots, MANY, **server):
            look = run(base, "snapshot", "-o", graph, **server, ROS_SUPER_CLIENT="TRUE")
            plain = run(base, "check", plan, "-v", **server)
    assert look.returncode == 0, look.stderr
    assert "40 nodes in 40 participants" in look.stderr
    done = multibot("check", plan, "-v", "--from", graph, env=live_fleet.environ(DOMAIN))
    assert (done.returncode, done.stdout) == (0, ""), done.stderr
    assert_inconclusive(plain)
    assert "MG102" in plain.stdout
    assert "the view is not complete, set ROS_SUPER_CLIENT=TRUE" in plain.stderr


@pytest.mark.deep
def test_the_profile_of_the_page_lifts_the_limit(tmp_path: Path) -> None:
    page = ROOT / "docs" / "large-fleets.md"
    profile = tmp_path / "look.xml"
    profile.write_text(page.read_text().partition("```xml\n")[2].partition("```")[0])
    plan = write_plan(tmp_path / "plan.yaml", MANY)
    settings = {
        "FASTRTPS_DEFAULT_PROFILES_FILE": str(profile),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "SYSTEM_DEFAULT",
    }
    with hosts(2) as (robots, base), crowd(robots, MANY, **LOCALHOST):
        # The page names the first host, and every host itself.
        for host in (robots, base):
            done = run(host, "check", plan, "-v", **settings)
            assert (done.returncode, done.stdout) == (0, ""), done.stderr


@pytest.mark.deep
def test_a_discovery_server_that_is_not_there(plan: Path) -> None:
    with hosts(1) as (base,):
        server = {"ROS_DISCOVERY_SERVER": f"{base.address}:11811", "ROS_SUPER_CLIENT": "TRUE"}
        done = run(base, "check", plan, "-v", **SUBNET, **server)
    assert_inconclusive(done)
    assert f"discovery server {base.address}:11811); is the server running there" in done.stderr


@pytest.mark.deep
def test_multicast_has_no_limit(tmp_path: Path) -> None:
    """One more than are found without it."""
    names = MANY[: LOCAL_LIMIT + 1]
    plan = write_plan(tmp_path / "plan.yaml", names)
    with hosts(2) as (robots, base), crowd(robots, names, **SUBNET):
        done = run(base, "check", plan, "-v", **SUBNET)
    assert (done.returncode, done.stdout) == (0, ""), done.stderr


ONE_MACHINE = "all that is seen runs on one machine (/robot1/drive). If robot2 is on another"


def assert_not_seen_from_here(done: CompletedProcess[str]) -> None:
    """robot2 is not called missing, and the line says how to look for it."""
    assert (done.returncode, len(done.stdout.splitlines())) == (3, 1), done.stdout + done.stderr
    assert "robot2: inconclusive: MG109" in done.stdout
    assert ONE_MACHINE in done.stdout


@pytest.mark.deep
def test_a_robot_that_keeps_to_its_machine_is_not_missing(plan: Path) -> None:
    with hosts(2) as (one, two):
        settings = (one, "robot1", SUBNET), (two, "robot2", LOCALHOST)
        with ExitStack() as stack:
            for host, robot, range_ in settings:
                stack.enter_context(fleet((host, [node(robot)]), **range_))
            assert_not_seen_from_here(run(one, "check", plan, "-v", **SUBNET))


@pytest.mark.deep
def test_where_all_are_to_be_on_this_machine_a_robot_is_missing(plan: Path) -> None:
    """What the message advises for a simulation: robots under SUBNET, the look under LOCALHOST."""
    with hosts(1) as (one,), fleet((one, [node("robot1")]), **SUBNET):
        done = run(one, "check", plan, "-v", **LOCALHOST)
    assert (done.returncode, len(done.stdout.splitlines())) == (1, 1), done.stdout
    assert "robot2: error: MG109" in done.stdout


@pytest.mark.deep
def test_what_is_advised_finds_it(plan: Path, tmp_path: Path) -> None:
    """Multicast is lost: a look on each machine, joined; and static peers."""
    with hosts(2, multicast=False) as (one, two):
        robots = (one, [node("robot1")]), (two, [node("robot2")])
        with fleet(*robots, **SUBNET):
            assert_not_seen_from_here(run(one, "check", plan, "-v", **SUBNET))
            files = [tmp_path / "one.json", tmp_path / "two.json"]
            for host, file in zip((one, two), files, strict=True):
                assert run(host, "snapshot", "-o", file, **SUBNET).returncode == 0
            named = run(one, "check", plan, **LOCALHOST, ROS_STATIC_PEERS=two.address)
    assert (named.returncode, named.stdout) == (0, ""), named.stderr
    both = [word for file in files for word in ("--from", file)]
    done = multibot("check", plan, "-v", *both, env=live_fleet.environ(DOMAIN))
    assert (done.returncode, done.stdout) == (0, ""), done.stderr


@pytest.mark.deep
def test_looks_from_two_machines_that_see_the_same_are_one_graph(
    plan: Path, tmp_path: Path
) -> None:
    files = [tmp_path / "one.json", tmp_path / "two.json"]
    with hosts(2) as (one, two):
        robots = (one, [node("robot1")]), (two, [node("robot2")])
        with fleet(*robots, **SUBNET):
            for host, file in zip((one, two), files, strict=True):
                assert run(host, "snapshot", "-o", file, **SUBNET).returncode == 0
    target, env = tmp_path / "all.json", live_fleet.environ(DOMAIN)
    joined = multibot(
        "snapshot", *(it for path in files for it in ("--from", path)), "-o", target, env=env
    )
    assert joined.returncode == 0, joined.stderr
    assert "2 nodes in 2 participants" in joined.stderr
    done = multibot("check", plan, "-v", "--from", target, env=env)
    assert (done.returncode, done.stdout) == (0, ""), done.stderr


@pytest.mark.deep
def test_a_robot_of_another_domain(plan: Path, tmp_path: Path) -> None:
    files = [tmp_path / "one.json", tmp_path / "two.json"]
    with hosts(2) as (one, two), ExitStack() as stack:
        for host, robot, domain in ((one, "robot1", DOMAIN), (two, "robot2", DOMAIN + 1)):
            settings = {**SUBNET, "ROS_DOMAIN_ID": str(domain)}
            stack.enter_context(fleet((host, [node(robot)]), **settings))
        assert_not_seen_from_here(run(one, "check", plan, "-v", **SUBNET))
        for file, domain in zip(files, (DOMAIN, DOMAIN + 1), strict=True):
            run(one, "snapshot", "-o", file, "--domain", domain, **SUBNET)
    done = multibot(
        "snapshot",
        *(it for path in files for it in ("--from", path)),
        env=live_fleet.environ(DOMAIN),
    )
    assert done.returncode == 2
    assert "nodes of two domains never see each other" in done.stderr


@pytest.mark.deep
@pytest.mark.parametrize("percent", [5, 25])
def test_a_network_that_loses_packets_makes_no_robot_missing(plan: Path, percent: int) -> None:
    with hosts(3) as (one, two, base):
        for host in (one, two, base):
            lose_packets(host, percent)
        robots = (one, [node("robot1")]), (two, [node("robot2")])
        with fleet(*robots, **SUBNET):
            done = run(base, "check", plan, "-v", **SUBNET)
        assert percent < 10 or sum(map(lost_packets, (one, two, base)))
    assert done.returncode in (0, 3), done.stdout + done.stderr
    assert ": error: " not in done.stdout
