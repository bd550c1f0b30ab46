# SPDX-License-Identifier: Apache-2.0
"""What a launched static_transform_publisher sends, in a plan and in what a launch would run."""

from __future__ import annotations

from launched_nodes import launched, runs, started

from multibot_rewrite.producers.launch.records import ParameterText
from multibot_rewrite.spelling.transforms import sent_by
from multibot_rewrite.system.records import Edge

ZEROS = ("0",) * 6


def sends(
    *words: str, executable: str = "static_transform_publisher", text: str = ""
) -> list[Edge]:
    parameters = (ParameterText("", text),) if text else ()
    node = started("tf2_ros", executable, "placed", arguments=words, parameters=parameters)
    return [*sent_by(runs(launched(node))["placed"], "base_link")]


def test_a_frame_below_itself_is_sent_by_nobody() -> None:
    assert sends(*ZEROS, "odom", "/odom") == []
