# SPDX-License-Identifier: Apache-2.0
"""What a source says of one parameter of a node: the record, and its line in a table."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from multibot_rewrite.producers.sources.records import Place

# Of a place: repository, version, path, line.
PLACE_COLUMNS = 4


class ParameterFact(NamedTuple):
    """A parameter as a source has it.

    ``owner`` is the class or the library of parameters that has it, ``path`` its dotted name with
    ``<id>`` for what is not in the text, ``default`` its text (``""`` in quotes for an empty one,
    nothing where the text does not say it), ``bounds`` what generate_parameter_library checks,
    ``how`` one of yaml (generate_parameter_library), declared (in code), read (never declared there).
    """

    package: str
    owner: str
    path: str
    type: str
    default: str
    bounds: str
    read_only: str
    how: str
    place: Place


def parameter_lines(facts: Iterable[ParameterFact]) -> Iterator[str]:
    """Yield a line for each fact, with tabs between, sorted, each once."""
    for fact in sorted(set(facts)):
        yield "\t".join((*fact[:-1], *map(str, fact.place[:PLACE_COLUMNS])))


def read_parameters(text: str) -> tuple[ParameterFact, ...]:
    """Return the facts of such lines."""
    return tuple(_fact(line.split("\t")) for line in text.splitlines())


def _fact(cells: list[str]) -> ParameterFact:
    package, owner, path, type_, default, bounds, read_only, how, *where = cells
    repository, version, file, line = where
    place = Place(repository, version, file, int(line))
    return ParameterFact(package, owner, path, type_, default, bounds, read_only, how, place)
