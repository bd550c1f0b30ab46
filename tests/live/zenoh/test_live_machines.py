# SPDX-License-Identifier: Apache-2.0
"""Routers on machines of their own, each a network namespace: what one router knows of the others."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import live_fleet
import pytest
from live_commands import multibot, write_plan
from network_hosts import Host, hosts
from paths import ROOT

pytestmark = [pytest.mark.live, pytest.mark.deep]
pytest.importorskip("zenoh", reason="no zenoh: pip install '.[zenoh]'")
PORT = 7447


def endpoint(host: Host) -> str:
    return f"tcp/{host.address}:{PORT}"


@contextmanager
def machine(host: Host, robot: str, *others: Host) -> Iterator[None]:
    """Yield a router and a robot on this host; the router connects to those of the others."""
    program = str(ROOT / "tests" / "support" / "zenoh_robots.py")
    more = [f"+{endpoint(other)}" for other in others]
    command = [*host.inside, sys.executable, program, endpoint(host), robot, *more]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True) as child:
        assert child.stdin is not None and child.stdout is not None
        assert child.stdout.readline() == "ready\n"
        yield
        child.stdin.close()


def test_routers_that_are_connected_know_all_robots(tmp_path: Path) -> None:
    """No multicast: the network drops it. Any router answers for all."""
    plan = write_plan(tmp_path / "plan.yaml", ("robot1", "robot2"))
    with hosts(3, multicast=False) as (one, two, base), ExitStack() as stack:
        stack.enter_context(machine(one, "robot1"))
        stack.enter_context(machine(two, "robot2", one))
        for host in (one, two):
            words = ("check", plan, "--from", endpoint(host), "--domain", "0")
            done = multibot(*words, env=live_fleet.environ(0), inside=base.inside)
            assert (done.returncode, done.stdout) == (0, ""), done.stderr


def test_routers_that_are_not_connected_are_joined_by_their_snapshots(tmp_path: Path) -> None:
    plan = write_plan(tmp_path / "plan.yaml", ("robot1", "robot2"))
    env = live_fleet.environ(0)
    files = [tmp_path / "one.json", tmp_path / "two.json"]
    with hosts(3) as (one, two, base), ExitStack() as stack:
        stack.enter_context(machine(one, "robot1"))
        stack.enter_context(machine(two, "robot2"))
        words = ("check", plan, "--from", endpoint(one), "--domain", "0")
        alone = multibot(*words, env=env, inside=base.inside)
        for host, file in zip((one, two), files, strict=True):
            look = ("snapshot", "--from", endpoint(host), "--domain", "0", "-o", file)
            assert multibot(*look, env=env, inside=base.inside).returncode == 0
    assert alone.returncode == 1
    assert f"connected to the router at {endpoint(one)}?" in alone.stdout
    both = [word for file in files for word in ("--from", file)]
    done = multibot("check", plan, *both, env=env)
    assert (done.returncode, done.stdout) == (0, ""), done.stderr
