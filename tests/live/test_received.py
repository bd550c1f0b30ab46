# SPDX-License-Identifier: Apache-2.0
"""What is judged of messages besides their frames: rates of tf, names of joints, the time on /clock."""

from __future__ import annotations

import math
import struct
import time
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

import pytest
from graph_examples import read_system
from made_bags import STORE, qos
from rosbags.rosbag2 import StoragePlugin, Writer

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.live.diagnose import diagnose
from multibot_rewrite.producers.bags.read import read_bag
from multibot_rewrite.producers.bags.recording import as_snapshot
from multibot_rewrite.producers.ros.headers import HeaderSamples
from multibot_rewrite.producers.ros.tf_subscriptions import Pace, TfSubscriptions
from multibot_rewrite.producers.snapshot_file import read_snapshot
from multibot_rewrite.producers.zenoh.cdr import read_joint_names, read_tf
from multibot_rewrite.rules.check import judge
from multibot_rewrite.system.index import Index
from multibot_rewrite.system.json import to_json
from multibot_rewrite.system.records import PUBLISHES, TOPIC, End, Heard, Place, Qos, System

CLOCK, JOINTS, TF, ODOM, POSE = (
    "rosgraph_msgs/msg/Clock",
    "sensor_msgs/msg/JointState",
    "tf2_msgs/msg/TFMessage",
    "nav_msgs/msg/Odometry",
    "geometry_msgs/msg/PoseStamped",
)
SECOND = 1_000_000_000


def stamp(seconds: float) -> bytes:
    return struct.pack("<iI", int(seconds), round(seconds % 1 * 1e9))


def text(value: str, before: int) -> bytes:
    """Return a string of CDR behind so many bytes: its length is at a multiple of four."""
    data = value.encode() + b"\0"
    return b"\0" * (-before % 4) + struct.pack("<I", len(data)) + data


def clock(seconds: float) -> bytes:
    return b"\0\1\0\0" + stamp(seconds)


def joint_state(*names: str, frame: str = "", seconds: float = 1.0) -> bytes:
    body = stamp(seconds)
    body += text(frame, len(body))
    body += b"\0" * (-len(body) % 4) + struct.pack("<I", len(names))
    for name in names:
        body += text(name, len(body))
    return b"\0\1\0\0" + body


def transform(parent: str, child: str, seconds: float) -> bytes:
    body = struct.pack("<I", 1) + stamp(seconds)
    body += text(parent, len(body))
    body += text(child, len(body))
    body += b"\0" * (-len(body) % 8) + struct.pack("<7d", 1, 0, 0, 0, 0, 0, 1)
    return b"\0\1\0\0" + body


def posed(*texts: str, x: float = 1.0, w: float = 1.0) -> bytes:
    """Return a pose behind these texts; more follows in odometry."""
    body = stamp(1.0)
    for it in texts:
        body += text(it, len(body))
    body += b"\0" * (-len(body) % 8) + struct.pack("<7d", x, 2, 0, 0, 0, 0, w)
    return b"\0\1\0\0" + body


# ------------------------------------------------------------------------------- how often


@pytest.mark.parametrize(
    ("stamps", "rate", "back"),
    [
        ([1.0, 1.1, 1.2, 1.3], 10.0, 0.0),
        # Of what a busy machine loses the median is left.
        ([1.0, 1.1, 1.2, 1.9, 2.0, 2.1], 10.0, 0.0),
        ([1.0, 1.1, 1.2], 0.0, 0.0),
        # A clock that began at 0.
        ([0.0, 0.2, 0.4, 0.6], 5.0, 0.0),
        ([5.0, 5.0, 5.0, 5.0, 5.0], 0.0, 0.0),
        ([], 0.0, 0.0),
        ([9.0, 9.5, 1.0, 1.5, 2.0, 0.5], 2.0, 8.5),
    ],
)
def test_a_pace_is_that_of_stamps(stamps: Sequence[float], rate: float, back: float) -> None:
    pace = Pace()
    for it in stamps:
        pace = pace.after(it)
    assert (pace.rate(), pace.back) == (rate, back)


def heard_on_tf(stamps: Iterable[float], topic: str = "/tf", marks: Iterable[int] = ()) -> float:
    receive: list[Callable[..., None]] = []
    session = TfSubscriptions(lambda *it: receive.append(it[3]) or (lambda: None))  # type: ignore[arg-type, func-returns-value]
    volatile = Qos("UNKNOWN", 0, "RELIABLE", "VOLATILE", math.inf, math.inf, "AUTOMATIC", math.inf)
    ends = [End(TOPIC, PUBLISHES, topic, TF, "", "/a", volatile, "")]
    session.update(ends, False)
    numbers = list(marks) or range(99)
    for number, it in zip(numbers, stamps, strict=False):
        receive[0](read_tf(transform("odom", "base_link", it)), number)
    return next(session.edges(ends)).rate


def test_a_transform_that_one_sends_has_a_rate() -> None:
    assert heard_on_tf([3.0, 3.02, 3.04, 3.06]) == 50.0
    # Two publishers number their messages each: nobody's rate is known.
    assert heard_on_tf([3.0, 3.02, 3.04, 3.06, 3.08], marks=[5, 1, 6, 2, 7]) == 0.0


MOVING = """\
running: transform robot1/odom -> robot1/base_link on /tf by /robot1/drive
running: transform robot2/odom -> robot2/base_link on /tf by /robot2/drive
running: transform robot1/base_link -> robot1/wheel on /tf by /robot1/drive
running: transform robot2/base_link -> robot2/wheel on /tf by /robot2/drive
"""


def paced(*rates: float) -> list[Finding]:
    seen = read_system(MOVING)
    edges = (it._replace(rate=rate) for it, rate in zip(seen.system.edges, rates, strict=True))
    return [it for it in judge(fresh(seen, edges=tuple(edges))) if it.code == "MG326"]


def fresh(seen: Index, **more: Any) -> Index:
    """Return the index of a system that is changed: what it remembers is of the other."""
    return seen._replace(system=seen.system._replace(**more), memo={})


def aged(*ages: float, clock: bool = False, senders: tuple[str, ...] = ()) -> list[Finding]:
    """Return what is said of the first transforms when they are so old."""
    lines = MOVING + "running: /sim publishes /clock rosgraph_msgs/msg/Clock\n" * clock
    seen = read_system(lines)
    ages += (0.0,) * (len(seen.system.edges) - len(ages))
    edges = [it._replace(age=age) for it, age in zip(seen.system.edges, ages, strict=True)]
    edges = [it._replace(publishers=senders or it.publishers) for it in edges]
    return [it for it in judge(fresh(seen, edges=tuple(edges))) if it.code == "MG417"]


def test_a_sender_of_transforms_that_a_file_starts_is_named_first() -> None:
    seen = read_system(
        "running: transform odom -> base_link on /robot1/tf by /robot1/wheel\n"
        "running: transform map -> odom on /robot1/tf by /robot1/ekf\n"
        "running: /robot1/planner looks up base_footprint"
    )
    placed = Place("a.launch.py", 7)
    edges = (it._replace(place=placed) if it.child == "odom" else it for it in seen.system.edges)
    (it,) = judge(fresh(seen, edges=tuple(edges)))
    assert it.hint.startswith("/robot1/ekf sends map -> odom (a.launch.py:7)")


def test_transforms_that_are_stamped_with_another_time() -> None:
    (it,) = aged(30.0)
    assert (it.level, it.node, it.robot) == ("error", "/robot1/drive", "robot1")
    assert it.message == "the stamps of robot1/odom -> robot1/base_link on /tf are 30 s old"
    # What localizers stamp ahead, and the network's delay.
    assert not aged(-2.0, 2.0)
    (ahead,) = aged(0.0, -10.0)
    assert ahead.robot == "robot2" and "10 s in the future" in ahead.message
    assert not aged(math.inf)
    (machine,) = aged(2.0, clock=True)
    assert "not of /clock" in machine.message
    assert not aged(30.0, senders=("/rosbag2_player",))
    assert not aged(30.0, senders=("/rosbag2_player_2",))
    # Of two of the robot the one that is no publisher of its description.
    (it,) = aged(30.0, senders=("/robot1/robot_state_publisher", "/robot1/ekf", "/robot2/ekf"))
    assert it.node == "/robot1/ekf"


def test_the_age_of_a_transform_is_that_of_its_youngest_message(tmp_path: Path) -> None:
    receive: list[Callable[..., None]] = []
    session = TfSubscriptions(lambda *it: receive.append(it[3]) or (lambda: None))  # type: ignore[arg-type, func-returns-value]
    volatile = Qos("UNKNOWN", 0, "RELIABLE", "VOLATILE", math.inf, math.inf, "AUTOMATIC", math.inf)
    ends = [End(TOPIC, PUBLISHES, "/tf", TF, "", "/a", volatile, "")]
    session.update(ends, False)
    for number, behind in enumerate((31.0, 30.0, 33.0)):
        receive[0](read_tf(transform("odom", "base_link", time.time() - behind)), number)
    # One that is ahead is not the younger for it.
    for number, behind in enumerate((2.0, -10.0)):
        receive[0](read_tf(transform("map", "odom", time.time() - behind)), number)
    edge, other = sorted(session.edges(ends))
    assert 29.9 <= edge.age <= 30.9 and 1.9 <= other.age <= 2.9
    (tmp_path / "a.json").write_bytes(to_json(System(edges=(edge._replace(age=math.inf),))))
    assert read_snapshot(str(tmp_path / "a.json")).edges[0].age == math.inf


def test_tf_that_is_three_times_slower_than_a_siblings_is_told() -> None:
    (it,) = paced(50.0, 10.0, 0.0, 0.0)
    assert (it.robot, it.names) == ("robot2", ("robot2/base_link", "/tf"))
    assert "at 10.0 Hz" in it.message and "at 50.0 Hz" in it.message
    assert not paced(50.0, 17.0, 0.0, 0.0)
    assert not paced(50.0, 0.0, 0.0, 0.0)
    # A wheel that stands still need not be sent as often.
    assert not paced(50.0, 50.0, 50.0, 1.0)


# ------------------------------------------------------------------------------- joints


def test_names_of_joints_are_read() -> None:
    assert read_joint_names(joint_state("left_wheel", "arm", frame="x")) == ("left_wheel", "arm")
    assert read_joint_names(joint_state()) == ()
    assert read_joint_names(joint_state("wheel")[:-3]) == ()
    assert read_joint_names(b"") == ()


def samples_of(topic: str, type_: str, *messages: bytes) -> tuple[Heard, ...]:
    receive: list[Callable[[bytes, int], None]] = []
    samples = HeaderSamples(lambda *it: receive.append(it[3]) or (lambda: None))  # type: ignore[arg-type, func-returns-value]
    samples.update([End(TOPIC, PUBLISHES, topic, type_, "", "/a", None, "")])
    for at, data in enumerate(messages):
        receive[0](data, at)
    return samples.heard()


@pytest.mark.parametrize(
    ("type_", "messages", "told"),
    [
        (ODOM, [posed("odom", "base_link")], ""),
        # A driver whose first reading is right.
        (ODOM, [posed("odom", "base_link"), posed("odom", "base_link", x=math.nan)], "(NaN)"),
        (ODOM, [posed("odom", "base_link", w=0.0)], "all zeros"),
        (ODOM, [posed("odom", "base_footprint", w=0.5)], "not of length 1"),
        (ODOM, [posed("odom", "")], "warning: MG412 child_frame_id of /robot1/odom is empty"),
        (POSE, [posed("map", x=math.inf)], "(NaN)"),
        (POSE, [posed("map")], ""),
        pytest.param(ODOM, [posed("odom", "base_link")[:-1]], "", id="cut short"),
        pytest.param(JOINTS, [posed("odom", "base_link", w=0.0)], "", id="of no pose"),
    ],
)
def test_a_pose_of_no_place_is_told(type_: str, messages: list[bytes], told: str) -> None:
    heard = samples_of("/robot1/odom", type_, *messages)
    seen = read_system(f"running: /robot1/drive publishes /robot1/odom {type_}")
    found = [it for it in judge(fresh(seen, heard=heard)) if it.code in ("MG416", "MG412")]
    assert [told in str(it).partition(" (see ")[0] for it in found] == ([True] if told else [])
    assert all((it.robot, it.node) == ("robot1", "/robot1/drive") for it in found)


ARMS = """\
running: /robot1/jsb publishes /robot1/joint_states sensor_msgs/msg/JointState
running: /robot2/jsb publishes /robot2/joint_states sensor_msgs/msg/JointState
running: /planner publishes /robot2/arm/joint_trajectory trajectory_msgs/msg/JointTrajectory
running: /all publishes /joint_states sensor_msgs/msg/JointState
"""


@pytest.mark.parametrize(
    ("topic", "joints", "told"),
    [
        ("/robot2/joint_states", ("robot1_wheel", "robot2_wheel"), "robot1_wheel, of robot1"),
        ("/robot2/arm/joint_trajectory", ("robot1_elbow",), "robot1_elbow, of robot1"),
        ("/robot2/joint_states", ("robot2_wheel", "robot2_arm"), ""),
        ("/robot2/joint_states", ("wheel",), ""),
        # Isaac Sim and a joint_state_publisher for all send those of all.
        ("/joint_states", ("robot1_wheel", "robot2_wheel"), ""),
    ],
)
def test_joints_of_another_robot(topic: str, joints: tuple[str, ...], told: str) -> None:
    own = Heard("/robot1/joint_states", "", joints=("robot1_wheel", "robot1_elbow", "wheel"))
    seen = fresh(read_system(ARMS), heard=(own, Heard(topic, "", joints=joints)))
    found = [it.message for it in judge(seen) if it.code == "MG419"]
    assert len(found) == bool(told)
    assert not told or told in found[0]


# ------------------------------------------------------------------------------- the clock


@pytest.mark.parametrize(
    ("times", "age", "back"),
    [
        ([], math.inf, 0.0),
        ([4.0, 4.0, 4.0], math.inf, 0.0),
        ([4.0, 4.001], 0.0, 0.0),
        ([40.0, 40.5, 2.0, 2.5], 0.0, 38.5),
    ],
)
def test_a_clock_runs_stands_or_goes_back(times: list[float], age: float, back: float) -> None:
    (it,) = samples_of("/clock", CLOCK, *map(clock, times))
    assert (it.topic, it.age, it.back) == ("/clock", age, back)


TIMED = """\
running: /ros_gz_bridge publishes /clock rosgraph_msgs/msg/Clock
running: /robot1/amcl subscribes /clock rosgraph_msgs/msg/Clock
"""


def clock_findings(heard: tuple[Heard, ...], example: str = TIMED) -> list[tuple[str, str]]:
    seen = fresh(read_system(example), heard=heard)
    return [(it.level, it.message) for it in judge(seen) if it.code == "MG504"]


def test_what_is_said_of_a_clock() -> None:
    ((level, message),) = clock_findings((Heard("/clock", "", math.inf),))
    assert level == "error"
    assert "/clock stopped" in message and "/robot1/amcl waits" in message
    ((level, message),) = clock_findings((Heard("/clock", "", back=12.5),))
    assert level == "warning"
    assert "went back by 12.5 s" in message
    assert not clock_findings((Heard("/clock", ""),))
    # Nobody waits for it; two clocks are another finding; nothing was heard at all.
    assert not clock_findings((Heard("/clock", "", math.inf),), TIMED.splitlines()[0] + "\n")
    two = TIMED + "running: /rosbag2_player publishes /clock rosgraph_msgs/msg/Clock\n"
    assert not clock_findings((Heard("/clock", "", back=3.0),), two)
    assert not clock_findings(())


# ------------------------------------------------------------------------------- a bag


def write(path: Path, topics: dict[tuple[str, str], list[bytes]]) -> Path:
    with Writer(path, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        for (name, type_), messages in topics.items():
            profiles = [qos(False)]
            added = writer.add_connection(
                name, type_, typestore=STORE, offered_qos_profiles=profiles
            )
            for at, data in enumerate(messages):
                writer.write(added, SECOND + at * SECOND // 10, data)
    return path


def test_a_bag_is_asked_the_same(tmp_path: Path) -> None:
    def moves(robot: str, hertz: float) -> list[bytes]:
        frames = f"{robot}/odom", f"{robot}/base_link"
        return [transform(*frames, 1 + at / hertz) for at in range(20)]

    path = write(
        tmp_path / "bag",
        {
            ("/clock", CLOCK): [clock(it) for it in (30.0, 30.1, 5.0, 5.1)],
            ("/robot1/odom", ODOM): [posed("odom", "b"), posed("odom", "b", x=math.nan)],
            ("/robot2/odom", ODOM): [posed("odom", "b"), posed("odom", "b", x=2.0)],
            ("/robot1/joint_states", JOINTS): [joint_state("robot1_wheel")],
            ("/robot2/joint_states", JOINTS): [joint_state("robot1_wheel")],
            ("/robot1/tf", TF): moves("robot1", 50),
            ("/robot2/tf", TF): moves("robot2", 5),
        },
    )
    found = diagnose(as_snapshot(read_bag(str(path)))).findings
    told = {it.code: it.message for it in found}
    assert "/robot1/odom cannot be used" in told["MG416"]
    assert "went back by 25.1 s" in told["MG504"]
    assert "/robot2/joint_states" in told["MG419"]
    assert "robot2/base_link on /robot2/tf comes at 5.0 Hz" in told["MG326"]
