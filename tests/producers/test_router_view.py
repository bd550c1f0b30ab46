# SPDX-License-Identifier: Apache-2.0
"""What a Zenoh router says becomes a snapshot, once or again and again.

The session here answers from tables, as ``zenoh.Session`` does: liveliness tokens are key expressions,
replies have ``ok`` or not, samples a kind, a payload and an attachment (eclipse-zenoh, session.pyi).
"""

from __future__ import annotations

import json
import sys
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from types import SimpleNamespace
from typing import Any

import pytest

from multibot_rewrite.base.model import InputError, Unusable
from multibot_rewrite.producers.ros.request import Request
from multibot_rewrite.producers.zenoh import observe
from multibot_rewrite.producers.zenoh.observe import Router, look, watch
from multibot_rewrite.producers.zenoh.session import NoRouter, RouterSession, opened
from multibot_rewrite.system.records import Node, System

SESSION = "aac3178e146ba6f1fc6e6a4085e77f21"
HASH = f"RIHS01_{'0' * 64}"
DRIVER = f"@ros2_lv/2/{SESSION}/0/0/NN/%/%robot1/driver"
SCAN = (
    f"@ros2_lv/2/{SESSION}/0/10/MP/%/%robot1/driver/%scan/std_msgs::msg::dds_::String_/{HASH}"
    "/::,10:,:,:,,"
)
TF = SCAN.replace("%scan/std_msgs::msg::dds_::String_", "%tf/tf2_msgs::msg::dds_::TFMessage_")
OTHER = DRIVER.replace("/2/", "/7/")
ROUTER = Router("tcp/h:7447", 2)


class Declared:
    """A subscription; ``ended`` once it is taken back."""

    ended = False

    def undeclare(self) -> None:
        self.ended = True


class Session:
    """``keys`` are the tokens that are there; ``silent``: a reply is missing."""

    def __init__(self, keys: Sequence[str], silent: bool = False, links: int = 1) -> None:
        self.keys, self.silent = list(keys), silent
        self.subscribed: dict[str, Callable[[Any], None]] = {}
        self.info = SimpleNamespace(routers_zid=lambda: ["r"] * links, peers_zid=lambda: [])

    def liveliness(self) -> Session:
        return self

    def get(self, key: str, timeout: float) -> Iterator[Any]:
        domain = key.removeprefix("@ros2_lv/").partition("/")[0]
        for it in self.keys:
            if domain in ("**", it.split("/")[1]):
                yield SimpleNamespace(ok=SimpleNamespace(key_expr=it))
        if self.silent:
            yield SimpleNamespace(ok=None)

    def declare_subscriber(self, key: str, arrived: Callable[[Any], None]) -> Declared:
        self.subscribed[key] = arrived
        return Declared()


@pytest.fixture
def opens(monkeypatch: pytest.MonkeyPatch) -> Callable[[Session], RouterSession]:
    """Yield the session that is opened next; nothing is waited for."""

    def given(session: Session) -> RouterSession:
        own = RouterSession(ZENOH, session, deque(), [])

        @contextmanager
        def opened(address: str, seconds: float) -> Iterator[RouterSession]:
            assert address == ROUTER.address
            yield own

        monkeypatch.setattr(observe, "opened", opened)
        return own

    monkeypatch.setattr(observe, "POLL_SECONDS", 0.001)
    monkeypatch.setattr(observe, "TF_SECONDS", 0.002)
    monkeypatch.setattr(observe, "TF_LONGEST_SECONDS", 0.004)
    return given


ZENOH = SimpleNamespace(SampleKind=SimpleNamespace(PUT="put"))


def codes(seen: System) -> list[tuple[str, bool]]:
    return [(it.code, it.incomplete) for it in seen.environment.caveats]


def seen_of(opens: Any, *keys: str, **asked: Any) -> System:
    silent = asked.pop("silent", False)
    opens(Session(keys, silent))
    return look(Request(asked.pop("timeout", 1.0), **asked), ROUTER)


def test_a_look_ends_when_the_expected_nodes_are_there(opens: Any) -> None:
    assert seen_of(opens, DRIVER, expected=("/robot1/driver",)).environment.settled == "expected"
    assert seen_of(opens, DRIVER, SCAN, expected=("/scan",)).environment.settled == "expected"
    late = seen_of(opens, DRIVER, expected=("/robot1/driver", "/b"), timeout=0.01)
    assert late.environment.settled == "timeout"
    assert codes(late) == [("expected-not-seen", True)]
    assert "graph: /b; is all" in late.environment.caveats[0].message


def test_an_empty_domain_says_which_ones_the_router_has(opens: Any) -> None:
    (other,) = seen_of(opens, OTHER).environment.caveats
    assert other.message.endswith(
        "no node of domain 2; it has nodes of domain 7; give one with --domain"
    )
    (empty,) = seen_of(opens).environment.caveats
    assert (empty.code, empty.incomplete) == ("nothing-seen", True)
    assert "RMW_IMPLEMENTATION=rmw_zenoh_cpp" in empty.message


def test_what_a_router_did_not_say_is_told(opens: Any) -> None:
    assert codes(seen_of(opens, DRIVER, silent=True)) == [("not-settled", True)]
    strange = seen_of(opens, DRIVER, "@ros2_lv/2/x")
    assert codes(strange) == [("strange-token", False)]
    assert strange.environment.caveats[0].message.startswith("1 token left out, not as rmw_zenoh")
    twins = seen_of(opens, DRIVER, DRIVER.replace("/0/0/NN", "/1/1/NN"))
    assert twins.nodes == (Node("/robot1/driver", SESSION),) * 2
    assert codes(twins) == [("same-name", False)]


def test_where_no_router_answers_the_view_is_empty(monkeypatch: pytest.MonkeyPatch) -> None:
    for words, told in (("Unable to connect to any", ""), ("access denied", " (access denied)")):

        def refused(address: str, seconds: float, words: str = words) -> Any:
            raise NoRouter(words)

        monkeypatch.setattr(observe, "opened", refused)
        for found in (
            look(Request(1.0), ROUTER),
            *(it for _, it in watch(Request(1.0), {2: ROUTER})),
        ):
            assert codes(found) == [("no-router", True)]
            said = f"no Zenoh router answers at tcp/h:7447{told}; is one running there"
            assert found.environment.caveats[0].message.startswith(said)


def test_tf_is_listened_to_and_what_is_not_heard_is_told(opens: Any) -> None:
    session = Session((DRIVER, TF))
    opens(session)
    assert codes(look(Request(1.0), ROUTER)) == [("frames-not-heard", True)]
    assert list(session.subscribed) == ["2/tf/tf2_msgs::msg::dds_::TFMessage_/*"]
    spoken = Session((DRIVER, TF))
    own = opens(spoken)
    sample = SimpleNamespace(payload=b"no cdr", attachment=b"1" * 33)

    def subscribe(key: str, arrived: Callable[[Any], None]) -> Declared:
        arrived(sample)
        return Declared()

    spoken.declare_subscriber = subscribe  # type: ignore[method-assign]
    found = look(Request(1.0), ROUTER)
    assert codes(found) == [("frames-not-read", True)]
    assert not own.inbox


def test_a_watched_router_is_shown_after_each_change(
    opens: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(observe, "SETTLE_SECONDS", 0.01)
    session = Session((DRIVER,))
    own = opens(session)
    views = watch(Request(5.0), {2: ROUTER})
    number, first = next(views)
    assert number == 2
    assert ([it.name for it in first.nodes], first.environment.settled) == (
        ["/robot1/driver"],
        "quiet",
    )
    changed = session.subscribed["@ros2_lv/2/**"]
    changed(SimpleNamespace(kind="put", key_expr=SCAN))
    assert [it.name for it in next(views)[1].ends] == ["/scan"]
    changed(SimpleNamespace(kind="delete", key_expr=DRIVER))
    changed(SimpleNamespace(kind="delete", key_expr=SCAN))
    assert next(views)[1].nodes == ()
    session.info = SimpleNamespace(routers_zid=lambda: [], peers_zid=lambda: [])
    assert codes(next(views)[1]) == [("no-router", True)]
    views.close()
    assert own.declared != []


def test_a_watch_ends_with_its_time_and_takes_its_subscription_back(opens: Any) -> None:
    own = opens(Session((DRIVER,)))
    assert list(watch(Request(0.02), {2: ROUTER})) == []
    assert own.declared == []


def test_what_is_received_is_delivered_on_the_thread_that_asks() -> None:
    session = Session(())
    own = RouterSession(ZENOH, session, deque(), [])
    found: list[tuple[bytes, bytes]] = []
    end = own.subscribe("2/x", False, lambda payload, mark: found.append((payload, mark)))
    session.subscribed["2/x"](SimpleNamespace(payload=b"p", attachment=b"a"))
    session.subscribed["2/x"](SimpleNamespace(payload=b"q", attachment=None))
    assert found == []
    own.deliver()
    assert found == [(b"p", b"a"), (b"q", b"")]
    (kept,) = own.declared
    end()
    assert kept.ended and own.declared == []


class ZError(Exception):
    """As zenoh has it."""


class Config:
    """As ``zenoh.Config``: JSON by key; ``file`` is where it was read from."""

    def __init__(self, file: str = "") -> None:
        self.file, self.set = file, {}

    @classmethod
    def from_file(cls, path: str) -> Config:
        if "wrong" in path:
            raise ZError("Expected a colon. at /home/z/config.rs:5.")
        return cls(path)

    def insert_json5(self, key: str, value: str) -> None:
        if "bad" in value:
            raise ZError("no endpoint! ")
        self.set[key] = json.loads(value)


class Opened(Session):
    """An open session; ``closed`` once it is."""

    closed = False

    def close(self) -> None:
        self.closed = True


def with_zenoh(monkeypatch: pytest.MonkeyPatch, fault: str = "") -> tuple[list[Config], Opened]:
    """Return a module in the place of zenoh: what it was opened with, and the session."""
    configs: list[Config] = []
    session = Opened([DRIVER])

    def open_(config: Config) -> Opened:
        configs.append(config)
        if fault:
            raise ZError(fault)
        return session

    module = SimpleNamespace(Config=Config, ZError=ZError, open=open_)
    monkeypatch.setitem(sys.modules, "zenoh", module)
    return configs, session


CLIENT = {"mode": "client", "scouting/multicast/enabled": False}


@pytest.mark.parametrize(
    ("router", "seconds", "file", "more"),
    [
        ("tcp/h:7447", 9.0, "", {"connect/endpoints": ["tcp/h:7447"], "connect/timeout_ms": 3000}),
        ("tcp/h:7447", 0.5, "", {"connect/endpoints": ["tcp/h:7447"], "connect/timeout_ms": 500}),
        ("a.json5", 9.0, "a.json5", {"connect/timeout_ms": 3000}),
        ("a.json", 9.0, "a.json", {"connect/timeout_ms": 3000}),
    ],
)
def test_a_session_is_a_client_of_the_router_alone(
    router: str, seconds: float, file: str, more: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    configs, session = with_zenoh(monkeypatch)
    with opened(router, seconds) as found:
        found.follow_tokens("k", lambda *_: None)
        (declared,) = found.declared
        assert found.tokens("@ros2_lv/2/**") == ([DRIVER], True)
        assert not session.closed
    assert session.closed and declared.ended
    assert [(it.file, it.set) for it in configs] == [(file, {**CLIENT, **more})]


@pytest.mark.parametrize(
    ("router", "reason"), [("wrong.json5", "Expected a colon"), ("tcp/bad", "no endpoint")]
)
def test_what_is_no_configuration_is_told(
    router: str, reason: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    with_zenoh(monkeypatch)
    with pytest.raises(InputError) as refused, opened(router, 1.0):
        pass
    hint = "give one that zenoh can load, or tcp/HOST:7447"
    assert str(refused.value) == f"{router}: no session configuration of Zenoh: {reason}; {hint}"


def test_a_router_that_does_not_answer_or_no_zenoh_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    with_zenoh(monkeypatch, "Unable to connect to any of [tcp/h:7447]! at /z/orchestrator.rs:1.")
    with pytest.raises(NoRouter, match=r"^Unable to connect to any of \[tcp/h:7447\]$"):
        opened("tcp/h:7447", 1.0).__enter__()
    monkeypatch.setitem(sys.modules, "zenoh", None)
    with pytest.raises(Unusable) as refused:
        opened("tcp/h:7447", 1.0).__enter__()
    assert str(refused.value).endswith(
        "pip install 'multibot_rewrite[zenoh]' (or pip install eclipse-zenoh)"
    )
