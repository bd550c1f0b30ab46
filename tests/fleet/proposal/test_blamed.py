# SPDX-License-Identifier: Apache-2.0
"""Which file keeps a proposed fleet from building, and what of a launch file is shown; by hand."""

from __future__ import annotations

import os
from typing import Any

import pytest

from multibot_rewrite.fleet.proposal import given_by_launch, trying
from multibot_rewrite.fleet.proposal.companions import Companions
from multibot_rewrite.fleet.proposal.given_by_launch import UNKNOWN, VALUES
from multibot_rewrite.fleet.proposal.looking import Looked
from multibot_rewrite.fleet.proposal.propose import Member, Proposal

BESIDE = Companions({"params": ("w/p.yaml", "w/q.yaml"), "rviz": ("v.rviz",)}, "w/r.srdf", {}, {})
MADE = Proposal({}, [Member(Looked("w/r.urdf"), BESIDE, ("robot1",), 0.5)], {})
IN_FLEET = os.path.join("some", "fleet.yaml", "values.yaml")


@pytest.mark.parametrize(
    ("file", "line", "blamed"),
    [
        (os.path.abspath("w/p.yaml"), "MB1 said: x", ("w/p.yaml", "MB1 said: x")),
        (os.path.abspath("w/r.srdf"), "MB2 said", ("w/r.srdf", "MB2 said")),
        ("", "w/q.yaml:3:1: wrong: x", ("w/q.yaml", "wrong: x")),
        ("", "v.rviz: wrong", ("v.rviz", "wrong")),
        ("", f"{IN_FLEET}:1: bad: y", (VALUES, "bad: y")),
        (os.path.abspath(IN_FLEET), "MB3 said", (VALUES, "MB3 said")),
        ("", "w/r.urdf:1: wrong", None), (os.path.abspath("p.yaml"), "MB1 said", None),
    ],
)  # fmt: skip
def test_the_file_that_has_an_error(file: str, line: str, blamed: tuple[str, str] | None) -> None:
    """A description is the robot itself."""
    assert list(trying._blamed(MADE, [(file, line)], "some/fleet.yaml")) == (
        [blamed] if blamed else []
    )


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        (True, "p: True"), (5, "p: 5"), (0.5, "p: 0.5"), ("a", "p: a"), ([1], "p"), (UNKNOWN, "p"),
        ("x" * 80, f"p: {'x' * 80}"), ("x" * 81, "p"),
    ],
)  # fmt: skip
def test_a_short_value_is_shown(value: Any, shown: str) -> None:
    assert given_by_launch._shown("p", value) == shown


@pytest.mark.parametrize(
    ("value", "data"),
    [
        (True, True), (5, 5), ("a", "a"), ([1, "a"], [1, "a"]), ([1, UNKNOWN], UNKNOWN),
        (UNKNOWN, UNKNOWN), (None, UNKNOWN), ({}, UNKNOWN), (__file__, UNKNOWN),
        ([__file__], UNKNOWN), ("/no/such/file", "/no/such/file"), ("tests", "tests"),
    ],
)  # fmt: skip
def test_a_path_is_no_value_of_a_fleet(value: Any, data: Any) -> None:
    """It would be another's where the fleet file is read."""
    assert given_by_launch._data(value) == data


@pytest.mark.parametrize(
    ("topic", "moved"),
    [
        ("/tf", False), ("tf_static", False), ("/a/robot_description", False), ("/odom", True),
        ("tf/x", True),
    ],
)  # fmt: skip
def test_rules_that_a_build_writes_anyway_are_not_told(topic: str, moved: bool) -> None:
    assert given_by_launch._is_moved(topic) is moved
    usual = {"use_sim_time", "autostart", "node_names", "frame_prefix"}
    assert usual == given_by_launch._USUAL
