# SPDX-License-Identifier: Apache-2.0
"""What libsdformat makes of a text, by the type that is asked for.

Source: gazebosim/sdformat sdformat14_14.9.0 src/Param.cc (ValueFromStringImpl,
ParsePoseUsingStringStream, ParseColorUsingStringStream): numbers are read by stod, stoi and stoul,
which stop at what is none, vectors by a stream. What cannot be read ends the loading of the model;
in a plugin it counts as 0 or false.
"""

import re
from collections.abc import Callable, Sequence
from functools import lru_cache, partial
from math import isinf, tau
from typing import NamedTuple

from multibot_rewrite.base.lazy import lazy_compile

# No digits but 0 to 9; inf and nan in capitals, too.
_ASCII = re.ASCII | re.IGNORECASE
_REAL = lazy_compile(
    r"[-+]?(?:0[xX][\da-fA-F]+|(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?|inf|nan)", _ASCII
)
_WHOLE = lazy_compile(r"[-+]?(?:0[xX][\da-fA-F]+|\d+)", _ASCII)
_ZEROS = lazy_compile(r"\.0*")
_DIGITS = 20
# No angle is as large; a little more than a turn is one that was rounded.
TURN = tau * 1.001
# The type of a pose with rotation_format="quat_xyzw".
QUATERNION = "quat_xyzw"
_TRUTHS = ("true", "false", "1", "0")


class Misread(NamedTuple):
    """What is wrong with a value; ``fails``: nothing of it can be read."""

    problem: str
    fails: bool


@lru_cache(maxsize=4096)  # values come again
def misread(type_: str, text: str) -> Misread | None:
    """Return what is wrong with a text for that type; None where right, empty or without a rule."""
    check = CHECKS.get(type_)
    return check(text) if check and text else None


def _misread_number(text: str, *, whole: bool = False) -> Misread | None:
    if text.lower() in ("true", "false"):
        return None
    found = (_WHOLE if whole else _REAL).match(text)
    if found is None:
        return Misread("is not a number", True)
    if _is_too_large(found[0], whole):
        return Misread("is too large a number", True)
    rest = text[found.end() :]
    if not rest or (whole and _ZEROS.fullmatch(rest)):
        return None
    return Misread(f"is read as {found[0]}", False)


def _is_too_large(digits: str, whole: bool) -> bool:
    """Return whether stod, stoi or stoul throw out_of_range; for whole numbers roughly."""
    if "x" in digits.lower() or not digits[-1].isdigit():
        return False
    return len(digits) > _DIGITS if whole else isinf(float(digits))


def _misread_unsigned(text: str) -> Misread | None:
    if text.startswith("-") and text != "-1":
        return Misread("is below 0, and is read as a number above 4 billion", False)
    return _misread_number(text, whole=True)


def _misread_boolean(text: str, *, more: Sequence[str] = ()) -> Misread | None:
    known = text.lower() in (*_TRUTHS, *more)
    return None if known else Misread("is neither true nor false", not more)


def _misread_numbers(text: str, *, count: int) -> Misread | None:
    """Return what is wrong with a text of ``count`` numbers: a stream stops at the first other word."""
    read = 0
    for word in text.split():
        found = _REAL.match(word)
        if found is None or read == count:
            break
        read += 1
        if found.end() < len(word):
            break
    return Misread(f"is not {count} numbers", True) if read < count else None


def _misread_pose(text: str, *, size: int) -> Misread | None:
    words = text.split()
    if not all(map(_REAL.match, words)):
        return Misread(f"is not {size} numbers", True)
    return None if len(words) == size else Misread(f"has {len(words)} numbers of {size}", True)


def _misread_color(text: str) -> Misread | None:
    found = [_REAL.match(word) for word in text.split()]
    if len(found) not in (3, 4) or not all(found):
        return Misread("is not three or four numbers", True)
    inside = all(it and 0 <= float(it[0]) <= 1 for it in found)
    return None if inside else Misread("has a number outside of 0 to 1", True)


CHECKS: dict[str, Callable[[str], Misread | None]] = {
    **dict.fromkeys(("double", "float", "number"), _misread_number),
    **dict.fromkeys(("int", "integer"), partial(_misread_number, whole=True)),
    "unsigned_int": _misread_unsigned,
    **dict.fromkeys(("bool", "boolean"), _misread_boolean),
    "truth": partial(_misread_boolean, more=("yes", "no")),
    "vector2d": partial(_misread_numbers, count=2),
    **dict.fromkeys(("vector", "vector3"), partial(_misread_numbers, count=3)),
    "pose": partial(_misread_pose, size=6),
    QUATERNION: partial(_misread_pose, size=7),
    "color": _misread_color,
}


def number_in(text: str) -> float | None:
    """Return the number that a text begins with, as stod reads it; None for any other."""
    found = _REAL.match(text)
    return float(found[0]) if found and "x" not in found[0].lower() else None
