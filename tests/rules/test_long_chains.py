# SPDX-License-Identifier: Apache-2.0
"""Circles of transforms: found by hand for small trees, and in one pass for long chains."""

from __future__ import annotations

import pytest
from counted_steps import steps

from multibot_rewrite.rules.system.transforms import _circles


@pytest.mark.parametrize(
    ("parents", "circles"),
    [
        ({}, []),
        ({"b": {"a"}, "c": {"b"}}, []),
        ({"a": {"a"}}, [{"a"}]),
        ({"a": {"b"}, "b": {"a"}, "c": {"b"}}, [{"a", "b"}]),
        # One way of c ends, the other does not: the frame above which the way ends counts no more.
        ({"a": {"b"}, "b": {"a"}, "c": {"b", "d"}, "d": {"map"}}, [{"a", "b"}]),
        ({"a": {"b"}, "b": {"a"}, "c": {"d"}, "d": {"c"}}, [{"a", "b"}, {"c", "d"}]),
        # Two circles with one frame in common: after the first one no other is left.
        ({"a": {"b", "c"}, "b": {"a"}, "c": {"a"}}, [{"a", "b"}]),
    ],
)
def test_circles_that_have_no_frame_in_common(
    parents: dict[str, set[str]], circles: list[set[str]]
) -> None:
    before = {child: set(above) for child, above in parents.items()}
    assert [{*it} for it in _circles(parents)] == circles
    assert parents == before, "what is given stays as it is"


def test_a_circle_goes_from_the_parent_to_the_child() -> None:
    (circle,) = _circles({"a": {"c"}, "b": {"a"}, "c": {"b"}})
    assert "".join(circle) in ("abc", "bca", "cab")


def test_a_long_chain_takes_a_pass() -> None:
    """With a pass for each frame this would be a hundred times as much."""

    def chain(length: int) -> dict[str, set[str]]:
        return {str(at): {str(at + 1)} for at in range(length)}

    assert [*_circles(chain(60_000))] == []
    assert steps(lambda: [*_circles(chain(2000))]) < 11 * steps(lambda: [*_circles(chain(200))])
