# SPDX-License-Identifier: Apache-2.0
"""A robot whose nodes miss each other by name is not built, where the launch file starts both sides."""

from __future__ import annotations

from pathlib import Path

import pytest
from paths import write_files

from multibot_rewrite.cli.multibot import main

# A drive that listens below its own name, and Nav2, which sends /cmd_vel.
ROBOT = """\
<robot name="rover">
  <link name="base_link"/><link name="left"/><link name="right"/>
  <joint name="left_wheel" type="continuous"><parent link="base_link"/><child link="left"/></joint>
  <joint name="right_wheel" type="continuous"><parent link="base_link"/><child link="right"/></joint>
  <ros2_control name="base" type="system">
    <hardware><plugin>mock_components/GenericSystem</plugin></hardware>
    <joint name="left_wheel"><command_interface name="velocity"/>
      <state_interface name="position"/><state_interface name="velocity"/></joint>
    <joint name="right_wheel"><command_interface name="velocity"/>
      <state_interface name="position"/><state_interface name="velocity"/></joint>
  </ros2_control>
</robot>
"""
PARAMS = """\
controller_manager:
  ros__parameters:
    update_rate: 50
    base_controller: {type: diff_drive_controller/DiffDriveController}
base_controller:
  ros__parameters:
    left_wheel_names: [left_wheel]
    right_wheel_names: [right_wheel]
    wheel_separation: 0.4
    wheel_radius: 0.1
    base_frame_id: base_link
    use_stamped_vel: false
bt_navigator: {ros__parameters: {odom_topic: base_controller/odom}}
amcl: {ros__parameters: {base_frame_id: base_link}}
"""
FLEET = """\
layout: tf-per-robot
distro: humble
simulator: none
description: rover.urdf
related_files: {params: params.yaml}
nodes: nodes.yaml
node_sets: nav2_here
robots: [{name: robot1}, {name: robot2}]
"""
ODOMETRY = "controller_server: {odom: base_controller/odom}"
DRIVEN = "base_controller/cmd_vel_unstamped"
OWN = "node_sets:\n  nav2_here:\n    include: [nav2]\n    remaps: {{{}}}\n"
MODEL = """\
structure:
  nodes:
    /behavior_server: {pkg: nav2_behaviors, exec: behavior_server, node_name: behavior_server}
"""
UNKNOWN = "    /own: {pkg: own, exec: own, node_name: own}\n"


def build(folder: Path, rules: str, more: str = "", *words: str) -> int:
    files = {"rover.urdf": ROBOT, "params.yaml": PARAMS, "system_model.yaml": MODEL}
    files |= {"unknown.system_model.yaml": MODEL + UNKNOWN}
    files |= {"fleet.yaml": FLEET + more, "nodes.yaml": OWN.format(rules)}
    write_files(folder, files)
    return main(["build", str(folder / "fleet.yaml"), "-o", str(folder / "out"), *words])


def levels(text: str, code: str) -> set[str]:
    return {it.split(": ")[1] for it in text.splitlines() if f" {code} " in it}


def test_a_rule_that_is_missing_is_an_error_and_nothing_is_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert build(tmp_path, ODOMETRY) == 1
    said = capsys.readouterr().err
    assert f"pass the rule /cmd_vel:=/{DRIVEN}" in said
    assert levels(said, "MG308") == {"error"}
    assert "nothing was written" in said and not (tmp_path / "out").exists()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("more", "words"),
    [
        ("", ("--ignore", "MG308")),
        ("params_style: bringup\n", ()),
        ("launch: unknown.system_model.yaml\n", ()),
    ],
)
def test_what_the_user_or_another_launch_file_answers_for_is_built(
    more: str, words: tuple[str, ...], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """What another launch file starts has rules of its own, and a node of unknown code may do more."""
    assert build(tmp_path, ODOMETRY, more, *words) == 0
    assert levels(capsys.readouterr().err, "MG308") == ({"warning"} if more else set())


@pytest.mark.slow
def test_a_launch_file_whose_nodes_are_known_is_asked_as_well(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """What it starts the built launch file starts, too, with its rules."""
    assert build(tmp_path, ODOMETRY, "launch: system_model.yaml\n") == 1
    assert levels(capsys.readouterr().err, "MG308") == {"error"}
