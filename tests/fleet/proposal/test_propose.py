# SPDX-License-Identifier: Apache-2.0
"""What a proposal takes from descriptions: layout, simulator, world, names and places; by hand."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest
from lxml import etree

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.proposal import launches, propose, seeing, trying
from multibot_rewrite.proposal.looking import Looked
from multibot_rewrite.proposal.propose import Member, Proposal
from multibot_rewrite.proposal.related_files import RelatedFiles
from multibot_rewrite.proposal.searching import search
from multibot_rewrite.proposal.seeing import Wanted

OF_NAV2 = ("nav2", "nav2_slam", "navigation", "localization", "slam_toolbox")


def member(
    *node_sets: str, radius: float = 0.5, names: tuple[str, ...] = (), **looked: Any
) -> Member:
    beside = RelatedFiles({}, "", dict.fromkeys(node_sets, ""), {})
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


def test_a_real_robot_that_stands_on_the_world_has_one_of_its_own() -> None:
    fixed = standing_on("world")
    found = propose.worlds_of([member(), fixed], True)
    assert {key: it.value for key, it in found.items()} == {"shared_frames": ["map"]}
    assert propose.worlds_of([member(simulator="gz"), fixed], False) == {}
    assert (
        propose.worlds_of([standing_on("map")], True) == propose.worlds_of([member()], True) == {}
    )


def wanted(**more: Any) -> Wanted:
    return Wanted((), 2, {}, "jazzy", more.pop("named", False), **more)


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


# Which file keeps a proposed fleet from building, and what of a launch file is shown; by hand.

BESIDE = RelatedFiles({"params": ("w/p.yaml", "w/q.yaml"), "rviz": ("v.rviz",)}, "w/r.srdf", {}, {})
MADE = Proposal({}, [Member(Looked("w/r.urdf"), BESIDE, ("robot1",), 0.5)], {})


@pytest.mark.parametrize(
    ("file", "line", "blamed"),
    [
        (os.path.abspath("w/p.yaml"), "MB1 said: x", ("w/p.yaml", "MB1 said: x")),
        (os.path.abspath("w/r.srdf"), "MB2 said", ("w/r.srdf", "MB2 said")),
        ("", "w/q.yaml:3:1: wrong: x", ("w/q.yaml", "wrong: x")),
        ("", "v.rviz: wrong", ("v.rviz", "wrong")),
        ("", "w/r.urdf:1: wrong", None), (os.path.abspath("p.yaml"), "MB1 said", None),
    ],
)  # fmt: skip
def test_the_file_that_has_an_error(file: str, line: str, blamed: tuple[str, str] | None) -> None:
    """A description is the robot itself."""
    assert list(trying._faulty_files(MADE, [(file, line)])) == ([blamed] if blamed else [])


@pytest.mark.parametrize(
    ("topic", "moved"),
    [
        ("/tf", False), ("tf_static", False), ("/a/robot_description", False), ("/odom", True),
        ("tf/x", True),
    ],
)  # fmt: skip
def test_rules_that_a_build_writes_anyway_are_not_told(topic: str, moved: bool) -> None:
    assert launches._is_moved(topic, "other") is moved
