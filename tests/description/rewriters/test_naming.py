# SPDX-License-Identifier: Apache-2.0
"""Spelling: kinds, layouts, separators, shared names, and the way back."""

from __future__ import annotations

from itertools import product

import pytest
from hypothesis import assume, given, strategies as st

from multibot_rewrite import UsageError
from multibot_rewrite.base.naming import (
    FRAME_KINDS,
    LAYOUTS,
    NAMESPACE,
    POSTFIX,
    PREFIX,
    SEPARATORS,
    Layout,
    Naming,
    affix,
    make_naming,
    overlap,
    removal,
)

KINDS = tuple(SEPARATORS)
STRATEGIES = (None, POSTFIX, PREFIX, NAMESPACE)
ROBOT = "r1"
POLICIES = [
    pytest.param(layout.short, side, topics, id=f"{layout.short}-{side}-{topics}")
    for layout, side, topics in product(LAYOUTS, (POSTFIX, PREFIX), STRATEGIES)
    if side == PREFIX or not layout.at_run_time
]
TEXTS = (
    "a", "arm", "/a", "a/", "/", "", "r1", "/r1", "r1/", "r1/a", "a/r1", "a_r1", "r1_a", "r1/r1",
    "r1_r1", "/r1/a", "/a/r1", "world", "/world", "map", "tf", "/tf", "/clock", "~/a", "~", "{n}/a",
    "$(n)", "a b", "a::b", "ä", "__ns",
)  # fmt: skip


def spelled(naming: Naming, kind: str, text: str, namespaced: bool = False) -> str:
    """The name for the robot; unchanged where it stays."""
    there = affix(naming, kind, text, namespaced)
    return there.spell(text, ROBOT) if there else text


def takes(kind: str, mark: str) -> bool:
    """Is the separator allowed for the kind?"""
    try:
        make_naming(separators={kind: mark})
    except UsageError:
        return False
    return True


def assert_inverse(naming: Naming, kind: str, text: str, robot: str, namespaced: bool) -> None:
    there = affix(naming, kind, text, namespaced)
    if there is None:
        return
    new = there.spell(text, robot)
    span = removal(naming, robot, kind, new, namespaced)
    assert new != text
    assert span is not None, new
    assert new[: span[0]] + new[span[1] :] == text


@pytest.mark.parametrize(("layout", "side", "topics"), POLICIES)
def test_removal_undoes_affix_for_every_kind(layout: str, side: str, topics: str | None) -> None:
    naming = make_naming(layout, side, topics)
    for kind, text, namespaced in product(KINDS, TEXTS, (False, True)):
        assert_inverse(naming, kind, text, ROBOT, namespaced)


def test_a_stem_below_a_namespace_is_the_robots_already_unless_it_is_absolute() -> None:
    """gazebo_ros puts its namespace before /camera no more than rcl does."""
    naming = make_naming("both")
    for text, moved in (("/eye", True), ("/eye/left", True), ("eye", False), ("eye/", False)):
        assert (affix(naming, "stem", text, namespaced=True) is not None) is moved, text


@pytest.mark.slow
@given(
    st.sampled_from(LAYOUTS),
    st.sampled_from((POSTFIX, PREFIX)),
    st.sampled_from(STRATEGIES),
    st.sampled_from(
        [(kind, mark) for kind in KINDS for mark in ("/", "_", "__") if takes(kind, mark)]
    ),
    st.text("ab_/.-~ ", max_size=6),
    st.sampled_from(("a", "b", "_", "a_b", "ab", "a__b")),
    st.booleans(),
)
def test_removal_undoes_affix_for_any_text(
    layout: Layout, side: str, topics: str | None, marked: tuple[str, str], text: str, robot: str,
    namespaced: bool,
) -> None:  # fmt: skip
    kind, mark = marked
    assume(not layout.at_run_time or (side == PREFIX and (mark == "/" or kind not in FRAME_KINDS)))
    naming = make_naming(layout.name, side, topics, {kind: mark})
    assert_inverse(naming, kind, text, robot, namespaced)


@pytest.mark.sample(3)
@pytest.mark.parametrize("text", TEXTS)
@pytest.mark.parametrize("kind", KINDS)
def test_nothing_is_removed_that_was_not_put_there(kind: str, text: str) -> None:
    naming = make_naming()
    span = removal(naming, ROBOT, kind, text)
    if span is not None:
        assert spelled(naming, kind, text[: span[0]] + text[span[1] :]) == text


@pytest.mark.parametrize(
    ("kind", "mark"),
    [
        ("topic", "-"),
        ("topic", "."),
        ("service", "-"),
        ("subtopic", "."),
        ("stem", "-"),
        ("namespace", "-"),
        ("node", "-"),
        ("node", "/"),
    ],
)
def test_a_separator_ros_does_not_allow_is_refused(kind: str, mark: str) -> None:
    with pytest.raises(UsageError, match=f"separator {kind}="):
        make_naming(separators={kind: mark})


@pytest.mark.slow
@given(
    st.sampled_from((POSTFIX, PREFIX)),
    st.sets(st.text("b_", min_size=1, max_size=6), max_size=4),
    st.sampled_from(("_", "__", "/")),
)
def test_overlap_is_what_its_text_says(side: str, robots: set[str], mark: str) -> None:
    naming = make_naming("L4", side)._replace(separators=dict.fromkeys(KINDS, mark))
    expected = {
        (robot, other, mark)
        for robot, other in product(robots, robots)
        if (robot.endswith(mark + other) if side == POSTFIX else robot.startswith(other + mark))
    }
    assert set(overlap(naming, robots)) == expected
