# SPDX-License-Identifier: Apache-2.0
"""``nodes.txt``: the classes of each known node; and from them, what it declares."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from importlib.resources import files
from typing import NamedTuple

from multibot_rewrite.producers.sources.records import Class, Place
from tools.interfaces.nodes import facts_of
from tools.interfaces.scope import Index
from tools.interfaces.table import Fact

# What a name that is made at run time depends on.
_MODE = re.compile(r"(?:plugin|tree has) \w+")


class NodeClasses(NamedTuple):
    """A node and its modes: the classes that run in each, as (package, class)."""

    node: str
    modes: tuple[tuple[tuple[str, str], ...], ...]


@cache
def known_nodes() -> tuple[NodeClasses, ...]:
    """All nodes of the file."""
    text = files(__package__).joinpath("nodes.txt").read_text(encoding="utf-8")
    lines = (line.split(maxsplit=1) for line in text.splitlines() if line and line[0] != "#")
    return tuple(NodeClasses(node, tuple(map(_mode, rest.split("|")))) for node, rest in lines)


def _mode(text: str) -> tuple[tuple[str, str], ...]:
    parts = (part.strip().partition("/") for part in text.split("+"))
    return tuple((package, name) for package, _, name in parts)


def extracted(index: Index) -> Iterator[Fact]:
    """Yield what all known nodes declare in the sources, each once."""
    own = frozenset(mode[0] for it in known_nodes() for mode in it.modes)
    for node in known_nodes():
        usual: dict[tuple[str, ...], Fact] = {}
        for at, mode in enumerate(node.modes):
            found = _of_mode(index, node.node, mode, own)
            more = {key: it for key, it in found.items() if key not in usual}
            yield from (_only(it, mode[0][1] if at and usual else "") for it in more.values())
            usual |= more


def _only(fact: Fact, mode: str) -> Fact:
    """Return a fact that holds in one mode only."""
    words = "; ".join(filter(None, (f"class {mode}" if mode else "", fact.condition)))
    return fact._replace(condition=words)


def _of_mode(
    index: Index, node: str, mode: tuple[tuple[str, str], ...], own: frozenset[tuple[str, str]]
) -> dict[tuple[str, ...], Fact]:
    """Return the facts of the classes of a mode; of equal ones that with the weakest condition."""
    found: dict[tuple[str, ...], Fact] = {}
    for root in _roots(index, mode):
        for fact in facts_of(index, node, root, own - {(root.place.package, root.name)}):
            only = "; ".join(_MODE.findall(fact.condition)) if "<" in fact.name else ""
            key = (fact.role, fact.name, fact.type, fact.way, only)
            if key not in found or len(fact.condition) < len(found[key].condition):
                found[key] = fact
    return found


def _roots(index: Index, mode: tuple[tuple[str, str], ...]) -> Iterator[Class]:
    for package, name in mode:
        there = [it for it in index.classes.get(name, ()) if it.place.package == package]
        if not name:
            there = [Class("", (), (), {}, Place("", "", "", 0, package))]
        yield from there[:1]


def unlisted(index: Index) -> Iterator[Class]:
    """Nodes that no line has, of packages that some line has: components, and what a main makes.

    A class that declares nothing is left out.
    """
    listed = {part for it in known_nodes() for mode in it.modes for part in mode}
    packages = {package for package, _ in listed}
    made = {(it.place.package, it.name) for it in index.functions.get("main", ())}
    names = sorted({name for _, name in made})
    for found in (it for name in names for it in index.classes.get(name, ())):
        key = (found.place.package, found.name)
        if key in made and key not in listed and key[0] in packages and _declares(index, found):
            yield found


def _declares(index: Index, found: Class) -> bool:
    return next(facts_of(index, found.name, found, frozenset()), None) is not None
