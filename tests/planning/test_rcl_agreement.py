# SPDX-License-Identifier: Apache-2.0
"""The names module and the real rcl agree: on thousands of names, rules and nodes under rules."""

from __future__ import annotations

import importlib.util
import random
from collections.abc import Sequence
from typing import Any

import pytest
from rcl_names import INSTALL, ask

from multibot_rewrite import UsageError
from multibot_rewrite.base.rosnames import (
    NameFault,
    RemapRule,
    bind,
    check_full_name,
    check_namespace,
    check_node_name,
    check_topic_name,
    expand,
    parse_remap,
    remapped_node,
    resolve_bound,
)

pytestmark = [
    pytest.mark.live,
    pytest.mark.skipif(
        not importlib.util.find_spec("rclpy"),
        reason=f"names are not compared with the real rcl: no rclpy here, {INSTALL} (CPython < 3.13)",
    ),
]
CHECKS = {
    "topic": check_topic_name,
    "full": check_full_name,
    "namespace": check_namespace,
    "node": check_node_name,
}
# Words of rcl's reason -> words of ours; the first that fits.
REASONS = {
    "empty": "it is empty",
    "end with": "is a slash at the end",
    "must be absolute": "that a fully qualified name starts with",
    "repeated": "slash right after a slash",
    "substitution name must not contain": "does not belong in a {substitution}",
    "substitution name must not start": "with which no substitution starts",
    "unless it is the first": "may only be the first",
    "not followed by": "follows '~'",
    "unmatched": "close",
    "start with a number": "with which no part of a name starts",
    "starts with a number": "with which no part of a name starts",
    "must not contain characters": "is not a letter, a digit",
    "not exceed": "ROS 2 allows",
}
PIECES = (
    "a", "b", "Z9", "_", "__", "7", "/", "//", "~", "~/", "{", "}", "{node}", "{ns}", "{7x}",
    "{namespace}", "{other}", "{}", "-", ".", " ", "*", "\\1", ":", "é", "机", "x" * 120,
)  # fmt: skip
RULE_PIECES = (
    *PIECES, ":=", ":=", ":=", "=", "n:", "n:", "rostopic://", "rosservice://", "rostopic:",
    "rosservice", "ros", "r", "__ns", "__node", "__name", "__no", "/a", "/b", "_x", "**",
)  # fmt: skip
NODES = ("n", "n", "n", "m", "_n", "n__2", "rostopic", "7n", "", "n-1", "/n")
NAMESPACES = ("", "/", "/r", "/r", "/r/s", "r", "r/s", "/r__1", "/7", "/r/", "//r", "/r//s", "/é")
NAMES = (
    "a", "a", "/a", "b", "/b", "/r/a", "/r/b", "~/a", "~/b", "~", "~a", "/n/a", "/r/n/a", "{node}/a",
    "{ns}/a", "/{node}/a", "{namespace}/n/a", "~/{node}", "{other}", "{", "a//b", "a/", "7", "a/7",
    "", "r/a", "a__b", "a b", "/a" * 120, "b" * 240, "a/b", "rostopic", "__ns", "/", "é",
)  # fmt: skip
SIDES = (
    "a", "a", "b", "c", "/a", "/b", "/c", "~/a", "~/b", "/r/a", "/r/b", "/n/a", "/r/n/a", "a/b",
    "/r/s/a", "rostopic", "/m/a", "/x/y/z", "_a",
)  # fmt: skip
TARGETS = (*SIDES, "d/" * 100 + "d", "/d" * 124)
NAMESPACE_TARGETS = ("/r", "/q", "/q/s", "/", "/q/", "/q" * 123)


def jumbled(dice: random.Random, pieces: Sequence[str], most: int) -> str:
    return "".join(dice.choices(pieces, k=dice.randint(0, most)))


def share(answers: Sequence[object]) -> float:
    """How many are answers: sides that agree on refusals alone, or on none, say little."""
    return sum(answer is not None for answer in answers) / len(answers)


def differing(
    cases: Sequence[dict[str, Any]], ours: Sequence[object], theirs: Sequence[object]
) -> list[tuple[dict[str, Any], object, object]]:
    """Return the cases in which the module and rcl say different things."""
    rows = zip(cases, ours, theirs, strict=True)
    return [(case, mine, yours) for case, mine, yours in rows if mine != yours]


@pytest.mark.parametrize("what", CHECKS)
def test_the_same_names_are_refused_at_the_same_character(what: str) -> None:
    dice = random.Random(what)
    names = [jumbled(dice, PIECES, 6) for _ in range(400)]
    names += ["/" + jumbled(dice, PIECES[:8], 5) for _ in range(200)]
    names += [lead + "x" * size for size in range(243, 258) for lead in ("", "/", "/a/")]
    cases = [{"ask": "check", "what": what, "name": name} for name in names]
    theirs = ask(cases)
    assert 0.3 < share(theirs) < 0.97
    ours = [located(CHECKS[what](name), name) for name in names]
    assert differing(cases, ours, [yours and yours[1] for yours in theirs]) == []
    for name, told in zip(names, theirs, strict=True):
        fault = CHECKS[what](name)
        assert fault is None or ours_for(told[0]) in fault.reason, (name, told, fault)


def ours_for(reason: str) -> str:
    return next(ours for theirs, ours in REASONS.items() if theirs in reason)


def located(fault: NameFault | None, name: str) -> int | None:
    """Where the fault is, in bytes as rcl counts."""
    return None if fault is None else len(name[: fault.at].encode())


def test_names_are_expanded_alike() -> None:
    dice = random.Random("expand")
    cases = [
        {
            "ask": "expand",
            "name": dice.choice(NAMES) if dice.random() < 0.5 else jumbled(dice, PIECES, 4),
            "node": dice.choice(NODES),
            "namespace": dice.choice(NAMESPACES),
        }
        for _ in range(1500)
    ]
    theirs = ask(cases)
    assert 0.1 < share(theirs) < 0.9
    assert differing(cases, [expanded(**case) for case in cases], theirs) == []


def expanded(ask: str, name: str, node: str, namespace: str) -> str | None:
    faults = (check_topic_name(name), check_node_name(node), check_namespace(namespace))
    full = expand(name, namespace, node)
    # A brace that is left is a substitution nobody knows.
    return None if any(faults) or "{" in full else full


def test_the_same_rules_are_read() -> None:
    dice = random.Random("rules")
    rules = [jumbled(dice, RULE_PIECES, 7) for _ in range(1500)]
    rules += [dented(dice, drawn_rule(dice)) for _ in range(1500)]
    rules += [drawn_rule(dice) for _ in range(300)]
    cases = [{"ask": "parse", "rule": rule} for rule in rules]
    theirs = ask(cases)
    assert 0.1 < share(theirs) < 0.5
    ours = [None if parse_remap(rule) is None else True for rule in rules]
    assert differing(cases, ours, theirs) == []


def drawn_rule(dice: random.Random) -> str:
    """Return a rule that rcl takes, for one node or for all."""
    prefix = dice.choice(("", "", "", "n:", "n:", "m:", "rostopic:"))
    if dice.random() < 0.12:
        return f"{prefix}__ns:={dice.choice(NAMESPACE_TARGETS)}"
    if dice.random() < 0.12:
        return f"{prefix}{dice.choice(('__node', '__name'))}:={dice.choice(('n', 'm', 'rostopic'))}"
    scheme = dice.choice(("", "", "", "rostopic://", "rosservice://"))
    return f"{prefix}{scheme}{dice.choice(SIDES)}:={dice.choice(TARGETS)}"


def dented(dice: random.Random, rule: str) -> str:
    """``rule`` with something put into it, or taken out of it, somewhere; or as it is."""
    at = dice.randrange(len(rule) + 1)
    new = dice.choice(("", *RULE_PIECES))
    return rule[:at] + new + rule[at + dice.choice((0, 0, 1)) :]


def test_nodes_under_rules_lead_to_the_same_names() -> None:
    dice = random.Random("nodes")
    cases = [drawn_node(dice) for _ in range(150)]
    theirs = ask(cases)
    assert 0.3 < share(theirs) < 0.9
    led = [name for answer in theirs for name in (answer or [])[1:]]
    assert len(led) > 400
    assert 0.3 < share(led) < 0.9
    assert differing(cases, [placed(case) for case in cases], theirs) == []


def drawn_node(dice: random.Random) -> dict[str, Any]:
    """Return a node with rules of its own and of its process; one rule in fifty is dented."""
    own, process = (
        [
            dented(dice, rule) if dice.random() < 0.02 else rule
            for rule in (drawn_rule(dice) for _ in range(dice.randrange(7)))
        ]
        for _ in range(2)
    )
    return {
        "ask": "node",
        "node": dice.choice(NODES if dice.random() < 0.4 else ("n", "m")),
        "namespace": dice.choice(NAMESPACES if dice.random() < 0.4 else ("", "/r")),
        "node_rules": own,
        "process_rules": process,
        "use_process_rules": dice.random() < 0.8,
        "names": [(dice.choice(("topic", "service")), dice.choice(NAMES)) for _ in range(8)],
    }


def placed(case: dict[str, Any]) -> list[str | None] | None:
    """Return what the module says to a case of ``drawn_node``."""
    own = [parse_remap(rule) for rule in case["node_rules"]]
    process = [parse_remap(rule) for rule in case["process_rules"]]
    if None in own or None in process:
        return None
    rules = [rule for rule in own + process * case["use_process_rules"] if rule is not None]
    where = (case["node"], case["namespace"], rules)
    try:
        node, namespace = remapped_node(*where)
    except UsageError:
        return None
    full = f"{namespace.rstrip('/')}/{node}"
    return [full, *(led_to(name, kind, where) for kind, name in case["names"])]


def led_to(name: str, kind: str, where: tuple[str, str, list[RemapRule]]) -> str | None:
    try:
        return resolve_bound(name, kind, bind(*where))
    except UsageError:
        return None
