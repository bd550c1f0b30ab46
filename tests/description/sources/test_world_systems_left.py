# SPDX-License-Identifier: Apache-2.0
"""Systems of the world that a rewrite leaves to the world: of several robots, and where it is said.

Expected: gz-sim loads each <plugin> element that it meets and no comment; a strip gives the input.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from lxml import etree

from multibot_rewrite import rewrite, rewrite_all, strip
from multibot_rewrite.base.model import InputError, UsageError

ROBOT = """<robot name="rover"><link name="base"/>
<gazebo reference="base"><sensor name="eye" type="gpu_lidar"><topic>scan</topic></sensor></gazebo>
<gazebo>
  {}
  <plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive"/>
</gazebo></robot>
"""
SENSORS = (
    '<plugin filename="gz-sim-sensors-system" name="gz::sim::systems::Sensors">\n'
    "    <render_engine>ogre2</render_engine>\n  </plugin>"
)
IMU = '<plugin filename="gz-sim-imu-system" name="gz::sim::systems::Imu"/>'


def _libraries(data: bytes) -> list[str]:
    return [it.get("filename") or "" for it in etree.fromstring(data).iter("plugin")]


@pytest.mark.parametrize(
    ("robots", "said", "is_left"),
    [
        (["r1"], {}, False),
        (["r1", "r2"], {}, True),
        (["r1", "r2"], {"world_systems": "keep"}, False),
        (["r1"], {"world_systems": "leave"}, True),
    ],
)
def test_several_robots_leave_them(robots: list[str], said: dict[str, str], is_left: bool) -> None:
    """Two copies of Sensors crash Gazebo (gz-sensors issue 497); one may be all there is."""
    made = [*rewrite_all(ROBOT.format(SENSORS), robots, distro="jazzy", **said)]
    assert {"gz-sim-sensors-system" in _libraries(it.data) for it in made} == {not is_left}
    assert {it.not_verified == () for it in made} == {is_left}


def test_a_xacro_with_names_of_its_own_is_stripped_to_its_expansion(tmp_path: Path) -> None:
    xacro = tmp_path / "rover.urdf.xacro"
    head = '<robot name="rover" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="p" '
    body = ROBOT.format(SENSORS).partition(">")[2].replace('"base"', '"$(arg p)base"')
    xacro.write_text(f'{head}default=""/>{body}')
    args = {"p": "{robot}_"}
    made = [*rewrite_all(str(xacro), ["r1", "r2"], distro="jazzy", xacro_args=args)]
    for it in made:
        assert _libraries(it.data) == ["gz-sim-diff-drive-system"]
        back = strip(it.data, it.robot, distro="jazzy", xacro=str(xacro), xacro_args=args)
        kept = rewrite(str(xacro), it.robot, distro="jazzy", xacro_args=args)
        assert back == kept.prepared.job.data


def test_a_source_with_such_a_comment_is_that_of_a_rewrite() -> None:
    """A strip could not tell it from its own."""
    text = ROBOT.format(f"<!-- left to the world {IMU} -->")
    for robots in (["r1"], ["r1", "r2"]):
        with pytest.raises(InputError, match="take that back by --undo"):
            list(rewrite_all(text, robots, distro="jazzy"))


def test_a_comment_that_was_edited_is_not_put_back() -> None:
    left = rewrite(ROBOT.format(IMU), "r1", distro="jazzy", world_systems="leave").text
    edited = left.replace("gz-sim-imu-system", "gz-sim-diff-drive-system").replace(
        "::Imu", "::DiffDrive"
    )
    with pytest.raises(InputError, match="left to the world"):
        strip(edited, "r1", distro="jazzy")


def test_another_word_is_refused() -> None:
    with pytest.raises(UsageError, match="world_systems 'drop' is not known"):
        rewrite(ROBOT.format(IMU), "r1", world_systems="drop")
