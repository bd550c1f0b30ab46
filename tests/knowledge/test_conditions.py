# SPDX-License-Identifier: Apache-2.0
"""Conditions of nodes.yaml, decided by values that are written here."""

from __future__ import annotations

import pytest

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.knowledge.conditions import (
    condition_in_release,
    holds,
    parse_condition,
    readable,
    verdict,
)

VALUES: dict[str, object] = {
    "on": True,
    "off": False,
    "mode": "mapping",
    "layer.plugin": "nav2_costmap_2d::VoxelLayer",
    "type": "diff_drive_controller/DiffDriveController",
    "plugins": ["static_layer", "nav2_costmap_2d::VoxelLayer"],
    "period": 0.0,
    "empty": "",
    "world_frame": "map",
    "map_frame": "map",
}


@pytest.mark.parametrize(
    ("text", "true"),
    [
        ("", True),
        ("on", True),
        ("off", False),
        ("absent", False),
        ("off != false", False),
        ("absent != false", True),
        ("mode = mapping", True),
        ("mode = localization | mapping", True),
        ("mode = localization", False),
        ("layer.plugin = VoxelLayer", True),
        ("layer.plugin = ObstacleLayer | StaticLayer", False),
        ("type = DiffDriveController", True),
        ("plugins has VoxelLayer", True),
        ("plugins has static_layer", True),
        ("plugins has obstacle_layer", False),
        ("absent has anything", False),
        ("plugins lacks obstacle_layer | VoxelLayer", False),
        ("plugins lacks obstacle_layer | range_layer", True),
        ("absent lacks anything", True),
        ("period != 0.0", False),
        ("world_frame = $map_frame", True),
        ("world_frame != $map_frame", False),
        ("world_frame = $absent", False),
        ("on and mode = mapping", True),
        ("on and off", False),
        ("off or on", True),
        ("off or on and absent", False),
        ("mode set", True),
        ("absent set", False),
        ("empty set", False),
        ("empty unset", True),
        ("absent unset and on", True),
        ("absent|mode = mapping", True),
        ("absent|mode = localization", False),
    ],
)
def test_a_condition_is_decided(text: str, true: bool) -> None:
    assert holds(text, VALUES.get) is true


@pytest.mark.parametrize(
    ("text", "known"),
    [
        ("heard: points", None),
        ("open: device", None),
        ("on and heard: points", None),
        ("off and heard: points", False),
        ("on or heard: points", True),
        ("off or heard: points", None),
        ("<layer>.plugin = VoxelLayer", None),
        ("on and <layer>.plugin = VoxelLayer", None),
        ("off and open: device", False),
        ("--debug set", None),
        ("file names DockRobot", None),
        ("run: simulated", None),
    ],
)
def test_what_parameters_do_not_say_is_open(text: str, known: bool | None) -> None:
    assert verdict(text, VALUES.get) is known


@pytest.mark.parametrize(
    "text", ["open: it is dark", "open: device | moment", "on and open: Device"]
)
def test_what_is_open_is_said_in_one_of_a_few_words(text: str) -> None:
    with pytest.raises(UsageError, match="is none of chosen, device, moment, code, file, nodl"):
        parse_condition(text)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        *((it, "no condition") for it in (" = x", "a b", "a and ", "!= x")),
        ("herd: points", "did you mean 'heard'"),
    ],
)
def test_what_is_no_condition(text: str, said: str) -> None:
    with pytest.raises(UsageError, match=said):
        parse_condition(text)


@pytest.mark.parametrize(
    ("text", "release", "left"),
    [
        ("on", "jazzy", "on"),
        ("on and release: kilted+", "jazzy", None),
        ("on and release: kilted+", "lyrical", "on"),
        ("release: <=jazzy and on or off", "kilted", "off"),
        ("release: <=jazzy and on or off", "humble", "on or off"),
    ],
)
def test_what_a_condition_says_of_releases_is_settled(
    text: str, release: str, left: str | None
) -> None:
    assert condition_in_release(text, release) == left


@pytest.mark.parametrize(
    ("text", "known"),
    [
        ("words has one", True),
        ("words has ne", False),
        ("run: simulated", True),
        ("run: real", False),
        ("given: words", True),
        ("given: absent", None),
        ("missing: words", False),
        ("missing: absent", None),
    ],
)
def test_what_a_parameter_says_of_how_it_is_started(text: str, known: bool | None) -> None:
    """MoveIt's capabilities are words of one text. What a file does not pass, a launch file may."""
    values = {"words": "a/one two", "use_sim_time": True}
    assert verdict(text, values.get) is known


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("version: nav2_route 1.3.9", "nav2_route 1.3.9 or newer"),
        (
            "use_mag != false and version: a 1.0 or on",
            "use_mag is not false and a 1.0 or newer or on is true",
        ),
        ("<c>.plugin|<c>.class = MPPI | DWB", "<c>.plugin or <c>.class is MPPI or DWB"),
        ("heard: points and scan_topic unset", "points has a subscriber and scan_topic is not set"),
        ("given: map and missing: params", "map is passed and params is not passed"),
        ("program: amcl | other", "it is started as amcl or other"),
        ("release: jazzy or run: simulated", "on jazzy or the robot is simulated"),
        ("unsent: scan and map set", "no other node sends scan and map is set"),
        ("open: chosen", "only where you start it"),
        ("open: moment", "only for a time, or for one request"),
        ("open: code", "only as its code was built"),
        ("open: file", "only if a file says so"),
        ("open: nodl", "its NoDL file does not have it"),
        ("plugins has A and plugins lacks B", "plugins has A and plugins lacks B"),
        ("path names A", "path names A"),
        # What the files of a fleet say besides.
        ("its parameters are in nav2.yaml", "its parameters are in nav2.yaml"),
        ("open: device", "only if the device has it"),
        ("open: device or on", "only if the device has it or on is true"),
        ("", ""),
    ],
)
def test_people_read_a_condition_as_english(text: str, words: str) -> None:
    assert readable(text) == words
