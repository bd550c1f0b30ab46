# SPDX-License-Identifier: Apache-2.0
"""A fact in prose is not a fact: no program can ask it.

Notes that name an endpoint, a node, a parameter, a port, a file or a condition are counted by what they
name. The numbers may only fall: make a field of the next one.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from functools import cache

from multibot_rewrite.knowledge.conditions import (
    KINDS,
    NODL,
    OPEN,
    OPEN_KIND,
    SOURCE,
    parse_condition,
)
from multibot_rewrite.knowledge.node_library import NodeLibrary
from multibot_rewrite.knowledge.node_sets import every_release

PROSE = {"endpoint": 3, "node": 1, "parameter": 4, "file": 0, "port": 0, "condition": 9}
TOPIC = re.compile(r"(?:^|[\s(])[~/]?[a-z_<>]*/[\w<>/*]+")
FILE = re.compile(r"\.(?:ya?ml|lua|xml|py|cpp|hpp|bag|mcap|launch)\b")
PORT = re.compile(r"\bport\b|:\d{4,5}\b")
CONDITION = re.compile(r"\b(?:if|unless|only|when|where|with|without|until|instead)\b")


@cache
def library() -> NodeLibrary:
    return every_release()


def notes() -> Iterator[tuple[str, str]]:
    """Each text for people, with the entry that has it."""
    known = library()
    for name, ends in known.parts.items():
        yield from ((name, it.note) for it in ends)
    for node in known.nodes.values():
        yield node.name, node.note
        yield from ((node.name, it) for it in node.fixed)
        yield from ((node.name, it.note) for it in node.endpoints if it not in of_parts())
    for facts in known.parameters.values():
        yield from ((facts.name, it.note) for it in facts.forms)


@cache
def of_parts() -> frozenset[object]:
    return frozenset(it for ends in library().parts.values() for it in ends)


def named(text: str, own: str) -> Iterator[str]:
    """Yield what a text names."""
    words = set(re.findall(r"[\w<>.]+", text))
    known = library()
    nodes = {it.rpartition("/")[2] for it in (*known.nodes, *known.parameters)} - {own}
    # A parameter is told from a word by its underscore or dot.
    params = {it.path for it in known.parameters[own].forms} if own in known.parameters else set()
    patterns = {"endpoint": TOPIC, "file": FILE, "port": PORT, "condition": CONDITION}
    yield from (what for what, pattern in patterns.items() if pattern.search(text))
    yield from ["node"] * bool(words & nodes)
    yield from ["parameter"] * any(it in params and re.search(r"[_.]", it) for it in words)


def test_prose_that_names_something_only_gets_less() -> None:
    """After a change for the better: write the smaller number into ``PROSE``."""
    texts = {(own, text) for own, text in notes() if text}
    found = Counter(what for own, text in texts for what in named(text, own))
    assert dict(found) == {what: number for what, number in PROSE.items() if number}


def conditions() -> Iterator[str]:
    known = library()
    nodes = (
        *known.nodes.values(),
        *(it for a_set in known.node_sets.values() for it in a_set.nodes),
    )
    for node in nodes:
        yield from (node.when, *(it.when for it in node.endpoints))
        yield from (it.condition for it in (*node.endpoints, *node.sends, *node.claims))
    yield from (end.when for ends in known.parts.values() for end in ends)


def test_no_condition_is_prose() -> None:
    """A term asks something that a program decides, or has one of the closed words."""
    terms = {term for it in conditions() for terms in parse_condition(it) for term in terms}
    told = [it for it in terms if it.how == ":"]
    assert [it for it in told if it.parameter not in KINDS] == []
    left = {word for it in told if it.parameter == OPEN_KIND for word in it.values}
    # A NoDL file and a source of a user have the last ones.
    assert left == {*OPEN} - {NODL, SOURCE}


def test_a_topic_that_somebody_has_to_hear_is_one_of_the_node() -> None:
    wrong = []
    for node in library().nodes.values():
        own = {end.name for end in node.endpoints}
        for end in node.endpoints:
            terms = (it for terms in parse_condition(end.when) for it in terms)
            wrong += [
                (node.name, it)
                for it in terms
                if it.parameter == "heard" and not own >= {*it.values}
            ]
    assert wrong == []


def test_a_condition_asks_parameters_by_ids_of_its_node() -> None:
    """``<layer>.plugin`` is one for each word of the list that ``ids`` names, ``<index>`` digits."""
    wrong = []
    for node in library().nodes.values():
        ids = {name for name, _ in node.ids} | {"index"}
        for end in node.endpoints:
            asked = set(re.findall(r"<(\w+)>", end.when))
            wrong += [(node.name, end.name, asked - ids)] if asked - ids else []
    assert wrong == []
