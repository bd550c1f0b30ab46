# SPDX-License-Identifier: Apache-2.0
"""Which of several descriptions is the robot: what speaks for one, and who may be meant as well."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from lxml import etree

from multibot_rewrite.proposal.choosing import (
    chosen,
)
from multibot_rewrite.proposal.looking import Looked
from multibot_rewrite.proposal.searching import Found

LINK, JOINT = '<link name="{}"/>', '<joint name="{}" type="{}"/>'
Made = Callable[..., Looked]


def text(links: str, moving: str = "", name: str = "r", tag: str = "robot") -> str:
    joints = "".join(JOINT.format(it, "continuous") for it in moving)
    return f'<{tag} name="{name}">{"".join(map(LINK.format, links))}{joints}</{tag}>'


@pytest.fixture
def made(tmp_path: Path) -> Made:
    """Return a description in a file: its links and moving joints are letters."""

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


def rivals(*robots: Looked, found: Found | None = None) -> tuple[list[str], list[str]]:
    made = chosen(robots, found or Found(every=tuple(it.path for it in robots)))
    return tuple([Path(it.robot.path).stem for it in them] for them in (made.rivals, made.alike))  # type: ignore[return-value]


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
