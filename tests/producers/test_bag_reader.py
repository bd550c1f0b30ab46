# SPDX-License-Identifier: Apache-2.0
"""What is read of a bag, with a stand-in for the reader of rosbags; messages are CDR."""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from math import inf
from types import SimpleNamespace
from typing import Any

import pytest

from multibot_rewrite.base.model import InputError
from multibot_rewrite.producers.bags import read
from multibot_rewrite.producers.bags.recording import RECORDER, RecordedTopic, Recording
from multibot_rewrite.system.records import Caveat, Edge, Qos

IMAGE, STRING = "sensor_msgs/msg/Image", "std_msgs/msg/String"
JOINTS, TF = "sensor_msgs/msg/JointState", "tf2_msgs/msg/TFMessage"
CLOCK, ODOMETRY = "rosgraph_msgs/msg/Clock", "nav_msgs/msg/Odometry"


class Cdr:
    """A message in CDR, little endian: each value is aligned to its size behind the four bytes."""

    def __init__(self) -> None:
        self.data = b""

    def put(self, layout: str, *values: Any) -> Cdr:
        for it in values:
            size = struct.calcsize(layout)
            self.data += b"\0" * (-len(self.data) % size) + struct.pack(f"<{layout}", it)
        return self

    def text(self, text: str) -> Cdr:
        self.put("I", len(text) + 1).data += text.encode() + b"\0"
        return self

    def header(self, frame: str, second: int = 1) -> Cdr:
        return self.put("i", second).put("I", 0).text(frame)

    @property
    def message(self) -> bytes:
        return b"\0\1\0\0" + self.data


def clock(seconds: float) -> bytes:
    second = int(seconds)
    return Cdr().put("i", second).put("I", round((seconds - second) * 1e9)).message


def transform(parent: str, child: str, x: float, second: int = 1) -> bytes:
    made = Cdr().put("I", 1).header(parent, second).text(child)
    return made.put("d", x, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0).message


def joints(*names: str) -> bytes:
    made = Cdr().header("").put("I", len(names))
    for it in names:
        made.text(it)
    return made.put("I", 0, 0, 0).message


def connection(
    topic: str, type_: str, *messages: bytes, text: str = "", profiles: Sequence[Any] = ()
) -> Any:
    return SimpleNamespace(
        topic=topic, msgtype=type_, msgcount=len(messages), own=messages,
        msgdef=SimpleNamespace(data=text), ext=SimpleNamespace(offered_qos_profiles=profiles),
    )  # fmt: skip


def recorded(*connections: Any, duration: int = 2_500_000_000) -> Recording:
    def messages(asked: list[Any]) -> Iterator[tuple[Any, int, bytes]]:
        yield from ((it, 0, data) for it in asked for data in it.own)

    reader: Any = SimpleNamespace(connections=connections, messages=messages, duration=duration)
    return read._recording(reader)


def test_topics_are_read_by_name_with_the_frames_of_their_first_messages() -> None:
    """Five messages of a topic are read; a name without a slash is that of the root."""
    images = [Cdr().header(it).message for it in ("b", "a", "b", "c", "d", "e")]
    found = recorded(
        connection("image", IMAGE, *images[:2]), connection("/image", IMAGE, *images[2:]),
        connection("/a", STRING, b"x"), duration=-5,
    )  # fmt: skip
    assert found == Recording(
        (
            RecordedTopic("/a", STRING, 1),
            RecordedTopic("/image", IMAGE, 6, frames=("b", "a", "c", "d")),
        ),
        (), 0.0,
    )  # fmt: skip
    assert recorded(connection("/a", STRING, b"x")).seconds == 2.5


@pytest.mark.parametrize(
    ("type_", "text", "there"),
    [
        (IMAGE, "", True), (STRING, "", False), (ODOMETRY, "", True),
        ("acme/msg/A", "std_msgs/Header header\nint8 x", True),
        ("acme/msg/A", "# words\n\n std_msgs/msg/Header   header", True),
        ("acme/msg/A", "Header header", True), ("acme/msg/A", "int8 x\nHeader header", False),
        ("acme/msg/A", "std_msgs/Header headers", False), (IMAGE, "int8 x", False),
    ],
)  # fmt: skip
def test_a_type_has_a_header_by_its_definition_or_as_it_is_known(
    type_: str, text: str, there: bool
) -> None:
    message = Cdr().header("f").put("d", *[0.0] * 20).message
    (topic,) = recorded(connection("/x", type_, message, text=text)).topics
    assert topic.frames == (("f",) if there else ())


def test_joints_a_clock_and_a_pose_are_read() -> None:
    """A clock goes back by 1.96 seconds; of poses one with a number that is none is kept."""

    def odometry(x: float) -> bytes:
        return Cdr().header("odom").text("base").put("d", x, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0).message

    found = recorded(
        connection("/clock", CLOCK, *map(clock, (5, 6, 4.04, 7, 6))),
        connection("/joints", JOINTS, joints("a", "b"), joints(), joints("a", "b"), joints("c")),
        connection("/odom", ODOMETRY, odometry(1.0), odometry(float("nan")), odometry(2.0)),
    )  # fmt: skip
    assert found.topics == (
        RecordedTopic("/clock", CLOCK, 5, back=2.0),
        RecordedTopic("/joints", JOINTS, 4, joints=(("a", "b"), ("c",))),
        RecordedTopic(
            "/odom", ODOMETRY, 3, frames=("odom",), pose=(inf, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
        ),
    )


@pytest.mark.parametrize(
    ("topic", "static"),
    [
        ("/tf", False), ("/tf_static", True), ("/r/tf_static", True), ("/tf_static/r", True),
        ("/my_tf_static", False),
    ],
)  # fmt: skip
def test_transforms_are_as_they_were_at_last(topic: str, static: bool) -> None:
    """Ten messages in nine seconds are one a second; what is static has no rate."""
    often = [transform("odom", "base", float(at), at + 1) for at in range(10)]
    (edge,) = recorded(connection(topic, TF, *often)).transforms
    last = (9.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0)
    rate = 0.0 if static else 1.0
    assert edge == Edge("base", "odom", topic, static, (RECORDER,), transform=last, rate=rate)


def test_what_is_no_transform_ends_the_reading_and_is_told(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    good = [transform("odom", it, 1.0) for it in ("a", "b")]
    found = recorded(connection("/tf", TF, good[0], b"no cdr", good[1]))
    assert [it.child for it in found.transforms] == ["a"]
    text = "messages on /tf are no TFMessage, or more than 50,000: not all were read"
    assert found.caveats == (Caveat("frames-not-read", True, text),)
    monkeypatch.setattr(read, "TRANSFORMS", 2)
    assert recorded(connection("/tf", TF, *good)).caveats == ()
    assert [it.code for it in recorded(connection("/tf", TF, *good, good[0])).caveats] == [
        "frames-not-read"
    ]


@pytest.mark.parametrize(
    ("connections", "told"),
    [
        ([], ["it has no topics"]),
        ([connection("/b", STRING), connection("/a", STRING)],
         ["no message was recorded (/a, /b)"]),
        ([connection("/b", STRING), connection("/a", STRING, b"x")], []),
    ],
)  # fmt: skip
def test_a_bag_without_messages_is_told(connections: list[Any], told: list[str]) -> None:
    found = recorded(*connections)
    assert found.caveats == tuple(Caveat("empty-bag", True, it) for it in told)


def test_a_profile_is_read_with_its_times() -> None:
    """Zero, and the longest time of rmw, are no limit."""

    def word(name: str) -> Any:
        return SimpleNamespace(name=name)

    def lasting(seconds: int, nanoseconds: int) -> Any:
        return SimpleNamespace(sec=seconds, nsec=nanoseconds)

    profile = SimpleNamespace(
        history=word("KEEP_LAST"), depth="7", reliability=word("RELIABLE"),
        durability=word("VOLATILE"), deadline=lasting(0, 0), lifespan=lasting(1, 500_000_000),
        liveliness=word("AUTOMATIC"),
        liveliness_lease_duration=lasting(9_223_372_036, 854_775_807),
    )  # fmt: skip
    (topic,) = recorded(connection("/a", STRING, b"x", profiles=[profile])).topics
    assert topic.qos == (Qos("KEEP_LAST", 7, "RELIABLE", "VOLATILE", inf, 1.5, "AUTOMATIC", inf),)


def test_a_bag_that_is_not_there_is_told() -> None:
    pytest.importorskip("rosbags.rosbag2")
    with pytest.raises(InputError) as refused:
        read.read_bag("/no/such.mcap")
    said = "/no/such.mcap: there is no such bag; name a folder, or a file .mcap or .db3"
    assert str(refused.value) == said
