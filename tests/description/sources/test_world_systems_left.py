# SPDX-License-Identifier: Apache-2.0
"""Systems of the world that a rewrite leaves to the world, by ``--world-systems leave``.

Expected: gz-sim loads each <plugin> element that it meets and no comment; a strip gives the input.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from lxml import etree

from multibot_rewrite import rewrite, strip
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.cli.urdf_postfix import main

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
COMMENTED = SENSORS.replace("<render", "<!-- ogre -- no --><render".replace(" -- ", " "))


def _libraries(data: bytes) -> list[str]:
    return [it.get("filename") or "" for it in etree.fromstring(data).iter("plugin")]


@pytest.mark.parametrize("layout", ["postfix", "both"])
@pytest.mark.parametrize("own", [SENSORS, IMU, SENSORS + IMU, f"{IMU}\n  {SENSORS}"])
def test_they_are_comments_then(own: str, layout: str) -> None:
    text = ROBOT.format(own)
    kept = rewrite(text, "r1", distro="jazzy", layout=layout)
    assert "MB416" in {it.code for it in kept.findings} and kept.not_proved
    left = rewrite(text, "r1", distro="jazzy", layout=layout, world_systems="leave")
    assert "MB416" not in {it.code for it in left.findings} and left.not_proved == ()
    assert _libraries(left.data) == ["gz-sim-diff-drive-system"]
    # Nothing but these is other than in a rewrite that keeps them.
    assert (
        left.text.replace("<!-- left to the world ", "")
        .replace("plugin> -->", "plugin>")
        .replace('"/> -->', '"/>')
        == kept.text
    )
    back = strip(left.data, "r1", distro="jazzy", layout=layout, world_systems="leave")
    assert back.decode() == text


def test_nothing_is_left_where_nothing_is_the_worlds() -> None:
    text = ROBOT.format("")
    left = rewrite(text, "r1", distro="jazzy", world_systems="leave")
    assert left.data == rewrite(text, "r1", distro="jazzy").data


def test_one_with_a_comment_in_it_stays_and_is_told() -> None:
    """A comment cannot hold a comment."""
    left = rewrite(ROBOT.format(COMMENTED), "r1", distro="jazzy", world_systems="leave")
    assert "gz-sim-sensors-system" in _libraries(left.data)
    assert [it.code for it in left.findings] == ["MB416"] and left.not_proved


def test_a_comment_that_was_edited_is_not_put_back() -> None:
    left = rewrite(ROBOT.format(IMU), "r1", distro="jazzy", world_systems="leave").text
    edited = left.replace("gz-sim-imu-system", "gz-sim-diff-drive-system").replace(
        "::Imu", "::DiffDrive"
    )
    with pytest.raises(InputError, match="left to the world"):
        strip(edited, "r1", distro="jazzy", world_systems="leave")


def test_another_word_is_refused() -> None:
    with pytest.raises(UsageError, match="world_systems 'drop' is not known"):
        rewrite(ROBOT.format(IMU), "r1", world_systems="drop")


def test_the_command_follows_its_hint(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """MB416 names the option, and says what the world has to load."""
    file, made = tmp_path / "rover.urdf", tmp_path / "r1.urdf"
    file.write_text(ROBOT.format(SENSORS + IMU))
    words = [str(file), "r1", "--distro", "jazzy", "-o", str(made)]
    assert main(words) == 0
    assert "--world-systems leave" in capsys.readouterr().err
    assert main([*words, "--world-systems", "leave"]) == 0
    end = "the world loads gz-sim-imu-system, gz-sim-sensors-system (ROS 2 jazzy: --distro)"
    assert capsys.readouterr().err.strip().endswith(end)
    again = [str(made), "r1", "--distro", "jazzy", "--undo", "--in-place"]
    assert main([*again, "--world-systems", "leave"]) == 0
    assert made.read_text() == file.read_text()
