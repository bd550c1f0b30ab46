# SPDX-License-Identifier: Apache-2.0
"""The survey of public descriptions: kinds of robots, and the verdict of each."""

from __future__ import annotations

from pathlib import Path

import pytest
from paths import write_files

from tools.proved import OPEN, PROVED, REFUSED, descriptions, judged, kind_of

PLUGIN = (
    '<robot name="r"><link name="a"/>'
    '<gazebo><plugin name="p" filename="{}">{}</plugin></gazebo></robot>'
)


@pytest.mark.parametrize(
    ("file", "inside", "kind"),
    [
        ("gz_ros2_control-system", "", "ros2_control in gz-sim"),
        ("libgazebo_ros2_control.so", "", "ros2_control in Classic"),
        ("libgazebo_ros_p3d.so", "<robotNamespace/>", "plugins of ROS 1"),
        ("libgazebo_ros_p3d.so", "<ros/>", "plugins of Classic"),
        ("gz-sim-imu-system", "", "systems of gz-sim"),
        ("libmine.so", "", "other plugins"),
    ],
)
def test_a_kind_is_what_it_loads(file: str, inside: str, kind: str) -> None:
    assert kind_of(PLUGIN.format(file, inside).encode()) == kind


@pytest.mark.more
def test_each_file_has_a_verdict_a_layout_and_release(tmp_path: Path) -> None:
    texts = {
        "plain.urdf": '<robot name="r"><link name="a"/></robot>',
        "unknown.urdf": PLUGIN.format("libmine.so", ""),
        "twice.urdf": '<robot name="r"><link name="a"/><link name="a"/></robot>',
        "world.sdf": '<sdf version="1.9"><world name="w"/></sdf>',
        "macro.xacro": '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"/>',
        "broken.urdf": "<robot",
    }
    write_files(tmp_path, texts)
    found = {
        it.name: [(each.word, each.is_known) for each in judged(it, ["postfix"], ["jazzy", ""])]
        for it in descriptions([tmp_path])
    }
    assert found == {
        "plain.urdf": [(PROVED, True)] * 2,
        "unknown.urdf": [(OPEN, False)] * 2,
        "twice.urdf": [(REFUSED, False)] * 2,
        "world.sdf": [],
        "macro.xacro": [],
        "broken.urdf": [],
    }
