# SPDX-License-Identifier: Apache-2.0
"""ROS 2 releases: which are known, which one is meant, and which of them have a fact.

Release words are terms with commas between: ``jazzy``, ``kilted+`` (it and all later), ``<=jazzy``
(it and all earlier), ``jazzy 1.3.9+`` (jazzy since that version of the fact's package).
Sources: REP 2000; https://docs.ros.org/en/rolling/Releases.html.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from functools import cache

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.nearest import did_you_mean_one_of

RELEASES = ("humble", "jazzy", "kilted", "lyrical", "rolling")
RELEASE_OR_NONE = ("", *RELEASES)
NEWEST_LTS = "lyrical"
# The days on which they came; rolling goes on from the last one.
CAME = dict(zip(RELEASES, ("2022-05-23", "2024-05-23", "2025-05-23", "2026-05-22"), strict=False))
# Which ROS loads a plugin that both have.
ROS_1, ROS_2 = "1", "2"
VARIABLE = "ROS_DISTRO"
# Those that have ended -> the next one that is known.
ENDED = {"foxy": "humble", "galactic": "humble", "iron": "jazzy"}
_INSTALLED = "/opt/ros/"
# The last release with Gazebo Classic and with the names of Ignition (REP 2000; gazebosim.org/docs,
# "Installing Gazebo with ROS"): its libraries, and names that only later ones have.
OF_OLD = "humble"
# MoveIt's adapters of planning requests have had another package since Jazzy (moveit2 MIGRATION.md).
_ADAPTERS = b"default_planner_request_adapters/"
CLASSIC = "libgazebo_"
# The plugins and the type of sensor of Field-Robotics-Lab/ds_sim (gazebo_src, src) are of Classic.
_OLD_WORDS = (CLASSIC.encode(), b"ignition-", b"ign_ros2_control", b"dsros_", _ADAPTERS)
# Two expressions: of one for both every character of a text is tried.
_OLD = lazy_compile(
    rb"[>\"'](libgazebo_[\w.-]+|(?:lib)?(?:dsros_|ignition-gazebo|ign_ros2_control)[\w.-]*)"
)
_OLD_ADAPTER = lazy_compile(rb"(" + _ADAPTERS + rb"\w+)")
_NEW_WORDS = (b"gz-sim", b"gz::sim", b"gz_ros2_control", b"default_planning_request_adapters/")
_NEW = lazy_compile(b"|".join(_NEW_WORDS))
_TERM = lazy_compile(r"(?P<until><=)?(?P<release>[a-z]+)(?: (?P<version>[0-9][0-9.]*))?(?P<on>\+)?")


def chosen_release(given: str, environment: Mapping[str, str]) -> str:
    """Return the release asked for, of ROS_DISTRO, of sourced ROS, or the newest LTS; or UsageError."""
    found = given or environment.get(VARIABLE, "") or _sourced(environment) or NEWEST_LTS
    if found in RELEASES:
        return found
    known = f"known are {', '.join(RELEASES)}"
    if given:
        hint = did_you_mean_one_of(found, RELEASES)
        raise UsageError(f"release {found!r} is not known; {hint or known}")
    hint = f"name your ROS 2 release with --distro: {', '.join(RELEASES)}"
    raise UsageError(f"{VARIABLE} is {found!r}, which is not known; {hint}")


def release_for_description(given: str, environment: Mapping[str, str]) -> str:
    """Return the release asked for, or of ROS_DISTRO, or of the sourced ROS; empty if none is known."""
    if given:
        return chosen_release(given, environment)
    found = environment.get(VARIABLE, "") or _sourced(environment)
    known = ENDED.get(found, found)
    return known if known in RELEASES else ""


def why_release(given: str, environment: Mapping[str, str]) -> str:
    """Return what sets ``release_for_description``: an option or variable; empty for neither."""
    if not release_for_description(given, environment):
        return ""
    by_variable = VARIABLE if environment.get(VARIABLE) else "that ROS is sourced"
    return "--distro" if given else by_variable


def _sourced(environment: Mapping[str, str]) -> str:
    """Return the release of the first folder of an installed ROS in AMENT_PREFIX_PATH, or ""."""
    paths = environment.get("AMENT_PREFIX_PATH", "").split(":")
    names = (it.removeprefix(_INSTALLED) for it in paths if it.startswith(_INSTALLED))
    return next((it for it in names if it in RELEASES), "")


def unusual_release(given: str, environment: Mapping[str, str]) -> str:
    """Return a warning about a ROS_DISTRO that is not known or has ended, or ""."""
    found = environment.get(VARIABLE, "")
    if given or not found or found in RELEASES:
        return ""
    what = "has ended" if found in ENDED else "is not known"
    other = f"{ENDED[found]} is taken in its place; " if found in ENDED else ""
    return f"{VARIABLE} is {found!r}, which {what}: {other}name another release with --distro"


def evidence(text: bytes) -> str:
    """Return the library by which a description is for ``OF_OLD`` or earlier; empty if none does."""
    if not any(it in text for it in _OLD_WORDS):
        return ""
    # Words are found faster than an expression.
    if any(it in text for it in _NEW_WORDS) and _in_force(_NEW, text):
        return ""
    found = _in_force(_OLD, text) or _in_force(_OLD_ADAPTER, text)
    return found[1].decode() if found else ""


def _in_force(pattern: re.Pattern[bytes], text: bytes) -> re.Match[bytes] | None:
    """Return the first match outside of XML comments, or None."""
    at = 0
    while found := pattern.search(text, at):
        comment = text.rfind(b"<!--", at, found.start())
        at = text.find(b"-->", comment) if comment >= 0 else -1
        if at < found.start():
            return found
    return None


def lacks_classic(release: str, text: bytes) -> bool:
    """Return whether a description loads only libraries of Gazebo Classic, which a release lacks."""
    return release not in ("", OF_OLD) and evidence(text).startswith(CLASSIC)


def release_here(given: str | None = None) -> str:
    """Return ``chosen_release`` with this process's environment: for commands and public calls."""
    return chosen_release(given or "", os.environ)


def release_chosen_here(given: str | None = None) -> str:
    """Return ``release_for_description`` in this process: for commands and public calls."""
    return release_for_description(given or "", os.environ)


def why_here(given: str | None = None) -> str:
    """Return ``why_release`` with this process's environment."""
    return why_release(given or "", os.environ)


def release_doubt(given: str | None = None) -> str:
    """Return ``unusual_release`` with this process's environment."""
    return unusual_release(given or "", os.environ)


def facts_of_release(release: str, why: str = "", ros: str = ROS_2) -> str:
    """Return the end of a summary: the release and the reason for it; empty without one."""
    if ros == ROS_1:
        return " (ROS 1: its plugins or its package.xml say so)"
    return f" (ROS 2 {release}{why and f': {why}'})" if release else ""


@cache  # so many facts, so few words
def has_release(words: str, release: str) -> bool:
    """Return whether a fact with these release words holds in ``release``; always without words."""
    return not words or any(_term_holds(it, release) for it in _terms(words))


def releases_with(words: str) -> tuple[str, ...]:
    """Return the releases in which a fact with these release words holds."""
    return tuple(it for it in RELEASES if has_release(words, it))


def share_release(words: str, others: str) -> bool:
    """Return whether there is a release in which both facts hold."""
    return any(has_release(words, it) and has_release(others, it) for it in RELEASES)


def since_version(words: str, release: str) -> str:
    """Return the package version that brought a fact into ``release``; "" if it always had it."""
    found = [it["version"] or "" for it in _terms(words) if _term_holds(it, release)]
    return min(found, default="")


def is_release_words(words: str) -> bool:
    """Return whether a text is release words, as ``has_release`` takes."""
    try:
        found = list(_terms(words))
    except UsageError:
        return False
    # ``<=`` and ``+`` exclude each other; a version is always ``VERSION+``.
    return bool(found) and all(
        it["release"] in RELEASES
        and not (it["until"] and it["on"])
        and (not it["version"] or bool(it["on"]))
        for it in found
    )


def _terms(words: str) -> Iterator[re.Match[str]]:
    """Yield the terms of release words; raises UsageError for words that are none."""
    for term in words.split(","):
        found = _TERM.fullmatch(term.strip())
        if found is None:
            raise UsageError(f"{words!r} names no releases; write jazzy, kilted+ or <=jazzy")
        yield found


def _term_holds(term: re.Match[str], release: str) -> bool:
    at, bound = RELEASES.index(release), RELEASES.index(term["release"])
    if term["until"]:
        return at <= bound
    return at >= bound if term["on"] and not term["version"] else at == bound
