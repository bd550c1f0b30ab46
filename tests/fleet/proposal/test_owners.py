# SPDX-License-Identifier: Apache-2.0
"""Which names are a robot's, and how well a file goes with it; by hand."""

from __future__ import annotations

import pytest

from multibot_rewrite.fleet.proposal import owners
from multibot_rewrite.fleet.proposal.looking import Looked
from multibot_rewrite.fleet.proposal.owners import Fitting


@pytest.mark.parametrize(
    ("given", "names", "plain"),
    [
        ("{robot}_", {"robot1_base", "robot1/x", "y", "robot1_"}, {"base", "x", "y", "robot1_"}),
        ("{robot}", {"robot1_base", "robot1base"}, {"base", "robot1base"}),
        ("tool_", {"tool_base", "robot1_base"}, {"tool_base", "robot1_base"}),
    ],
)  # fmt: skip
def test_names_are_known_without_what_arguments_put_in_front(
    given: str, names: set[str], plain: set[str]
) -> None:
    robot = Looked("a.urdf.xacro", arguments=(("prefix", given),))
    assert owners._plain(robot, frozenset(names)) == plain


def fit(names: str) -> Fitting:
    return Fitting("p.yaml", frozenset({"amcl"}), frozenset(names))


def test_a_file_with_clearly_more_strange_names_is_no_rival() -> None:
    assert owners._is_rival(fit("abcd"), fit("ab"))
    assert not owners._is_rival(fit("abcde"), fit("ab"))


@pytest.mark.parametrize(("names", "shown"), [("ba", "a, b"), ("cab", "a, b ..."), ("a", "a")])
def test_of_many_strange_names_two_are_shown(names: str, shown: str) -> None:
    assert owners._shown(names) == shown
