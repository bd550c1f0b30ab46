# SPDX-License-Identifier: Apache-2.0
"""The container has what the README's fleet starts, and its files are what Docker and editors read.

It cannot be built here: ``.github/workflows/container.yml`` builds it and runs the fleet.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import page_commands
import pytest
import yaml
from paths import ROOT

try:
    import tomllib
except ModuleNotFoundError:
    import tomli as tomllib

FOLDER = ROOT / ".devcontainer"
DOCKERFILE = (FOLDER / "Dockerfile").read_text()
SCRIPT = FOLDER / "try_fleet.sh"
SETTINGS = tomllib.loads((ROOT / "pyproject.toml").read_text())
INSTALLED = re.findall(r"^ +([a-z0-9-]+) \\$", DOCKERFILE, re.MULTILINE)
# Of the image: ros_base of REP 2001 has them.
OF_THE_IMAGE = {"robot_state_publisher", "tf2_ros"}
# Programs -> the apt package that has them; those of the image and of coreutils need none.
PROGRAMS = {
    "xvfb-run": "xvfb",
    **dict.fromkeys(("ros2", "python3", "timeout", "mktemp", "head"), ""),
}
IN_FRONT = r"(?:^|&&|\|\|?|\$\(|\btimeout \d+|\bxvfb-run -a|\btrap ') *"
OF_BASH = {"set", "cd", "kill", "wait", "trap", "echo", "at", "tail", "true"}


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


@pytest.mark.parametrize(
    ("program", "file"), [("hadolint", FOLDER / "Dockerfile"), ("shellcheck", SCRIPT)]
)
@pytest.mark.more
def test_a_linter_finds_nothing(program: str, file: Path) -> None:
    path = Path(sys.executable).with_name(program)
    if not path.exists():
        pytest.skip(f"no {program}: pip install '.[test]'")
    done = subprocess.run([path, file], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (0, "")


def test_every_program_of_the_script_is_in_the_image() -> None:
    text = SCRIPT.read_text()
    used = set(re.findall(IN_FRONT + r"(?=([a-z][\w-]*)\b(?!=))", text, re.MULTILINE)) - OF_BASH
    assert {"multibot", "ros2", "xvfb-run"} <= used
    ours = set(SETTINGS["project"]["scripts"])
    assert used - ours <= set(PROGRAMS)
    assert {PROGRAMS[it] for it in used - ours} - {""} <= set(INSTALLED)


def test_what_is_copied_and_installed_is_there() -> None:
    copied = re.findall(r"^COPY (?:--\S+ )*(\S+) ", DOCKERFILE, re.MULTILINE)
    assert copied and all((ROOT / it).exists() for it in copied)
    settings = (FOLDER / "devcontainer.json").read_text()
    extras = re.findall(r"-e '\.\[([\w,]+)\]'", DOCKERFILE + settings)
    known = set(SETTINGS["project"]["optional-dependencies"])
    assert len(extras) == 2 and {it for one in extras for it in one.split(",")} <= known
    # A clone that is copied into the image brings nothing that was made in it.
    left_out = (ROOT / ".dockerignore").read_text().split()
    assert {".git", ".venv", "build", "dist"} <= set(left_out)


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
