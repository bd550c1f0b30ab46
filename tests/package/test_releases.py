"""Release words and the choice of a release; what holds where is said here, not by the code."""

from __future__ import annotations

import pytest

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.releases import (
    RELEASES,
    chosen_release,
    has_release,
    is_release_words,
    since_version,
)


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
