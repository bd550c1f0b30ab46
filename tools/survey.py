# SPDX-License-Identifier: Apache-2.0
"""``python -m tools.survey PATH...``: how much of a set of descriptions the plugin definitions knows.

Every .urdf and .sdf there is read. Printed are plugins and hardware classes that no section describes,
how many values of each kind are claimed, and links and joints in values that no line reads.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple, TypeVar

from multibot_rewrite.base.findings.finding import locate
from multibot_rewrite.base.model import Claim, InputError, MultibotError
from multibot_rewrite.base.naming import DECLARED_KINDS
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.base.wording import clip, plural
from multibot_rewrite.cli.tables import Grid, render
from multibot_rewrite.cli.walk import find_files
from multibot_rewrite.description.checks.mentions import MENTIONED, unclaimed_mentions
from multibot_rewrite.description.reports.explain import tag_path
from multibot_rewrite.description.reports.suggest import Loaded, loaded_by
from multibot_rewrite.description.rewriters.renaming import ResolvedName
from multibot_rewrite.description.rewriters.tree import Tree, builtin_tree
from multibot_rewrite.description.sources.job import read_whole
from multibot_rewrite.description.steps.collect import Inventory, collect
from multibot_rewrite.description.steps.document import Document, read_document, slot_values

SUFFIXES = (".urdf", ".sdf")

# Stands for the kind of a name that this file would have to declare.
UNRESOLVED = "unresolved"


class Tally(NamedTuple):
    """How often, in how many files, and where first: ``file:line``, with the value in question."""

    times: int
    files: int
    place: str
    value: str


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
    """Return what is known of one file."""
    named = zip(inventory.claims, inventory.names, strict=True)
    claims = Counter(_kind(claim, names) for claim, names in named)
    return Survey(1, _loaded(inventory), claims, _mentions(inventory, tree))


def add(surveys: Iterable[Survey]) -> Survey:
    """Return the sum of surveys; the first place of each thing is the one that is kept."""
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
    """Return the kind of a claimed value, which is that of the first name in it."""
    return names[0].kind or UNRESOLVED if names else _first(claim)


def _first(claim: Claim) -> str:
    """Return the kind of a value without a name: what it would be, or nothing of this file."""
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
    """Return the most frequent first, those of one frequency by name."""
    return sorted(tallies, key=lambda pair: (-pair[1].times, pair[0]))


def share(total: Survey, type_: str) -> tuple[int, int]:
    """How many occurrences of that type there are, and how many of them are known."""
    counts = [(tally.times, it.known) for it, tally in total.loaded.items() if it.type == type_]
    return sum(count for count, _ in counts), sum(count for count, known in counts if known)


def surveyed(paths: Sequence[str]) -> tuple[Survey, list[str]]:
    """Return what is known of all files below the paths, and why some are unread; raises UsageError."""
    tree, found, unreadable = builtin_tree((), NEWEST_LTS), [], []
    for path in find_files(paths, SUFFIXES, everything=True).files:
        try:
            read = read_whole(path, {}, False)
            found.append(survey(collect(read_document(read.data, read.file), tree), tree))
        except InputError as error:
            unreadable.append(str(error))
    return add(found), unreadable


def percentage(count: int, known: int) -> float:
    """Return a percentage rounded down, so that 100 means all; all of nothing is all."""
    return 1000 * known // count / 10 if count else 100.0


def report(total: Survey, unreadable: Sequence[str]) -> Iterator[str | Grid]:
    """Yield what is printed."""
    yield f"{plural(total.files, 'file')} read, {len(unreadable)} cannot be read"
    yield from (f"  {it}" for it in unreadable)
    yield from _loaded_parts(total, "plugin", "plugins")
    yield from _loaded_parts(total, "hardware", "hardware classes")
    claims = sorted(total.claims.items(), key=lambda pair: (-pair[1], pair[0]))
    yield from ("", f"{plural(sum(total.claims.values()), 'value')} claimed")
    yield "  " + ", ".join(f"{kind} {count}" for kind, count in claims)
    for exact, what in (
        (True, "and exactly a link or joint"),
        (False, "with a link or joint inside"),
    ):
        mentions = ranked(it for it in total.mentions.items() if it[0].exact == exact)
        yield from ("", f"{sum(it.times for _, it in mentions)} unclaimed {what}")
        rows = [(str(t.times), str(t.files), m.path, clip(t.value), t.place) for m, t in mentions]
        yield from [Grid(("count", "files", "path", "value", "first seen"), rows)] * bool(rows)


def _loaded_parts(total: Survey, type_: str, words: str) -> Iterator[str | Grid]:
    count, known = share(total, type_)
    every = [it for it in total.loaded.items() if it[0].type == type_]
    names = f"{sum(it.known for it, _ in every)} of {len(every)} names"
    yield from ("", f"{known} of {count} {words} known ({percentage(count, known)} %), {names}")
    unknown = ranked(it for it in every if not it[0].known)
    rows = [(str(t.times), str(t.files), it.name, t.place) for it, t in unknown]
    yield from [Grid(("count", "files", "not known", "first seen"), rows)] * bool(rows)


def main(words: Sequence[str]) -> int:
    """Print the report; returns the exit code."""
    try:
        print(render(report(*surveyed(words))), end="")
    except MultibotError as error:
        print(f"survey: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
