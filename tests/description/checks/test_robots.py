# SPDX-License-Identifier: Apache-2.0
"""Robots that are called like frames and topics that all share: the same wherever they are named."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from multibot_rewrite import RewriteRefused, rewrite, rewrite_all, strip

ROBOT = '<robot name="r"><link name="{}"/>{}</robot>'
SCAN = (
    '<gazebo><plugin name="p" filename="libgazebo_ros_ray_sensor.so">'
    "<ros><remapping>~/out:=scan</remapping></ros></plugin></gazebo>"
)


def refusals(text: str, robots: Sequence[str], **options: object) -> set[tuple[str, str]]:
    """Codes and messages of a call that is refused; empty for one that is not."""
    try:
        list(rewrite_all(text, robots, **options))  # type: ignore[arg-type]
    except RewriteRefused as error:
        return {(it.code, it.message) for it in error.findings if it.level == "error"}
    return set()


@pytest.mark.parametrize("order", [("world", "map", "odom"), ("odom", "map", "world")])
@pytest.mark.parametrize("link", ["/world", "world", "map", "/map", "base"])
def test_a_shared_frame_is_no_trace_of_a_robot_of_that_name(
    link: str, order: Sequence[str]
) -> None:
    for made in rewrite_all(ROBOT.format(link, ""), order):
        assert strip(made.data, made.robot) == ROBOT.format(link, "").encode()


@pytest.mark.parametrize("order", [("world", "r2"), ("r2", "world")])
def test_a_name_that_becomes_a_shared_frame_is_refused(order: Sequence[str]) -> None:
    message = "link '/' would become '//world' for world, which is shared"
    assert refusals(ROBOT.format("/", ""), order) == {("MB420", message)}
    assert refusals(ROBOT.format("/", ""), ["r2"]) == set()


def test_a_name_that_becomes_a_shared_one_of_the_users_is_refused() -> None:
    frames = {"shared_frames": ["base/r1"]}
    message = "link 'base' would become 'base/r1' for r1, which is shared"
    assert refusals(ROBOT.format("base", ""), ["r2", "r1"], **frames) == {("MB420", message)}
    assert refusals(ROBOT.format("base", ""), ["r2", "r10"], **frames) == set()
    topics = {"shared_topics": ["/scan/r1"]}
    message = "topic 'scan' would become 'scan/r1' for r1, which is shared"
    assert refusals(ROBOT.format("base", SCAN), ["r1"], **topics) == {("MB420", message)}
    assert rewrite(ROBOT.format("base", SCAN), "r1").text.count("scan/r1") == 1
