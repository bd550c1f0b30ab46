# SPDX-License-Identifier: Apache-2.0
"""Which release a description is for: what it loads, the CI and the package of its repository."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.description.sources.release_said import (
    release_of_launch,
    release_said,
)

PLAIN = b'<robot name="r"><link name="a"/></robot>'
CLASSIC = (
    b'<robot name="r"><gazebo><plugin name="p" filename="libgazebo_ros_p3d.so"/></gazebo></robot>'
)


def repository(folder: Path, workflow: str = "", package: str = "") -> str:
    (folder / ".git").mkdir()
    if workflow:
        (folder / ".github" / "workflows").mkdir(parents=True)
        (folder / ".github" / "workflows" / "ci.yml").write_text(workflow)
    (folder / "my_robot" / "urdf").mkdir(parents=True)
    (folder / "my_robot" / "package.xml").write_text(f"<package>{package}</package>")
    file = folder / "my_robot" / "urdf" / "r.urdf"
    file.write_bytes(PLAIN)
    return str(file)


@pytest.mark.parametrize(
    ("workflow", "package", "release", "why"),
    [
        ("env:\n  ROS_DISTRO: jazzy\n", "", "jazzy", ".github/workflows/ci.yml names it"),
        ("image: ros:humble-ros-base", "", "humble", ".github/workflows/ci.yml names it"),
        # One that has ended stands for the next.
        ("ros_distro: iron", "", "jazzy", ".github/workflows/ci.yml names it"),
        # Several say nothing.
        ("ros_distro: [humble, jazzy]", "", NEWEST_LTS, ""),
        ("ros_distro: humble\nros_distro: jazzy", "", NEWEST_LTS, ""),
        ("run: echo humble", "", NEWEST_LTS, ""),
        (
            "",
            "<exec_depend>gazebo_ros</exec_depend>",
            "humble",
            "package.xml depends on gazebo_ros",
        ),
        ("", "<depend>gazebo_ros</depend><depend>ros_gz_sim</depend>", NEWEST_LTS, ""),
        ("", "<depend>rclcpp</depend>", NEWEST_LTS, ""),
    ],
)
def test_a_repository_says_its_release(
    workflow: str, package: str, release: str, why: str, tmp_path: Path
) -> None:
    found = release_said("", PLAIN, repository(tmp_path, workflow, package))
    assert found.release == release
    assert found.why.endswith(why) and bool(found.why) == bool(why)


@pytest.mark.parametrize(
    ("manifest", "told", "release"),
    [
        ('{"format": "multibot build 1", "distro": "kilted"}', "", "kilted"),
        ('{"format": "multibot build 1", "distro": "kilted"}', "jazzy", "jazzy"),
        # Files of others, and what a person made of ours.
        ('{"format": "nothing of ours", "distro": "kilted"}', "", "humble"),
        ('{"format": "multibot build 1", "distro": ["kilted"]}', "", "humble"),
        ('{"format": "multibot build 1"}', "", "humble"),
        ("[1]", "", "humble"),
        ("{", "", "humble"),
    ],
)
def test_a_built_folder_says_its_release(
    manifest: str, told: str, release: str, tmp_path: Path
) -> None:
    (tmp_path / "robot1").mkdir()
    (tmp_path / "manifest.json").write_text(manifest)
    for file in ("fleet.launch.py", "robot1/r.urdf"):
        assert release_said(told, CLASSIC, str(tmp_path / file)).release == release


@pytest.mark.parametrize(
    ("packages", "texts", "said"),
    [
        (["rviz2", "gazebo_ros"], [], ("humble", "it starts gazebo_ros")),
        (["ros_gz_sim"], [CLASSIC.decode()], ("humble", "it loads libgazebo_ros_p3d.so")),
        (["ros_gz_sim", "my_gazebo_ros"], [PLAIN.decode()], (NEWEST_LTS, "")),
        ([], [], (NEWEST_LTS, "")),
    ],
)
def test_a_launch_file_says_its_release(
    packages: list[str], texts: list[str], said: tuple[str, str], tmp_path: Path
) -> None:
    file = str(tmp_path / "two.launch.py")
    assert release_of_launch("", packages, texts, file) == said
    assert release_of_launch("jazzy", packages, texts, file) == ("jazzy", "")
