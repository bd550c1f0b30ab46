# SPDX-License-Identifier: Apache-2.0
"""What is read of a bag, with a stand-in for the reader of rosbags; messages are CDR."""

from __future__ import annotations

import errno
import struct
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from math import inf
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from multibot_rewrite.base.model import InputError
from multibot_rewrite.producers.bags import read
from multibot_rewrite.producers.bags.read import RecordedTopic, Recording
from multibot_rewrite.system.records import Caveat, Qos

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


def test_what_is_no_transform_ends_the_reading_and_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
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


class Opened:
    """In the place of rosbags' reader: a bag without topics, or what opening it raises."""

    connections, duration = (), 0

    def __init__(self, fault: Exception | None) -> None:
        self.fault = fault

    def __call__(self, path: str) -> Opened:
        if self.fault:
            raise self.fault
        return self

    def __enter__(self) -> Opened:
        return self

    def __exit__(self, *_: object) -> None:
        pass


def read_here(
    monkeypatch: pytest.MonkeyPatch, path: Path, fault: Exception | None = None
) -> Recording | str:
    """Return what is read of a bag in this process, or why it is not."""
    limits: list[int] = []
    monkeypatch.setattr(read, "limit_files", limits.append)
    monkeypatch.setattr(tempfile, "tempdir", None)
    monkeypatch.setitem(sys.modules, "rosbags", SimpleNamespace())
    monkeypatch.setitem(sys.modules, "rosbags.rosbag2", SimpleNamespace(Reader=Opened(fault)))
    found = read._read_with_limits("/unpacked/here", 7, str(path))
    assert tempfile.tempdir == "/unpacked/here" and set(limits) <= {7}
    assert limits or isinstance(found, InputError), "nothing bounds what it unpacks to"
    return str(found) if isinstance(found, InputError) else found


@pytest.mark.parametrize(
    ("fault", "reason"),
    [
        (ValueError("no such table."), "no such table"), (EOFError(), "EOFError"),
        (ValueError("two\nlines"), "two\\nlines"), (RuntimeError("a" * 300), "a" * 200),
        (OSError(errno.EIO, "broken"), "[Errno 5] broken"),
    ],
)  # fmt: skip
def test_a_damaged_bag_says_what_its_reader_says(
    fault: Exception, reason: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert read_here(monkeypatch, tmp_path, fault) == (
        f"{tmp_path}: not a readable bag: {reason};"
        " is the recording complete? ros2 bag reindex may mend it"
    )


@pytest.mark.parametrize("fault", [MemoryError(), OSError(errno.EFBIG, "large")])
def test_a_bag_that_unpacks_to_too_much_is_refused(
    fault: Exception, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    said = f"{tmp_path}: it unpacks to more than a bag may hold; leave it out"
    assert read_here(monkeypatch, tmp_path, fault) == said


def test_a_folder_is_read_with_its_metadata_or_without(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    empty = Recording((), (), 0.0, (Caveat("empty-bag", True, "it has no topics"),))
    assert read_here(monkeypatch, tmp_path) == empty
    (tmp_path / "metadata.yaml").write_text("rosbag2_bagfile_information: {}\n")
    assert read_here(monkeypatch, tmp_path) == empty
    (tmp_path / "metadata.yaml").write_text("a: [")
    found = read_here(monkeypatch, tmp_path)
    assert isinstance(found, str) and found.startswith(
        f"{tmp_path}/metadata.yaml:1:5: not valid YAML: "
    )


def test_a_file_that_is_no_bag_is_told_before_it_is_opened(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "x.mcap"
    path.write_text('<robot name="r"/>')
    found = read_here(monkeypatch, path, ValueError("not asked"))
    assert isinstance(found, str) and found.startswith(f"{path}: a description; use multibot init")
    path.write_bytes(b"\x89MCAP0\r\n")
    assert isinstance(read_here(monkeypatch, path), Recording)


HEADED = [
    *(f"sensor_msgs/msg/{it}" for it in (
        "LaserScan", "PointCloud2", "Image", "CompressedImage", "CameraInfo", "Imu", "Range",
        "NavSatFix",
    )),
    *(f"nav_msgs/msg/{it}" for it in ("Odometry", "Path", "OccupancyGrid")),
    *(f"geometry_msgs/msg/{it}" for it in (
        "PoseStamped", "PoseWithCovarianceStamped", "TwistStamped",
    )),
]  # fmt: skip


@pytest.mark.parametrize("type_", HEADED)
def test_types_with_a_header_that_need_no_definition(type_: str) -> None:
    message = Cdr().header("f").put("d", *[0.0] * 50).message
    (topic,) = recorded(connection("/x", type_, message)).topics
    assert topic.frames == ("f",)


def test_a_bag_is_read_in_one_process_that_may_unpack_forty_times_its_largest_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """At least a gigabyte: messages pack to a twentieth of their size."""
    asked: list[tuple[Any, ...]] = []

    @contextmanager
    def pool(
        call: Any, paths: list[str], lost: Callable[..., Exception], many: int
    ) -> Iterator[Any]:
        asked.append((call.func, Path(call.args[0]).is_dir(), call.args[1], paths, many))
        yield SimpleNamespace(results=lambda: iter([lost(paths[0], 9)]))

    monkeypatch.setitem(sys.modules, "rosbags", SimpleNamespace())
    monkeypatch.setitem(sys.modules, "rosbags.rosbag2", SimpleNamespace())
    monkeypatch.setattr(read, "worker_pool", pool)
    with (tmp_path / "a.db3").open("wb") as file:
        file.truncate(2**26)
    (tmp_path / "b.db3").write_bytes(b"x")
    (tmp_path / "folder").mkdir()
    small, large = tmp_path / "b.db3", tmp_path
    for path, most in ((small, 2**30), (large, 40 * 2**26)):
        with pytest.raises(InputError) as refused:
            read.read_bag(str(path))
        assert str(refused.value) == f"{path}: the process that read it was ended by signal 9"
        assert asked.pop() == (read._read_with_limits, True, most, [str(path)], 1)
