# SPDX-License-Identifier: Apache-2.0
"""The live graph observed with a stand-in for rclpy, on a clock that only waiting moves."""

from __future__ import annotations

import time
from types import SimpleNamespace
from typing import Any

import pytest

from multibot_rewrite.producers.ros import look, observe, ros
from multibot_rewrite.producers.ros.request import Request
from multibot_rewrite.system.records import EXPECTED, PUBLISHES, TIMEOUT, TOPIC, Caveat, End

SCAN = End(TOPIC, PUBLISHES, "/scan", "sensor_msgs/msg/LaserScan", "", "/lidar", None, "p1")


class Clock:
    """The time, and the event that ends an observation at ``ends``."""

    def __init__(self, ends: float = 1e9) -> None:
        self.now, self.ends = 0.0, ends
        self.waited: list[float] = []

    def wait(self, seconds: float) -> bool:
        self.waited.append(round(seconds, 3))
        self.now += seconds
        return self.is_set()

    def is_set(self) -> bool:
        return self.now >= self.ends


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    made = Clock()
    monkeypatch.setattr(time, "monotonic", lambda: made.now)
    monkeypatch.setattr(time, "thread_time", lambda: 0.0)
    monkeypatch.setattr(look.ros, "receive", lambda node: None)
    return made


def session(clock: Clock, request: Request | None = None) -> look.GraphSession:
    context = SimpleNamespace(get_domain_id=lambda: 7)
    around: Any = SimpleNamespace(context=context)
    told: list[bytes] = []
    stop: Any = clock
    return look.GraphSession(around, told, request or Request(15.0), stop, 0.0, told.append, 0)


def test_messages_are_received_for_so_long_in_short_waits(clock: Clock) -> None:
    look.receive(session(clock), 0.25)
    assert clock.waited == [0.1, 0.1, 0.05]
    clock.ends, clock.waited = clock.now, []
    look.receive(session(clock), 1.0)
    assert clock.waited == [0.1]
    look.receive(session(clock), 0.0)
    assert clock.waited == [0.1]


def test_an_observation_is_over_a_second_behind_its_time_or_when_it_is_stopped(
    clock: Clock,
) -> None:
    made = session(clock, Request(2.0))
    clock.now = 2.9
    assert (made.now(), made.domain(), made.over()) == (2.9, 7, False)
    clock.now = 3.0
    assert made.over()
    clock.now, clock.ends = 1.0, 0.5
    assert made.over()


def test_when_the_graph_is_settled_the_names_that_came_last_are_known(
    clock: Clock, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The lidar comes after a second; 3.5 s without a change end the look."""
    monkeypatch.setattr(
        observe, "overview", lambda _: (["/lidar"], [SCAN]) if clock.now > 1 else ([], [])
    )
    monkeypatch.setattr(observe, "view", lambda *_: (["/lidar"], [SCAN]))
    monkeypatch.setattr(observe, "_quiet_seconds", lambda *_: observe.assemble.QUIET_SECONDS)
    updates: list[Any] = []
    heard: Any = SimpleNamespace(update=updates.append)
    made = session(clock)
    alone: Any = SimpleNamespace(missed=lambda _: (), lossy=False)
    why, unchanged, last, missed = observe._wait_until_settled(made, {}, heard, alone)
    assert (why, last, missed) == (observe.QUIET, ("/lidar", "/scan"), ())
    assert updates[-1] == [SCAN] and made.node == [b"0 nodes so far", b"1 node so far"]
    quiet = observe.assemble.QUIET_SECONDS
    assert clock.now == pytest.approx(1.1 + quiet, abs=0.21)
    assert unchanged.observed == pytest.approx(quiet, abs=0.01)
    clock.ends = clock.now
    assert observe._wait_until_settled(made, {}, heard, alone)[0] == ""


@pytest.mark.parametrize(
    ("theirs", "ends"),
    [
        # The second participant has the lidar's end after 2 s, too: packets were lost.
        (lambda now: [SCAN] if now > 2 else [], (observe.QUIET, 11.6, True, ())),
        (lambda now: [SCAN] if now > 0.5 else [], (observe.QUIET, 3.6, False, ())),
        (lambda _: [], (TIMEOUT, 15.0, True, ("/lidar",))),
    ],
)
def test_two_participants_see_whether_the_network_loses_packets(
    clock: Clock,
    monkeypatch: pytest.MonkeyPatch,
    theirs: Any,
    ends: tuple[str, float, bool, tuple[str, ...]],
) -> None:
    made = session(clock)
    other = made._replace(node=[b"second"])

    def overview(it: look.GraphSession) -> tuple[list[str], list[End]]:
        return ["/lidar"], theirs(clock.now) if it.node == other.node else [SCAN]

    monkeypatch.setattr(look, "overview", overview)
    monkeypatch.setattr(observe, "overview", overview)
    monkeypatch.setattr(observe, "view", lambda *_: (["/lidar"], [SCAN]))
    monkeypatch.setattr(observe, "_quiet_seconds", lambda *_: observe.assemble.QUIET_SECONDS)
    second = look.SecondParticipant(made, None)  # type: ignore[arg-type]
    second._second = other
    heard: Any = SimpleNamespace(update=lambda _: None)
    why, _, _, missed = observe._wait_until_settled(made, {}, heard, second)
    reason, seconds, lossy, nodes = ends
    assert (why, second.lossy, missed) == (reason, lossy, nodes)
    assert clock.now == pytest.approx(seconds, abs=1.1)
    assert [it.code for it in observe.assemble.seen_by_one(missed)] == (
        ["network-loses-packets"] if nodes else []
    )


@pytest.mark.parametrize(
    ("why", "over", "hears", "codes"),
    [
        ("quiet", False, 0, ["late"]), (EXPECTED, False, 0, []),
        ("quiet", False, 2, ["late"]), ("quiet", True, 9, ["late", "cut", "/tf"]),
    ],
)  # fmt: skip
def test_what_may_be_missing_in_a_snapshot_is_told(
    why: str,
    over: bool,
    hears: int,
    codes: list[str],
    clock: Clock,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """``hears``: how often something may still come."""
    left = [hears]

    def keep_waiting() -> bool:
        left[0] -= 1
        return left[0] >= 0

    updates: list[Any] = []
    heard = SimpleNamespace(
        keep_waiting=keep_waiting, silent=lambda: ["/tf"], update=updates.append
    )
    monkeypatch.setattr(observe, "GraphListeners", lambda _: heard)
    late = SimpleNamespace(starved=lambda: [Caveat("late", True, "")])
    monkeypatch.setattr(observe, "_wait_until_settled", lambda *_: (why, late, ("/a",), ()))
    monkeypatch.setattr(observe, "complete_view", lambda *_: (["/lidar"], [SCAN]))
    monkeypatch.setattr(observe.assemble, "cut_short", lambda *_: [Caveat("cut", True, "")])
    monkeypatch.setattr(
        observe.assemble, "not_heard", lambda names: [Caveat(it, True, "") for it in names]
    )
    monkeypatch.setattr(observe, "_snapshot", lambda *it: it[1:])
    made = session(clock, Request(1.0))
    clock.now = 5.0 if over else 0.0
    found: Any = observe.take_snapshot(made)
    names, ends, _, settled, more = found
    waited = 0.0 if over else 0.1 * hears
    assert (names, ends) == (["/lidar"], [SCAN])
    assert settled == (why, pytest.approx(clock.now - waited), ("/a",))
    assert [it.code for it in more] == codes and updates == [[SCAN]]
    assert clock.waited == ([] if over else [0.1] * hears)


@pytest.mark.parametrize(("topics", "codes"), [((), ["programs-unannounced"]), (("b",), [])])
def test_a_program_that_has_announced_itself_without_nodes_is_not_seen(
    topics: tuple[str, ...], codes: list[str], clock: Clock, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What has topics and no nodes is no ROS program."""
    monkeypatch.setattr(observe, "participants_here", lambda domain: {7: 3}[domain])
    asked = observe.queries
    monkeypatch.setattr(asked, "participants", lambda _: frozenset(("own", "a", "b")))
    monkeypatch.setattr(asked, "without_nodes", lambda *_: frozenset("b"))
    monkeypatch.setattr(asked, "participants_with_topics", lambda _: frozenset(topics))
    monkeypatch.setattr(asked, "on_this_machine", lambda _, found: sorted(found))
    monkeypatch.setattr(observe, "lost_here", lambda _: 0)
    found = observe._unannounced(session(clock), ["/lidar"], [SCAN])
    assert [it.code for it in found] == codes


@pytest.mark.parametrize(
    ("around", "announced", "here", "enough"),
    [
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}, 2, 2, "short"),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}, 2, 3, "long"),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}, 0, 0, "long"),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"}, 2, 2, "long"),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST", "ROS_STATIC_PEERS": "a"}, 2, 2, "long"),
        (
            {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST", "ROS_DISCOVERY_SERVER": "a:1"}, 2, 2,
            "long",
        ),
    ],
)  # fmt: skip
def test_a_shorter_look_is_enough_where_all_of_this_machine_are_known(
    around: dict[str, str], announced: int, here: int, enough: str, clock: Clock,
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    for it in ("ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_STATIC_PEERS", "ROS_DISCOVERY_SERVER"):
        monkeypatch.delenv(it, raising=False)
    monkeypatch.delenv("ROS_LOCALHOST_ONLY", raising=False)
    for name, value in around.items():
        monkeypatch.setenv(name, value)
    monkeypatch.setattr(observe.queries, "participants", lambda _: [*range(announced)])
    monkeypatch.setattr(observe, "participants_here", lambda domain: {7: here}[domain])
    wanted = {
        "short": observe.assemble.ALL_KNOWN_SECONDS, "long": observe.assemble.QUIET_SECONDS,
    }  # fmt: skip
    assert observe._quiet_seconds(session(clock)) == wanted[enough]


def test_what_is_subscribed_to(clock: Clock, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of images the last, of the clock all; a type without a header not at all."""
    asked: list[Any] = []

    def subscribe(node: Any, class_: Any, topic: str, latched: bool, call: Any, **more: Any) -> Any:
        asked.append((class_, topic, latched, more))
        return None if topic == "/twice" else (lambda: None)

    monkeypatch.setattr(ros, "subscribe", subscribe)
    monkeypatch.setattr(ros, "begins_with_header", lambda type_: "Image" in type_)
    monkeypatch.setattr(
        ros, "raw_message_class",
        lambda type_: ("", "no type") if "tf" in type_ and "x" in type_ else (f"raw {type_}", ""),
    )  # fmt: skip
    made, call = session(clock), lambda *_: None
    assert look._subscribe_to_headers(made, "/cmd", "std_msgs/msg/String", False, call) is None
    assert look._subscribe_to_headers(made, "/i", "sensor_msgs/msg/Image", True, call)
    assert look._subscribe_to_headers(made, "/clock", "rosgraph_msgs/msg/Clock", False, call)
    tf = "tf2_msgs/msg/TFMessage"
    assert callable(look._subscribe(made, "/tf", tf, False, call))
    said = look._subscribe(made, "/twice", tf, True, call)
    assert said == "they have two types, and the other is read already"
    said = look._subscribe(made, "/tf", "tf2_msgs/msg/x", False, call)
    assert said == "no type; install tf2_msgs or source ROS 2"
    assert asked == [
        ("raw sensor_msgs/msg/Image", "/i", True, {"depth": 1}),
        ("raw rosgraph_msgs/msg/Clock", "/clock", False, {"depth": 0}),
        (f"raw {tf}", "/tf", False, {}), (f"raw {tf}", "/twice", True, {}),
    ]  # fmt: skip


@pytest.mark.parametrize("headers", [True, False])
def test_ears_are_those_of_transforms_and_of_headers_where_they_are_asked_for(
    headers: bool, clock: Clock
) -> None:
    made: Any = look.GraphListeners(session(clock, Request(1.0, substitutes=not headers)))
    updated: list[Any] = []
    made.tf = SimpleNamespace(update=lambda *it: updated.append(it), silent=lambda: ["/tf", "/a"])
    made.headers = SimpleNamespace(
        update=lambda *it: updated.append(it), silent=lambda: ["/scan", "/a"]
    )
    made.update([SCAN])
    assert updated == [([SCAN], made._request.substitutes), *([([SCAN],)] if headers else [])]
    assert made.silent() == ["/a", "/scan", "/tf"]
    for of_tf, of_headers in ((True, True), (True, False), (False, True), (False, False)):
        made.tf.keep_waiting = lambda *it, on=of_tf: on and it == (1.5, 3.0)
        made.headers.keep_waiting = lambda *it, on=of_headers: on and it == (1.5,)
        assert made.keep_waiting() is (of_tf or of_headers)
