# SPDX-License-Identifier: Apache-2.0
"""Frames that headers of messages name: who is told what, and what is healthy."""

from __future__ import annotations

import struct
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from fault_changes import nav
from graph_calls import Whose, diagnose, from_json, index, judge, to_json, with_answers
from graph_cases import qos
from graph_examples import read_system
from node_answers import told
from open_faults import without_edge

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import InputError
from multibot_rewrite.cli import multibot
from multibot_rewrite.producers.ros.headers import (
    HeaderSamples,
    pose_in,
)
from multibot_rewrite.system.records import (
    PUBLISHES,
    TOPIC,
    End,
    Heard,
    Node,
    System,
    answering,
)

SCAN, JOINTS = "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/JointState"
TWO_ROBOTS = """\
running: transform map -> robot1/odom on /tf
running: transform robot1/odom -> robot1/camera_link on /tf
running: transform map -> robot2/odom on /tf
running: transform robot2/odom -> robot2/camera_link on /tf
running: /robot1/camera publishes /robot1/image sensor_msgs/msg/Image
running: /robot1/camera publishes /robot1/camera_info sensor_msgs/msg/CameraInfo
running: /robot1/planner publishes /robot1/goal geometry_msgs/msg/PoseStamped
"""


def serialized(
    frame: str, mark: bytes = b"\x00\x01", rest: bytes = b"\x00" * 9, stamp: float = 7.000000008
) -> bytes:
    """Return a message as in DDS: encapsulation, stamp, text with its length and a zero, the rest."""
    order = "<" if mark == b"\x00\x01" else ">"
    text = frame.encode() + b"\x00"
    return mark + b"\x00\x00" + struct.pack(f"{order}iII", *_parts(stamp), len(text)) + text + rest


def _parts(stamp: float) -> tuple[int, int]:
    return int(stamp), round(stamp % 1 * 1e9)


def found(*lines: str) -> list[Finding]:
    return judge(read_system(TWO_ROBOTS + "".join(f"running: {it}\n" for it in lines)))


def heard(graph: System, topic: str, frame: str) -> System:
    return graph._replace(heard=(Heard(topic, frame),))


def test_a_map_that_nothing_joins_with_its_robot_is_one_finding() -> None:
    graph = without_edge("odom", "/robot2/tf")(nav())
    assert [it.code for it in diagnose(graph).findings] == ["MG415"]
    with_map = heard(graph, "/robot2/map", "map")
    assert [it.code for it in diagnose(with_map).findings] == ["MG415"]


@pytest.mark.parametrize(
    ("frame", "topic", "codes"),
    [
        ("map", "/robot1/map", []),
        ("robot1/odom", "/robot1/map", ["MG415"]),
        ("robot3/base_link", "/robot3/map", []),
        # A local costmap.
        ("robot1/odom", "/robot1/costmap", []),
        # Nothing says that it moves.
        ("robot3/odom", "/robot3/map", []),
    ],
)
def test_a_map_is_not_in_the_frame_of_odometry(frame: str, topic: str, codes: list[str]) -> None:
    sent = f"{topic.rpartition('/')[0]}/server publishes {topic} nav_msgs/msg/OccupancyGrid"
    third = "transform robot3/odom -> robot3/base_link on /tf"
    told = found(sent, third, f"frame_id {frame} on {topic}")
    assert [(it.code, it.level) for it in told] == [(it, "warning") for it in codes]
    assert all(f"is {frame}, which moves in map" in it.message for it in told)


@pytest.mark.parametrize(("own", "codes"), [(True, ["MG411"]), (False, [])])
def test_a_map_in_another_robots_frame(own: bool, codes: list[str]) -> None:
    """Without a frame of its own for a map, a robot may be on another one's."""
    frames = [f"transform robot{at}/map -> robot{at}/odom on /tf" for at in (1, 2)[: 1 + own]]
    sent = "/robot2/map_server publishes /robot2/map nav_msgs/msg/OccupancyGrid"
    told = judge(read_system("".join(f"running: {it}\n" for it in (
        *frames, "transform robot2/odom -> robot2/base_link on /tf", sent,
        "frame_id robot1/map on /robot2/map"))))  # fmt: skip
    assert [it.code for it in told] == codes
    assert all("set the frame of /robot2/map_server to robot2/map" in it.hint for it in told)


def test_another_robots_frame_is_named_with_both() -> None:
    (it,) = found("frame_id robot2/camera_link on /robot1/image")
    assert (it.code, it.robot) == ("MG411", "robot1")
    assert "a frame of robot2; sent by /robot1/camera" in it.message


# What vendors' descriptions call the frame of such a sensor.
CALLED = {
    "sensor_msgs/msg/LaserScan": ("laser", "lidar_link", "base_scan"),
    "sensor_msgs/msg/PointCloud2": ("lidar_link", "velodyne", "ouster", "camera_depth_frame"),
    "sensor_msgs/msg/Imu": ("imu_link",),
    "sensor_msgs/msg/Image": ("camera_optical_frame",),
    "sensor_msgs/msg/NavSatFix": ("gps_link", "gnss", "navsat_link"),
}


def test_the_one_frame_of_such_a_sensor_is_named_as_the_remedy() -> None:
    for type_, frames in CALLED.items():
        for frame in frames:
            text = (
                f"running: transform robot1/base_link -> robot1/{frame} on /tf\n"
                f"running: /robot1/driver publishes /robot1/data {type_}\n"
                "running: frame_id zzzzz on /robot1/data"
            )
            (it,) = [it for it in diagnose(read_system(text).system).findings if it.code == "MG412"]
            assert it.hint.endswith(f" to robot1/{frame}"), it


# ---------------------------------------------------------------- what is received


def end(topic: str, type_: str = SCAN, node: str = "/a") -> End:
    return End(TOPIC, PUBLISHES, topic, type_, "", node, None, "")


def rate_of(messages: list[tuple[int | None, float]], type_: str = SCAN, senders: int = 1) -> float:
    """By the numbers and stamps of messages; a subscription that has ended receives no more."""
    receive, ended = [], []
    samples = HeaderSamples(lambda *it: receive.append(it[3]) or (lambda: ended.append(1)))  # type: ignore[arg-type, func-returns-value]
    samples.update([end("/scan", type_, f"/n{at}") for at in range(senders)])
    for number, stamp in messages:
        if not ended:
            receive[0](serialized("laser", stamp=stamp), number)  # type: ignore[operator]
    return samples.heard()[0].rate


@pytest.mark.parametrize(
    ("messages", "rate"),
    [
        ([(1, 10.0), (2, 10.1), (7, 10.6)], 10.0),
        # Half a second is enough, and then no more is received.
        ([(1, 10.0), (6, 10.5), (100, 10.6)], 10.0),
        ([(1, 10.0), (2, 11.0)], 1.0),
        ([(1, 10.0), (2, 10.1)], 0.0),
        ([(1, 10.0)], 0.0),
        ([(None, 10.0), (None, 11.0)], 0.0),
        ([(1, 0.0), (2, 0.0)], 0.0),
        # A publisher that was started anew counts from the beginning.
        ([(50, 10.0), (2, 11.0)], 0.0),
    ],
)
def test_a_rate_is_that_of_numbers_and_stamps(
    messages: list[tuple[int | None, float]], rate: float
) -> None:
    assert rate_of(messages) == rate


def test_one_message_in_a_while_is_a_slow_sensor(monkeypatch: pytest.MonkeyPatch) -> None:
    """A second message is waited for, and the look ends without it."""
    now = [100.0]
    monkeypatch.setattr("multibot_rewrite.producers.ros.headers.time.monotonic", lambda: now[0])
    receive: list[Callable[[bytes, int], None]] = []
    samples = HeaderSamples(lambda *it: receive.append(it[3]) or (lambda: None))  # type: ignore[arg-type, func-returns-value]
    samples.update([end("/scan")])
    assert samples.keep_waiting(1.5)
    # A body's sensor is waited for longer than others.
    now[0] += 2.9
    assert samples.keep_waiting(1.5)
    now[0] += 0.2
    assert not samples.keep_waiting(1.5)
    now[0] -= 2.6
    receive[0](serialized("laser", stamp=10.0), 1)
    assert samples.keep_waiting(1.5) and samples.heard()[0].rate == 0.0
    now[0] += 2.0
    assert not samples.keep_waiting(1.5) and samples.heard()[0].rate == 0.4


def slower(
    rate: float, topic: str = "scan", type_: str = SCAN, read: bool = False
) -> list[Finding]:
    """Two robots, the second of which sends at this rate, the first at 10 Hz."""
    both = ("robot1", "robot2")
    lines = [f"/{it}/lidar publishes /{it}/{topic} {type_}" for it in both]
    lines += [f"/{it}/amcl subscribes /{it}/{topic} {type_}" for it in both if read]
    graph = read_system("".join(f"running: {it}\n" for it in lines))
    one = Heard(f"/robot1/{topic}", "laser", rate=10.0)
    heard = (one, one._replace(topic=f"/robot2/{topic}", rate=rate))
    return judge(index(graph.system._replace(heard=heard), Whose(*graph[1:6])))


def test_a_sensor_that_is_three_times_slower_than_a_siblings_is_told() -> None:
    (it,) = slower(3.3)
    assert (it.code, it.robot, it.node) == ("MG326", "robot2", "/robot2/lidar")
    assert it.message.startswith("publishes /robot2/scan at 3.3 Hz, /robot1/scan comes at 10.0 Hz")
    # Read by nobody it hurts nobody; so seldom it is as good as none for who reads it.
    assert [it.level for it in slower(0.4)] == ["warning"]
    assert [it.level for it in slower(0.4, read=True)] == ["error"]
    assert [it.level for it in slower(1.0, read=True)] == ["warning"]
    # So many are usual, or nobody knows, or what it sends is no measure of a sensor.
    assert not slower(3.4) and not slower(0.0)
    assert not slower(1.0, "goal", "geometry_msgs/msg/PoseStamped")


# ---------------------------------------------------------------- the file


@pytest.mark.more
def test_a_snapshot_keeps_what_was_heard_and_answered() -> None:
    own = (("arm", "active", ("joint1/position",)), ("spare", "inactive", ()))
    states = (
        told("/a", "inactive", True, (), (("rate", "5.0"),)),
        told("/b", "", None, own),
        told("/c"),
    )
    nodes = (*nav().nodes, Node("/a"))
    graph = with_answers(nav()._replace(nodes=nodes, heard=(Heard("/scan", "/laser"),)), states)
    assert from_json(to_json(graph), "g") == graph
    assert graph.nodes[-1].lifecycle == "inactive"
    assert answering(graph) == {"/a", "/b"}
    assert not any(it in to_json(nav()) for it in (b'"heard"', b'"parameters"', b'"lifecycle"'))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('"heard": 3, ', "heard: expected a list, not 3"),
        ('"heard": [{"topic": "scan", "frame": ""}], ', "heard[0].topic: expected a full name"),
        (
            '"parameters": [{"node": "/a", "name": "rate", "value": 5}], ',
            "parameters[0].value: expected text",
        ),
        ('"controllers": [{"name": "arm"}], ', "controllers[0].manager: missing"),
    ],
)
def test_wrong_records_are_said_with_their_place(text: str, said: str) -> None:
    data = to_json(nav()).decode().replace('"nodes"', f'{text}"nodes"', 1)
    with pytest.raises(InputError, match="g: ") as raised:
        from_json(data.encode(), "g")
    assert said in str(raised.value)


def test_the_table_shows_what_was_heard_and_answered(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    states = (
        told("/m", "", False, (("arm", "active", ()),)),
        told("/n", "inactive"),
    )
    nodes = (*nav().nodes, Node("/n"))
    graph = with_answers(nav()._replace(nodes=nodes, heard=(Heard("/scan", "laser"),)), states)
    (tmp_path / "g.json").write_bytes(to_json(graph))
    assert multibot.main(["snapshot", "--from", str(tmp_path / "g.json")]) == 0
    lines = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert ["/scan", "laser"] in lines and ["/n", "inactive"] in lines
    assert ["/m", "false", "arm", "(active)"] in lines


@pytest.mark.parametrize(
    ("before", "latched", "age"),
    [
        (0.9, False, 0.0), (-0.9, False, 0.0), (1.0, False, 1.0), (-1.0, False, -1.0),
        (12.34, False, 12.3), (-60.0, False, -60.0), (12.0, True, 0.0),
    ],
)  # fmt: skip
def test_a_message_has_the_age_of_its_stamp(
    before: float, latched: bool, age: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What is latched may have been sent long ago; less than a second is the network's."""
    monkeypatch.setattr(time, "time", lambda: 1000.0)
    (heard,) = sampled(1000.0 - before, latched)
    assert heard.age == age


def sampled(stamp: float, latched: bool = False) -> tuple[Heard, ...]:
    """Return what is kept of one message."""
    calls: list[Callable[[bytes], None]] = []
    samples = HeaderSamples(lambda *it: calls.append(it[3]) or (lambda: None))
    durability = "TRANSIENT_LOCAL" if latched else "VOLATILE"
    samples.update([end("/scan")._replace(qos=qos(durability=durability))])
    calls[0](serialized("laser", stamp=stamp))
    return samples.heard()


@pytest.mark.parametrize(
    ("type_", "frames"),
    [
        ("geometry_msgs/msg/PoseStamped", 1),
        ("geometry_msgs/msg/PoseWithCovarianceStamped", 1),
        ("nav_msgs/msg/Odometry", 2),
    ],
)
def test_a_pose_stands_behind_the_frames_of_its_message(type_: str, frames: int) -> None:
    """The fields of the .msg files: a header, the child frame of odometry, the pose. A frame of three
    letters ends at a multiple of four; numbers of eight bytes begin at one of eight (CDR)."""
    data = struct.pack("<ii", 1, 2) + struct.pack("<I4s", 4, b"map\0") * frames
    data += bytes(-len(data) % 8) + struct.pack("<7d", 1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0)
    assert pose_in(type_, b"\0\1\0\0" + data + bytes(36 * 8)) == (1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0)
