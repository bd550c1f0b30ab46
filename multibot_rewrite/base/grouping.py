# SPDX-License-Identifier: Apache-2.0
"""Values gathered by a key, or by chains of keys."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Hashable, Iterable, Mapping
from typing import TypeVar

_Key = TypeVar("_Key", bound=Hashable)
_Name = TypeVar("_Name", bound=Hashable)
_Value = TypeVar("_Value")
_Member = TypeVar("_Member", bound=Hashable)


def lists_by_key(pairs: Iterable[tuple[_Key, _Value]]) -> dict[_Key, list[_Value]]:
    """Return the values of each key, in the order of the pairs; of any other key an empty list."""
    found: dict[_Key, list[_Value]] = defaultdict(list)
    for key, value in pairs:
        found[key].append(value)
    return found


def sets_by_key(pairs: Iterable[tuple[_Key, _Member]]) -> dict[_Key, set[_Member]]:
    """Return the values of each key, each once; of any other key an empty set."""
    found: dict[_Key, set[_Member]] = defaultdict(set)
    for key, value in pairs:
        found[key].add(value)
    return found


def dicts_by_key(
    triples: Iterable[tuple[_Key, _Name, _Value]],
) -> dict[_Key, dict[_Name, _Value]]:
    """Return for each key the values by name, the last one of a name; of any other key none."""
    found: dict[_Key, dict[_Name, _Value]] = defaultdict(dict)
    for key, name, value in triples:
        found[key][name] = value
    return found


def chain_ends(next_of: Mapping[str, str]) -> dict[str, str]:
    """Return what each name leads to in the end; empty for one that leads into a circle."""
    ends: dict[str, str] = {}
    for start in next_of:
        passed: dict[str, None] = {}
        name = start
        while name in next_of and name not in ends and name not in passed:
            passed[name] = None
            name = next_of[name]
        end = "" if name in passed else ends.get(name, name)
        ends.update(dict.fromkeys(passed, end))
    return ends
