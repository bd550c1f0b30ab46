# SPDX-License-Identifier: Apache-2.0
"""Chains of filters of laser_filters: what of them is loaded.

Source: ros/filters 2.1.1 filter_chain.hpp (``load_chain_config``: filter1, filter2 ... up to the first
number without name and type; one without the other, or a name twice, and the chain is not configured).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.companions.kinds import PARAMS
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.rules.files.plugins import FILTER
from multibot_rewrite.rules.files.section_facts import Section, Setting, sections
from multibot_rewrite.rules.places import remark_at

_PACKAGE = "laser_filters"
_NEEDED = ("name", "type")
# The number of a filter, or none, with its parts.
_Filters = Mapping[str, Mapping[str, Setting]]


@rule("MB896", "filter-chain", WARNING, formats=(PARAMS,))
def broken_chains(file: NamedFile) -> Iterator[Finding]:
    """Of every chain of a node of laser_filters."""
    for section in sections(file):
        if section.node and section.node.package == _PACKAGE:
            for filters in _chains(section).values():
                yield from _not_loaded(section, filters)
                yield from _incomplete(section, filters)


def _chains(section: Section) -> Mapping[str, _Filters]:
    found: dict[str, dict[str, dict[str, Setting]]] = {}
    for it in section.whole.values():
        if part := FILTER.fullmatch(it.name):
            filters = found.setdefault(part["chain"], {})
            filters.setdefault(part["number"], {}).setdefault(part["word"], it)
    return found


def _not_loaded(section: Section, filters: _Filters) -> Iterator[Finding]:
    last = next(at for at in range(1, len(filters) + 2) if str(at) not in filters) - 1
    for number, parts in filters.items():
        if not number or int(number) > last:
            message = f"{section.title}: filter{number} is not loaded: there is no filter{last + 1}"
            hint = "filters are called filter1, filter2 and so on, without a gap"
            yield remark_at(next(iter(parts.values())).key, message, hint)


def _incomplete(section: Section, filters: _Filters) -> Iterator[Finding]:
    names: dict[str, str] = {}
    for number, parts in filters.items():
        first = next(iter(parts.values()))
        for word in (it for it in _NEEDED if it not in parts):
            message = f"{section.title}: filter{number} has no {word}"
            yield remark_at(first.key, message, "the chain is not configured without", ERROR)
        name = str(parts["name"].value) if "name" in parts else ""
        if name and name in names:
            message = f"{section.title}: filter{number} has the name {name!r}, as {names[name]} has"
            yield remark_at(parts["name"].node, message, "give it another name", ERROR)
        names.setdefault(name, f"filter{number}")
