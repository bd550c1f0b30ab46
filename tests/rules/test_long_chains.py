# SPDX-License-Identifier: Apache-2.0
"""Frames above which no way ends: found by hand for small trees, and in one pass for long chains."""

from __future__ import annotations

import pytest

from multibot_rewrite.rules.system.transforms import _that_end_nowhere


@pytest.mark.parametrize(
    ("parents", "left"),
    [
        ({}, {}), ({"b": {"a"}, "c": {"b"}}, {}), ({"a": {"a"}}, {"a": {"a"}}),
        ({"a": {"b"}, "b": {"a"}, "c": {"b"}}, {"a": {"b"}, "b": {"a"}, "c": {"b"}}),
        # One way of c ends, the other does not: the frame above which the way ends counts no more.
        ({"a": {"b"}, "b": {"a"}, "c": {"b", "d"}, "d": {"map"}}, {"a": {"b"}, "b": {"a"}, "c": {"b"}}),
    ],
)  # fmt: skip
def test_the_frames_above_which_no_way_ends(
    parents: dict[str, set[str]], left: dict[str, set[str]]
) -> None:
    before = {child: set(above) for child, above in parents.items()}
    assert _that_end_nowhere(parents) == left
    assert parents == before, "what is given stays as it is"


def test_a_long_chain_takes_a_pass() -> None:
    """With a pass for each frame this would be 1,800,000,000 steps."""
    assert _that_end_nowhere({str(at): {str(at + 1)} for at in range(60_000)}) == {}
