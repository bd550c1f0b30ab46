# SPDX-License-Identifier: Apache-2.0
"""A footprint as nav2_util's parseVVF reads it."""

from __future__ import annotations

import pytest

from multibot_rewrite.rules.files.bounds import polygon_of


@pytest.mark.parametrize(
    ("text", "points"),
    [
        ("[[1, 2], [3.5, -4], [0, 0]]", [(1.0, 2.0), (3.5, -4.0), (0.0, 0.0)]),
        (" [[1, 2]] ", [(1.0, 2.0)]),
        ("[]", []),
        ("", None),
        ("1", None),
        ("[[1, 2]", None),
        ("[1, 2]]", None),
        ("[1, 2]", None),
        ("[[1]]", None),
        ("[[1, 2, 3]]", None),
        ("[[1, a]]", None),
        ("[[1, true]]", None),
        ("[[1, 2], 3]", None),
    ],
)
def test_a_footprint_is_a_list_of_points(
    text: str, points: list[tuple[float, float]] | None
) -> None:
    assert polygon_of(text) == points
