# SPDX-License-Identifier: Apache-2.0
"""Which names are a robot's, and how well a file goes with it; by hand."""

from __future__ import annotations

import pytest

from multibot_rewrite.fleet.proposal import fitting, owners
from multibot_rewrite.fleet.proposal.fitting import Fitting
from multibot_rewrite.fleet.proposal.looking import Looked


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


@pytest.mark.parametrize(
    ("name", "specific"), [("camera", False), ("base_link", True), ("joint1", True), ("a-b", False)]
)
def test_a_plain_word_is_no_name_of_one_robot(name: str, specific: bool) -> None:
    assert owners._is_specific(name) is specific


@pytest.mark.parametrize(
    ("topic", "said", "strange"),
    [
        ("/scan", "", False), ("scan", "", False), ("/front/scan", "", True),
        ("front/scan", "<topic>/front/scan</topic>", False), ("/front/scan/", "front/scan", False),
    ],
)  # fmt: skip
def test_a_sensors_topic_of_several_words_stands_somewhere(
    topic: str, said: str, strange: bool
) -> None:
    assert fitting._is_strange(topic, said) is strange


def fit(names: str, given: bool = False) -> Fitting:
    return Fitting("p.yaml", frozenset({"amcl"}), frozenset(names), given)


def test_a_file_with_clearly_more_strange_names_is_no_rival() -> None:
    assert fitting._is_rival(fit("abcd"), fit("ab"))
    assert not fitting._is_rival(fit("abcde"), fit("ab"))
    assert not fitting._is_rival(fit("ab", given=True), fit("ab"))
    order = [fit("ab", given=True), fit(""), fit("a"), fit("", given=True)]
    assert [order.index(it) for it in sorted(order, key=lambda it: it.rank)] == [3, 1, 0, 2]


@pytest.mark.parametrize(("names", "shown"), [("ba", "a, b"), ("cab", "a, b ..."), ("a", "a")])
def test_of_many_strange_names_two_are_shown(names: str, shown: str) -> None:
    assert fitting._shown(names) == shown
