# SPDX-License-Identifier: Apache-2.0
"""What controllers are spawned with, by ``urdf-postfix``: since Jazzy a controller takes no rules
of the plugin that loads it, on Humble it does."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite.cli.urdf_postfix import main

ROBOT = (
    '<robot name="r"><link name="a"/><gazebo><plugin filename="gz_ros2_control-system" '
    'name="gz_ros2_control::GazeboSimROS2ControlPlugin"><parameters>c.yaml</parameters></plugin>'
    '</gazebo><ros2_control name="s" type="system"><hardware><plugin>gz_ros2_control/GazeboSimSystem'
    '</plugin></hardware><joint name="j"><command_interface name="position"/></joint></ros2_control>'
    "</robot>"
)


@pytest.mark.parametrize(("distro", "is_said"), [("lyrical", True), ("humble", False)])
def test_the_rules_of_a_spawner(
    distro: str, is_said: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "r.urdf"
    file.write_text(ROBOT)
    assert main([str(file), "robot1", "--distro", distro]) == 0
    assert ("-r /joint_states:=/joint_states/ROBOT" in capsys.readouterr().err) is is_said
