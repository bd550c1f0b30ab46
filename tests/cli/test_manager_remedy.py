# SPDX-License-Identifier: Apache-2.0
"""``check-launch`` names the argument with which a controller manager is started, if there is one."""

from __future__ import annotations

from pathlib import Path

import pytest
from paths import fixture_text

from multibot_rewrite.cli.multibot import main

ROBOT = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="use_gazebo" default="false"/>
  <link name="base_link"/>
  <xacro:if value="$(arg use_gazebo)">
    <gazebo><plugin filename="gz_ros2_control-system"
      name="gz_ros2_control::GazeboSimROS2ControlPlugin"/></gazebo>
  </xacro:if>
</robot>
"""
LAUNCH = fixture_text("manager_remedy_launch.txt")
OTHERWISE = "start ros2_control_node there, load gz_ros2_control in the description, or name"


@pytest.mark.parametrize(
    ("name", "default", "value", "words", "hint"),
    [
        ("use_sim", "false", 'LaunchConfiguration("use_sim")', [], "add use_sim:=true, with"),
        ("gz", "true", 'LaunchConfiguration("gz")', ["gz:=false"], "add gz:=true, with"),
        ("speed", "false", 'LaunchConfiguration("speed")', [], OTHERWISE),
        ("use_sim", "false", '"false"', [], OTHERWISE),
    ],
)
def test_the_argument_that_starts_the_manager(
    name: str,
    default: str,
    value: str,
    words: list[str],
    hint: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """It is tried: what is called so and changes nothing is no remedy."""
    (tmp_path / "r.urdf.xacro").write_text(ROBOT)
    text = LAUNCH.replace("NAME", name).replace("DEFAULT", default).replace("VALUE", value)
    (tmp_path / "r.launch.py").write_text(text)
    assert main(["check-launch", str(tmp_path / "r.launch.py"), *words]) == 1
    (line,) = (it for it in capsys.readouterr().out.splitlines() if "MG723" in it)
    assert f"({hint}" in line
