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
COMMENTED = SENSORS.replace("<render", "<!-- ogre - no --><!-- --><!----><render")


def _libraries(data: bytes) -> list[str]:
    return [it.get("filename") or "" for it in etree.fromstring(data).iter("plugin")]


@pytest.mark.parametrize("layout", ["postfix", "both"])
@pytest.mark.parametrize("own", [SENSORS, IMU, SENSORS + IMU, f"{IMU}\n  {SENSORS}"])
def test_they_are_comments_then(own: str, layout: str) -> None:
    text = ROBOT.format(own)
    kept = rewrite(text, "r1", distro="jazzy", layout=layout)
    assert "MB416" in {it.code for it in kept.findings} and kept.not_verified
    left = rewrite(text, "r1", distro="jazzy", layout=layout, world_systems="leave")
    assert "MB416" not in {it.code for it in left.findings} and left.not_verified == ()
    assert _libraries(left.data) == ["gz-sim-diff-drive-system"]
    # Nothing but these is other than in a rewrite that keeps them.
    assert (
        left.text.replace("<!-- left to the world ", "")
        .replace("plugin> -->", "plugin>")
        .replace('"/> -->', '"/>')
        == kept.text
    )
    back = strip(left.data, "r1", distro="jazzy", layout=layout)
    assert back.decode() == text


def test_nothing_is_left_where_nothing_is_the_worlds() -> None:
    text = ROBOT.format("")
    left = rewrite(text, "r1", distro="jazzy", world_systems="leave")
    assert left.data == rewrite(text, "r1", distro="jazzy").data


def test_one_with_a_comment_in_it_is_put_back_as_it_was() -> None:
    """A comment cannot hold a comment: it is spelled in another way as long as it is one."""
    text = ROBOT.format(COMMENTED)
    left = rewrite(text, "r1", distro="jazzy", world_systems="leave")
    assert _libraries(left.data) == ["gz-sim-diff-drive-system"]
    assert strip(left.data, "r1", distro="jazzy").decode() == text


def test_one_with_that_spelling_stays_and_is_told() -> None:
    own = SENSORS.replace("ogre2", "ogre-&#45;2")
    left = rewrite(ROBOT.format(own), "r1", distro="jazzy", world_systems="leave")
    assert "gz-sim-sensors-system" in _libraries(left.data)
    assert [it.code for it in left.findings] == ["MB416"] and left.not_verified


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


def test_the_note_has_the_text_for_the_world() -> None:
    first, _ = rewrite_all(ROBOT.format(IMU + COMMENTED + IMU), ["r1", "r2"], distro="jazzy")
    (note,) = (it for it in first.findings if it.code == "MF847")
    assert "gz-sim-imu-system, gz-sim-sensors-system," in note.message and note.level == "note"
    written = etree.fromstring(f"<world>{note.hint.partition(': ')[2]}</world>")
    assert [it.get("filename") for it in written] == ["gz-sim-imu-system", "gz-sim-sensors-system"]
    assert written.findtext("plugin/render_engine") == "ogre2"


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
    assert main([str(made), "r1", "--distro", "jazzy", "--undo", "--in-place"]) == 0
    assert made.read_text() == file.read_text()
