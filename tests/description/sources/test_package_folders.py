# SPDX-License-Identifier: Apache-2.0
"""Where packages are looked for, and files in them, in a tree of folders made for it."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from paths import fixture_text

from multibot_rewrite.description.sources.packages import (
    find_in,
    in_sources,
    package_folder,
    packages_below,
)

# What ROS 2 packages say, and what catkin's do.
AMENT, CATKIN = "<depend>ament_cmake</depend>", "<buildtool_depend>catkin</buildtool_depend>"


@pytest.fixture
def tree(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a folder in which nothing is installed, and no package of this machine."""
    for name in ("ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH"):
        monkeypatch.delenv(name, raising=False)
    return tmp_path


def package(folder: Path, name: str = "", more: str = AMENT) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    named = f"<name> {name} </name>" if name else ""
    (folder / "package.xml").write_text(f"<package>{named}{more}</package>")
    return folder


def written(path: Path) -> str:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("")
    return str(path)


def test_packages_are_found_by_their_manifests_else_by_their_folders(tree: Path) -> None:
    one = package(tree / "a", "arm")
    twice = package(tree / "z" / "arm", "arm")
    bare = package(tree / "no_name")
    (tree / "hand").mkdir()
    found = packages_below((str(tree),))
    assert found["arm"] == (str(one), str(twice))
    assert (found["no_name"], found["hand"]) == ((str(bare),), (str(tree / "hand"),))
    # A folder of a name that a manifest has is none.
    (tree / "y" / "arm").mkdir(parents=True)
    assert packages_below((str(tree), str(tree / "none")))["arm"] == (str(one), str(twice))


def test_a_package_may_be_beside_that_of_the_file(tree: Path) -> None:
    home, hand = package(tree / "arm", "arm"), package(tree / "hand", "hand")
    (tree / "foot").mkdir()
    file = str(home / "urdf" / "a.urdf")
    assert package_folder("hand", file, ()) == str(hand)
    # A folder without a manifest is no package, and a repository ends at itself.
    assert package_folder("foot", file, ()) == ""
    alone = package(tree / "other" / "arm", "arm")
    package(tree / "other" / "hand", "hand")
    (alone / ".git").mkdir()
    assert package_folder("hand", str(alone / "a.urdf"), ()) == ""
    assert package_folder("hand", str(tree / "a.urdf"), ()) == ""


@pytest.mark.parametrize(
    ("path", "found"),
    [
        ("meshes/arm.stl", "Meshes/Arm.stl"),
        ("Meshes/ARM.STL", "Meshes/Arm.stl"),
        ("meshes/hand.stl", ""),
        ("sub/../Meshes/Arm.stl", "Meshes/Arm.stl"),
        ("sub/../../arm.stl", "../arm.stl"),
        ("both/a", "both/a"),
        ("both/A", "both/A"),
        ("Both/a", "both/a"),
    ],
)
def test_a_path_as_it_is_on_the_disk(tree: Path, path: str, found: str) -> None:
    for name in ("p/Meshes/Arm.stl", "arm.stl", "p/both/a", "p/both/A", "p/sub/x"):
        written(tree / name)
    assert find_in(str(tree / "p"), path) == found


CMAKE = fixture_text("package_folders_cmake.txt")


@pytest.mark.parametrize(
    ("path", "source"),
    [
        ("config/c.yaml", "bringup/conf/c.yaml"),
        # Two end so: the one that is installed.
        ("config/d.yaml", "a/config/d.yaml"),
        ("launch/a.launch.py", "bringup/launch/a.launch.py"),
        ("params/one.yaml", "one.yaml"),
        ("urdf/arm.xacro", "description/urdf/arm.xacro"),
        # Another package's share, and what is nowhere.
        ("maps/m.yaml", "other/maps/m.yaml"),
        ("maps/n.yaml", ""),
        ("config/none.yaml", ""),
        ("config", ""),
    ],
)
def test_what_a_cmake_file_installs_under_another_name(path: str, source: str, tree: Path) -> None:
    home = package(tree / "arm", "arm")
    (home / "CMakeLists.txt").write_text(CMAKE)
    for name in ("bringup/conf/c", "a/config/d", "b/config/d", "one", "other/maps/m"):
        written(home / f"{name}.yaml")
    for name in ("bringup/launch/a.launch.py", "description/urdf/arm.xacro"):
        written(home / name)
    found = in_sources(str(home / path))
    assert (os.path.relpath(found, home) if found else "") == source
