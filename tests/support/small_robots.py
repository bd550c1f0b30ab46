# SPDX-License-Identifier: Apache-2.0
"""Small robots and what ``multibot init`` makes of a folder of them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yaml

from multibot_rewrite.cli.multibot import main

PACKAGE = "<package><name>{}</name></package>"


def robot(name: str, *joints: str, more: str = "") -> str:
    """Return a base with a wheel for each joint."""
    parts = "".join(
        f'<link name="{it}_wheel"/><joint name="{it}" type="continuous"><parent link="{name}_base"/>'
        f'<child link="{it}_wheel"/><axis xyz="0 1 0"/></joint>'
        for it in joints
    )
    return f'<robot name="{name}"><link name="{name}_base"/>{parts}{more}</robot>'


def init(folder: Path, *words: str) -> int:
    return main(["init", str(folder), *words, "-n", "2", "--yes", "-o", str(folder / "fleet.yaml")])


def taken(folder: Path, *words: str) -> Any:
    assert init(folder, *words) == 0
    return yaml.safe_load((folder / "fleet.yaml").read_text())


UP = """import os
from launch import LaunchDescription
from launch.substitutions import Command
from launch_ros.actions import Node
HERE = os.path.dirname(__file__)
def given(name):
    path = os.path.join(HERE, name)
    if name.endswith("sdf"):
        return Node(package="ros_gz_sim", executable="create", arguments=["-file", path])
    text = Command(["xacro ", path]) if name.endswith("xacro") else open(path).read()
    program = "robot_state_publisher"
    return Node(package=program, executable=program, parameters=[{"robot_description": text}])
def generate_launch_description():
    drivers = [Node(package="own", executable=f"driver{at}") for at in range(DRIVERS)]
    return LaunchDescription([*map(given, FILES), *drivers])
"""


def loads(*files: str, drivers: int = 0) -> str:
    """Return a launch file that gives these descriptions to publishers and spawners; without
    drivers it shows them."""
    return UP.replace("FILES", repr(files)).replace("DRIVERS", str(drivers))
