# SPDX-License-Identifier: Apache-2.0
"""A file that was rewritten for a robot is refused for it, whatever was done to it since."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import pairwise, product

import pytest
from lxml import etree
from paths import ROBOTS, fixture_text

from multibot_rewrite import RewriteRefused, rewrite, rewrite_all, strip
from multibot_rewrite.description.checks.twice import is_part

ROVER = fixture_text("twice_rover.urdf")
PLAIN = ROVER.partition("  <gazebo>")[0] + "</robot>\n"
PLUGIN = '<gazebo><plugin name="p" filename="libgazebo_ros_diff_drive.so">{}</plugin></gazebo>'
LAYOUTS = ("tf-per-robot", "frames-per-robot", "both", "postfix")
SIDES = ("postfix", "prefix")
# Links, joints, topics: every separator that is allowed.
SEPARATORS = (("/", "_", "/"), ("_", "/", "_"), ("__", "-", "/"), ("-", ".", "_"), (".", "__", "/"))
# A name that is nothing else, a part's name, and one with the separator in it.
NAMES = ("robot1", "left", "tb3_0")
MARKER = re.compile(r"\s*<!-- multibot .*?-->")


def options(layout: str, side: str, separators: tuple[str, str, str]) -> dict[str, object]:
    """Return the words of a rewrite."""
    link, joint, topic = separators
    given = {"link": link, "joint": joint, "topic": topic}
    return {"layout": layout, "affix": side, "separators": given}


WAYS = [options(*way) for way in product(LAYOUTS, SIDES, SEPARATORS)]


def without_traces(text: str) -> str:
    """Return the text without the comments that tell of added elements."""
    return MARKER.sub("", text)


def words(text: str | bytes, robot: str) -> list[str]:
    """Every value that holds the robot's name twice, one after the other or at both ends."""
    values = [
        it for el in etree.fromstring(text).iter("*") for it in (*el.attrib.values(), el.text)
    ]
    twice = re.compile(rf"(?:^|[/_.-]){robot}(?:.*?[/_.-])?[/_.-]?{robot}(?:$|[/_.-])")
    return [it for it in values if it and "\n" not in it and twice.search(it)]


def outcome(text: str | bytes, robot: str, way: dict[str, object]) -> str:
    """Return what a rewrite comes to: a code, nothing, or the names that it has doubled."""
    try:
        made = rewrite(text, robot, **way)  # type: ignore[arg-type]
    except RewriteRefused as error:
        return " ".join(sorted({it.code for it in error.findings if it.level == "error"}))
    return ", ".join(words(made.data, robot))


@pytest.mark.deep
@pytest.mark.parametrize("robot", NAMES)
def test_every_way_after_every_way_is_refused(robot: str) -> None:
    """1,600 pairs a robot: layout, side and separators of the first rewrite and of the second."""
    assert not any(outcome(ROVER, "robot1", way) for way in WAYS)
    for first in WAYS:
        once = without_traces(rewrite(ROVER, robot, **first).text)  # type: ignore[arg-type]
        for second in WAYS:
            assert outcome(once, robot, second) == "MB106", (first, second)


@pytest.mark.sample(1)
@pytest.mark.parametrize("robot", NAMES)
@pytest.mark.parametrize("first", WAYS[::7], ids=str)
def test_some_ways_after_some_ways_are_refused(robot: str, first: dict[str, object]) -> None:
    once = without_traces(rewrite(ROVER, robot, **first).text)  # type: ignore[arg-type]
    assert {outcome(once, robot, second) for second in WAYS[::3]} == {"MB106"}


# What a person does to a file that was rewritten.
EDITS = {
    "nothing": ("", ""),
    "a-link-more": ("</robot>", '<link name="mast"/></robot>'),
    "a-joint-more": ("</robot>", '<joint name="mj" type="fixed"/></robot>'),
    "a-sensor-more": (
        "</robot>",
        '<gazebo reference="x"><sensor name="imu" type="imu"/></gazebo></robot>',
    ),
    "a-plugin-more": (
        "</robot>",
        '<gazebo><plugin name="p" filename="libgazebo_ros_imu_sensor.so"/></gazebo></robot>',
    ),
    "the-base-as-before": (r'(?<=")[^"]*base_link[^"]*', "base_link"),
    "the-camera-as-before": (r'(?<=")[^"]*camera_link[^"]*', "camera_link"),
    "joints-as-before": (r"[\w/.-]*(left_wheel|camera)_joint[\w/.-]*", r"\1_joint"),
    "no-plugin": (r"(?s)<gazebo>.*</gazebo>", ""),
}


@pytest.mark.sample(2)
@pytest.mark.parametrize("edit", EDITS)
@pytest.mark.parametrize("robot", NAMES)
@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("layout", LAYOUTS[1:])
def test_edits_by_hand_hide_nothing(layout: str, side: str, robot: str, edit: str) -> None:
    first = options(layout, side, SEPARATORS[0])
    once = without_traces(rewrite(ROVER, robot, **first).text)  # type: ignore[arg-type]
    old, new = EDITS[edit]
    edited = re.sub(old, new, once) if old else once
    assert (edited == once) == (edit == "nothing")
    # Each of the ways comes after some of the edits.
    at = list(EDITS).index(edit)
    assert {outcome(edited, robot, second) for second in WAYS[at::9]} == {"MB106"}


def test_one_name_that_was_left_is_enough() -> None:
    for name in ("camera_link/robot1", "robot1_camera_link", "camera_link-robot1", "robot1.camera"):
        assert outcome(ROVER.replace("camera_link", name), "robot1", {}) == "MB106"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        pytest.param("/demo", "/robot1", id="namespace"),
        pytest.param("/demo", "robot1/demo", id="namespace-below"),
        pytest.param("cmd_vel:=cmd", "cmd_vel:=/robot1/cmd", id="topic"),
        pytest.param("cmd_vel:=cmd", "cmd_vel:=cmd/robot1", id="topic-behind"),
        pytest.param('name="drive"', 'name="drive_robot1"', id="node"),
        pytest.param('"left_wheel_joint"', '"left_wheel_joint__robot1"', id="joint"),
    ],
)
def test_a_name_of_any_kind_is_enough(old: str, new: str) -> None:
    assert outcome(ROVER, "robot1", {}) == ""
    assert outcome(ROVER.replace(old, new), "robot1", {}) == "MB106"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        pytest.param('robot name="rover"', 'robot name="robot1"', id="model"),
        pytest.param("camera_link", "camera_robot10", id="longer"),
        pytest.param("camera_link", "xrobot1_link", id="inside-a-word"),
        pytest.param("camera_link", "a_robot1_link", id="in-the-middle"),
        pytest.param("camera_link", "ROBOT1_link", id="capitals"),
    ],
)
def test_what_is_no_trace_of_a_rewrite(old: str, new: str) -> None:
    with_it = ROVER.replace(old, new)
    assert with_it != ROVER
    rewrite(with_it, "robot1")


# ---------------------------------------------------------------- robots that are called like parts


@pytest.mark.parametrize(
    "robot", ["left", "right", "front", "arm", "base", "left_arm", "r", "lf", "mobile_base"]
)
def test_words_of_parts(robot: str) -> None:
    assert is_part(robot)


@pytest.mark.parametrize("robot", ["robot1", "arm1", "alice", "husky", "left_1", "tb3_0", "r1"])
def test_words_of_robots(robot: str) -> None:
    assert not is_part(robot)


@pytest.mark.more
def test_a_part_of_that_name_is_by_chance() -> None:
    made = rewrite(ROVER, "left", affix="prefix", separators={"link": "_"}).text
    assert '"left_left_wheel"' in made
    rover = (ROBOTS / "rover.urdf").read_bytes()
    for robot in ("left", "right", "front", "base", "wheel", "camera", "imu", "arm"):
        rewrite(rover, robot)


@pytest.mark.parametrize(
    ("kind", "text"),
    [
        ("link", '<link name="left_a"/><link name="left_b"/>'),
        ("joint", '<joint name="left_j" type="fixed"><parent link="c"/><child link="c"/></joint>'),
        ("namespace", PLUGIN.format("<ros><namespace>left</namespace></ros>")),
        ("topic", PLUGIN.format("<ros><remapping>cmd_vel:=left/c</remapping></ros>")),
    ],
)
def test_more_than_half_of_a_kind_is_not(kind: str, text: str) -> None:
    with pytest.raises(RewriteRefused, match=f"MB106 .* its name is in {kind} "):
        rewrite(f'<robot name="r"><link name="c"/>{text}</robot>', "left")


def test_half_of_a_kind_is_by_chance() -> None:
    rewrite('<robot name="r"><link name="left_a"/><link name="b"/></robot>', "left")


# ---------------------------------------------------------------- what is said


def test_the_message_names_the_names_with_their_lines() -> None:
    once = rewrite(PLAIN, "robot1").text
    with pytest.raises(RewriteRefused) as caught:
        rewrite(once, "robot1", layout="both")
    (finding,) = caught.value.findings
    assert (finding.line, finding.column) == (2, 3)
    assert finding.message == (
        "the description is already rewritten for robot1: its name is in link 'base_link/robot1' "
        "(line 2), joint 'left_wheel_joint_robot1' (line 5) and 3 more names"
    )
    for way in ("--undo", "name the robot otherwise", "--force"):
        assert way in finding.hint


def test_every_way_out_is_one() -> None:
    once = rewrite(PLAIN, "robot1").text
    assert "base_link/robot1/robot1" in rewrite(once, "robot1", again=True).text
    assert "base_link/robot1/robot2" in rewrite(once, "robot2").text
    assert strip(once, "robot1") == PLAIN.encode()


def test_added_elements_alone_are_said() -> None:
    source = f'<robot name="r">{PLUGIN.format("")}</robot>'
    once = rewrite(source, "robot1", layout="tf-per-robot").text
    bare = once.replace("<namespace>/robot1</namespace>", "<namespace>/</namespace>")
    assert bare != once
    with pytest.raises(RewriteRefused, match="elements were added for it") as caught:
        rewrite(bare, "robot1", again=True)
    assert "--force" not in caught.value.findings[-1].hint


def test_robots_of_one_call_are_each_looked_at() -> None:
    once = without_traces(rewrite(ROVER, "robot1").text)
    for before, after in pairwise(["robot2", "robot1", "robot3"]):
        with pytest.raises(RewriteRefused, match="already rewritten for robot1"):
            next(rewrite_all(once, [before, after]))


def test_a_link_that_is_a_slash_is_rewritten_once() -> None:
    slash = '<robot name="r"><link name="/"/></robot>'
    once = rewrite(slash, "robot1").text
    assert 'name="//robot1"' in once
    assert outcome(once, "robot1", {}) == "MB106"


def test_a_file_of_one_robot_is_reported_where_it_is_rewritten_for_another() -> None:
    drive = '<plugin name="p" filename="libgazebo_ros_diff_drive.so"><ros/></plugin>'
    text = f'<robot name="r"><link name="base"/><gazebo>{drive}</gazebo></robot>'
    assert "MB106" not in {it.code for it in rewrite(text, "robot1").findings}
    one = rewrite(text, "robot1").text
    said = [it.message for it in rewrite(one, "robot2").findings if it.code == "MB106"]
    assert len(said) == 1 and "robot1" in said[0]


# Robots that are called like frames and topics that all share: the same wherever they are named.

ROBOT = '<robot name="r"><link name="{}"/>{}</robot>'


def refusals(text: str, robots: Sequence[str], **options: object) -> set[tuple[str, str]]:
    """Codes and messages of a call that is refused; empty for one that is not."""
    try:
        list(rewrite_all(text, robots, **options))  # type: ignore[arg-type]
    except RewriteRefused as error:
        return {(it.code, it.message) for it in error.findings if it.level == "error"}
    return set()


@pytest.mark.parametrize("order", [("world", "r2"), ("r2", "world")])
def test_a_name_that_becomes_a_shared_frame_is_refused(order: Sequence[str]) -> None:
    message = "link '/' would become '//world' for world, which is shared"
    assert refusals(ROBOT.format("/", ""), order) == {("MB420", message)}
    assert refusals(ROBOT.format("/", ""), ["r2"]) == set()
