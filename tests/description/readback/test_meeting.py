# SPDX-License-Identifier: Apache-2.0
"""Names that two robots have: which count, which may be shared."""

from __future__ import annotations

import pytest
from description_calls import RuntimeName, advice, make_naming, meetings, said, same_for_all

LAYOUTS = ("tf-per-robot", "frames-per-robot", "both", "postfix")


def having(*names: tuple[str, str]) -> list[RuntimeName]:
    return [RuntimeName(*it, "plugin", 0, "x") for it in names]


# Does the name meet, in the order of LAYOUTS?
@pytest.mark.parametrize(
    ("kind", "name", "meets"),
    [
        ("topic", "/scan", (1, 1, 1, 1)),
        ("service", "/reset", (1, 1, 1, 1)),
        ("node", "/drive", (1, 1, 1, 1)),
        ("sensor", "imu", (1, 1, 1, 1)),
        # One tf topic for all is what frames-per-robot is.
        ("topic", "/tf", (1, 0, 1, 1)),
        ("topic", "/tf_static", (1, 0, 1, 1)),
        # Bare frames on a tf topic of their own do not meet.
        ("frame", "odom", (0, 1, 1, 1)),
        ("frame", "world", (0, 0, 0, 0)),
        ("frame", "map", (0, 0, 0, 0)),
        ("topic", "/clock", (0, 0, 0, 0)),
        # The simulator makes this one from the model's name.
        ("topic", "/__default_topic__", (0, 0, 0, 0)),
        ("frame", "__odom__", (0, 1, 1, 1)),
        # A node may be called like a shared topic or frame.
        ("node", "/clock", (1, 1, 1, 1)),
    ],
)
def test_what_meets(kind: str, name: str, meets: tuple[int, ...]) -> None:
    one = having((kind, name))
    for layout, wanted in zip(LAYOUTS, meets, strict=True):
        naming = make_naming(layout)
        assert len(list(same_for_all(one, "robot1", naming))) == wanted, layout
        assert len(list(meetings({"a": one, "b": one}, naming))) == wanted, layout


def test_a_name_with_the_robot_is_its_own() -> None:
    both = having(("topic", "/robot1/scan"), ("topic", "/scan"), ("topic", "/scan"))
    found = same_for_all(both, "robot1", make_naming())
    assert [it.name for it in found] == ["/scan"]


def test_three_robots_meet_once_each_name() -> None:
    readings = {
        "a": having(("topic", "/x"), ("topic", "/y"), ("topic", "/x")),
        "b": having(("topic", "/z")),
        "c": having(("topic", "/x"), ("topic", "/z"), ("service", "/y")),
    }
    found = [(it.robot, it.other, it.name.name) for it in meetings(readings, make_naming())]
    assert found == [("a", "c", "/x"), ("b", "c", "/z")]


def test_what_the_user_allows_is_shared() -> None:
    naming = make_naming("both", shared_topics=("/scan",), shared_frames=("site",))
    one = having(("topic", "/scan"), ("frame", "site"), ("frame", "/site"))
    assert not list(same_for_all(one, "robot1", naming))


# What is looked up in the whole world is found by its bare name, whoever has it; the rest is shared.
@pytest.mark.parametrize(
    ("kind", "looked_up"),
    [("sensor", True), ("link", True), ("topic", False), ("node", False), ("frame", False)],
)
def test_only_a_lookup_is_said_to_be_one(kind: str, looked_up: bool) -> None:
    (it,) = having((kind, "imu"))
    assert ("in the whole world" in said("all robots would", it)) == looked_up
    assert ("--layout both" in advice(it)) == looked_up
