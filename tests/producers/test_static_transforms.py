# SPDX-License-Identifier: Apache-2.0
"""What a launched static_transform_publisher sends, in a plan and in what a launch would run."""

from __future__ import annotations

import pytest
from launched_nodes import launched, runs, started

from multibot_rewrite.producers.launch.records import ParameterText
from multibot_rewrite.spelling.transforms import sent_by
from multibot_rewrite.system.records import Edge, edge_of

ZEROS = ("0",) * 6
FILE = "/**:\n  ros__parameters: {frame_id: map, child_frame_id: odom}\n"


def sends(
    *words: str, executable: str = "static_transform_publisher", text: str = ""
) -> list[Edge]:
    parameters = (ParameterText("", text),) if text else ()
    node = started("tf2_ros", executable, "placed", arguments=words, parameters=parameters)
    return [*sent_by(runs(launched(node))["placed"], "base_link")]


@pytest.mark.parametrize(
    "words",
    [
        (*ZEROS, "odom", "dock"),
        (*ZEROS, "1", "/odom", "dock"),
        ("--frame-id", "odom", "--x", "-1", "--child-frame-id", "/dock"),
    ],
)
def test_its_arguments_name_the_frames(words: tuple[str, ...]) -> None:
    assert sends(*words) == [edge_of("odom", "dock", True)]


@pytest.mark.parametrize("words", [(), ("odom", "dock"), (*ZEROS, "odom"), ("--frame-id", "odom")])
def test_a_frame_that_is_not_named_is_not_known(words: tuple[str, ...]) -> None:
    assert sends(*words) == []


def test_a_component_has_its_frames_as_parameters_and_arguments_come_first() -> None:
    plugin = "tf2_ros::StaticTransformBroadcasterNode"
    assert sends(executable=plugin, text=FILE) == [edge_of("map", "odom", True)]
    assert sends(*ZEROS, "odom", "dock", text=FILE) == [edge_of("odom", "dock", True)]


def test_a_frame_below_itself_is_sent_by_nobody() -> None:
    assert sends(*ZEROS, "odom", "/odom") == []
