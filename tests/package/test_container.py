"""The container has what the README's fleet starts, and its files are what Docker and editors read.

It cannot be built here: ``.github/workflows/container.yml`` builds it and runs the fleet.
"""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path

import page_commands
import pytest
import yaml
from paths import ROOT

FOLDER = ROOT / ".devcontainer"
DOCKERFILE = (FOLDER / "Dockerfile").read_text()
SCRIPT = FOLDER / "try_fleet.sh"
INSTALLED = re.findall(r"^ +([a-z0-9-]+) \\$", DOCKERFILE, re.MULTILINE)
# Of the image: ros_base of REP 2001 has them.
OF_THE_IMAGE = {"robot_state_publisher", "tf2_ros"}


@pytest.mark.more
def test_every_package_of_the_fleet_is_installed(tmp_path: Path) -> None:
    there = page_commands.reader(tmp_path, ROS_DISTRO="jazzy")
    for line in (
        "init examples/launch_tutorial/rover.urdf -n 2 -o rovers.yaml",
        "build rovers.yaml",
    ):
        done = there.run(f"multibot {line}")
        assert done.returncode == 0, done.stdout
    text = (tmp_path / "out" / "fleet.launch.py").read_text()
    assert "ROS 2 jazzy" in text
    used = set(re.findall(r"package='(\w+)'|FindPackageShare\('(\w+)'\)", text))
    names = {one or other for one, other in used} - OF_THE_IMAGE
    assert {"ros_gz_sim", "ros_gz_bridge", "rviz2"} <= names
    assert {f"ros-jazzy-{it.replace('_', '-')}" for it in names} <= set(INSTALLED)
    for argument in re.findall(
        r"(\w+):=", re.search(r"fleet.launch.py(.*)", SCRIPT.read_text())[1]
    ):  # type: ignore[index]
        assert f"'{argument}'" in text


def test_the_script_and_the_commands_of_the_readme_are_the_same() -> None:
    assert subprocess.run(["bash", "-n", SCRIPT], check=False).returncode == 0
    readme = (ROOT / "README.md").read_text()
    for line in re.findall(r"^multibot (?:build|check) .*$", SCRIPT.read_text(), re.MULTILINE):
        assert line in readme
    assert SCRIPT.stat().st_mode & 0o111


def test_the_editor_builds_that_file() -> None:
    settings = json.loads((FOLDER / "devcontainer.json").read_text())
    assert (FOLDER / settings["build"]["dockerfile"]).exists()
    assert (FOLDER / settings["build"]["context"]).resolve() == ROOT.resolve()
    user = re.search(r"^USER (\w+)$", DOCKERFILE, re.MULTILINE)
    assert user and settings["remoteUser"] == user[1]
    workflow = yaml.safe_load((ROOT / ".github" / "workflows" / "container.yml").read_text())
    runs = [it["run"] for it in workflow["jobs"]["fleet"]["steps"] if "run" in it]
    assert any(".devcontainer/Dockerfile" in it for it in runs)
    assert any(f"{FOLDER.name}/{SCRIPT.name}" in it for it in runs)
