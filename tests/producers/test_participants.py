# SPDX-License-Identifier: Apache-2.0
"""How many participants run here, by their ports."""

from __future__ import annotations

import socket
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import nullcontext
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from multibot_rewrite.producers.ros import assemble, observe, participants
from multibot_rewrite.producers.ros.participants import (
    lost_by_us,
    lost_here,
    participants_here,
)
from multibot_rewrite.producers.ros.request import Request

DOMAIN = 93
KNOWN, LONG = assemble.ALL_KNOWN_SECONDS, assemble.QUIET_SECONDS
LOCAL = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}


@pytest.fixture
def domain_in_use() -> Iterator[int]:
    """Bind a participant's port in a domain that nothing else is in, and yield the domain."""
    if not sys.platform.startswith("linux"):
        pytest.skip("ports are read on Linux alone")
    # Another live test may have drawn a domain of these.
    domain = next(it for it in range(DOMAIN, 102) if not participants_here(it))
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as own:
        own.bind(("127.0.0.1", 7400 + 250 * domain + 10))
        yield domain


def test_a_look_gives_its_sockets_room_and_leaves_them_open(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Of datagrams alone: they are the middleware's, and no file, pipe or stream is touched."""
    context = SimpleNamespace(get_domain_id=lambda: DOMAIN)
    monkeypatch.setattr(
        observe.ros, "opened", lambda: nullcontext(SimpleNamespace(context=context))
    )
    monkeypatch.setattr(observe.ros, "add_node", lambda *_: None)
    with (
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as own,
        socket.socket() as stream,
        open(tmp_path / "file", "w") as file,
    ):
        before = [it.getsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF) for it in (own, stream)]
        with observe._open_session(Request(1.0), threading.Event(), lambda _: None):
            after = [it.getsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF) for it in (own, stream)]
        own.bind(("127.0.0.1", 0))
        file.write("open")
    if sys.platform.startswith("linux"):
        assert after[0] > before[0]
    assert after[1] == before[1]


def test_a_port_in_use_is_a_participant(
    domain_in_use: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert participants_here(domain_in_use) == 1
    # Also where the kernel has no IPv6, and so no second table.
    monkeypatch.setattr(participants, "TABLES", ("/proc/net/udp", "/proc/net/none"))
    assert participants_here(domain_in_use) == 1


def test_where_any_program_gets_a_port_one_alone_is_no_participant(
    domain_in_use: int, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    port = 7400 + 250 * domain_in_use + 10
    (tmp_path / "range").write_text(f"{port}\t60999\n")
    monkeypatch.setattr(participants, "ANYBODYS", str(tmp_path / "range"))
    assert participants_here(domain_in_use) == 0
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as data:
        data.bind(("127.0.0.1", port + 1))
        assert participants_here(domain_in_use) == 1


def test_what_a_full_buffer_loses_is_counted(domain_in_use: int) -> None:
    before = lost_here(domain_in_use + 1)
    assert lost_here(domain_in_use) == 0
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        for _ in range(2000):
            sender.sendto(bytes(1000), ("127.0.0.1", 7400 + 250 * domain_in_use + 10))
    assert 0 < lost_here(domain_in_use) < 2000
    assert lost_here(domain_in_use + 1) == before


def test_only_what_this_process_lost_makes_a_look_longer(
    domain_in_use: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What another process lost of ours hides nothing from us: its sender says it again."""
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    monkeypatch.setattr(observe, "participants_here", lambda _: 1)
    port = 7400 + 250 * domain_in_use + 12
    bind = f"import socket; own = socket.socket(2, 2); own.bind(('127.0.0.1', {port}))"
    program = [sys.executable, "-c", f"{bind}; print(flush=True); input()"]
    pipe = subprocess.PIPE
    with (
        subprocess.Popen(program, stdin=pipe, stdout=pipe) as other,
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender,
    ):
        assert other.stdout and other.stdout.readline()
        seconds = []
        for to in (port, port - 2):
            for _ in range(2000):
                sender.sendto(bytes(1000), ("127.0.0.1", to))
            seconds.append(observe._quiet_seconds(session(1)))
        lost = lost_here(domain_in_use)
        other.communicate(b"\n")
    # Of the two, the other one's are not of this process.
    assert seconds == [KNOWN, LONG] and 0 < lost_by_us() < lost


def session(*participants: int) -> Any:
    """One that sees a topic of the middleware with an end of each of these participants of Fast DDS, on
    the machines of their first digit."""
    prefixes = ([1, 15, it // 10, 0, *[it] * 8] for it in participants)
    ends = [SimpleNamespace(endpoint_gid=[*it, 0, 0, 1, 3]) for it in prefixes]
    node = SimpleNamespace(
        get_publishers_info_by_topic=lambda _, no_mangle: ends if no_mangle else []
    )
    return SimpleNamespace(node=node, domain=lambda: DOMAIN)


@pytest.mark.parametrize(
    ("environ", "announced", "here", "seconds"),
    [
        (LOCAL, (1,), 1, KNOWN),
        (LOCAL, (1, 1), 1, KNOWN),
        ({"ROS_LOCALHOST_ONLY": "1"}, (1,), 1, KNOWN),
        pytest.param(LOCAL, (), 1, LONG, id="one is not announced"),
        pytest.param(LOCAL, (1, 2), 1, LONG, id="one was killed, and may stand for another"),
        pytest.param(
            {}, (1, 2), 2, LONG, id="none of another machine was seen, and it may be there"
        ),
        pytest.param({}, (1,), 1, LONG, id="nobody but the look itself"),
        pytest.param({}, (1, 2, 11), 2, LONG, id="other machines"),
        pytest.param({}, (1, 11), 2, LONG, id="one that is not announced, and another machine"),
        pytest.param({**LOCAL, "ROS_STATIC_PEERS": "10.0.0.2"}, (1,), 1, LONG, id="a peer"),
        pytest.param({**LOCAL, "ROS_DISCOVERY_SERVER": "10.0.0.2"}, (1,), 1, LONG, id="a server"),
    ],
)
def test_less_is_enough_where_each_port_is_announced(
    environ: dict[str, str],
    announced: tuple[int, ...],
    here: int,
    seconds: float,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(observe, "participants_here", lambda _: here)
    for name in ("ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_STATIC_PEERS", "ROS_LOCALHOST_ONLY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.delenv("ROS_DISCOVERY_SERVER", raising=False)
    for name, value in environ.items():
        monkeypatch.setenv(name, value)
    assert observe._quiet_seconds(session(*announced)) == seconds


@pytest.mark.parametrize(
    ("announced", "here", "nodes", "lost", "said"),
    [
        (3, 3, 10, 0, ""),
        # One that was killed is announced for a while.
        (4, 3, 10, 0, ""),
        (3, 6, 10, 0, "10 of about 25 nodes seen: 3 of 5 programs in this domain"),
        (3, 6, 10, 36_000, "announced no nodes, and this machine lost 36000 datagrams meanwhile;"),
        # Nothing is seen, so nothing is estimated.
        (1, 3, 0, 0, "2 of 2 programs in this domain on this machine announced no nodes; they are"),
    ],
)
def test_who_has_ports_and_announces_nothing(
    announced: int, here: int, nodes: int, lost: int, said: str
) -> None:
    found = [*assemble.unannounced(announced, here, nodes, lost)]
    assert [it.incomplete for it in found] == [True] * bool(said)
    assert said in "".join(it.message for it in found)
