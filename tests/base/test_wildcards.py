# SPDX-License-Identifier: Apache-2.0
"""Names with gaps: as a pattern that tries all ways, in one pass."""

from __future__ import annotations

import re
from itertools import product

import pytest

from multibot_rewrite.base.lazy import with_gaps
from multibot_rewrite.knowledge.declared import checks_in

GAPS = [
    ["a", "b"],
    ["", ""],
    ["a", "", "b"],
    ["", "a", ""],
    ["a", "a", "a"],
    ["", "ab", "b"],
    ["a"],
]


@pytest.mark.parametrize("gap", [".", "[^/]"])
@pytest.mark.parametrize("pieces", GAPS, ids="*".join)
def test_a_name_with_gaps_is_what_a_pattern_finds(pieces: list[str], gap: str) -> None:
    simple, fast = f"{gap}+".join(map(re.escape, pieces)), with_gaps(pieces, gap)
    for length in range(7):
        for text in map("".join, product("ab/", repeat=length)):
            assert bool(re.fullmatch(fast, text)) == bool(re.fullmatch(simple, text)), text


@pytest.mark.parametrize(
    ("bounds", "checks"),
    [
        ("", ()),
        ("gt(0)", (("gt", "0"),)),
        ("gt(0) lt(1.5)", (("gt", "0"), ("lt", "1.5"))),
        ("a::b(x, (y)) one_of(['a b', 'c'])", (("a::b", "x, (y)"), ("one_of", "['a b', 'c']"))),
    ],
)
def test_checks_are_told_apart(bounds: str, checks: tuple[tuple[str, str], ...]) -> None:
    assert checks_in(bounds) == checks
