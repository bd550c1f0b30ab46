# SPDX-License-Identifier: Apache-2.0
"""How much of a set of descriptions the vocabulary knows: plugins, values, unclaimed names."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import TypeVar

from multibot_rewrite.base.findings.finding import locate
from multibot_rewrite.base.model import Claim
from multibot_rewrite.base.naming import DECLARED_KINDS
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.checks.mentions import MENTIONED, unclaimed_mentions
from multibot_rewrite.description.checks.unknown import is_unknown
from multibot_rewrite.description.reports.paths import plugin_name, tag_path
from multibot_rewrite.description.rewriters.spelling import ResolvedName
from multibot_rewrite.description.rewriters.text import text_at
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.steps.collect import Host, Inventory
from multibot_rewrite.description.steps.document import Document, slot_values

# Stands for the kind of a name that this file would have to declare.
UNRESOLVED = "unresolved"


class Tally(NamedTuple):
    """How often, in how many files, and where first: ``file:line``, with the value in question."""

    times: int
    files: int
    place: str
    value: str


class Loaded(NamedTuple):
    """What an element loads: the library (or class) of a plugin, the class of a hardware."""

    type: str
    name: str
    known: bool


class MentionPlace(NamedTuple):
    """A place where a link's or joint's name is not claimed; ``exact`` if it is all of the value.

    ``path`` is ``robot/gazebo/plugin[libfoo.so]/frameName`` or ``robot/joint@type``; a ``param``
    has its name in brackets.
    """

    path: str
    exact: bool


_Thing = TypeVar("_Thing", Loaded, MentionPlace)


class Survey(NamedTuple):
    """What is known of one file or, added up, of many."""

    files: int
    loaded: Mapping[Loaded, Tally]
    claims: Mapping[str, int]
    mentions: Mapping[MentionPlace, Tally]


def survey(inventory: Inventory, tree: Tree) -> Survey:
    """What is known of one file."""
    named = zip(inventory.claims, inventory.names, strict=True)
    claims = Counter(_kind(claim, names) for claim, names in named)
    return Survey(1, _loaded(inventory), claims, _mentions(inventory, tree))


def add(surveys: Iterable[Survey]) -> Survey:
    """The sum of surveys; the first place of each thing is the one that is kept."""
    files = 0
    loaded: dict[Loaded, Tally] = {}
    claims: Counter[str] = Counter()
    mentions: dict[MentionPlace, Tally] = {}
    for one in surveys:
        files += one.files
        claims.update(one.claims)
        for thing, tally in one.loaded.items():
            loaded[thing] = _sum(loaded.get(thing), tally)
        for mention, tally in one.mentions.items():
            mentions[mention] = _sum(mentions.get(mention), tally)
    return Survey(files, loaded, claims, mentions)


def _sum(first: Tally | None, second: Tally) -> Tally:
    if first is None:
        return second
    return first._replace(times=first.times + second.times, files=first.files + second.files)


def _kind(claim: Claim, names: Sequence[ResolvedName]) -> str:
    """The kind of a claimed value, which is that of the first name in it."""
    return names[0].kind or UNRESOLVED if names else _first(claim)


def _first(claim: Claim) -> str:
    """The kind of a value without a name: what it would be, or nothing of this file."""
    kind = claim.site.kinds[0]
    return UNRESOLVED if kind in DECLARED_KINDS else kind


def _loaded(inventory: Inventory) -> dict[Loaded, Tally]:
    found: dict[Loaded, Tally] = {}
    for host in inventory.hosts:
        thing = loaded_by(host)
        if thing is None:
            continue
        tally = _first_or(found.get(thing), inventory.document, host.start, thing.name)
        found[thing] = tally
    return found


def loaded_by(host: Host) -> Loaded | None:
    """What an element loads; None where it loads nothing (a sensor is no plugin)."""
    section = host.node.section
    assert section is not None
    type_ = section.select or section.type
    if type_ == "plugin":
        return Loaded(type_, plugin_name(host.element), not is_unknown(section))
    class_ = text_at(host.element, "hardware/plugin") if type_ == "hardware" else ""
    return Loaded(type_, class_, not section.select) if class_ else None


def _mentions(inventory: Inventory, tree: Tree) -> dict[MentionPlace, Tally]:
    names = {name for kind in MENTIONED for name in inventory.declared[kind]}
    values = slot_values(inventory.document.root)
    found: dict[MentionPlace, Tally] = {}
    for slot in unclaimed_mentions(inventory, values, names, tree):
        mention = MentionPlace(tag_path(slot.element, slot.attribute), slot.value == slot.name)
        tally = _first_or(found.get(mention), inventory.document, slot.start, slot.value)
        found[mention] = tally
    return found


def _first_or(tally: Tally | None, document: Document, start: int, value: str) -> Tally:
    """One more of what was tallied, or the first of it."""
    if tally is not None:
        return tally._replace(times=tally.times + 1)
    line, _ = locate(document.source, start)
    return Tally(1, 1, f"{document.file}:{line}", value)


def ranked(tallies: Iterable[tuple[_Thing, Tally]]) -> list[tuple[_Thing, Tally]]:
    """The most frequent first, those of one frequency by name."""
    return sorted(tallies, key=lambda pair: (-pair[1].times, pair[0]))


def share(total: Survey, type_: str) -> tuple[int, int]:
    """How many occurrences of that type there are, and how many of them are known."""
    counts = [(tally.times, it.known) for it, tally in total.loaded.items() if it.type == type_]
    return sum(count for count, _ in counts), sum(count for count, known in counts if known)
