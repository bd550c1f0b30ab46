# SPDX-License-Identifier: Apache-2.0
"""What holds for any robot at all, tried on random ones with nasty names and odd spelling."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from itertools import permutations

import pytest
from expected_names import (
    ROBOT,
    Names,
    Options,
    Slot,
    bare,
    changed_slots,
    graph_problems,
    is_insertion,
    new_names,
    slots,
    spelled,
)
from hypothesis import assume, given, settings, strategies as st
from lxml import etree
from random_robots import LAYOUTS, PARAMETERS, SEPARATORS, Robot, random_robots, robot_names

from multibot_rewrite import Rewrite, RewriteRefused, UsageError, rewrite, rewrite_all, strip
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.base.rosnames import check_robot_name, propose_token
from multibot_rewrite.description import pipeline
from multibot_rewrite.description.rewriters.tree import builtin_tree

pytestmark = pytest.mark.slow

PLAIN = b'<robot name="r"><link name="base"/></robot>'
RENAMED_ATTRIBUTES = {"name", "link", "joint", "reference"}

options = st.fixed_dictionaries(
    {},
    optional={
        "layout": st.sampled_from(LAYOUTS),
        "affix": st.sampled_from(("postfix", "prefix")),
        "topics": st.sampled_from(("postfix", "prefix", "namespace")),
        "separators": st.fixed_dictionaries(
            {},
            optional={kind: st.sampled_from(marks.split()) for kind, marks in SEPARATORS.items()},
        ),
        "shared_frames": st.sampled_from(((), ("world",), ("odom", "base_link", "x"))),
    },
)


def attempt(robot: Robot, words: Options, name: str = ROBOT) -> Rewrite | None:
    """Return the rewrite, or None where it was refused for a reason that is true.

    Random names carry the robot's name as often as not: they are to be rewritten all the same.
    """
    try:
        return rewrite(robot.text, name, again=True, **words)
    except RewriteRefused as error:
        codes = {finding.code for finding in error.findings if finding.level == "error"}
        assert codes <= true_reasons(robot, words, name), str(error)
        return None


def true_reasons(robot: Robot, words: Options, name: str) -> set[str]:
    """Return the codes with which this robot may be refused."""
    root = etree.fromstring(robot.text)
    table = new_names(root, words, name)
    reasons = {"MB104"} if robot.style.escapes or b"&" in robot.text else set()
    if any(len(set(kind.values())) < len(kind) for kind in table) or dangling_meets(root, table):
        reasons.add("MB420")
    return reasons


def dangling_meets(root: etree._Element, table: Names) -> bool:
    """Would something that is named but not declared be declared after the rewrite?"""
    come = {new for kind in table for new in kind.values() if new not in kind}
    return any(slot.value in come for slot in slots(root))


@given(random_robots(), options, robot_names)
@settings(max_examples=25)
def test_the_laws_of_a_rewrite(robot: Robot, words: Options, name: str) -> None:
    """The same robot under new names, and back; what is told of is changed, and names alone."""
    result = attempt(robot, words, name)
    if result:
        assert graph_problems(robot.text, result.data, words, name) == []
        assert strip(result.data, name, **words) == robot.text  # type: ignore[arg-type]
        found = changed_slots(robot.text, result.data, name)
        assert_told(result, found)
        assert_names_alone(found, name)


def assert_told(result: Rewrite, found: list[tuple[Slot, str]]) -> None:
    """Assert that the reported changes are the difference."""
    listed = [c for c in result.changes if c.rule != "inserted"]
    wanted = Counter((" ".join(c.old.split()), " ".join(c.new.split())) for c in listed)
    assert Counter((old.value, new) for old, new in found) == wanted


def assert_names_alone(found: list[tuple[Slot, str]], name: str) -> None:
    for (tag, attribute, old), new in found:
        assert is_insertion(old, new, name)
        assert attribute in RENAMED_ATTRIBUTES if attribute else tag in PARAMETERS
        assert tag != "note"


@given(random_robots(), options, st.lists(robot_names, min_size=2, max_size=2, unique=True))
@settings(max_examples=25)
def test_two_robots_share_no_renamed_name(robot: Robot, words: Options, two: list[str]) -> None:
    try:
        results = list(rewrite_all(robot.text, two, again=True, **words))  # type: ignore[arg-type]
    except RewriteRefused:
        return
    for kind in ("link", "joint"):
        first, second = (renamed(robot.text, result, kind) for result in results)
        assert not first & second


def renamed(source: bytes, result: Rewrite, kind: str) -> set[str]:
    """Return the names of one kind that are the robot's own."""
    before = [item.get("name", "") for item in etree.fromstring(source).iterchildren(kind)]
    after = [item.get("name", "") for item in bare(result.data, result.robot).iterchildren(kind)]
    return {new for old, new in zip(before, after, strict=True) if old != new}


@given(random_robots(), options, st.lists(robot_names, min_size=1, max_size=4, unique=True))
@settings(max_examples=25)
def test_many_at_once_are_each_alone(robot: Robot, words: Options, fleet: list[str]) -> None:
    try:
        together = list(rewrite_all(robot.text, fleet, again=True, **words))  # type: ignore[arg-type]
    except RewriteRefused:
        return
    alone = [rewrite(robot.text, name, again=True, **words) for name in fleet]
    assert [r.data for r in together] == [r.data for r in alone]
    assert [r.changes for r in together] == [r.changes for r in alone]
    assert [r.robot for r in together] == fleet


# Robots that are called like frames and topics, shared ones too, and like words of plugin definitions.
odd_names = st.sampled_from(
    (
        "world",
        "map",
        "odom",
        "tf",
        "clock",
        "x",
        "arm",
        "robot1",
        "demo",
        "scan",
        "base_link",
        "drive",
    )
)


def verdict(robot: Robot, fleet: Sequence[str], words: Options) -> object:
    """Return what a call comes to, wherever in it each robot is: their texts, or what is wrong."""
    try:
        return {it.robot: it.data for it in rewrite_all(robot.text, fleet, **words)}  # type: ignore[arg-type]
    except RewriteRefused as error:
        return {(it.code, it.level, it.message, it.line) for it in error.findings}


@given(
    random_robots(),
    options,
    st.lists(odd_names, min_size=2, max_size=3, unique=True),
    st.booleans(),
)
@settings(max_examples=25)
def test_a_robots_place_in_the_call_does_not_matter(
    robot: Robot, words: Options, fleet: list[str], again: bool
) -> None:
    asked = {**words, "again": again}
    found = [verdict(robot, order, asked) for order in permutations(fleet)]
    assert all(it == found[0] for it in found)


@given(random_robots())
@settings(max_examples=25)
def test_a_policy_that_renames_nothing_changes_no_byte(robot: Robot) -> None:
    nothing = make_naming()._replace(separators={})
    # Their frames are below the name of the model where the file leaves them out.
    assume(b"gz-sim-diff-drive" not in robot.text)
    template = pipeline.prepare(robot.text, "robot", nothing, builtin_tree((), NEWEST_LTS))
    assert list(pipeline.render(template, [ROBOT, "r2"], again=True)) == [robot.text] * 2


@given(random_robots(extras=False))
@settings(max_examples=25)
def test_bare_frames_leave_a_plain_description_alone(robot: Robot) -> None:
    assert rewrite(robot.text, ROBOT, layout="L1", again=True).data == robot.text


@given(random_robots(), options)
@settings(max_examples=25)
def test_a_second_rewrite_needs_again(robot: Robot, words: Options) -> None:
    result = attempt(robot, words)
    assume(result is not None and any(True for _ in etree.fromstring(robot.text).iter("link")))
    assert result is not None
    if graph_changed(result):
        with pytest.raises(RewriteRefused, match="MB106"):
            rewrite(result.data, ROBOT, **words)


def graph_changed(result: Rewrite) -> bool:
    """Was a link or a joint renamed?"""
    return any(change.kind in ("link", "joint") for change in result.changes)


@given(st.text(max_size=12) | st.text("ab_1- /", max_size=6) | st.just("a" * 246))
@settings(max_examples=25)
def test_any_text_is_a_robot_name_or_leads_to_one(text: str) -> None:
    valid = re.fullmatch("[A-Za-z_][A-Za-z0-9_]*", text) is not None and len(text) <= 245
    if valid and "__" not in text:
        assert check_robot_name(text) == text
        assert f"base/{text}" in rewrite(PLAIN, text).text
        return
    with pytest.raises(UsageError) as caught:
        rewrite(PLAIN, text)
    proposal = str(caught.value).rpartition("use for example ")[2].strip("'")
    assert check_robot_name(proposal) == proposal == propose_token(text)


@given(st.text(max_size=8), st.sampled_from(("layout", "affix", "topics")))
@settings(max_examples=25)
def test_an_unknown_word_is_a_usage_error(word: str, option: str) -> None:
    known = {*LAYOUTS, "postfix", "prefix", "namespace", ""}
    assume(word not in known)
    with pytest.raises(UsageError, match=option):
        rewrite(PLAIN, ROBOT, **{option: word})


def test_the_oracle_spells_by_hand() -> None:
    assert spelled("/x", "/", {"affix": "prefix"}, "r") == "/r/x"
    assert spelled("x", "_", {}, "r") == "x_r"
    assert spelled("x", "_", {"layout": "L1"}, "r") == "x"
    assert is_insertion("a b", "a/robot1 b")
    assert not is_insertion("a b", "a/robot1 c")
    assert not is_insertion("a", "a")


def test_most_random_robots_are_rewritten() -> None:
    taken: list[bool] = []

    @given(random_robots(), options)
    @settings(max_examples=25)
    def count(robot: Robot, words: Options) -> None:
        taken.append(attempt(robot, words) is not None)

    count()
    assert sum(taken) > 0.7 * len(taken)


@pytest.mark.deep
@given(random_robots(), options, robot_names)
@settings(max_examples=1_000)
def test_a_thousand_robots(robot: Robot, words: Options, name: str) -> None:
    result = attempt(robot, words, name)
    if result:
        assert graph_problems(robot.text, result.data, words, name) == []
        assert strip(result.data, name, **words) == robot.text  # type: ignore[arg-type]
