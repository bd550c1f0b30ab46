# SPDX-License-Identifier: Apache-2.0
"""Files of yarp plugins: each robot has its own, and its description loads that."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite.cli.multibot import main

URDF = """\
<robot name="bot">
  <link name="root">
    <inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
  </link>
  <link name="head">
    <inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
  </link>
  <joint name="neck" type="revolute">
    <parent link="root"/><child link="head"/><limit effort="1" velocity="1"/>
  </joint>
  <gazebo reference="head"><sensor name="gyro" type="imu"/></gazebo>
  <gazebo>
    <plugin name="board" filename="libgazebo_yarp_controlboard.so">
      <yarpConfigurationFile>{}</yarpConfigurationFile>
    </plugin>
  </gazebo>
</robot>
"""
INI = """\
[include "../name.ini"]
  # jointNames neck in a comment
jointNames neck  other
parentLinkName head
sensorName gyro # gyro
enabledSensors (bot::gyro
                gyro)
[neck]
neck 0 1
"""


def built(folder: Path, path: str, *, layout: str = "both", more: str = "") -> Path:
    """A model ``bot`` whose description names ``path``."""
    conf = folder / "bot" / "conf" / "inner"
    conf.mkdir(parents=True)
    (conf / "head.ini").write_text(INI)
    name = '[include "inner/head.ini"]\ngazeboYarpPluginsRobotName botSim\n'
    (conf.parent / "name.ini").write_text(name)
    (folder / "bot" / "robot.urdf").write_text(URDF.format(path))
    robots = "robots: [{name: robot1}, {name: robot2, pose: {y: 2}}]\n"
    head = f"distro: jazzy\nlayout: {layout}\naffix: prefix\ndescription: bot/robot.urdf\n{more}"
    (folder / "fleet.yaml").write_text(head + robots)
    assert main(["build", str(folder / "fleet.yaml"), "-o", str(folder / "out")]) == 0
    return folder / "out"


@pytest.mark.more
def test_each_robot_loads_its_own(tmp_path: Path) -> None:
    out = built(tmp_path, "model://bot/conf/inner/head.ini")
    for robot in ("robot1", "robot2"):
        own = out / robot / "conf" / "inner" / "head.ini"
        text = (out / robot / "robot.urdf").read_text()
        assert f"<yarpConfigurationFile>file://{own}</yarpConfigurationFile>" in text
        lines = own.read_text().splitlines()
        assert lines[1] == "  # jointNames neck in a comment"
        assert lines[2:5] == [
            f"jointNames {robot}_neck  other",
            f"parentLinkName {robot}/head",
            f"sensorName {robot}_gyro # gyro",
        ]
        assert lines[-2:] == ["[neck]", "neck 0 1"]
        name = (out / robot / "conf" / "name.ini").read_text()
        # The file includes the one that includes it.
        assert name == f'[include "inner/head.ini"]\ngazeboYarpPluginsRobotName {robot}\n'
    assert (tmp_path / "bot" / "conf" / "inner" / "head.ini").read_text() == INI


@pytest.mark.more
def test_a_layout_with_bare_names_keeps_them(tmp_path: Path) -> None:
    out = built(tmp_path, "conf/inner/head.ini", layout="tf-per-robot")
    text = (out / "robot1" / "head.ini").read_text()
    assert "jointNames neck  other" in text


@pytest.mark.more
@pytest.mark.sample(1)
@pytest.mark.parametrize(
    "path",
    ["model://bot/conf/none.ini", "model://bot/../../etc/passwd", "model://other/conf/head.ini"],
)
def test_one_that_is_not_followed_is_told(
    path: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = built(tmp_path, path)
    said = capsys.readouterr().err
    assert said.count("note: MF842") == 1
    assert f"its description loads '{path}'" in said
    assert path in (out / "robot1" / "robot.urdf").read_text()


@pytest.mark.more
def test_a_real_robot_loads_none(tmp_path: Path) -> None:
    out = built(tmp_path, "model://bot/conf/inner/head.ini", more="simulator: none\n")
    assert not (out / "robot1" / "conf").exists()
