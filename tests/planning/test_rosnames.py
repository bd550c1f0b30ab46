# SPDX-License-Identifier: Apache-2.0
"""ROS 2 names and remap rules: what is refused, what is proposed, where the parts stand."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import pytest
from hypothesis import given, strategies as st

from multibot_rewrite import UsageError
from multibot_rewrite.base.rosnames import (
    NameFault,
    RemapRule,
    bind,
    check_full_name,
    check_namespace,
    check_node_name,
    check_robot_name,
    check_topic_name,
    expand,
    parse_remap,
    propose_token,
    read_remap,
    remapped_node,
    resolve_bound,
    split_remap,
)


def resolve_name(
    name: str, kind: str, node: str, namespace: str, rules: Iterable[RemapRule]
) -> str:
    return resolve_bound(name, kind, bind(node, namespace, rules))


def refusal(name: str) -> str:
    with pytest.raises(UsageError) as caught:
        check_robot_name(name)
    return str(caught.value)


@pytest.mark.parametrize(
    ("name", "reason", "proposal"),
    [
        pytest.param("robot-1", "character 6, '-',", "robot_1", id="dash"),
        pytest.param("1st", "starts with the digit '1'", "robot_1st", id="digit"),
        pytest.param("", "it is empty", "robot1", id="empty"),
        pytest.param("a__b", "two underscores in a row", "a_b", id="doubled-underscore"),
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


@pytest.mark.slow
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
        pytest.param("n:__name:=m", RemapRule("n", "__name", "m", 2, 10, ""), id="name"),
        pytest.param("__ns:=/x/", RemapRule("", "__ns", "/x/", 0, 6, ""), id="namespace-slash"),
        pytest.param("rostopic://a:=b", RemapRule("", "a", "b", 11, 14, "rostopic://"), id="topic"),
        pytest.param(
            "rosservice:///a:=/b", RemapRule("", "/a", "/b", 13, 17, "rosservice://"), id="service"
        ),
        pytest.param(
            "n:rostopic://a:=b", RemapRule("n", "a", "b", 13, 16, "rostopic://"), id="node-topic"
        ),
        pytest.param(
            "rostopic:a:=b", RemapRule("rostopic", "a", "b", 9, 12, ""), id="node-called-rostopic"
        ),
        pytest.param("_a/b_:=~/c", RemapRule("", "_a/b_", "~/c", 0, 7, ""), id="underscores"),
    ],
)
def test_a_remap_rule_is_taken_apart(text: str, rule: RemapRule) -> None:
    assert parse_remap(text) == rule
    assert read_remap(text) == rule
    assert split_remap(text) == rule


@pytest.mark.parametrize(
    ("text", "place", "found"),
    [
        ("", 1, "the end"),
        ("a", 2, "the end"),
        ("a:=", 4, "the end"),
        (":=b", 1, "':='"),
        ("a b:=c", 2, "' '"),
        ("a:=b c", 5, "' '"),
        ("a:=b:=c", 5, "':='"),
        ("7a:=b", 1, "'7'"),
        ("*:=b", 1, "a wildcard"),
        ("a/**:=b", 2, "a slash"),
        ("a:=\\1", 4, "a back reference"),
        ("{ns}/a:=b", 1, "a substitution"),
        ("a:={node}", 4, "a substitution"),
        ("a:=rostopic://b", 4, "a scheme"),
        ("a:=scan__robot1", 8, "two underscores"),
        ("r__1:a:=b", 2, "two underscores"),
        ("__other:=b", 1, "two underscores"),
        ("~:=b", 1, "a '~'"),
        ("a/:=b", 2, "a slash"),
        ("a:=//b", 4, "a slash"),
        ("__ns:=r", 7, "'r'"),
        ("__ns:=/r//s", 10, "a slash"),
        ("__node:=/n", 9, "a slash"),
        ("n:m:a:=b", 4, "':'"),
        ("a:=é", 4, "'é'"),
    ],
)
def test_a_rule_that_rcl_refuses_says_where_and_what(text: str, place: int, found: str) -> None:
    assert parse_remap(text) is None
    fault = read_remap(text)
    assert isinstance(fault, NameFault)
    assert fault.at == place - 1
    assert fault.reason.startswith(f"character {place}: expected ")
    assert f", found {found}" in fault.reason


@pytest.mark.parametrize(
    "text",
    [
        "a:=b", "n:a:=b", "n:rosservice://~/a:=/b/c", "rostopic:///a:=rostopic://b", "__ns:=/x",
        "${robot}a:=$(arg b)/c",
    ],
)  # fmt: skip
def test_every_part_is_where_the_rule_puts_it(text: str) -> None:
    rule = split_remap(text)
    assert rule is not None
    for part, at in ((rule.node, 0), (rule.source, rule.source_at), (rule.target, rule.target_at)):
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
        ("{node}/scan", "/ns", "/ns/node/scan"),
        ("/{node}/scan", "/ns", "/node/scan"),
        ("{ns}/scan", "/ns", "/ns/scan"),
        ("{node}/scan", "ns", "/ns/node/scan"),
        ("{ns}/scan", "ns", "/ns/scan"),
        ("/all{namespace}/{node}", "/ns", "/all/ns/node"),
        ("{ns}/scan", "/", "//scan"),
        ("~/{other}", "/ns", "/ns/node/{other}"),
    ],
)
def test_a_name_is_expanded_as_rcl_does(name: str, namespace: str, full: str) -> None:
    assert expand(name, namespace, "node") == full


# What a name of each kind may not be: the name, the place of the fault, and why.
REFUSED: dict[Callable[[str], NameFault | None], list[tuple[str, int, str]]] = {
    check_topic_name: [
        ("", 1, "it is empty"),
        ("7a", 1, "is a digit, with which no part of a name starts"),
        ("a/7", 3, "is a digit, with which no part of a name starts"),
        ("a/", 2, "is a slash at the end"),
        ("/", 1, "is a slash at the end"),
        ("a-b", 2, "is not a letter, a digit, or one of _ / ~ { }"),
        ("a~", 2, "may only be the first character"),
        ("~a/b", 2, "follows '~'"),
        ("a/{b", 3, "is not closed"),
        ("a}", 2, "closes what was not opened"),
        ("{{a}}", 2, "does not belong in a {substitution}"),
        ("{a/b}", 3, "does not belong in a {substitution}"),
        ("{7}", 2, "is a digit, with which no substitution starts"),
    ],
    check_full_name: [
        ("", 1, "it is empty"),
        ("a", 1, "is not the slash"),
        ("/a/", 3, "is a slash at the end"),
        ("/a//b", 4, "is a slash right after a slash"),
        ("/a/7", 4, "is a digit"),
        ("/{node}", 2, "is not a letter, a digit, an underscore or a slash"),
    ],
    check_node_name: [
        ("", 1, "empty"),
        ("7", 1, "digit"),
        ("a/b", 2, "is not a letter"),
        ("é", 1, "is not"),
    ],
}


@pytest.mark.parametrize(
    ("check", "name", "place", "reason"),
    [(check, *row) for check, rows in REFUSED.items() for row in rows],
)
def test_what_a_name_may_not_be(
    check: Callable[[str], NameFault | None], name: str, place: int, reason: str
) -> None:
    fault = check(name)
    assert fault is not None
    assert fault.at == place - 1
    assert reason in fault.reason
    assert check is not check_full_name or fault == check_namespace(name)


@pytest.mark.parametrize(
    ("check", "longest"),
    [
        pytest.param(check_full_name, "/" + "a" * 246, id="topic"),
        pytest.param(check_namespace, "/" + "a" * 244, id="namespace"),
        pytest.param(check_node_name, "a" * 255, id="node"),
    ],
)
def test_lengths_have_a_limit(check: Callable[[str], NameFault | None], longest: str) -> None:
    limit = len(longest)
    reason = f"it has {limit + 1} characters, ROS 2 allows {limit}"
    assert check(longest) is None
    assert check(longest + "a") == NameFault(reason, limit - 1)


def rules(*texts: str) -> list[RemapRule]:
    found = [parse_remap(text) for text in texts]
    assert None not in found
    return [rule for rule in found if rule is not None]


@pytest.mark.parametrize(
    ("given", "placed"),
    [
        pytest.param([], ("n", "/r"), id="none"),
        pytest.param(["__node:=m"], ("m", "/r"), id="name"),
        pytest.param(["__ns:=/q"], ("n", "/q"), id="namespace"),
        pytest.param(["__name:=m", "__node:=k", "__ns:=/"], ("m", "/"), id="first-wins"),
        pytest.param(["k:__node:=m", "k:__ns:=/q"], ("n", "/r"), id="other-node"),
        pytest.param(["n:__node:=m", "n:__ns:=/q"], ("m", "/r"), id="old-name-has-no-namespace"),
        pytest.param(["n:__node:=m", "m:__ns:=/q"], ("m", "/q"), id="new-name-has-one"),
        pytest.param(["__node:=m", "m:__node:=k"], ("m", "/r"), id="no-chain"),
    ],
)
def test_a_node_is_moved_by_its_rules(given: list[str], placed: tuple[str, str]) -> None:
    assert remapped_node("n", "r", rules(*given)) == placed


@pytest.mark.parametrize(
    ("node", "namespace", "given", "message"),
    [
        ("n-1", "", [], "node name 'n-1': character 2, '-'"),
        ("n", "/r/", [], "namespace '/r/': character 3, '/', is a slash at the end"),
        ("n", "", ["__ns:=/q/"], "namespace '/q/': character 3"),
        ("n", "", ["__node:=" + "m" * 256], "it has 256 characters, ROS 2 allows 255"),
    ],
)
def test_a_node_that_cannot_start(
    node: str, namespace: str, given: list[str], message: str
) -> None:
    with pytest.raises(UsageError) as caught:
        remapped_node(node, namespace, rules(*given))
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("name", "given", "full"),
    [
        pytest.param("a", [], "/r/a", id="none"),
        pytest.param("a", ["a:=b"], "/r/b", id="relative"),
        pytest.param("a", ["/a:=b"], "/r/a", id="absolute-misses-relative"),
        pytest.param("/a", ["a:=b"], "/a", id="relative-misses-absolute"),
        pytest.param("a", ["/r/a:=b"], "/r/b", id="compared-in-full"),
        pytest.param("~/a", ["n/a:=/b"], "/b", id="private-by-its-full-name"),
        pytest.param("a", ["a:=~/b"], "/r/n/b", id="private-target"),
        pytest.param("a", ["a:=b", "a:=c"], "/r/b", id="first-wins"),
        pytest.param("a", ["a:=b", "b:=c"], "/r/b", id="no-chain"),
        pytest.param("a/b", ["a:=c"], "/r/a/b", id="whole-names-alone"),
        pytest.param("a", ["m:a:=b", "n:a:=c"], "/r/c", id="other-node"),
        pytest.param("a", ["__node:=m", "n:a:=b", "m:a:=c"], "/r/c", id="prefix-is-the-new-name"),
        pytest.param("~/a", ["__node:=m", "__ns:=/q", "~/a:=b"], "/q/b", id="after-the-node"),
        pytest.param("{node}/a", ["n/a:=b"], "/r/b", id="substitution"),
    ],
)
def test_a_name_leads_where_rcl_leads_it(name: str, given: list[str], full: str) -> None:
    for kind in ("topic", "service"):
        assert resolve_name(name, kind, "n", "/r", rules(*given)) == full
        assert resolve_bound(name, kind, bind("n", "/r", rules(*given))) == full


def test_a_scheme_keeps_a_rule_to_its_kind() -> None:
    bound = bind("n", "", rules("rostopic://a:=t", "rosservice://a:=s", "a:=both"))
    assert resolve_bound("a", "topic", bound) == "/t"
    assert resolve_bound("a", "service", bound) == "/s"


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("a b", "topic name 'a b': character 2, ' '"),
        ("a//b", "topic name '/r/a//b': character 6, '/', is a slash right after a slash"),
        ("~/{other}", "topic name '~/{other}': {other} is not known"),
        ("a" * 245, "it has 248 characters, ROS 2 allows 247"),
        ("far", "it has 251 characters, ROS 2 allows 247"),
    ],
)
def test_a_name_that_leads_nowhere(name: str, message: str) -> None:
    with pytest.raises(UsageError) as caught:
        resolve_name(name, "topic", "n", "/r", rules("far:=/" + "a" * 250))
    assert message in str(caught.value)
