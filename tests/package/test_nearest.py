# SPDX-License-Identifier: Apache-2.0
"""What "did you mean" proposes for a word that is not known."""

from __future__ import annotations

import pytest

from multibot_rewrite.base.nearest import (
    ALIKE,
    MISTYPED,
    did_you_mean,
    did_you_mean_one_of,
    nearest,
    nearest_few,
)

LINKS = ("base_link", "left_wheel", "right_wheel", "laser")


@pytest.mark.parametrize(
    ("name", "wanted"),
    [
        ("base_lnik", "base_link"),
        ("Base-Link", "base_link"),
        ("arm::laser", "laser"),
        ("/laser", "laser"),
        ("left wheel", "left_wheel"),
        ("gripper", ""),
        ("", ""),
    ],
)
def test_the_nearest_name(name: str, wanted: str) -> None:
    assert nearest(name, LINKS) == wanted


def test_another_way_to_write_a_name_comes_before_a_similar_one() -> None:
    assert nearest("LEFT_WHEEL", ("LEFT_WHEE", "left_wheel")) == "left_wheel"
    assert nearest_few("LEFT_WHEEL", ("LEFT_WHEE", "left_wheel"), 2) == ["left_wheel", "LEFT_WHEE"]


def test_no_more_names_than_asked_for() -> None:
    assert nearest_few("wheel", ("wheel_1", "wheel_2", "wheel_3", "laser"), 2) == [
        "wheel_3",
        "wheel_2",
    ]


def test_a_finding_needs_more_likeness_than_a_hint() -> None:
    """Three of four letters: 0.75, between the two."""
    assert ALIKE < 0.75 < MISTYPED
    assert nearest("abcd", ["abcx"]) == "abcx"
    assert nearest("abcd", ["abcx"], MISTYPED) == ""


def test_the_hint() -> None:
    assert did_you_mean("lasr", LINKS) == "did you mean 'laser'?"
    assert did_you_mean("camera", LINKS) == ""


@pytest.mark.parametrize(
    ("word", "choices", "wanted"),
    [
        ("frames", ("tf-per-robot", "frames-per-robot"), "did you mean 'frames-per-robot'?"),
        ("suffix", ("prefix", "postfix", "keep"), "did you mean 'postfix'?"),
        ("frames_per_robot", ("frames-per-robot",), "did you mean 'frames-per-robot'?"),
        ("p", ("postfix", "prefix"), ""),
        ("pos", ("postfix", "pose"), "did you mean 'pose'?"),
        ("tf", ("tf-a", "tf_b", "tfx"), "did you mean one of tf-a, tf_b?"),
        ("", ("_a", "_b"), ""),
        ("zzz", ("postfix", "prefix"), ""),
    ],
)
def test_the_hint_for_one_of_a_few_words(word: str, choices: tuple[str, ...], wanted: str) -> None:
    assert did_you_mean_one_of(word, choices) == wanted
