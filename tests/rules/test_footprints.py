# SPDX-License-Identifier: Apache-2.0
"""Checks on values: those of parameter_validators (README), and a footprint as parseVVF reads it."""

from __future__ import annotations

from typing import Any

import pytest

from multibot_rewrite.rules.files.parameter_files import beyond, polygon_of
from multibot_rewrite.rules.files.wheels import _inscribed_radius


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


NAN = float("nan")


@pytest.mark.parametrize(
    ("check", "arguments", "value", "said"),
    [
        ("gt", "[0.0]", 0.1, ""),
        ("gt", "[0.0]", 0.0, "above 0.0"),
        ("rsl::gt", "0", 0, "above 0"),
        ("gt", "", 0, ""),
        ("gt", "[a]", 0, ""),
        ("gt", "[0]", "x", ""),
        ("gt", "[0]", True, ""),
        ("gt_eq", "[1]", 1, ""),
        ("gt_eq", "[1]", 0, "at least 1"),
        ("lower_bounds", "[1]", 1, ""),
        ("lower_bounds", "[1]", 0, "at least 1"),
        ("lt", "[1]", 0, ""),
        ("lt", "[1]", 1, "below 1"),
        ("lt_eq", "[1]", 1, ""),
        ("lt_eq", "[1]", 2, "at most 1"),
        ("upper_bounds", "[1]", 1, ""),
        ("upper_bounds", "[1]", 2, "at most 1"),
        ("gt_eq_or_nan", "[1]", NAN, ""),
        ("gt_eq_or_nan", "[1]", 0.5, "at least 1"),
        ("gt_eq", "[1]", NAN, "at least 1"),
        ("fixed_size", "[2]", [1, 2], ""),
        ("fixed_size", "[2]", [1], "with a size of 2"),
        ("fixed_size", "[2]", "abc", "with a size of 2"),
        ("fixed_size", "[2]", 3, ""),
        ("size_gt", "[2]", [1, 2], "with a size above 2"),
        ("size_gt", "[2]", [1, 2, 3], ""),
        ("size_lt", "[2]", [1, 2], "with a size below 2"),
        ("size_lt", "[2]", [1], ""),
        ("lower_bounds", "[1]", [1, 2, "x"], ""),
        ("lower_bounds", "[1]", [2, 0], "at least 1 in each place"),
        ("upper_bounds", "[1]", [0, 1], ""),
        ("upper_bounds", "[1]", [0, 2], "at most 1 in each place"),
        ("gt", "[1]", [0], ""),
        ("bounds", "[0, 1]", 0, ""),
        ("bounds", "[0, 1]", 1, ""),
        ("bounds", "[0, 1]", -0.1, "from 0 to 1"),
        ("bounds", "[0, 1]", 1.1, "from 0 to 1"),
        ("bounds", "[0]", 1.1, ""),
        ("bounds", "[0, 1]", "x", ""),
        ("not_empty", "", "", "not empty"),
        ("not_empty", "", [], "not empty"),
        ("not_empty", "", "x", ""),
        ("not_empty", "", ["x"], ""),
        ("not_empty", "", ["x", ""], "without an empty name"),
        ("one_of", "[[a, b]]", "b", ""),
        ("one_of", "[[a, b]]", "c", "one of a, b"),
        ("one_of", "[[a, b]]", 3, ""),
        ("one_of", "[[1, 2]]", "c", ""),
        ("subset_of", "[[a, b]]", ["b"], ""),
        ("subset_of", "[[a, b]]", ["a", "c"], "of a, b"),
        ("subset_of", "[[a, b]]", "c", ""),
        ("unique", "", [1, 2], ""),
        ("unique", "", [1, 1], "without one twice"),
        ("unique", "", "aa", ""),
        ("some", "", [False, True], ""),
        ("some", "", [False], "true in one place or more"),
        ("some", "", False, ""),
        ("limits", "", [1, 2, 3], ""),
        ("limits", "", [1] * 6, ""),
        ("limits", "", [1, 2], "with three values (x, y, theta), or six from Lyrical on"),
        ("limits", "", 1, ""),
        ("square", "[3]", [1] * 3, ""),
        ("square", "[3]", [1] * 9, ""),
        ("square", "[3]", [1] * 6, "with 9 values, or 3 on its diagonal"),
        ("square", "[3]", 1, ""),
        ("polygon", "", "[[0, 0], [1, 0], [0, 1]]", ""),
        ("polygon", "", "[[0, 0], [1, 0]]", "of three points or more"),
        ("polygon", "", "[[0, 0], [1]]", "a list of points as text, [[x, y], ...]"),
        ("polygon", "", "", ""),
        ("polygon", "", "[]", ""),
        ("polygon", "", 1, ""),
        ("stem", "[[.yaml, .pgm]]", "map", ""),
        ("stem", "[[.yaml, .pgm]]", "map.pgm", "without .yaml or .pgm, which its reader adds"),
        ("stem", "[[.yaml, .pgm]]", 1, ""),
        ("acme::sorted", "[1]", [2, 1], ""),
    ],
)  # fmt: skip
def test_what_a_value_has_to_be(check: str, arguments: str, value: Any, said: str) -> None:
    assert beyond(check, arguments, value) == said


@pytest.mark.parametrize(
    ("points", "nearest"),
    [
        ([(2, 1), (2, -1), (-2, -1), (-2, 1)], 1.0),
        # The nearest edge goes from the last point to the first.
        ([(0.5, -2), (-3, -2), (-3, 2), (0.5, 2)], 0.5),
        # What is nearest of an edge that does not pass the middle is its end.
        ([(3, 4), (6, 4), (6, 8)], 5.0),
        ([(1, 0), (1, 0), (1, 0)], 1.0),
    ],
)
def test_how_near_to_the_middle_an_edge_is(
    points: list[tuple[float, float]], nearest: float
) -> None:
    """calculateMinAndMaxDistances of nav2_costmap_2d."""
    assert _inscribed_radius(points) == nearest
