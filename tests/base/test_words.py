# SPDX-License-Identifier: Apache-2.0
"""Words in messages: lists, counts, what was meant, releases, text that a terminal may show."""

from __future__ import annotations

import pytest

from multibot_rewrite.base import nearest, releases
from multibot_rewrite.base.wording import (
    and_then,
    clip,
    for_terminal,
    in_json,
    one_line,
    only,
    plural,
    shorten,
    unique,
)


def test_lists_in_a_sentence() -> None:
    assert [shorten(it) for it in ("", "abc", "abcd", "abcab", "abcdef")] == [
        "", "a, b, c", "a, b, c and 1 more", "a, b, c", "a, b, c and 3 more",
    ]  # fmt: skip
    assert shorten("abcdef", 5) == "a, b, c, d, e and 1 more"
    assert [and_then(it) for it in ("", "a", "ab", "abc")] == ["", "a", "a and b", "a, b and c"]
    assert (unique("abca"), only(["a"]), only(["a", "b"]), only([])) == (
        ("a", "b", "c"),
        "a",
        "",
        "",
    )
    assert [plural(it, "node") for it in (0, 1, 2)] == ["0 nodes", "1 node", "2 nodes"]
    assert [plural(it, "class") for it in (1, 2)] == ["1 class", "2 classes"]
    assert (clip(" a\n b "), clip("x" * 60), clip("x" * 61)) == ("a b", "x" * 60, "x" * 59 + "…")


def test_text_of_one_line() -> None:
    assert one_line("a\nb\x1b[0m\t\u202ec\udcff\x85é") == r"a\nb\x1b[0m\t\u202ec\udcff\x85é"
    assert one_line("x" * 1000) == "x" * 1000
    assert one_line("a" * 600 + "b" * 600) == "a" * 500 + " … " + "b" * 500
    assert for_terminal("a\tb\n\x1b[31mc\x1b[2Jd\x07") == "a\tb\n\x1b[31mc\\x1b[2Jd\\x07"
    assert for_terminal("a\nb") == "a\nb"
    assert in_json("é\x7f\u2028\u200e") == "é\\u007f\\u2028\\u200e"


KNOWN = ("base_link", "base_footprint", "left_wheel", "right_wheel")


@pytest.mark.parametrize(
    ("name", "meant"),
    [
        ("left_weel", "left_wheel"), ("left_wehel", "left_wheel"), ("left_wheell", "left_wheel"),
        ("LEFT_WHEEL", "left_wheel"), ("lift_wheel", "left_wheel"), ("lift_weel", ""),
        ("left_wheel_2", ""), ("base_linc", "base_link"), ("base_linkx", "base_link"), ("wheel", ""),
        ("bass_link", "base_link"), ("left_whexx", ""),
    ],
)  # fmt: skip
def test_one_typing_mistake_in_one_word(name: str, meant: str) -> None:
    assert nearest.meant_name(name, KNOWN) == meant
    assert nearest.meant_name("arm_1", ["arm_2"]) == nearest.meant_name("cat", ["car"]) == ""
    assert nearest.meant_name("abcd", ["abce"]) == "abce"


# ---------------------------------------------------------------- releases


JAZZY, HUMBLE = "/opt/ros/jazzy", "/opt/ros/humble"


@pytest.mark.parametrize(
    ("given", "around", "chosen", "told"),
    [
        ("", {}, "lyrical", ""), ("kilted", {"ROS_DISTRO": "jazzy"}, "kilted", "kilted"),
        ("", {"ROS_DISTRO": "jazzy"}, "jazzy", "jazzy"),
        ("", {"AMENT_PREFIX_PATH": f"/home/ws:{JAZZY}:{HUMBLE}"}, "jazzy", "jazzy"),
        ("", {"AMENT_PREFIX_PATH": f"/opt/ros/own:{HUMBLE}"}, "humble", "humble"),
        ("", {"ROS_DISTRO": "rolling", "AMENT_PREFIX_PATH": HUMBLE}, "rolling", "rolling"),
    ],
)  # fmt: skip
def test_the_release_that_is_meant(
    given: str, around: dict[str, str], chosen: str, told: str
) -> None:
    assert releases.chosen_release(given, around) == chosen
    assert releases.release_for_description(given, around) == told
    assert releases.unusual_release(given, around) == ""


@pytest.mark.parametrize(
    ("words", "holds"),
    [
        ("", "humble jazzy kilted lyrical rolling"), ("jazzy", "jazzy"),
        ("kilted+", "kilted lyrical rolling"),
        ("<=jazzy", "humble jazzy"), ("humble, kilted+", "humble kilted lyrical rolling"),
        ("jazzy 1.3.9+", "jazzy"), ("jazzy 1.3.9+, kilted+", "jazzy kilted lyrical rolling"),
    ],
)  # fmt: skip
def test_the_releases_of_a_fact(words: str, holds: str) -> None:
    assert releases.releases_with(words) == tuple(holds.split())
    assert releases.is_release_words(words) is bool(words)


@pytest.mark.parametrize(
    ("text", "found"),
    [
        (b'<plugin filename="libgazebo_ros_x.so"/>', "libgazebo_ros_x.so"),
        (b"<plugin>ignition-gazebo-x-system</plugin>", "ignition-gazebo-x-system"),
        (b"'libignition-gazebo-x'", "libignition-gazebo-x"),
        (b"<plugin>ign_ros2_control/X</plugin>", "ign_ros2_control"),
        (b'"libgazebo_x.so" gz-sim', ""), (b'"libgazebo_x.so" gz::sim', ""),
        (b'"libgazebo_x.so" gz_ros2_control', ""), (b'<!-- "libgazebo_x.so" -->', ""),
        (b"my libgazebo_x.so", ""), (b"", ""),
    ],
)  # fmt: skip
def test_what_tells_of_gazebo_classic(text: bytes, found: str) -> None:
    assert releases.evidence(text) == found
