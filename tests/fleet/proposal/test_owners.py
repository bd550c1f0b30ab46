# SPDX-License-Identifier: Apache-2.0
"""Which names are a robot's, and how well a file goes with it; by hand."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from given_parameters import run_given

from multibot_rewrite.fleet.proposal import owners
from multibot_rewrite.fleet.proposal.looking import Looked
from multibot_rewrite.fleet.proposal.owners import Fitting
from multibot_rewrite.knowledge.records import Param
from multibot_rewrite.system.records import NOWHERE


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
    assert owners._is_strange(topic, said) is strange


def fit(names: str) -> Fitting:
    return Fitting("p.yaml", frozenset({"amcl"}), frozenset(names))


def test_a_file_with_clearly_more_strange_names_is_no_rival() -> None:
    assert owners._is_rival(fit("abcd"), fit("ab"))
    assert not owners._is_rival(fit("abcde"), fit("ab"))


@pytest.mark.parametrize(("names", "shown"), [("ba", "a, b"), ("cab", "a, b ..."), ("a", "a")])
def test_of_many_strange_names_two_are_shown(names: str, shown: str) -> None:
    assert owners._shown(names) == shown


KNOWN = (
    Param("scan_topic", "topic"), Param("layer.scan.topic", "topic"), Param("map_topic", "topic"),
    Param("base", "frame"), Param("tool", "link"), Param("joints", "joint"), Param("rate", ""),
    Param("own", "frame", own=True), Param("space", "namespace"),
)  # fmt: skip
VALUES = {
    "scan_topic": "/a/scan", "layer.scan.topic": "/b/scan", "map_topic": "/c/map", "base": "base_link",
    "tool": "$(var tool)", "joints": ["j1", "j2", 3], "rate": "5", "own": "x", "space": "y",
    "nobody": "z",
}  # fmt: skip


def test_the_names_of_a_robot_in_known_parameters() -> None:
    """Frames, links and joints, and the topics of sensors; what a launch file fills in is none."""
    given = {name: SimpleNamespace(value=it) for name, it in VALUES.items()}
    known = SimpleNamespace(nodes={"amcl": SimpleNamespace(params={it.path: it for it in KNOWN})})
    nodes = [run_given("", it, "", given, NOWHERE) for it in ("amcl", "nobody")]  # type: ignore[arg-type]
    found = list(owners._named(nodes, known))  # type: ignore[arg-type]
    assert found == [
        ("topic", "/a/scan"), ("topic", "/b/scan"), ("frame", "base_link"), ("joint", "j1"),
        ("joint", "j2"),
    ]  # fmt: skip
