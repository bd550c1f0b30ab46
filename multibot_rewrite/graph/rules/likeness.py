"""What was probably meant: names that come near, and nodes that stand where a planned one is missed."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.graph.rules.owners import Owners
from multibot_rewrite.nearest import MISTYPED, nearest

# Among more names than these something always comes near.
GUESSES = 50


def similar(name: str, known: Collection[str]) -> str:
    """The one of a few names that goes on like ``name`` or is spelled nearly alike, or ""."""
    if len(known) > GUESSES:
        return ""
    going_on = [other for other in known if other.startswith(name) or name.startswith(other)]
    if going_on:
        return min(going_on, key=lambda other: abs(len(other) - len(name)))
    return nearest(name, known, MISTYPED)


class _Loose(NamedTuple):
    """Nodes that nobody planned: all, and those that are no tools by robot; and the namespaces of
    those without one, by what is left of them without case and underscores."""

    all: frozenset[str]
    of: Mapping[str, Sequence[str]]
    heads: Mapping[str, str]


def stand_ins(
    missing: Mapping[str, str], strangers: Iterable[str], unplanned: Iterable[str], owners: Owners
) -> dict[str, str]:
    """The stranger that each missing node (node -> robot) probably is, where there is one.

    ``unplanned`` are the strangers that are no tools: only those may have another name.
    """
    if not missing:
        return {}
    of: dict[str, list[str]] = defaultdict(list)
    for node in unplanned:
        of[owners.of(node)].append(node)
    heads = {_plain(node.split("/")[1]): node.split("/")[1] for node in of[""]}
    loose = _Loose(frozenset(strangers), of, heads)
    found = {node: _stand_in(node, robot, loose, owners) for node, robot in missing.items()}
    return {node: other for node, other in found.items() if other}


def _plain(name: str) -> str:
    return "".join(filter(str.isalnum, name)).lower()


def _stand_in(node: str, robot: str, loose: _Loose, owners: Owners) -> str:
    bare = owners.bare(node, robot)
    head = loose.heads.get(_plain(robot), robot)
    for likely in (bare, f"/{bare.rpartition('/')[2]}", f"/{head}{bare}"):
        if likely in loose.all:
            return likely
    own = {owners.bare(other, robot): other for other in loose.of.get(robot, ())}
    return own.get(similar(bare, own), "")
