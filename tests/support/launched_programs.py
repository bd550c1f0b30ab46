# SPDX-License-Identifier: Apache-2.0
"""Launch files in the real launch, with programs that write down what they are told."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

from paths import ROOT, SUPPORT, write_files

CHILD = SUPPORT / "launch_child.py"
EXAMPLE = ROOT / "examples" / "multibot_example"


def fake_packages(folder: Path, files: dict[str, str], programs: dict[str, str]) -> None:
    """Write an install folder of packages whose programs write down what they are told."""
    index = folder / "share" / "ament_index" / "resource_index" / "packages"
    index.mkdir(parents=True)
    write_files(folder, files)
    for package in {*programs.values(), *(path.split("/")[1] for path in files)}:
        (index / package).touch()
    for program, package in programs.items():
        path = folder / "lib" / package / program
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"#!{sys.executable}\n{PROGRAM}")
        path.chmod(0o755)


PROGRAM = """\
import json, os, sys
files = {word: open(word).read() for word in sys.argv if os.path.isfile(word)}
with open(os.path.join(os.environ["TOLD"], str(os.getpid())), "w") as out:
    json.dump({"words": sys.argv, "files": files}, out)
"""
EMPTY = "from launch import LaunchDescription\n\n\ndef generate_launch_description():\n"
EMPTY += "    return LaunchDescription([])\n"
PROGRAMS = {
    "robot_state_publisher": "robot_state_publisher",
    "create": "ros_gz_sim",
    "parameter_bridge": "ros_gz_bridge",
    "spawn_entity.py": "gazebo_ros",
    "static_transform_publisher": "tf2_ros",
    "rviz2": "rviz2",
}


def launched(
    file: Path,
    folder: Path,
    *arguments: str,
    programs: Mapping[str, str] = MappingProxyType({}),
    more: Mapping[str, str] = MappingProxyType({}),
    real: Mapping[str, Path] = MappingProxyType({}),
) -> tuple[list[dict[str, Any]], str]:
    """Return what the programs of a launch file were told, and what launch said; ``more`` are
    files of packages, by their paths below ``share``, ``real`` the texts of programs that do
    more."""
    share = {
        f"share/multibot_example/{path.relative_to(EXAMPLE)}": path.read_text()
        for path in EXAMPLE.glob("*/*.*")
    }
    included = ("ros_gz_sim/launch/gz_sim.launch.py", "gazebo_ros/launch/gazebo.launch.py")
    files = {**share, **{f"share/{it}": EMPTY for it in included}}
    files |= {f"share/{path}": text for path, text in more.items()}
    fake_packages(folder / "install", files, {**PROGRAMS, **programs})
    for name, source in real.items():
        (path,) = (folder / "install" / "lib").glob(f"*/{name}")
        path.write_text(f"#!{sys.executable}\n{source.read_text()}")
    (folder / "told").mkdir()
    (folder / "tmp").mkdir()
    env = {
        **os.environ,
        # Commands of the package are found where its Python is, in an environment that is not active.
        "PATH": os.pathsep.join([os.path.dirname(sys.executable), os.environ.get("PATH", "")]),
        "AMENT_PREFIX_PATH": os.pathsep.join(
            [str(folder / "install"), os.environ.get("AMENT_PREFIX_PATH", "")]
        ),
        "TOLD": str(folder / "told"),
        "TMPDIR": str(folder / "tmp"),
        "ROS_LOG_DIR": str(folder / "log"),
    }
    command = [sys.executable, str(CHILD), str(file), *arguments]
    done = subprocess.run(
        command, env=env, capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == 0, done.stderr + done.stdout
    told = [json.loads(it.read_text()) for it in (folder / "told").iterdir()]
    # Others leave their files: launch_ros its launch_params_, nav2_common those that it makes.
    assert [it.name for it in (folder / "tmp").iterdir() if it.name.startswith("multibot")] == []
    return told, done.stderr + done.stdout
