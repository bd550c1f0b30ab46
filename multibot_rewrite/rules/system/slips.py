# SPDX-License-Identifier: Apache-2.0
"""The known name that another one is but for a slip: case, dashes, a letter."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator
from functools import lru_cache
from itertools import islice, zip_longest

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.nearest import CHOICE, COMPARED, MISTYPED, nearest
from multibot_rewrite.rules.system.instead import COMMON

_DIGITS = lazy_compile(r"_?\d+")
_Rest = tuple[int | str, ...]


class Spelled:
    """Known names by how they are spelled: no name is held against all."""

    def __init__(self, names: Iterable[str]) -> None:
        self.by_letters: dict[str, list[str]] = defaultdict(list)
        # The other words and the place of one -> that without its number -> the word, and the name.
        self.beside: dict[_Rest, dict[str, list[tuple[str, str]]]] = {}
        for name in names:
            self.by_letters[_letters(name)].append(name)
            parts = name.split("/")
            for at in {1, len(parts) - 1}:
                words = self.beside.setdefault(_rest(parts, at), defaultdict(list))
                words[_DIGITS.sub("", parts[at])].append((parts[at], name))


NONE = Spelled(())


def alike(
    name: str, known: Spelled, type_: str, may_be: Callable[[str], bool] = lambda _: True
) -> str:
    """The known name that is the same but for case, dashes or a misspelled word, of those that it may
    be; empty for none.

    Names that differ in their numbers alone are two things.
    """
    same = known.by_letters.get(_letters(name), ())
    folded = next((it for it in same if it != name and may_be(it)), "")
    if folded or type_.startswith(COMMON):
        return folded
    parts = name.split("/")
    for at in (1, len(parts) - 1):
        others = _with_other_word(parts, at, known)
        near = {word: it for word, it in others if it != name and may_be(it)}
        swapped = (it for it in near if sorted(it) == sorted(parts[at]))
        slips = [it for it in near if _is_slip(it, parts[at])]
        found = next(swapped, "") or nearest(parts[at], slips, MISTYPED)
        if found:
            return near[found]
    return ""


def _with_other_word(parts: list[str], at: int, known: Spelled) -> Iterator[tuple[str, str]]:
    """The names that differ in the word at one place alone, by that word; not by its number."""
    own, words = _DIGITS.sub("", parts[at]), known.beside.get(_rest(parts, at), {})
    found = (it for bare, others in words.items() if bare != own for it in others)
    return islice(found, COMPARED)


def _rest(parts: list[str], at: int) -> _Rest:
    return at, *parts[:at], *parts[at + 1 :]


def _is_slip(one: str, other: str) -> bool:
    """Is no part between underscores another word? `cmd_vel_out` is no slip of `cmd_vel_ui`, nor is
    `lidar_l` of `lidar_r`."""
    parts = list(zip_longest(one.split("_"), other.split("_"), fillvalue=""))
    return all(here == there or nearest(here, (there,), CHOICE) for here, there in parts)


@lru_cache(maxsize=4096)
def _letters(name: str) -> str:
    """Its letters, digits and slashes, in lower case."""
    return "".join(it for it in name.lower() if it.isalnum() or it == "/")
