# SPDX-License-Identifier: Apache-2.0
"""What the sources of a release say against what ``knowledge/nodes/`` says, both ways."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from multibot_rewrite.knowledge.node_library import NodeLibrary
from multibot_rewrite.knowledge.records import Endpoint
from multibot_rewrite.producers.sources.records import Class
from tools.interfaces.table import Fact

# Parts of ours that come from rclcpp and rclcpp_lifecycle, which are not read.
NOT_READ = ("every_node", "lifecycle")
OURS, THEIRS, WAY, WHEN = "not in the sources", "not in ours", "another way", "only sometimes"
UNLISTED = "not in nodes.txt"
# A condition with one of these is never true for all.
SOMETIMES = re.compile(r"plugin |class |tree has ")
_MADE = re.compile(r"<[^<>]*>")


class Difference(NamedTuple):
    """One difference; ``what`` is one of the words above."""

    node: str
    role: str
    name: str
    type: str
    what: str
    detail: str = ""


def differences(facts: Iterable[Fact], library: NodeLibrary) -> Iterator[Difference]:
    """All differences of the nodes that the sources have; ``library`` is of the same release."""
    by_node: dict[str, list[Fact]] = {}
    for fact in facts:
        by_node.setdefault(fact.node, []).append(fact)
    for node, found in by_node.items():
        known = library.nodes.get(node)
        yield from _of_node(node, found, tuple(_read(library, known.endpoints)) if known else ())


def difference_of(found: Class) -> Difference:
    """Return that of a node without a line in ``nodes.txt``."""
    place = found.place
    return Difference(
        f"{place.package}/{found.name}", "", "", "", UNLISTED, f"{place.path}:{place.line}"
    )


def _read(library: NodeLibrary, endpoints: Iterable[Endpoint]) -> Iterator[Endpoint]:
    """Return the endpoints that sources can say something about."""
    names = {(it.role, it.name) for part in NOT_READ for it in library.parts[part]}
    return (it for it in endpoints if (it.role, it.name) not in names)


def _of_node(node: str, facts: list[Fact], endpoints: tuple[Endpoint, ...]) -> Iterator[Difference]:
    for end in endpoints:
        same = [it for it in facts if is_same(it, end)]
        own = (node, end.role, end.name, end.type)
        if not same:
            yield Difference(*own, OURS)
        elif all(bool(it.way) != end.helper for it in same):
            yield Difference(*own, WAY, same[0].way or "its own")
        elif not end.when and all(SOMETIMES.search(it.condition) for it in same):
            yield Difference(*own, WHEN, same[0].condition)
    for fact in facts:
        if not any(is_same(fact, end) for end in endpoints):
            yield Difference(node, fact.role, fact.name, fact.type, THEIRS, fact.condition)


def is_same(fact: Fact, end: Endpoint) -> bool:
    """Is this the endpoint that the fact is about? Parts made at run time may be anything."""
    if fact.role != end.role:
        return False
    types = (end.type, *end.also)
    known = "/" in fact.type and end.type
    if known and fact.type not in types:
        return False
    return same_name(fact.name, end.name, fact.node)


def same_name(one: str, other: str, node: str) -> bool:
    """Return whether both names can be one."""
    plain = [_plain(it, node) for it in (one, other)]
    return bool(
        _pattern(plain[0]).fullmatch(_sample(plain[1]))
        or _pattern(plain[1]).fullmatch(_sample(plain[0]))
    )


def _plain(name: str, node: str) -> str:
    """With the node's own name as ``~``."""
    above, _, own = node.rpartition("/")
    name = re.sub(rf"^(<get_name>|<this>|{re.escape(own)})/", "~/", name)
    if above:  # an entry has names of the namespace above it as absolute ones.
        name = name.lstrip("/")
    return name.replace("<getName>", f"<{own}>") if name.startswith("~") else name


def _pattern(name: str) -> re.Pattern[str]:
    return re.compile(".*".join(re.escape(part) for part in _MADE.split(name)))


def _sample(name: str) -> str:
    return _MADE.sub("x", name)


class Excepted(NamedTuple):
    """Differences that may stay: node, role and name are patterns with ``*``."""

    node: str
    role: str
    name: str
    what: str
    reason: str


def exceptions_of(text: str) -> tuple[Excepted, ...]:
    """Return the exceptions of a table with a head line."""
    return tuple(Excepted(*line.split("\t")) for line in text.splitlines()[1:])


def excepted(found: Difference, exceptions: Iterable[Excepted]) -> str:
    """Return the reason why a difference may stay; empty for none."""
    for it in exceptions:
        pairs = zip(it[:3], found[:3], strict=True)
        if it.what == found.what and all(_fits(pattern, text) for pattern, text in pairs):
            return it.reason
    return ""


def _fits(pattern: str, text: str) -> bool:
    return re.fullmatch(re.escape(pattern).replace(r"\*", ".*"), text) is not None
