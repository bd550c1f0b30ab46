# SPDX-License-Identifier: Apache-2.0
"""Finds where ``${prefix}`` goes in the sources so that it changes the names and nothing else.

A name is used in an attribute or a text of a xacro element. There the prefix goes, whatever makes the
name: ``<parent link="${prefix}${parent}"/>``. Where the same place is also that of a name that all
robots share, as ``world``, it goes where the name is made: ``parent="${prefix}base_link"`` in the call
of the macro. Then every other place that uses this piece has to take it from there as well."""

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import accumulate
from typing import NamedTuple

from lxml import etree

from multibot_rewrite.base.grouping import dicts_by_key, lists_by_key
from multibot_rewrite.description.sources.expand import Expansion
from multibot_rewrite.description.sources.trace import EXPRESSION, GIVEN, Piece
from multibot_rewrite.description.steps.document import tag_end, written_slot
from multibot_rewrite.refactor.package import Description
from multibot_rewrite.refactor.source_edits import SourceEdit, ValueEdit, place_of

# A file and an offset in it.
Spot = tuple[str, int]


class Left(NamedTuple):
    """What could not be changed: its place, and why."""

    place: str
    why: str


class PlacedNames(NamedTuple):
    """The edits, the changes that they make in each description, and what is left."""

    edits: list[SourceEdit]
    changes: list[list[ValueEdit]]
    left: list[Left]


class _Name(NamedTuple):
    """A place for a prefix in a value of description ``of``, and its change if there is one.

    ``used`` is where the value is used, ``made`` where its piece is made, ``other`` its other
    pieces."""

    of: int
    used: Spot | None
    made: Spot | None
    other: frozenset[Spot]
    change: ValueEdit | None


def placed(
    found: Sequence[Description],
    changes: Sequence[Sequence[ValueEdit]],
    written: Callable[[Spot, ValueEdit], str],
) -> PlacedNames:
    """Return the edits of the sources for the changes of each description."""
    # They share sources: what one needs at a place, the others get.
    both = enumerate(zip(found, changes, strict=True))
    names = [name for of, (it, own) in both for name in _places_in(of, it, own)]
    deep = _made_elsewhere(names)
    stay = {it.made for it in names if it.made and it.change is None}
    others = stay.union(*(it.other for it in names))
    made = PlacedNames([], [[] for _ in found], [])
    for name in names:
        if name.change is None:
            continue
        spot = name.made if name.used is None or name.used in deep else name.used
        if spot is None or (spot == name.made and spot in others):
            it = found[name.of]
            where = place_of(it.read, name.change.element) or it.path
            why = "stays with other arguments or elsewhere" if spot in stay else "is put together"
            made.left.append(Left(where, f"{name.change.value!r} {why}"))
            continue
        word = written(spot, name.change).encode()
        made.edits.append(SourceEdit(*spot, spot[1], word))
        made.changes[name.of].append(name.change)
    return made


def _places_in(of: int, it: Description, changes: Iterable[ValueEdit]) -> Iterator[_Name]:
    """Yield the places of changes, and of values at the same places that do not change."""
    assert it.read is not None
    read = it.read
    real = {file: os.path.realpath(file) for file in read.sources}
    wanted = dicts_by_key(((one.element, one.attribute), one.start, one) for one in changes)
    for number, element in enumerate(it.inventory.document.elements):
        for attribute, value in _values(element):
            mine = wanted.get((number, attribute), {})
            if not value and not mine:
                continue
            own = read.pieces.of(number, attribute, value)
            # Each with the offset in the value at which it ends.
            pieces = [*zip(accumulate(len(it.text) for it in own), own, strict=True)]
            for at in mine or [len(value) - len(value.lstrip())]:
                used = _spot_of_use(read, number, attribute, pieces, at)
                made, other = _spot_of_copy(read, pieces, at)
                places = frozenset((real[file], start) for file, start in other)
                yield _Name(
                    of,
                    _with_real_path(used, real),
                    _with_real_path(made, real),
                    places,
                    mine.get(at),
                )


def _with_real_path(spot: Spot | None, real: Mapping[str, str]) -> Spot | None:
    """Return the spot with the real path of its file."""
    return spot and (real[spot[0]], spot[1])


def _values(element: etree._Element) -> Iterator[tuple[str, str]]:
    """Yield (attribute, value) of an element, and its text under the name "" if it has no elements."""
    yield from ((str(name), str(value)) for name, value in element.attrib.items())
    if not len(element):
        yield "", element.text or ""


def _spot_of_use(
    read: Expansion, number: int, attribute: str, pieces: Sequence[tuple[int, Piece]], at: int
) -> Spot | None:
    """Return where a prefix before character ``at`` goes in the element that has the value."""
    origin = read.origins.of(number)
    slot = origin and _slot(read.sources[origin.file], origin.start, attribute)
    if not origin or not slot:
        return None
    begin, end = slot
    if not at:
        return origin.file, begin
    for last, it in pieces:
        here = it.file == origin.file and begin <= it.start and it.end <= end
        if here and last == at:
            return it.file, it.end
        if here and it.kind not in (EXPRESSION, GIVEN) and last - len(it.text) <= at < last:
            return it.file, it.start + len(it.text[: at - last].encode())
    return None


def _slot(source: bytes, start: int, attribute: str) -> tuple[int, int] | None:
    """Return start and end of an attribute's value, or of an element's text; None without one."""
    if attribute:
        return written_slot(source, start, attribute)
    begin = tag_end(source, start)
    return begin, source.find(b"<", begin)


def _spot_of_copy(
    read: Expansion, pieces: Sequence[tuple[int, Piece]], at: int
) -> tuple[Spot | None, frozenset[Spot]]:
    """Return the spot that the piece at ``at`` is copied from, None if in an expression; the others."""
    spots = {(it.file, it.start): last for last, it in pieces if it.kind not in (EXPRESSION, GIVEN)}
    for last, it in pieces:
        spot = it.file, it.start
        if spot in spots and last - len(it.text) <= at < last:
            inside = read.sources[it.file][: it.start]
            free = inside.rfind(b"${") <= inside.rfind(b"}")
            begins = last - len(it.text) == at
            return (spot if free and begins else None), frozenset(spots.keys() - {spot})
    return None, frozenset(spots)


def _made_elsewhere(names: Sequence[_Name]) -> set[Spot | None]:
    """Return the spots of use where no prefix can go, as the name is made elsewhere."""
    groups = lists_by_key((it.used, it) for it in names)
    deep = {it for it, group in groups.items() if len({name.change is None for name in group}) > 1}
    while True:
        made = {it.made for it in names if it.change and it.made and it.used in deep}
        more = {
            it.used for it in names if it.change and it.made in made and it.made != it.used
        } - deep
        if not more:
            return deep
        deep |= more
