"""How many participants run here, by their ports."""

from __future__ import annotations

import socket
import sys
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import pytest

from multibot_rewrite.live.staged import stage
from multibot_rewrite.producers.ros import observe
from multibot_rewrite.producers.ros.participants import participants_at, participants_here, ports_in

TABLE = """\
   sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout inode
 7225: 0100007F:1CF2 00000000:0000 07 00000000:00000000 00:00000000 00000000     0        0 274152
 9183: 00000000:1CF3 00000000:0000 07 00000000:00000000 00:00000000 00000000     0        0 274145
 9184: 00000000:1CE8 00000000:0000 07 00000000:00000000 00:00000000 00000000     0        0 274150
"""


def test_ports_of_a_table() -> None:
    assert ports_in(TABLE) == [7410, 7411, 7400]
    assert ports_in("") == []


def test_a_participant_has_an_even_port_behind_those_of_its_domain() -> None:
    # Two in domain 0: 7400 is for messages to all, odd ones are for data.
    assert participants_at([7400, 7410, 7411, 7412, 7413, 7412], 0) == 2
    # Two of domain 1, and one of domain 2.
    assert participants_at([7650, 7660, 7662, 7910], 1) == 2
    assert participants_at([7660, 32769], 0) == 0


DOMAIN = 93
LOCAL = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}


@pytest.fixture
def port_in_use() -> Iterator[None]:
    """A participant's port in a domain that nothing else is in."""
    if not sys.platform.startswith("linux"):
        pytest.skip("ports are read on Linux alone")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as own:
        own.bind(("127.0.0.1", 7400 + 250 * DOMAIN + 10))
        yield


@pytest.mark.usefixtures("port_in_use")
def test_a_port_in_use_is_a_participant() -> None:
    assert participants_here(DOMAIN) == 1


@pytest.mark.usefixtures("port_in_use")
def test_a_rehearsal_is_in_the_domain_of_the_environment_if_that_is_free(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", str(DOMAIN - 1))
    assert stage(None)["ROS_DOMAIN_ID"] == str(DOMAIN - 1)
    assert stage(7)["ROS_DOMAIN_ID"] == "7"
    monkeypatch.setenv("ROS_DOMAIN_ID", str(DOMAIN))
    monkeypatch.setattr("os.getpid", lambda: 41)
    assert stage(None)["ROS_DOMAIN_ID"] == "42"


def test_without_dds_nothing_is_known(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    assert participants_here(DOMAIN) in (0, None)
    assert observe._all_are_known(session()) is False


def session(*participants: int) -> Any:
    """One that sees a topic of the middleware with an end of each of these participants."""
    ends = [SimpleNamespace(endpoint_gid=[it] * 12 + [0, 0, 1, 3]) for it in participants]
    node = SimpleNamespace(
        get_publishers_info_by_topic=lambda _, no_mangle: ends if no_mangle else []
    )
    context = SimpleNamespace(get_domain_id=lambda: DOMAIN)
    return SimpleNamespace(node=node, ros=SimpleNamespace(context=context))


@pytest.mark.usefixtures("port_in_use")
@pytest.mark.parametrize(
    ("environ", "announced", "known"),
    [
        (LOCAL, (1,), True),
        (LOCAL, (1, 1), True),
        ({"ROS_LOCALHOST_ONLY": "1"}, (1,), True),
        pytest.param(LOCAL, (), False, id="one is not announced"),
        pytest.param(LOCAL, (1, 2), False, id="one was killed, and may stand for another"),
        pytest.param({}, (1,), False, id="other machines"),
        pytest.param({**LOCAL, "ROS_STATIC_PEERS": "10.0.0.2"}, (1,), False, id="a peer"),
        pytest.param({**LOCAL, "ROS_DISCOVERY_SERVER": "10.0.0.2"}, (1,), False, id="a server"),
    ],
)
def test_all_are_known_where_each_port_is_announced(
    environ: dict[str, str],
    announced: tuple[int, ...],
    known: bool,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for name in ("ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_STATIC_PEERS", "ROS_LOCALHOST_ONLY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.delenv("ROS_DISCOVERY_SERVER", raising=False)
    for name, value in environ.items():
        monkeypatch.setenv(name, value)
    assert observe._all_are_known(session(*announced)) is known
