# SPDX-License-Identifier: Apache-2.0
"""Which of the files beside a description are taken, and what is said of those that are not."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.proposal.looking import NO_SIMULATOR, Looked
from multibot_rewrite.proposal.related_files import related_files_of
from multibot_rewrite.proposal.searching import Found


def params(folder: Path, name: str, *nodes: str) -> str:
    sections = (f"{it}:\n  ros__parameters: {{rate: 1.0}}\n" for it in nodes)
    (folder / name).write_text("".join(sections))
    return str(folder / name)


def looked(folder: Path, simulator: str = NO_SIMULATOR, control: bool = False) -> Looked:
    return Looked(str(folder / "r.urdf"), "r", "robot", 2, simulator, control)


def test_of_two_files_for_one_node_the_first_is_taken(tmp_path: Path) -> None:
    """The node that is named is the first by its name, whichever stands first in the files."""
    taken = params(tmp_path, "a.yaml", "zeta", "omega", "alpha", "mid")
    left = params(tmp_path, "b.yaml", "mid", "other", "omega", "alpha", "zeta")
    alone = params(tmp_path, "c.yaml", "other")
    made = related_files_of(looked(tmp_path), Found(params=(alone, left, taken)), "jazzy")
    assert made.files["params"] == (taken, alone)
    assert made.left == {left: "a.yaml has parameters of alpha, too"}


EKF = ("ekf_filter_node_odom", "ekf_filter_node_map", "navsat_transform")


@pytest.mark.parametrize(
    ("nodes", "node_sets"),
    [
        ("amcl controller_server", ["nav2: amcl and controller_server"]),
        ("/a/amcl /a/controller_server", ["nav2: amcl and controller_server"]),
        ("amcl controller_server slam_toolbox", ["nav2: amcl and controller_server"]),
        ("slam_toolbox controller_server", ["nav2_slam: slam_toolbox and controller_server"]),
        ("controller_server", ["navigation: controller_server"]),
        ("amcl", ["localization: amcl"]), ("slam_toolbox", ["slam_toolbox: slam_toolbox"]),
        ("amcl slam_toolbox", ["localization: amcl", "slam_toolbox: slam_toolbox"]),
        ("ekf_node", ["robot_localization: ekf_node"]),
        ("ekf_filter_node", ["robot_localization: ekf_filter_node"]),
        ("ekf_node ekf_filter_node", ["robot_localization: ekf_node"]),
        (" ".join(EKF), [f"robot_localization_gps: {' and '.join(EKF)}"]),
        (f"ekf_filter_node {EKF[0]}", []),
        ("teleop_twist_joy_node", ["teleop: teleop_twist_joy_node"]),
        ("driver", []),
    ],
)  # fmt: skip
def test_sections_say_the_node_sets(nodes: str, node_sets: list[str], tmp_path: Path) -> None:
    file = params(tmp_path, "p.yaml", *nodes.split())
    made = related_files_of(looked(tmp_path), Found(params=(file,)), "jazzy")
    # Besides those that the description itself says.
    bare = related_files_of(looked(tmp_path), Found(), "jazzy").node_sets
    said = {it: f"p.yaml has parameters of {by}" for it, by in (it.split(": ") for it in node_sets)}
    assert {it: why for it, why in made.node_sets.items() if it not in bare} == said


@pytest.mark.parametrize(
    ("package", "node", "why"),
    [
        # Beside the code of the node: an example.
        ("nav2_collision_monitor", "collision_monitor", "it is an example of"),
        ("own", "collision_monitor", ""),
        # Where a launch file starts the robot, that says which files its nodes read.
        ("own", "mapper", "it is for mapper, which no launch file of the robot starts"),
        ("own", "/**", "it is for any node, which no launch file of the robot starts"),
        # With the description's own package nothing is asked.
        (".", "mapper", ""),
    ],
)
def test_files_of_nodes_that_are_not_started(
    package: str, node: str, why: str, tmp_path: Path
) -> None:
    for at in (tmp_path, tmp_path / "own", tmp_path / "nav2_collision_monitor"):
        at.mkdir(exist_ok=True)
        (at / "package.xml").write_text(f"<package><name>{at.name}</name></package>")
    file = params(tmp_path / package, "p.yaml", node)
    made = related_files_of(looked(tmp_path), Found(params=(file,)), "jazzy")
    assert bool(made.files.get("params")) == (not why)
    assert made.left.get(file, "").startswith(why)


EXPLORE = "/**:\n  ros__parameters: {costmap_topic: map}\n"
PACKAGE = "<package><name>{}</name><export><build_type>ament_cmake</build_type></export></package>"
ROBOT = (
    '<robot name="{0}"><link name="{0}_a"/><link name="{0}_b"/><joint name="{0}_j" type="continuous">'
    '<parent link="{0}_a"/><child link="{0}_b"/></joint></robot>'
)
NODE = """\
import os
from launch import LaunchDescription
from launch_ros.actions import Node
from ament_index_python.packages import get_package_share_directory
def generate_launch_description():
    file = os.path.join(get_package_share_directory("{0}"), "config", "{1}")
    return LaunchDescription([Node(package="{0}", executable="{2}", parameters=[file])])
"""


def workspace(folder: Path, files: dict[str, str]) -> Path:
    """Return a folder of packages, each file in one of them."""
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        (folder / name.split("/")[0] / "package.xml").write_text(PACKAGE.format(name.split("/")[0]))
    return folder


def test_a_file_for_any_node_that_a_vendor_gives_to_its_own_is_not_the_robots(
    tmp_path: Path,
) -> None:
    """With it every node of the robot would have the parameters of one."""
    files = {
        "rover_description/urdf/rover.urdf": ROBOT.format("rover"),
        "explore_lite/config/params.yaml": EXPLORE,
        "explore_lite/launch/explore.launch.py": NODE.format(
            "explore_lite", "params.yaml", "explore"
        ),
    }
    assert "explore_lite/config" not in written(workspace(tmp_path, files))


@pytest.mark.parametrize("names", ["gripper", "ranger"])
def test_what_another_robot_is_made_with_is_behind_it(names: str, tmp_path: Path) -> None:
    """Both are launched and called after their packages; one package depends on the other."""
    part = f"{names}_description"
    files = {
        f"{part}/urdf/{names}.urdf": ROBOT.format(names),
        f"{part}/launch/view.launch.py": f"{names}.urdf",
        "zz_robot_description/urdf/zz_robot.urdf": ROBOT.format("zz"),
        "zz_robot_description/launch/view.launch.py": "zz_robot.urdf",
    }
    workspace(tmp_path, files)
    manifest = tmp_path / "zz_robot_description" / "package.xml"
    manifest.write_text(
        manifest.read_text().replace("<export>", f"<exec_depend>{part}</exec_depend><export>")
    )
    assert "description: zz_robot_description/urdf/zz_robot.urdf" in written(tmp_path)


def written(folder: Path) -> str:
    """Return the fleet file that init writes for a folder."""
    file = folder / "fleet.yaml"
    assert main(["init", str(folder), "-n", "2", "--yes", "--force", "-o", str(file), "-q"]) == 0
    lines = file.read_text().splitlines()
    return "\n".join(it for it in lines if not it.startswith("#"))
