# SPDX-License-Identifier: Apache-2.0
"""Hosts on one machine: network namespaces on one bridge, each with a /dev/shm of its own.

Fast DDS prefers shared memory and finds it across network namespaces; where every host has its own,
only the network is left. The namespaces have no names: each is held by a process that ends when its
standard input closes, so nothing is left behind even when the test run is killed.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import NamedTuple

import pytest

_READY = "ready"
_TOOLS = ("bridge", "ip", "nsenter", "unshare")
# Who is not root becomes root of a user namespace, where the machine allows that.
_ROOT = os.geteuid() == 0
_BECOME = () if _ROOT else ("--user", "--map-root-user")
_ENTER = () if _ROOT else ("--user", "--preserve-credentials")
_HOLD = f"mount -t tmpfs tmpfs /dev/shm && ip link set lo up && echo {_READY} && exec cat"
# Snooping would keep multicast from hosts that have not asked for it yet.
_SWITCH = "ip link add br0 type bridge mcast_snooping 0 && ip link set br0 up"
_PLUG = (
    "ip link add {port} type veth peer name eth0 netns {pid} && ip link set {port} master br0 up"
)
# In a shell, because the server itself would outlive a test run that is killed.
_SERVE = '"$@" & cat; kill $!; wait'
# As many a wireless access point does.
_DROP = "bridge link set dev {port} mcast_flood off"
_NETEM = "tc qdisc add dev eth0 root netem loss {percent}% 2>/dev/null"
# Where the kernel has no netem: a queue without room, for packets whose random number is below a bound.
# The packet filter loads such a number, compares it, and returns the class 1:2 or none.
_QUEUES = " && ".join(
    (
        "tc qdisc add dev eth0 root handle 1: htb default 1 r2q 1000000",
        "tc class add dev eth0 parent 1: classid 1:1 htb rate 10gbit",
        "tc class add dev eth0 parent 1: classid 1:2 htb rate 10gbit",
        "tc qdisc add dev eth0 parent 1:2 pfifo limit 0",
        "tc filter add dev eth0 parent 1: protocol all prio 1 bpf bytecode"
        " '4,32 0 0 4294963256,53 1 0 {lost},6 0 0 65538,6 0 0 0'",
    )
)
_ADDRESS = "ip addr add {address}/24 dev eth0 && ip link set eth0 up"


class Host(NamedTuple):
    """``inside`` is put before a command to run it on this host."""

    address: str
    inside: tuple[str, ...]


THIS = Host("127.0.0.1", ())


@contextmanager
def hosts(count: int, multicast: bool = True) -> Iterator[list[Host]]:
    """Yield that many hosts on one network; skip the test where they cannot be made. Without
    ``multicast`` the network takes it and drops it.

    Without ``multicast`` the network takes it and drops it.
    """
    missing = [tool for tool in _TOOLS if not shutil.which(tool)]
    if missing:
        pytest.skip(f"no network of several hosts: {', '.join(missing)} not found")
    with ExitStack() as stack:
        switch = _inside(stack.enter_context(_held(("unshare", *_BECOME))))
        _run(switch, _SWITCH)
        ends = [stack.enter_context(_plugged(switch, number)) for number in range(1, count + 1)]
        for number in range(1, count + 1) if not multicast else ():
            _run(switch, _DROP.format(port=f"port{number}"))
        yield ends


@contextmanager
def _plugged(switch: tuple[str, ...], number: int) -> Iterator[Host]:
    with _held((*switch, "unshare")) as pid:
        host = Host(f"10.77.0.{number}", _inside(pid))
        _run(switch, _PLUG.format(port=f"port{number}", pid=pid))
        _run(host.inside, _ADDRESS.format(address=host.address))
        yield host


@contextmanager
def _held(unshare: Sequence[str]) -> Iterator[int]:
    """Yield the process that keeps new namespaces alive inside the block."""
    command = [*unshare, "--net", "--mount", "sh", "-c", _HOLD]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=pipe, text=True) as child:
        assert child.stdout is not None and child.stderr is not None
        if child.stdout.readline().strip() != _READY:
            pytest.skip(f"no network namespace on this machine: {child.stderr.read().strip()}")
        yield child.pid


def _inside(pid: int) -> tuple[str, ...]:
    return ("nsenter", "--target", str(pid), *_ENTER, "--net", "--mount", "--wd")


def _run(inside: tuple[str, ...], script: str) -> None:
    done = subprocess.run(
        [*inside, "sh", "-c", script], capture_output=True, text=True, check=False
    )
    if done.returncode:
        pytest.skip(f"no network of several hosts: {script}: {done.stderr.strip()}")


def lose_packets(host: Host, percent: int) -> None:
    """Drop so many of the packets that the host sends; the test is skipped where the kernel cannot."""
    if not shutil.which("tc"):
        pytest.skip("no packet loss: tc not found")
    lost = percent * 2**32 // 100
    _run(host.inside, f"{_NETEM.format(percent=percent)} || {{ {_QUEUES.format(lost=lost)}; }}")


def lost_packets(host: Host) -> int:
    """How many packets that the host sent were dropped."""
    done = subprocess.run(
        [*host.inside, "tc", "-s", "qdisc", "show", "dev", "eth0"],
        capture_output=True,
        text=True,
        check=True,
    )
    return sum(map(int, re.findall(r"dropped (\d+)", done.stdout)))


@contextmanager
def discovery_server(host: Host, port: int = 11811) -> Iterator[str]:
    """Yield a Fast DDS discovery server on ``host``; gives the value of ROS_DISCOVERY_SERVER.

    The test is skipped where there is no server program.
    """
    beside = Path(sys.prefix) / "bin"
    program = shutil.which(
        "fast-discovery-server", path=f"{beside}{os.pathsep}{os.environ['PATH']}"
    )
    if program is None:
        pytest.skip(
            f"no discovery server: fast-discovery-server is neither in {beside} nor on PATH"
        )
    options = ["-i", "0", "-l", host.address, "-p", str(port)]
    command = [*host.inside, "sh", "-c", _SERVE, "sh", program, *options]
    pipe = subprocess.PIPE
    # Its libraries are found as those of rclpy: the wheels put them into LD_LIBRARY_PATH.
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True) as server:
        assert server.stdout is not None
        if "running" not in server.stdout.readline():
            pytest.skip(f"the discovery server does not start: {program}")
        yield f"{host.address}:{port}"
