"""ROS 2 names and remap rules: what is refused, what is proposed, where the parts stand."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from multibot_rewrite import UsageError
from multibot_rewrite.rosnames import (
    MAX_TOKEN,
    RemapRule,
    check_robot_name,
    expand,
    parse_remap,
    propose_token,
    split_remap,
)


def refusal(name: str) -> str:
    with pytest.raises(UsageError) as caught:
        check_robot_name(name)
    return str(caught.value)


@pytest.mark.parametrize("name", ["robot1", "r", "_r", "R2_d2", "a__b", "r" * MAX_TOKEN])
def test_a_token_is_taken_as_it_is(name: str) -> None:
    assert check_robot_name(name) == name


@pytest.mark.parametrize(
    ("name", "reason", "proposal"),
    [
        pytest.param("robot-1", "character 6, '-',", "robot_1", id="dash"),
        pytest.param("1st", "starts with the digit '1'", "robot_1st", id="digit"),
        pytest.param("", "it is empty", "robot1", id="empty"),
        pytest.param("a/b", "character 2, '/',", "a_b", id="slash"),
        pytest.param("/a", "character 1, '/',", "a", id="leading-slash"),
        pytest.param("a::b", "character 2, ':',", "a_b", id="scope"),
        pytest.param("my robot", "character 3, ' ',", "my_robot", id="space"),
        pytest.param("robot1\n", "character 7, '\\n',", "robot1", id="newline"),
        pytest.param("zoë", "character 3, 'ë',", "zo", id="accent"),
        pytest.param("机器人", "character 1, '机',", "robot1", id="han"),
        pytest.param("r٣", "character 2, '٣',", "r", id="other-digit"),
        pytest.param("r" * 300, "300 characters, ROS 2 allows 245", "r" * 245, id="long"),
    ],
)
def test_a_refusal_says_what_is_wrong_and_what_would_do(
    name: str, reason: str, proposal: str
) -> None:
    message = refusal(name)
    assert message.startswith(f"robot name {name!r}: ")
    assert reason in message
    assert message.endswith(f"use for example {proposal!r}")
    assert "\n" not in message


@given(st.text(max_size=8) | st.text("1_", min_size=240, max_size=260))
def test_a_proposal_is_always_valid(name: str) -> None:
    proposal = propose_token(name)
    assert check_robot_name(proposal) == proposal


@pytest.mark.parametrize(
    ("text", "rule"),
    [
        pytest.param("a:=b", RemapRule("", "a", "b", 0, 3, ""), id="plain"),
        pytest.param("/x/a:=/b", RemapRule("", "/x/a", "/b", 0, 6, ""), id="absolute"),
        pytest.param("~/a:=b", RemapRule("", "~/a", "b", 0, 5, ""), id="private"),
        pytest.param("n:a:=b", RemapRule("n", "a", "b", 2, 5, ""), id="node"),
        pytest.param("n:/a:=/b", RemapRule("n", "/a", "/b", 2, 6, ""), id="node-absolute"),
        pytest.param("__ns:=/x", RemapRule("", "__ns", "/x", 0, 6, ""), id="namespace"),
        pytest.param("n:__node:=m", RemapRule("n", "__node", "m", 2, 10, ""), id="node-name"),
        pytest.param("rostopic://a:=b", RemapRule("", "a", "b", 11, 14, "rostopic://"), id="topic"),
        pytest.param(
            "rosservice:///a:=/b",
            RemapRule("", "/a", "/b", 13, 17, "rosservice://"),
            id="service",
        ),
        pytest.param(
            "n:rostopic://a:=b", RemapRule("n", "a", "b", 13, 16, "rostopic://"), id="node-topic"
        ),
    ],
)
def test_a_remap_rule_is_taken_apart(text: str, rule: RemapRule) -> None:
    assert parse_remap(text) == rule


@pytest.mark.parametrize(
    "text",
    [
        "", "a", ":=", "a:=", ":=b", " :=b", "a:= ", "a=b", "a:b", "a: =b", ":a:=b", "a:=b:=c",
        "rostopic://:=b", "a:=rostopic://", "n::=b",
    ],
)  # fmt: skip
def test_anything_else_is_no_rule(text: str) -> None:
    assert parse_remap(text) is None


@pytest.mark.parametrize(
    "text",
    [
        "a:=b", "n:a:=b", "n:rosservice://~/a:=/b/c", "rostopic:///a:=rostopic://b", "__ns:=/x",
        "${robot}a:=$(arg b)/c",
    ],
)  # fmt: skip
def test_every_part_stands_where_the_rule_says(text: str) -> None:
    rule = split_remap(text)
    assert rule is not None
    for part, at in (
        (rule.node, 0),
        (rule.source, rule.source_at),
        (rule.target, rule.target_at),
    ):
        assert text.startswith(part, at)
    assert text.endswith(rule.target)


@pytest.mark.parametrize(
    ("name", "namespace", "full"),
    [
        ("scan", "", "/scan"),
        ("scan", "/", "/scan"),
        ("scan", "ns", "/ns/scan"),
        ("scan", "/ns", "/ns/scan"),
        ("scan", "/a/b/", "/a/b/scan"),
        ("x/scan", "/ns", "/ns/x/scan"),
        ("/scan", "/ns", "/scan"),
        ("~/scan", "/ns", "/ns/node/scan"),
        ("~/scan", "", "/node/scan"),
        ("~", "/ns", "/ns/node"),
    ],
)
def test_a_name_is_expanded_as_rcl_does(name: str, namespace: str, full: str) -> None:
    assert expand(name, namespace, "node") == full
