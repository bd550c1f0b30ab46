# SPDX-License-Identifier: Apache-2.0
"""The known name that another one is but for a slip: case, dashes, a letter."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import lru_cache
from itertools import islice, zip_longest

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.nearest import CHOICE, COMPARED, MISTYPED, nearest
from multibot_rewrite.rules.system.instead import COMMON

_DIGITS = lazy_compile(r"_?\d+")


def alike(name: str, known: Iterable[str], type_: str) -> str:
    """The known name that is the same but for case, dashes or a misspelled word; empty for none.

    Names that differ in their numbers alone are two things.
    """
    letters = _letters(name)
    names = [it for it in islice(known, COMPARED) if it != name]
    folded = next((it for it in names if _letters(it) == letters), "")
    if folded or type_.startswith(COMMON):
        return folded
    parts = name.split("/")
    for at in (1, len(parts) - 1):
        near = dict(_with_other_word(parts, at, names))
        swapped = (it for it in near if sorted(it) == sorted(parts[at]))
        slips = [it for it in near if _is_slip(it, parts[at])]
        found = next(swapped, "") or nearest(parts[at], slips, MISTYPED)
        if found:
            return near[found]
    return ""


def _with_other_word(parts: list[str], at: int, names: Iterable[str]) -> Iterator[tuple[str, str]]:
    """The names that differ in the word at one place alone, by that word; not by its number."""
    rest = parts[:at] + parts[at + 1 :]
    for name in names:
        other = name.split("/")
        same = len(other) == len(parts) and other[:at] + other[at + 1 :] == rest
        if same and not _same_but_number(other[at], parts[at]):
            yield other[at], name


def _is_slip(one: str, other: str) -> bool:
    """Is no part between underscores another word? `cmd_vel_out` is no slip of `cmd_vel_ui`, nor is
    `lidar_l` of `lidar_r`."""
    parts = list(zip_longest(one.split("_"), other.split("_"), fillvalue=""))
    return all(here == there or nearest(here, (there,), CHOICE) for here, there in parts)


@lru_cache(maxsize=4096)
def _letters(name: str) -> str:
    """Its letters, digits and slashes, in lower case."""
    return "".join(it for it in name.lower() if it.isalnum() or it == "/")


def _same_but_number(one: str, other: str) -> bool:
    return _DIGITS.sub("", one) == _DIGITS.sub("", other)
