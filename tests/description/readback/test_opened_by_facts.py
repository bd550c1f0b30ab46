# SPDX-License-Identifier: Apache-2.0
"""Files that are called verified, judged by a reader that knows neither our definitions nor the second
reading: facts from the consumers' sources say what each plugin opens. No two robots meet."""

from __future__ import annotations

from itertools import product

import pytest
from opened_facts import FACTS, Opened, met, only_in_ros_1, opened
from real_robots import corpus_files

from multibot_rewrite import rewrite_all
from multibot_rewrite.base.model import MultibotError

# So many outputs with something that opens a name, of libraries of so many kinds.
ENOUGH, KINDS = 50, 25
LAYOUTS = ("postfix", "tf-per-robot", "frames-per-robot")


def both(text: bytes, layout: str, known: set[str]) -> tuple[set[Opened], set[Opened]] | None:
    """Return what two robots open; None where the rewrite is refused or not verified."""
    try:
        one, other = rewrite_all(text, ["robot1", "robot2"], layout=layout)
    except MultibotError:
        return None
    if one.not_verified:
        return None
    # ROS 1 loads no plugin of a robot that ROS 2 controls, or of which one reads <ros>
    # (gazebo_ros/src/node.cpp); ROS 2 does not read its parameters (MB904), and has other libraries.
    of_ros_2 = b"<ros2_control" in text or b"<ros>" in text
    of_ros_1 = any(b"lib%s.so" % it in text for it in only_in_ros_1())
    absent = "noetic" if of_ros_2 else "of ROS 2" if of_ros_1 else "no such branch"
    pair = (opened(it.data, it.robot, known) for it in (one, other))
    first, second = ({it for it in its if absent not in it.source} for its in pair)
    return first, second


@pytest.mark.deep
@pytest.mark.sample(4)
@pytest.mark.parametrize("part", range(4))
def test_no_robots_meet_that_are_proved(part: int) -> None:
    if not FACTS.is_dir() or not corpus_files():
        pytest.skip("no facts and no corpus beside the repository")
    judged, known = 0, set[str]()
    texts = (path.read_bytes() for path in list(corpus_files().values())[part::4])
    for text, layout in product((it for it in texts if b"<plugin" in it), LAYOUTS):
        pair = both(text, layout, known)
        if pair and pair[0]:
            judged += 1
            assert not met(*pair, frames=layout != "tf-per-robot")
    assert judged >= ENOUGH
    assert len(known) >= KINDS


def test_the_reader_sees_what_two_robots_share() -> None:
    """The judge is worth something: the outputs of a layout that keeps topics meet."""
    if not FACTS.is_dir():
        pytest.skip("no facts beside the repository")
    drive = (
        b'<robot name="r"><link name="a"/><gazebo><plugin name="d" '
        b'filename="libgazebo_ros_diff_drive.so"><ros><namespace>/x</namespace></ros>'
        b"<publish_odom>true</publish_odom></plugin></gazebo></robot>"
    )
    found = {it.name for it in met(*(set(opened(drive, it, set())) for it in "ab"), frames=True)}
    assert {"/x/d", "/x/cmd_vel"} <= found
