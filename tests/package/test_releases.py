# SPDX-License-Identifier: Apache-2.0
"""Release words and the choice of a release; what holds where is said here, not by the code."""

from __future__ import annotations

import pytest

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.releases import (
    RELEASES,
    chosen_release,
    has_release,
    is_release_words,
    release_for_description,
    since_version,
    unusual_release,
)
from multibot_rewrite.description.sources.release_said import release_said


@pytest.mark.parametrize(
    ("words", "releases"),
    [
        ("", "humble jazzy kilted lyrical rolling"),
        ("jazzy", "jazzy"),
        ("kilted+", "kilted lyrical rolling"),
        ("<=jazzy", "humble jazzy"),
        ("humble, lyrical+", "humble lyrical rolling"),
        ("jazzy 1.3.9+, lyrical+", "jazzy lyrical rolling"),
    ],
)
def test_words_name_the_releases_that_have_a_fact(words: str, releases: str) -> None:
    assert [it for it in RELEASES if has_release(words, it)] == releases.split()


def test_a_version_is_for_its_own_release() -> None:
    words = "jazzy 1.3.9+, kilted+"
    assert since_version(words, "jazzy") == "1.3.9"
    assert since_version(words, "kilted") == ""


@pytest.mark.parametrize(
    "words", ["", "jazy", "<=jazzy+", "jazzy 1.3", "jazzy kilted", "1.3+", "jazzy,", "<=jazzy 1.3+"]
)
def test_what_is_no_release_words(words: str) -> None:
    assert not is_release_words(words)


@pytest.mark.parametrize("words", ["jazzy", "kilted+", "<=jazzy", "jazzy 1.3.9+, kilted+"])
def test_what_is_release_words(words: str) -> None:
    assert is_release_words(words)


@pytest.mark.parametrize(
    ("given", "environment", "release"),
    [
        ("humble", {"ROS_DISTRO": "jazzy"}, "humble"),
        ("", {"ROS_DISTRO": "jazzy"}, "jazzy"),
        ("", {}, "lyrical"),
        ("", {"ROS_DISTRO": ""}, "lyrical"),
        ("", {"AMENT_PREFIX_PATH": "/ws/install/a:/opt/ros/jazzy"}, "jazzy"),
        ("", {"ROS_DISTRO": "kilted", "AMENT_PREFIX_PATH": "/opt/ros/jazzy"}, "kilted"),
    ],
)
def test_the_release_that_is_meant(given: str, environment: dict[str, str], release: str) -> None:
    assert chosen_release(given, environment) == release


@pytest.mark.parametrize(
    ("given", "environment", "words"),
    [
        ("lyricl", {}, "did you mean 'lyrical'"),
        ("", {"ROS_DISTRO": "noetic"}, "ROS_DISTRO is 'noetic'.* --distro: humble"),
    ],
)
def test_a_release_that_is_not_known(given: str, environment: dict[str, str], words: str) -> None:
    with pytest.raises(UsageError, match=words):
        chosen_release(given, environment)


CLASSIC = b'<gazebo><plugin name="p" filename="libgazebo_ros_diff_drive.so"/></gazebo>'
IGNITION = b"<plugin name='ignition::gazebo::x' filename='ignition-gazebo-imu-system'/>"
NEW = b'<plugin name="p" filename="gz-sim-imu-system"/>'


@pytest.mark.parametrize(
    ("environment", "text", "release"),
    [
        ({}, CLASSIC, "humble"),
        ({}, IGNITION, "humble"),
        ({}, b"<plugin>ign_ros2_control/IgnitionSystem</plugin>", "humble"),
        ({}, NEW, "lyrical"),
        # It has a variant for each: nothing is said of the release.
        ({}, CLASSIC + NEW, "lyrical"),
        ({}, b"<!-- " + CLASSIC + b" -->", "lyrical"),
        ({}, b"<robot/>", "lyrical"),
        ({"ROS_DISTRO": "jazzy"}, CLASSIC, "jazzy"),
        ({"ROS_DISTRO": "noetic"}, CLASSIC, "humble"),
        ({"ROS_DISTRO": "noetic"}, NEW, "lyrical"),
        ({"ROS_DISTRO": "iron"}, CLASSIC, "jazzy"),
    ],
)
def test_the_release_of_a_description(
    environment: dict[str, str], text: bytes, release: str
) -> None:
    """A library of Gazebo Classic or with a name of Ignition is in no later release."""
    assert release_said(release_for_description("", environment), text, "").release == release
    assert (
        release_said(release_for_description("kilted", environment), text, "").release == "kilted"
    )


def test_a_release_that_has_ended_or_is_not_known_is_doubted() -> None:
    assert "has ended: jazzy is taken in its place" in unusual_release("", {"ROS_DISTRO": "iron"})
    assert "is not known" in unusual_release("", {"ROS_DISTRO": "noetic"})
    assert unusual_release("", {"ROS_DISTRO": "jazzy"}) == unusual_release("", {}) == ""
    assert unusual_release("jazzy", {"ROS_DISTRO": "noetic"}) == ""
