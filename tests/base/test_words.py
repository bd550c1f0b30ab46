# SPDX-License-Identifier: Apache-2.0
"""Words in messages: lists, counts, what was meant, releases, text that a terminal may show."""

from __future__ import annotations

import pytest

from multibot_rewrite.base import nearest, releases
from multibot_rewrite.base.findings.finding import Finding, by_place, locate, same_for
from multibot_rewrite.base.findings.selection import (
    OFF,
    Selection,
    is_on,
    level_of,
    matched,
    said_of,
)
from multibot_rewrite.base.model import UsageError
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
    ("name", "near"),
    [
        ("base_lnk", "base_link"), ("Base-Link", "base_link"), ("ns::base_link", "base_link"),
        ("/base link/", "base_link"), ("lift_wheel", "left_wheel"), ("camera", ""), ("", ""),
    ],
)  # fmt: skip
def test_the_nearest_name(name: str, near: str) -> None:
    assert nearest.nearest(name, KNOWN) == near
    assert nearest.did_you_mean(name, KNOWN) == (f"did you mean {near!r}?" if near else "")


def test_some_near_names_the_nearest_first() -> None:
    assert nearest.nearest_few("wheel_left", KNOWN, 2, 0.4)[0] == "left_wheel"
    assert nearest.nearest_few("LEFT_WHEEL", [*KNOWN, "left_wheels"], 2) == ["left_wheel"]
    known = [*KNOWN, "left_wheels"]
    assert nearest.nearest_few("left_wheelz", known, 3)[:2] == ["left_wheel", "left_wheels"]


def test_a_word_of_a_short_list_may_be_begun() -> None:
    words = ("frames-per-robot", "tf-per-robot", "both")
    assert nearest.did_you_mean_one_of("fra", words) == "did you mean 'frames-per-robot'?"
    assert nearest.did_you_mean_one_of("fr", words) == ""
    assert nearest.did_you_mean_one_of("boht", words) == "did you mean 'both'?"


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


def test_camel_case_is_a_slip() -> None:
    assert nearest.slip_of("linkName", ["link_name", "frame"]) == "link_name"
    assert nearest.slip_of("link_names", ["link_name"]) == "link_name"
    assert nearest.slip_of("other", ["link_name"]) == ""


def test_a_report_guesses_for_its_first_names() -> None:
    guesses = nearest.Guesses()
    known = [f"name_{at}" for at in range(30)]
    found = [guesses.nearest(f"nane_{at}", known) for at in range(30)]
    assert found[:20] == known[:20] and set(found[20:]) == {""}
    assert guesses.hint("nane_3", known) == "did you mean 'name_3'?"
    assert guesses.hint("nane_29", known) == ""


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
    assert releases.told_release(given, around) == told
    assert releases.unusual_release(given, around) == ""


def test_a_release_that_is_not_known_is_said() -> None:
    known = "humble, jazzy, kilted, lyrical, rolling"
    for given, around, said in (
        ("jazy", {}, "release 'jazy' is not known; did you mean 'jazzy'?"),
        ("xyz", {}, f"release 'xyz' is not known; known are {known}"),
        (
            "", {"ROS_DISTRO": "xyz"},
            f"ROS_DISTRO is 'xyz', which is not known; name your ROS 2 release with --distro: {known}",
        ),
    ):  # fmt: skip
        with pytest.raises(UsageError) as caught:
            releases.chosen_release(given, around)
        assert str(caught.value) == said
    assert releases.told_release("", {"ROS_DISTRO": "xyz"}) == ""


@pytest.mark.parametrize(
    ("ended", "other"), [("foxy", "humble"), ("galactic", "humble"), ("iron", "jazzy")]
)
def test_a_release_that_has_ended_is_the_next(ended: str, other: str) -> None:
    around = {"ROS_DISTRO": ended}
    assert releases.told_release("", around) == other
    assert releases.unusual_release("", around) == (
        f"ROS_DISTRO is '{ended}', which has ended: {other} is taken in its place;"
        " name another release with --distro"
    )
    assert releases.unusual_release("jazzy", around) == ""
    assert releases.unusual_release("", {"ROS_DISTRO": "xyz"}) == (
        "ROS_DISTRO is 'xyz', which is not known: name another release with --distro"
    )


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
    "words", ["<=jazzy+", "foxy", "jazzy 1.2", "Jazzy", "jazzy,", "jazzy kilted"]
)
def test_what_are_no_words_of_releases(words: str) -> None:
    assert not releases.is_release_words(words)


def test_versions_and_what_is_shared() -> None:
    assert releases.since_version("jazzy 1.3.9+, kilted+", "jazzy") == "1.3.9"
    assert releases.since_version("jazzy 1.3.9+, kilted+", "kilted") == ""
    assert releases.since_version("<=jazzy, jazzy 2+", "jazzy") == ""
    assert releases.share_release("<=jazzy", "jazzy+") and not releases.share_release(
        "humble", "jazzy+"
    )
    assert releases.facts_of_release("jazzy", "it loads x") == " (ROS 2 jazzy: it loads x)"
    assert (releases.facts_of_release("jazzy"), releases.facts_of_release("")) == (
        " (ROS 2 jazzy)",
        "",
    )


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


# ---------------------------------------------------------------- findings


@pytest.mark.parametrize(
    ("offset", "place"),
    [(0, (1, 1)), (1, (1, 2)), (2, (2, 1)), (4, (2, 2)), (5, (2, 3)), (6, (3, 1))],
)
def test_a_place_is_line_and_column(offset: int, place: tuple[int, int]) -> None:
    assert locate("a\né\n".encode() + b"x", offset) == place if offset < 4 else True
    assert locate("a\néx\n".encode(), offset) == place


def test_a_place_far_behind() -> None:
    text = b"x" * 4095 + b"\n" + b"y" * 5000 + b"\n" + b"z" * 10
    assert locate(text, 4095) == (1, 4096) and locate(text, 4096) == (2, 1)
    assert locate(text, 9097 + 3) == (3, 4) and locate(text, 8192) == (2, 4097)


def test_where_a_finding_is() -> None:
    it = Finding("M1", "error", "is bad", "do it", "f.urdf", 3, 4)
    assert it.place == "f.urdf:3:4" and str(it) == "f.urdf:3:4: error: M1 is bad (do it)"
    assert it._replace(node="/a", robot="r").place == "/a"
    assert it._replace(node="a", robot="r").place == "r: a"
    assert it._replace(robot="r").place == "r" and it._replace(file="").place == "graph"
    others = it._replace(robots=("a", "b", "c", "d"), hint="")
    assert same_for(others) == "; the same for b and 2 more" and same_for(it) == ""
    assert str(others) == "f.urdf:3:4: error: M1 is bad; the same for b and 2 more"
    assert by_place(it) == ("f.urdf", 3, 4, "M1", "is bad", "")


def test_the_longer_beginning_counts() -> None:
    assert [matched(("M", "MG1"), it) for it in ("MG102", "MF1", "X")] == [3, 1, -1]
    levels = {"MG": "note", "MG1": OFF, "MG102": "error"}
    selection = Selection(levels=levels)
    assert [level_of(selection, it, "warning") for it in ("MG2", "MG101", "MG102", "MF1")] == [
        "note", "warning", "error", "warning",
    ]  # fmt: skip
    assert [is_on(selection, it) for it in ("MG2", "MG101", "MG102")] == [True, False, True]
    assert is_on(Selection(("MG101",), levels=levels), "MG101")


def test_a_text_is_said_of_another_robot() -> None:
    it = Finding("M1", "error", "", robots=("r1", "r2"))
    assert said_of("/r1/a of r11", it, "r2") == "/r2/a of r11"
    assert said_of("/r1/a", it, "r3") == "/r1/a"
