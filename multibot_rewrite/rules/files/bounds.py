# SPDX-License-Identifier: Apache-2.0
"""The checks of generate_parameter_library on a value, and those of ``demanded.schema``.

Source: PickNikRobotics/rsl and generate_parameter_library, parameter_validators (README, "Built-In
Validators"); control_filters of ros2_controllers take nan as well.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from operator import eq, ge, gt, le, lt
from typing import Any, TypeGuard

from multibot_rewrite.base.bounded import load_yaml
from multibot_rewrite.base.model import InputError

_Number = Callable[[float, float], bool]
# Check -> whether a number holds it, and its words.
_NUMBERS: dict[str, tuple[_Number, str]] = {
    "gt": (gt, "above"),
    "lt": (lt, "below"),
    **dict.fromkeys(("gt_eq", "lower_bounds"), (ge, "at least")),
    **dict.fromkeys(("lt_eq", "upper_bounds"), (le, "at most")),
}
_SIZES: dict[str, tuple[_Number, str]] = {
    "fixed_size": (eq, "with a size of"),
    "size_gt": (gt, "with a size above"),
    "size_lt": (lt, "with a size below"),
}
_OR_NAN = "_or_nan"


def beyond(check: str, arguments: str, value: Any) -> str:
    """Return what a value has to be and is not; empty if it is, or if nobody can read the check."""
    name = check.rpartition("::")[2]
    try:
        given = load_yaml(arguments, "") if arguments else []
    except InputError:
        return ""
    given = given if isinstance(given, list) else [given]
    if name.endswith(_OR_NAN):
        name = name.removesuffix(_OR_NAN)
        if isinstance(value, float) and math.isnan(value):
            return ""
    first: Any = given[0] if given else None
    if name in _NUMBERS and is_number(value) and is_number(first):
        holds, words = _NUMBERS[name]
        return "" if holds(value, first) else f"{words} {first}"
    if name in _SIZES and isinstance(value, str | list) and is_number(first):
        holds, words = _SIZES[name]
        return "" if holds(len(value), first) else f"{words} {first}"
    return _SHAPES[name](first, value) if name in _SHAPES else _of_many(name, given, value)


def _of_many(name: str, given: list[Any], value: Any) -> str:
    first: Any = given[0] if given else None
    if name in ("lower_bounds", "upper_bounds") and isinstance(value, list) and is_number(first):
        holds, words = _NUMBERS[name]
        every = all(holds(it, first) for it in value if is_number(it))
        return "" if every else f"{words} {first} in each place"
    if name == "bounds" and is_number(value) and len(given) == 2:
        return "" if given[0] <= value <= given[1] else f"from {given[0]} to {given[1]}"
    if name == "not_empty" and value in ("", []):
        return "not empty"
    if name == "not_empty" and isinstance(value, list) and "" in value:
        return "without an empty name"  # it is taken, and no interface has that name
    return _of_list(name, first, value)


def _of_list(name: str, choices: Any, value: Any) -> str:
    if not isinstance(choices, list) or not all(isinstance(it, str) for it in choices):
        return ""
    words = ", ".join(choices)
    if name == "one_of" and isinstance(value, str) and value not in choices:
        return f"one of {words}"
    if name == "subset_of" and isinstance(value, list) and not set(value) <= set(choices):
        return f"of {words}"
    return ""


def _limits(_: Any, value: Any) -> str:
    known = not isinstance(value, list) or len(value) in (3, 6)
    return "" if known else "with three values (x, y, theta), or six from Lyrical on"


def _square(side: Any, value: Any) -> str:
    known = not isinstance(value, list) or len(value) in (side, side * side)
    return "" if known else f"with {side * side} values, or {side} on its diagonal"


def _polygon(_: Any, value: Any) -> str:
    """Return what a footprint has to be and is not, as nav2_util parseVVF reads it; empty if right."""
    if not isinstance(value, str) or value in ("", "[]"):
        return ""
    points = polygon_of(value)
    if points is None:
        return "a list of points as text, [[x, y], ...]"
    return "" if len(points) >= 3 else "of three points or more"


def polygon_of(text: str) -> list[tuple[float, float]] | None:
    """Return the points of a footprint; None for a text that is none."""
    inner = text.strip()
    if not (inner.startswith("[") and inner.endswith("]") and inner.count("[") == inner.count("]")):
        return None
    try:
        read = load_yaml(inner, "")
    except InputError:
        return None
    points = read if isinstance(read, list) else []
    pairs = all(isinstance(it, list) and len(it) == 2 for it in points)
    if not pairs or any(isinstance(it, bool) for point in points for it in point):
        return None
    try:
        return [(float(x), float(y)) for x, y in points]
    except (TypeError, ValueError):
        return None


def _unique(_: Any, value: Any) -> str:
    twice = isinstance(value, list) and len(set(value)) < len(value)
    return "without one twice" if twice else ""


def _some(_: Any, value: Any) -> str:
    none = isinstance(value, list) and True not in value
    return "true in one place or more" if none else ""


def _stem(endings: Any, value: Any) -> str:
    ended = isinstance(value, str) and value.endswith(tuple(endings))
    return f"without {' or '.join(endings)}, which its reader adds" if ended else ""


_SHAPES: dict[str, Callable[[Any, Any], str]] = {
    it.__name__[1:]: it for it in (_limits, _square, _polygon, _unique, _some, _stem)
}


def is_number(value: Any) -> TypeGuard[float]:
    """Return whether it is a number, and no truth value."""
    return isinstance(value, int | float) and not isinstance(value, bool)
