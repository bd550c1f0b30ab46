"""Names that differ from a known one by a typing mistake: nearer than a "did you mean"."""

from __future__ import annotations

from collections.abc import Iterable

from multibot_rewrite.nearest import COMPARED, fold


def meant_name(name: str, known: Iterable[str]) -> str:
    """The known name that differs from ``name`` by one typing mistake in one word."""
    folded = fold(name)
    for it, _ in zip(known, range(COMPARED), strict=False):
        other = fold(it)
        if folded == other or _one_typo(folded.split("_"), other.split("_")):
            return it
    return ""


def _one_typo(words: list[str], others: list[str]) -> bool:
    """Do they differ in one long word without digits, by a letter or two letters swapped?"""
    if len(words) != len(others):
        return False
    pairs = [pair for pair in zip(words, others, strict=True) if pair[0] != pair[1]]
    if len(pairs) != 1:
        return False
    one, two = pairs[0]
    if not (one.isalpha() and two.isalpha()) or max(len(one), len(two)) < 4:
        return False
    while one and two and one[0] == two[0]:
        one, two = one[1:], two[1:]
    while one and two and one[-1] == two[-1]:
        one, two = one[:-1], two[:-1]
    return max(len(one), len(two)) == 1 or (len(one) == 2 and one == two[::-1])
