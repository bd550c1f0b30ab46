# SPDX-License-Identifier: Apache-2.0
"""A real arm of a node set, without a parameter file: its controllers still have a type, as
ros2_control's controller_manager.cpp needs ("The 'type' param was not defined")."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite.cli.multibot import main

ARM = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="robot_ip" default="192.168.11.11"/>
  <link name="base_link"/><link name="l1"/>
  <joint name="j1" type="revolute"><parent link="base_link"/><child link="l1"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <ros2_control name="sys" type="system">
    <hardware><plugin>kortex_driver/KortexMultiInterfaceHardware</plugin>
      <param name="robot_ip">$(arg robot_ip)</param></hardware>
    <joint name="j1"><command_interface name="position"/><state_interface name="position"/></joint>
  </ros2_control>
</robot>"""
FLEET = """layout: {}
distro: {}
description: arm.urdf.xacro
simulator: none
node_sets: ros2_control
robots:
  - {{name: robot1, arguments: {{robot_ip: 10.0.0.1}}}}
  - {{name: robot2, arguments: {{robot_ip: {}}}}}
"""
TYPED = "controller_manager:\n  ros__parameters:\n    joint_state_broadcaster:\n      type: {}\n"
BROADCASTER = "joint_state_broadcaster/JointStateBroadcaster"


def _built(folder: Path, layout: str, distro: str, ip: str = "10.0.0.2", params: str = "") -> int:
    (folder / "arm.urdf.xacro").write_text(ARM)
    text = FLEET.format(layout, distro, ip)
    if params:
        (folder / "controllers.yaml").write_text(params)
        text += "related_files: {params: [controllers.yaml]}\n"
    (folder / "fleet.yaml").write_text(text)
    return main(["build", str(folder / "fleet.yaml"), "-o", str(folder / "out"), "-q"])


@pytest.mark.more
@pytest.mark.sample(4)
@pytest.mark.parametrize("distro", ["humble", "jazzy", "lyrical"])
@pytest.mark.parametrize(
    ("layout", "name"),
    [
        ("postfix", "f'joint_state_broadcaster_{name}.type'"),
        ("both", "'joint_state_broadcaster.type'"),
        ("tf-per-robot", "'joint_state_broadcaster.type'"),
    ],
)
def test_the_manager_gets_the_type(layout: str, name: str, distro: str, tmp_path: Path) -> None:
    assert _built(tmp_path, layout, distro) == 0
    text = (tmp_path / "out" / "fleet.launch.py").read_text()
    assert text.count(f"{name}: '{BROADCASTER}'") == 1
    # Of what is not started nothing is said.
    assert ".type'" not in text.replace(name, "")
    assert (
        main(["check-launch", str(tmp_path / "out" / "fleet.launch.py"), "--distro", distro]) == 0
    )


@pytest.mark.more
def test_what_a_file_declares_is_not_said_again(tmp_path: Path) -> None:
    assert _built(tmp_path, "both", "jazzy", params=TYPED.format(BROADCASTER)) == 0
    assert ".type'" not in (tmp_path / "out" / "fleet.launch.py").read_text()


def test_one_address_of_two_robots_is_said_once_with_the_argument(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert _built(tmp_path, "both", "jazzy", ip="10.0.0.1") == 1
    told = [it for it in capsys.readouterr().err.splitlines() if "MB412" in it]
    assert len(told) == 1 and "error" in told[0]
    assert "arguments: {robot_ip: ...}" in told[0]
