# SPDX-License-Identifier: Apache-2.0
"""Which of several descriptions is the robot: what speaks for one, and who may be meant as well."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from lxml import etree
from small_robots import loads

from multibot_rewrite.fleet.proposal.choosing import (
    chosen,
    launched_descriptions,
    processes_with,
)
from multibot_rewrite.fleet.proposal.looking import Looked
from multibot_rewrite.fleet.proposal.searching import Found
from multibot_rewrite.producers.launch.records import LaunchOrder

LINK, JOINT = '<link name="{}"/>', '<joint name="{}" type="{}"/>'
Made = Callable[..., Looked]


def text(links: str, moving: str = "", name: str = "r", tag: str = "robot") -> str:
    joints = "".join(JOINT.format(it, "continuous") for it in moving)
    return f'<{tag} name="{name}">{"".join(map(LINK.format, links))}{joints}</{tag}>'


@pytest.fixture
def made(tmp_path: Path) -> Made:
    """A description in a file: its links and moving joints are letters."""

    def looked(
        path: str, links: str = "ab", moving: str = "j", name: str = "", **more: object
    ) -> Looked:
        file = tmp_path / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text(links, moving, name or path))
        root = etree.fromstring(file.read_bytes())
        found = Looked(str(file), name or path, "robot", len(links), root=root)
        return found._replace(**more)  # type: ignore[arg-type]

    return looked


def put(folder: Path, name: str, data: str) -> str:
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(data)
    return str(path)


def order(*robots: Looked, found: Found | None = None) -> str:
    """The names of the files without their ends, the likeliest first."""
    every = Found(every=tuple(it.path for it in robots))
    made = chosen(robots, found or every)
    return " ".join(Path(it.robot.path).stem for it in made.order)


@pytest.mark.parametrize(
    "word",
    ["gripper", "hand", "finger", "camera", "sensor", "lidar", "tool", "effector", "mount", "wheel",
     "dock", "geometry"],
)  # fmt: skip
def test_what_is_called_like_a_part_is_behind(word: str, made: Made) -> None:
    assert order(made(f"my_{word}.urdf"), made("zzzzzzzzzzzzzzzzzzzzz.urdf")).startswith("zzz")


def test_a_robot_has_links_and_moves(made: Made) -> None:
    assert order(made("a.urdf", "a"), made("b.urdf", "ab")) == "b a"
    assert order(made("a.urdf", moving=""), made("b.urdf")) == "b a"
    # The number of links counts more than the name, the name more than what moves.
    assert order(made("hand.urdf", "ab"), made("a.urdf", "a")) == "hand a"
    assert order(made("hand.urdf"), made("a.urdf", moving="")) == "a hand"


def test_of_two_alike_the_simulated_one_with_control_and_a_short_path_is_first(made: Made) -> None:
    assert order(made("a.urdf"), made("b.urdf", simulator="gz")) == "b a"
    assert order(made("a.urdf"), made("b.urdf", control=True)) == "b a"
    assert order(made("aa.urdf"), made("b.urdf")) == "b aa"
    assert order(made("b.urdf"), made("a.urdf")) == "a b"


def test_what_is_launched_is_first_by_how_much_is_started(made: Made, tmp_path: Path) -> None:
    one, two, three = made("a.urdf"), made("bb.urdf"), made("ccc.urdf")
    launch = (
        put(tmp_path, "x.launch.py", loads("bb.urdf", drivers=1)),
        put(tmp_path, "y.launch.py", loads("ccc.urdf", drivers=2)),
        put(tmp_path, "test.launch.py", loads("a.urdf", drivers=3)),
        put(tmp_path, "read.launch.py", "open('a.urdf').read()"),
    )
    found = Found(every=(one.path, two.path, three.path), launch=launch)
    assert order(one, two, three, found=found) == "ccc bb a"
    assert [processes_with(it.path, found) for it in (one, two, three)] == [0, 2, 3]
    assert launched_descriptions(found) == [two.path, three.path]
    # One that was named counts whatever it is called and starts.
    named = found._replace(named=(LaunchOrder(launch[2]),))
    assert launched_descriptions(named) == [one.path]


def test_of_files_of_one_name_that_which_is_read_is_launched(tmp_path: Path) -> None:
    paths = tuple(put(tmp_path, f"{name}/r.urdf", text("a")) for name in ("one", "two"))
    launch = put(tmp_path, "x.launch.py", loads("two/r.urdf"))
    found = Found(every=paths, launch=(launch,))
    assert [processes_with(it, found) for it in paths] == [0, 1]


def rivals(*robots: Looked, found: Found | None = None) -> tuple[list[str], list[str]]:
    made = chosen(robots, found or Found(every=tuple(it.path for it in robots)))
    return tuple([Path(it.robot.path).stem for it in them] for them in (made.rivals, made.alike))  # type: ignore[return-value]


def test_who_may_be_meant_as_well(made: Made, tmp_path: Path) -> None:
    first, other = made("a.urdf", "abc", "jk"), made("bb.urdf", "xyz", "lm")
    assert rivals(first, other) == (["bb"], [])
    # Another kind, and a part of the first one's joints, are not.
    assert rivals(first, made("bb.urdf", "xyz", "")) == ([], [])
    assert rivals(first, made("bb.urdf", "xyz", "j")) == ([], [])
    launch = put(tmp_path, "x.launch.py", loads("a.urdf"))
    paths = (first.path, other.path)
    assert rivals(first, other, found=Found(every=paths, launch=(launch,))) == ([], [])


def test_files_of_one_robot_are_alike(made: Made) -> None:
    first = made("rover.urdf", "abc", "jk")
    assert rivals(first, made("rover.urdf.xacro", "abc", "jk")) == ([], ["rover.urdf"])
    assert rivals(first, made("another.urdf", "abc", "jk", name="rover.urdf")) == ([], ["another"])
    # Some of its links are enough in a file of another name, and in a folder a variant is none.
    assert rivals(first, made("rover.sdf", "abcd", "jk")) == ([], ["rover"])
    assert rivals(first, made("sub/rover.urdf", "abcd", "jl"))[1] == []
    copy = made("copied.urdf", "abc", "jk", name="rover.urdf")
    Path(copy.path).write_bytes(Path(first.path).read_bytes())
    assert rivals(first, copy) == ([], ["copied"])
