# SPDX-License-Identifier: Apache-2.0
"""Every name that nodes were found to ask for is in ``nodes.yaml``, or its absence has a reason.

``fixtures/node_facts.tsv`` holds a line for each: node, role, kind, name and type, read from the
nodes' sources. ``fixtures/node_facts_exceptions.tsv`` holds node, role, name and the reason.
"""

from __future__ import annotations

from collections import Counter
from typing import NamedTuple

import pytest
from paths import FIXTURES

from multibot_rewrite.base.rosnames import expand
from multibot_rewrite.knowledge.node_sets import built_in
from multibot_rewrite.knowledge.records import Endpoint

LEAST_FACTS = 600
LEAST_NODES = 94


class Fact(NamedTuple):
    """One line of ``node_facts.tsv``."""

    node: str
    role: str
    kind: str
    name: str
    type: str

    @property
    def key(self) -> tuple[str, str, str]:
        """What exceptions are listed by."""
        return self.node, self.role, self.name


def rows(file: str) -> list[list[str]]:
    """Return the lines of a table."""
    return [line.split("\t") for line in (FIXTURES / file).read_text().splitlines()]


FACTS = [Fact(*row) for row in rows("node_facts.tsv")]
EXCEPTIONS = {
    (n, role, name): reason for n, role, name, reason in rows("node_facts_exceptions.tsv")
}


def endpoints(node: str) -> tuple[Endpoint, ...]:
    """Return what a node or a part has, nothing where it is not known."""
    library = built_in("jazzy")
    if node in library.nodes:
        return library.nodes[node].endpoints
    return library.parts.get(node, ())


def full(name: str, node: str) -> str:
    """Return a name as it is without a namespace: ``map_server/map`` and ``~/map`` are the same."""
    return expand(name, "/", node) if name.startswith("~") else "/" + name.lstrip("/")


def same_form(one: str, other: str) -> bool:
    """Whether both are absolute, or none is."""
    return one.startswith("/") == other.startswith("/")


def trouble(fact: Fact) -> str:
    """Return what is wrong with the data, measured by this fact; empty where nothing is."""
    wanted = full(fact.name, fact.node)
    found = [
        e
        for e in endpoints(fact.node)
        if (e.role, e.kind, full(e.name, fact.node)) == (fact.role, fact.kind, wanted)
    ]
    if not found:
        return f"no {fact.kind} {fact.name}"
    if not any(same_form(e.name, fact.name) for e in found):
        return f"{fact.name} is written {found[0].name}"
    types = {t for e in found for t in (e.type, *e.also)}
    return "" if fact.type in types else f"{fact.name} is a {sorted(types)}"


def test_nothing_was_lost() -> None:
    assert len(FACTS) >= LEAST_FACTS
    assert len({fact.node for fact in FACTS}) >= LEAST_NODES
    assert [fact for fact, count in Counter(FACTS).items() if count > 1] == []


def test_every_fact_is_followed_or_excepted() -> None:
    wrong = {fact.key: trouble(fact) for fact in FACTS if trouble(fact)}
    assert {key: words for key, words in wrong.items() if key not in EXCEPTIONS} == {}


def test_every_exception_is_needed_and_says_why() -> None:
    needed = {fact.key for fact in FACTS if trouble(fact)}
    assert sorted(EXCEPTIONS.keys() - needed) == []
    assert all(len(reason.split()) >= 3 for reason in EXCEPTIONS.values())


@pytest.mark.parametrize(
    "fact",
    [
        pytest.param(Fact("amcl", "publishes", "topic", "pose", "a/msg/B"), id="a-missing-name"),
        pytest.param(Fact("no_node", "publishes", "topic", "pose", "a/msg/B"), id="a-missing-node"),
        pytest.param(
            Fact("amcl", "subscribes", "topic", "/scan", "sensor_msgs/msg/LaserScan"),
            id="absolute-not-relative",
        ),
        pytest.param(
            Fact("amcl", "subscribes", "topic", "scan", "sensor_msgs/msg/Image"), id="another-type"
        ),
        pytest.param(
            Fact("amcl", "publishes", "topic", "scan", "sensor_msgs/msg/LaserScan"),
            id="the-other-way",
        ),
    ],
)
def test_a_wrong_fact_is_noticed(fact: Fact) -> None:
    assert trouble(fact)
