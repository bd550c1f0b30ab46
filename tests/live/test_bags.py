# SPDX-License-Identifier: Apache-2.0
"""Recordings: two robots in a bag of our own, healthy and with a fault each, and damaged bags."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
import small_fleet
from graph_calls import check, to_yaml

pytest.importorskip("rosbags")

from made_bags import ROBOTS, SCAN, TEXT, TF, TWIST, Made, healthy, plan, write

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.producers.bags.read import RecordedTopic, Recording, read_bag
from multibot_rewrite.producers.bags.recording import as_snapshot, counted
from multibot_rewrite.system.records import Edge, System

Topics = dict[str, Made]


def changed(name: str, **fields: object) -> Callable[[Topics], None]:
    def change(topics: Topics) -> None:
        topics[name] = topics[name]._replace(**fields)  # type: ignore[arg-type]

    return change


def renamed(name: str, new: str) -> Callable[[Topics], None]:
    def change(topics: Topics) -> None:
        topics[new] = topics.pop(name)._replace(name=new)

    return change


def both(*changes: Callable[[Topics], None]) -> Callable[[Topics], None]:
    def change(topics: Topics) -> None:
        for it in changes:
            it(topics)

    return change


def edges(*pairs: str) -> list[tuple[str, str]]:
    return [(a, b) for a, _, b in (pair.partition(" ") for pair in pairs)]


# What is wrong -> how the healthy bag is changed, the codes that are found, and a word of the message.
FAULTS: dict[str, tuple[Callable[[Topics], None], set[str], str]] = {
    "another type": (
        changed("/robot1/cmd_vel", type="geometry_msgs/msg/TwistStamped"),
        {"MG306"},
        "/robot1/cmd_vel as geometry_msgs/msg/TwistStamped, but the plan has it as geometry",
    ),
    "a bare topic": (
        renamed("/robot1/scan", "/scan"),
        {"MG102", "MG320"},
        "/scan is of no robot; planned: /robot1/scan, /robot2/scan",
    ),
    "a robot spelled otherwise": (
        renamed("/robot2/odom", "/robot_2/odom"),
        {"MG102", "MG320"},
        "/robot_2/odom is of no robot",
    ),
    "data in the frame of another robot": (
        changed("/robot1/scan", frame="robot2/laser"),
        {"MG411"},
        "frame_id of /robot1/scan is robot2/laser, a frame of robot2",
    ),
    "data in a bare frame": (
        changed("/robot2/odom", frame="odom"),
        {"MG412"},
        "frame_id of /robot2/odom is odom, which is in no transform of robot2",
    ),
    "a silent sensor": (
        changed("/robot2/scan", count=0),
        {"MG326"},
        "/robot2/scan has no message, /robot1/scan has 100",
    ),
    "a topic that is not there": (
        lambda topics: bool(topics.pop("/robot2/odom")) and None,
        {"MG102"},
        "/robot2/odom is not there, /robot1/odom is",
    ),
    "a slow sensor": (
        changed("/robot1/scan", count=10),
        {"MG326"},
        "/robot1/scan came at 1.0 Hz, /robot2/scan at 10.0 Hz",
    ),
    "two senders of a command": (
        changed("/robot1/cmd_vel", latched=(False, False)),
        {"MG121"},
        "/robot1/cmd_vel has 2 publishers, planned are 1",
    ),
    "tf_static that is not kept": (
        changed("/robot1/tf_static", latched=(False,)),
        {"MG309"},
        "/robot1/tf_static with durability VOLATILE",
    ),
    "a frame with two parents": (
        changed("/robot1/tf", edges=edges("robot1/odom robot1/base_link", "map robot1/base_link")),
        {"MG401"},
        "robot1/base_link",
    ),
    "the other robot's transforms": (
        changed("/robot1/tf", edges=edges("robot2/odom robot2/base_link")),
        {"MG405", "MG412"},
        "robot2/base_link of robot2 is on /robot1/tf, expected on /robot2/tf",
    ),
    "the other robot's fixed transforms": (
        changed("/robot1/tf_static", edges=edges("robot2/base_link robot2/laser")),
        {"MG405", "MG412"},
        "robot2/laser of robot2 is on /robot1/tf, expected on /robot2/tf",
    ),
    "all of the other robot's transforms as well": (
        changed(
            "/robot1/tf",
            edges=edges("robot1/odom robot1/base_link", "robot2/odom robot2/base_link"),
        ),
        {"MG405"},
        "robot2/base_link of robot2 is on /robot1/tf, expected on /robot2/tf",
    ),
    "frames without the robot's name": (
        both(
            changed("/robot1/tf", edges=edges("odom base_link")),
            changed("/robot1/tf_static", edges=edges("base_link laser")),
        ),
        {"MG207", "MG412"},
        "base_link",
    ),
    "the robot's name twice": (
        changed("/robot1/tf_static", edges=edges("robot1/robot1/base_link robot1/robot1/laser")),
        {"MG407", "MG412"},
        "robot1/robot1/base_link",
    ),
}


def placed(layout: str, topic: Callable[[Edge], str]) -> tuple[System, System]:
    """Return a plan and a recording of its transforms, each on the topic that is told."""
    wanted = small_fleet.plan(layout)
    sent = [it._replace(topic=topic(it), publishers=()) for it in small_fleet.healthy(layout).edges]
    topics = tuple(RecordedTopic(it, TF, 9) for it in dict.fromkeys(it.topic for it in sent))
    return wanted, as_snapshot(Recording(topics, tuple(sent), 10.0), wanted)


def bare(topic: str) -> str:
    return "/" + "/".join(it for it in topic.split("/") if it.startswith("tf"))


def swapped(topic: str) -> str:
    return topic.translate(str.maketrans("12", "21"))


MOVED = {
    "moving": lambda it: not it.static,
    "fixed": lambda it: it.static,
    "all": lambda it: True,
    "none": lambda it: False,
}


@pytest.mark.parametrize("layout", ["L1", "L3", "L4"])
@pytest.mark.parametrize("which", MOVED)
@pytest.mark.parametrize("other", [bare, swapped])
def test_transforms_on_another_topic(other: Callable[[str], str], which: str, layout: str) -> None:
    """Frames that both robots have are of either topic; of what is recorded no sender is known."""

    def topic(it: Edge) -> str:
        return other(it.topic) if MOVED[which](it) else it.topic

    wanted, seen = placed(layout, topic)
    is_seen = which != "none" and (layout, other) != ("L1", swapped)
    assert {(it.code, it.robot) for it in check(wanted, seen)} == (
        {("MG405", "robot1"), ("MG405", "robot2")} if is_seen else set()
    )


def found(path: Path) -> list[tuple[str, str]]:
    recording = read_bag(str(path))
    wanted = plan()
    findings = check(wanted, as_snapshot(recording, wanted), counted(recording))
    return [(it.code, it.message) for it in findings]


@pytest.mark.slow
@pytest.mark.parametrize("mcap", [True, False])
def test_a_healthy_bag_has_no_finding(tmp_path: Path, mcap: bool) -> None:
    path = write(tmp_path / "bag", healthy().values(), mcap)
    assert found(path) == []
    recording = read_bag(str(path))
    scan = next(it for it in recording.topics if it.name == "/robot1/scan")
    assert (scan.type, scan.messages, scan.frames) == (SCAN, 100, ("robot1/laser",))
    assert [it.durability for it in scan.qos] == ["VOLATILE"]
    assert round(recording.seconds) == 10
    edges_ = {(it.parent, it.child, it.static) for it in recording.transforms}
    assert ("robot1/odom", "robot1/base_link", False) in edges_
    assert ("robot2/base_link", "robot2/laser", True) in edges_
    # The last of 100 messages, and the one of a tf_static.
    last = {it.child: it.transform for it in recording.transforms}
    assert last["robot1/base_link"] == (99, 2, 3, 0, 0, 0, 1)
    assert last["robot2/laser"] == (0, 2, 3, 0, 0, 0, 1)


@pytest.mark.more
@pytest.mark.sample(3)
@pytest.mark.parametrize("fault", FAULTS)
def test_a_seeded_fault_is_found(fault: str, tmp_path: Path) -> None:
    change, codes, words = FAULTS[fault]
    topics = healthy()
    change(topics)
    seen = found(write(tmp_path / "bag", topics.values()))
    assert {code for code, _ in seen} == codes
    assert any(words in message for _, message in seen), seen


@pytest.mark.more
def test_what_the_plan_does_not_have_is_no_fault(tmp_path: Path) -> None:
    topics = healthy()
    for robot in ROBOTS:
        topics["x" + robot] = Made(f"/{robot}/camera/image", "sensor_msgs/msg/Image", 5)
    topics["t"] = Made("/fleet/tasks", TEXT, 3)
    assert found(write(tmp_path / "bag", topics.values())) == []


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with a plan, a healthy bag, a bag with a bare topic, and one in sqlite3."""
    folder = tmp_path_factory.mktemp("bags")
    (folder / "plan.yaml").write_text(to_yaml(plan()))
    write(folder / "healthy", healthy().values())
    write(folder / "sqlite", healthy().values(), mcap=False)
    topics = healthy()
    renamed("/robot1/scan", "/scan")(topics)
    write(folder / "faulty", topics.values())
    shared = [Made("/tf", TF, 9, edges=edges("odom base_link", "map base_link"))]
    write(folder / "collision", [*shared, Made("/robot1/cmd_vel", TWIST, 9)])
    return folder


def run(capsys: pytest.CaptureFixture[str], *words: object) -> tuple[int, str, str]:
    code = main([str(word) for word in words])
    return code, *capsys.readouterr()


@pytest.mark.slow
def test_the_command(made: Path, capsys: pytest.CaptureFixture[str]) -> None:
    check_ = ("check", made / "plan.yaml", "--from")
    assert run(capsys, *check_, made / "healthy")[:2] == (0, "")
    (file,) = (made / "healthy").glob("*.mcap")
    assert run(capsys, *check_, file)[:2] == (0, "")
    code, out, err = run(capsys, *check_, made / "faulty")
    assert code == 1
    assert "MG320 /scan is of no robot" in out and "MG102" in out
    assert (
        err
        == "multibot: 2 robots, 1 node each: all known, 0 of 2 seen; 2 findings: not as planned\n"
    )
    assert run(capsys, *check_, made / "faulty", "--ignore", "MG320,MG102")[0] == 0


@pytest.mark.slow
def test_the_doctor(made: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(capsys, "check", "--from", made / "healthy")[0] == 0
    assert "\ntf topic " in run(capsys, "snapshot", "--from", made / "healthy")[1]
    code, out, _ = run(capsys, "check", "--from", made / "collision")
    assert (code, "MG401" in out) == (1, True)


@pytest.mark.slow
@pytest.mark.parametrize(
    "fault", ["data in the frame of another robot", "a silent sensor", "tf_static that is not kept"]
)
def test_the_doctor_finds_what_needs_no_plan(
    fault: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    change, (wanted,), _ = FAULTS[fault]
    topics = healthy()
    change(topics)
    _, out, _ = run(capsys, "check", "--from", write(tmp_path / "bag", topics.values()))
    assert wanted in out


@pytest.mark.more
@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--from", "{}/nowhere/"), "there is no such bag"),
        (("--from", "{}/nowhere.mcap"), "there is no such bag"),
        (("--from", "{}/plan.yaml"), "a plan; use multibot check"),
        (("--from", "{}"), "not a readable bag"),
        (("--from", "{}/healthy", "--watch"), "leave out --watch"),
        (("--from", "{}/healthy", "--report", "{}/page.html"), "leave out --report"),
        (("--from", "{}/healthy", "--from", "{}/graph.json"), "two sources"),
        (("--from", "{}/healthy", "--from", "{}/healthy"), "two sources"),
    ],
)
def test_wrong_use_is_one_line(
    words: tuple[str, ...], said: str, made: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    given = [word.format(made) for word in words]
    code, out, err = run(capsys, "check", made / "plan.yaml", *given)
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert said in err


BOMB = "a: &a [x, x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"{b}: &{b} [{', '.join([f'*{a}'] * 10)}]\n"
    for a, b in zip("abcdefgh", "bcdefghi", strict=True)
)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["healthy", "sqlite"])
@pytest.mark.parametrize(
    "damage",
    [
        lambda data: b"",
        lambda data: data[: len(data) // 2],
        lambda data: data[:-20],
        lambda data: data[:100] + b"\xff" * 400 + data[500:],
        lambda data: bytes(255 - it for it in data),
    ],
    ids=["empty", "half", "no-end", "overwritten", "noise"],
)
def test_a_damaged_bag_is_one_line_or_is_read(
    name: str,
    damage: Callable[[bytes], bytes],
    made: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    bag = tmp_path / "bag"
    shutil.copytree(made / name, bag)
    (file,) = (it for it in bag.iterdir() if it.suffix != ".yaml")
    file.write_bytes(damage(file.read_bytes()))
    for path in (bag, file):
        code, _, err = run(capsys, "check", made / "plan.yaml", "--from", path)
        assert code in (0, 1, 2, 3)
        assert err.count("\n") == 1 or code == 3, err
        assert "Traceback" not in err


@pytest.mark.more
@pytest.mark.parametrize("text", [BOMB, "[" * 100_000, "a: b\n", "\xff", ""])
def test_hostile_metadata_is_one_line(
    text: str, made: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bag = tmp_path / "bag"
    shutil.copytree(made / "healthy", bag)
    (bag / "metadata.yaml").write_bytes(text.encode("latin-1"))
    code, out, err = run(capsys, "check", made / "plan.yaml", "--from", bag)
    assert (code, out, err.count("\n")) == (2, "", 1)


@pytest.mark.more
def test_a_bag_without_messages_is_inconclusive(
    made: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bag = write(tmp_path / "bag", [it._replace(count=0) for it in healthy().values()])
    assert run(capsys, "check", made / "plan.yaml", "--from", bag)[0] == 3


def test_without_rosbags_it_says_what_to_install(
    made: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(__import__("sys").modules, "rosbags.rosbag2", None)
    code, _, err = run(capsys, "check", made / "plan.yaml", "--from", made / "healthy")
    assert (code, err.count("\n")) == (4, 1)
    assert "pip install 'multibot_rewrite[bags]'" in err


def test_a_tf_topic_of_one_robot_alone_needs_no_endpoint_of_the_plan() -> None:
    """A plan that somebody wrote names a robot's tf, and no node that sends it."""
    name = "/robot1/tf"
    topic = RecordedTopic(name, TF, 100)
    wanted = plan()._replace(ends=())
    seen = as_snapshot(Recording((topic,), (), 10.0), wanted)
    assert [(it.code, it.names) for it in check(wanted, seen)] == [("MG102", ("/robot2/tf",))]


@pytest.mark.more
def test_the_robots_of_a_recording_are_told_by_its_topics(
    made: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    _, _, err = run(capsys, "check", "--from", made / "healthy")
    assert "2 robots by their namespaces: robot1, robot2" in err
    assert "of no robot" not in err
