# SPDX-License-Identifier: Apache-2.0
"""What a proposal takes from descriptions: layout, simulator, world, names and places; by hand."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from lxml import etree

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.fleet.proposal import propose, seeing
from multibot_rewrite.fleet.proposal.companions import Companions
from multibot_rewrite.fleet.proposal.looking import Looked
from multibot_rewrite.fleet.proposal.propose import Member
from multibot_rewrite.fleet.proposal.searching import search
from multibot_rewrite.fleet.proposal.seeing import Wanted

OF_NAV2 = ("nav2", "nav2_slam", "navigation", "localization", "slam_toolbox")


def member(*stacks: str, radius: float = 0.5, names: tuple[str, ...] = (), **looked: Any) -> Member:
    beside = Companions({}, "", dict.fromkeys(stacks, ""), {})
    return Member(Looked("/p/a.urdf", **looked), beside, names, radius)


def standing_on(link: str, **looked: Any) -> Member:
    root = etree.fromstring(f'<robot name="a"><link name="base"/><link name="{link}"/></robot>')
    return member(names=("a",), root=root, **looked)


@pytest.mark.parametrize(
    ("members", "layout", "why"),
    [
        ([member()], "frames-per-robot", "shows them all"),
        ([member("moveit", "nav2")], "frames-per-robot", "arms"),
        ([member("nav2", arguments=(("prefix", "{robot}_"),))], "frames-per-robot", "arms"),
        ([member("moveit"), member(own_tf=True)], "tf-per-robot", "plugins"),
        *(([member(it)], "tf-per-robot", "Nav2") for it in OF_NAV2),
        ([member("teleop"), member("nav2")], "tf-per-robot", "Nav2"),
        ([member("teleop")], "frames-per-robot", "shows them all"),
    ],
)
def test_the_layout_is_that_of_the_files(members: list[Member], layout: str, why: str) -> None:
    found = propose.layout_of(members)
    assert found.value == layout and why in found.why
    affix = propose.affix_of(layout)
    assert (affix and affix.value) == (None if layout == "tf-per-robot" else "prefix")


@pytest.mark.parametrize(
    ("kinds", "simulator", "why"),
    [
        ("", "none", "the description has nothing for a simulator"),
        ("gz", "gazebo", "plugins and sensors for gz-sim; write none for real robots"),
        ("classic", "gazebo", "plugins and sensors for Gazebo Classic; write none for real robots"),
        (
            "gz classic", "gazebo",
            "plugins and sensors for Gazebo Classic and gz-sim; write none for real robots",
        ),
    ],
)  # fmt: skip
def test_robots_are_simulated_where_a_description_has_something_for_it(
    kinds: str, simulator: str, why: str
) -> None:
    members = [member(), *(member(simulator=it) for it in kinds.split())]
    assert propose.simulator_of(members) == (simulator, why)


def test_a_real_robot_that_stands_on_the_world_has_one_of_its_own() -> None:
    fixed = standing_on("world")
    found = propose.worlds_of([member(), fixed], True)
    assert {key: it.value for key, it in found.items()} == {"shared_frames": ["map"]}
    assert propose.worlds_of([member(simulator="gz"), fixed], False) == {}
    assert (
        propose.worlds_of([standing_on("map")], True) == propose.worlds_of([member()], True) == {}
    )


@pytest.mark.parametrize(("apart", "places"), [(0.0, (0, 1.5, 3.5)), (2.0, (0, 2, 4))])
def test_robots_stand_in_a_row_as_they_are_wide(apart: float, places: tuple[float, ...]) -> None:
    """Half a metre between their outlines, in steps of half a metre."""
    members = [member(names=("a", "b"), radius=0.3), member(names=("c",), radius=1.2)]
    found = propose.poses_of(members, apart)
    assert found == {name: {"x": 0, "y": y} for name, y in zip("abc", places, strict=True)}


def test_a_real_robot_whose_description_has_its_place_gets_none() -> None:
    assert propose.poses_of([standing_on("map"), member(names=("b",))], 0) == {
        "b": {"x": 0, "y": 0}
    }
    for it in (standing_on("world"), standing_on("map", simulator="gz")):
        assert propose.poses_of([it], 0) == {"a": {"x": 0, "y": 0}}


def test_robots_are_numbered_and_several_descriptions_have_their_own_words() -> None:
    assert propose.names_of(["rover"], 2) == [("robot1", "robot2")]
    assert propose.names_of(["Rover-X", "arm"], 2) == [
        ("rover_x1", "rover_x2"), ("arm1", "arm2"),
    ]  # fmt: skip
    words = ["UR5e", "ur5e", "3d", "--", "cam2", "_x_"]
    assert propose.unlike(words) == ["ur5e", "ur5e_1_", "robot_3d", "robot", "cam", "x"]


@pytest.mark.parametrize(
    ("looked", "said"),
    [
        (Looked("a.urdf", fault="a.urdf:1: no XML", links=2), "a.urdf:1: no XML; more"),
        (Looked("a.urdf", links=2), "a.urdf: nothing in it moves or senses; give the file"),
        (Looked("a.urdf"), "a.urdf: it has no link; "),
    ],
)
def test_why_a_description_is_not_taken(looked: Looked, said: str) -> None:
    with pytest.raises(UsageError) as found:
        seeing._refuse([looked, Looked("b.urdf", fault="other")], "; more")
    assert str(found.value).startswith(said) and str(found.value).endswith("; more")
    seeing._refuse([], "; more")


def wanted(**more: Any) -> Wanted:
    return Wanted((), 2, {}, "jazzy", more.pop("named", False), **more)


@pytest.mark.parametrize(
    ("simulator", "has", "simulated"),
    [("", "gz", True), ("", "", False), ("none", "gz", False), ("gazebo", "", True)],
)
def test_what_is_asked_for_counts_more_than_what_is_there(
    simulator: str, has: str, simulated: bool
) -> None:
    looked = Looked("a.urdf", **({"simulator": has} if has else {}))
    assert seeing._is_simulated(looked, wanted(simulator=simulator)) is simulated


@pytest.mark.parametrize(
    ("looked", "said"),
    [
        # A URDF without links acts as far as anybody knows; one link of an SDF alone does not.
        (Looked("a.urdf", tag="robot"), "a.urdf: it has no link; "),
        (Looked("a.sdf", tag="sdf", links=1), "a.sdf: nothing in it moves or senses; "),
    ],
)
def test_a_robot_has_links_and_acts(looked: Looked, said: str) -> None:
    with pytest.raises(UsageError) as found:
        seeing._likeliest(wanted(), search([]), [looked])
    assert str(found.value).startswith(said)


@pytest.mark.parametrize(
    ("has", "asked", "package", "simulated"),
    [
        ("gz", "", "own", False),
        ("", "", "own", False),
        ("", "", "ros_gz_sim", True),
        ("gz", "gazebo", "own", True),
        ("", "none", "ros_gz_sim", False),
    ],
)
def test_a_launch_file_that_starts_a_simulator_is_for_simulated_robots(
    has: str, asked: str, package: str, simulated: bool, tmp_path: Path, monkeypatch: Any
) -> None:
    launch = tmp_path / "sim.launch.py"
    publisher = "Node(package='robot_state_publisher', executable='robot_state_publisher')"
    nodes = f"{publisher}, Node(package='{package}', executable='driver')"
    launch.write_text(
        "from launch import LaunchDescription; from launch_ros.actions import Node\n"
        f"def generate_launch_description(): return LaunchDescription([{nodes}])\n"
    )
    told = []
    monkeypatch.setattr(seeing, "in_its_world", lambda it, is_so, _: told.append(bool(is_so)) or it)
    looked = Looked(str(tmp_path / "a.urdf"), **({"simulator": has} if has else {}))
    found = search([])._replace(launch=(str(launch),))
    (made,) = seeing.with_arguments([looked], wanted(simulator=asked), found)
    assert made._replace(bringup=None) == looked
    assert told == [simulated]


def test_the_release_is_asked_for_or_that_of_the_simulator() -> None:
    """The last one with packages of Gazebo Classic is Humble (rosdistro)."""
    classic, nothing = [Looked("", simulator="gz"), Looked("", simulator="classic")], search([])
    assert propose.release_of(classic, nothing, wanted(named=True)).value == "jazzy"
    assert propose.release_of(classic, nothing, wanted()).value == "humble"
    assert propose.release_of(classic[:1], nothing, wanted()).value == "jazzy"
