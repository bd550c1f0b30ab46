# SPDX-License-Identifier: Apache-2.0
"""Which file keeps a proposed fleet from building, and what of a launch file is shown; by hand."""

from __future__ import annotations

import os

import pytest

from multibot_rewrite.fleet.proposal import launches, trying
from multibot_rewrite.fleet.proposal.companions import Companions
from multibot_rewrite.fleet.proposal.looking import Looked
from multibot_rewrite.fleet.proposal.propose import Member, Proposal

BESIDE = Companions({"params": ("w/p.yaml", "w/q.yaml"), "rviz": ("v.rviz",)}, "w/r.srdf", {}, {})
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
    assert list(trying._blamed(MADE, [(file, line)])) == ([blamed] if blamed else [])


@pytest.mark.parametrize(
    ("topic", "moved"),
    [
        ("/tf", False), ("tf_static", False), ("/a/robot_description", False), ("/odom", True),
        ("tf/x", True),
    ],
)  # fmt: skip
def test_rules_that_a_build_writes_anyway_are_not_told(topic: str, moved: bool) -> None:
    assert launches._is_moved(topic, "other") is moved
