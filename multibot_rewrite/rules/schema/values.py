# SPDX-License-Identifier: Apache-2.0
"""What an attribute's value must be by its type in ``urdf.schema``, and what is wrong with it."""

from __future__ import annotations

import re
from collections.abc import Sequence
from math import isfinite

from multibot_rewrite.base.lazy import lazy_compile

_SCALAR = r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d\d?)?"
_UNIT = r"(?:0+(?:\.\d*)?|\.\d+|1(?:\.0*)?)"
# What most values look like. urdfdom accepts spaces before a single number and none after it.
_ONE = lazy_compile(rf" *{_SCALAR}", re.ASCII)
_THREE = lazy_compile(rf" *{_SCALAR}(?: +{_SCALAR}){{2}} *", re.ASCII)
FINE = {
    "number": _ONE,
    "numbers": _THREE,
    "rgba": lazy_compile(rf" *{_UNIT}(?: +{_UNIT}){{3}} *", re.ASCII),
    "quaternion": lazy_compile(rf" *{_SCALAR}(?: +{_SCALAR}){{3}} *", re.ASCII),
    "unsigned": _ONE,
    "positive": _ONE,
    "positives": _THREE,
    "version": lazy_compile(r"1\.[0-2]", re.ASCII),
    "filled": lazy_compile(r"\S.*"),
}
_LONG = 200
COUNTS = {
    "number": 1,
    "numbers": 3,
    "rgba": 4,
    "quaternion": 4,
    "unsigned": 1,
    "positive": 1,
    "positives": 3,
}
# What numbers of these types may not be.
_BEYOND = {"unsigned": "below 0", "positive": "not above 0", "positives": "not above 0"}
_NUMBER = lazy_compile(r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?", re.ASCII)
_INFINITE = lazy_compile(r"[-+]?(?:nan|inf|infinity)", re.IGNORECASE)
_UNITS = lazy_compile(r"[-+.\deE]*\d\.?\s*[A-Za-z°%]+", re.ASCII)


def is_fine(kind: str, value: str) -> bool:
    """Does a value look like most correct ones? (Others may be correct as well.)"""
    if len(value) > _LONG or kind not in FINE or FINE[kind].fullmatch(value) is None:
        return False
    if kind == "unsigned":
        return not value.lstrip().startswith("-")
    # Each number has a digit that is not 0 in front of its exponent, and no minus.
    return kind not in _BEYOND or all(it.strip("+0.")[:1].isdigit() for it in value.split())


def shortened(text: str) -> str:
    """A text that fits into a message."""
    return text if len(text) < 60 else f"{text[:56]} ..."


def wrong_numbers(value: str, kind: str) -> tuple[str, str, str]:
    """(fault, what is wrong, hint) of a value that should be numbers; empty where fine."""
    words = value.split()
    odd = next((word for word in words if not _NUMBER.fullmatch(word)), None)
    if not words:
        return "value", ", which is not a number", ""
    if odd is not None and not _INFINITE.fullmatch(odd):
        return (
            "value",
            f": {shortened(odd)!r} is not a number" * (odd != value),
            _number_hint(value, odd),
        )
    if odd is not None or not all(isfinite(float(word)) for word in words):
        return "value", ", which is not finite", "write a large number, or leave it out"
    return _miscounted(value, [float(word) for word in words], kind)


def _miscounted(value: str, numbers: Sequence[float], kind: str) -> tuple[str, str, str]:
    """The same for a value of nothing but numbers."""
    wanted = COUNTS[kind]
    if len(numbers) != wanted:
        count = f"{len(numbers)} numbers" if len(numbers) != 1 else "1 number"
        return "value", f": {count} of {wanted}", ""
    if kind == "rgba" and not all(0 <= it <= 1 for it in numbers):
        return "value", ": outside of 0 to 1", "divide by 255" if max(numbers) > 1 else ""
    if wanted == 1 and value.endswith(" "):
        return "value", ", with a space after it", "delete the space"
    if kind in _BEYOND and (min(numbers) < 0 or (kind != "unsigned" and 0 in numbers)):
        return "range", f", which is {_BEYOND[kind]}", ""
    return "", "", ""


def _number_hint(value: str, odd: str) -> str:
    if "," in value:
        single = re.fullmatch(r"\s*[-+]?\d+,\d+\s*", value)
        return "use a decimal point" if single else "separate numbers by spaces, not commas"
    if "$" in value:
        return "expand it with xacro first"
    if _UNITS.fullmatch(odd):
        return "leave the unit out: lengths are metres, angles radians, masses kilograms"
    return ""
