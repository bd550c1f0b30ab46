# SPDX-License-Identifier: Apache-2.0
"""Values of JSON: one is read as what it has to be, or it is said what is wrong and where."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Collection
from typing import Any

Reader = Callable[[Any], Any]
_TYPE_NAMES = {str: "text", int: "a whole number", bool: "true or false"}
# NaN is not below it, and every whole number below it fits into a float.
_LARGEST = 1e300
# What no robot reaches, in metres. NaN is not below it, either.
FARTHEST = 1e12


class WrongValue(Exception):
    """A wrong value; ``keys`` is the path to it, the innermost key first."""

    def __init__(self, reason: str, *keys: str) -> None:
        super().__init__(reason)
        self.reason = reason
        self.keys = list(keys)


def unexpected(expected: str, value: object) -> WrongValue:
    """That something else was expected."""
    return WrongValue(f"expected {expected}, not {shown(value)}")


def read_plain(expected: type, value: object) -> object:
    """A text, whole number or truth value."""
    # Not isinstance: True is an int as well.
    if type(value) is not expected:
        raise unexpected(_TYPE_NAMES[expected], value)
    return value


def read_word(words: tuple[str, ...], value: object) -> object:
    """One of these words."""
    if value not in words:
        raise unexpected(f"one of {', '.join(words)}", value)
    return value


def read_policies(policies: Collection[str], value: object) -> object:
    """The words of policies, in any case; no file has pairs."""
    if not isinstance(value, dict):
        raise unexpected("a mapping, as {durability: transient_local}", value)
    for policy, word in value.items():
        if policy not in policies or not isinstance(word, str):
            what = f"write words of {', '.join(policies)}, as {{durability: transient_local}}"
            raise WrongValue(what, f".{policy}")
    return tuple((policy, word.upper()) for policy, word in value.items())


def read_nothing(value: object) -> object:
    """What no file has."""
    raise WrongValue("not a key of a file; leave it out")


def read_full_name(value: object) -> object:
    """A name with a slash in front."""
    if not isinstance(value, str) or not value.startswith("/"):
        raise unexpected("a full name that starts with /", value)
    return value


def read_seconds(value: object) -> object:
    """A time; null is no limit."""
    if value is None:
        return math.inf
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) <= _LARGEST:
        raise unexpected("a number or null", value)
    return float(value)


def read_transform(value: object) -> object:
    """Three numbers and four, or nothing; null is one that is none (NaN)."""
    numbers = read_list(read_seconds, value)
    if len(numbers) not in (0, 7) or not all(
        abs(it) < FARTHEST or it == math.inf for it in numbers
    ):
        raise unexpected("7 numbers: x, y, z and a quaternion x, y, z, w", value)
    return numbers


def read_list(reader: Reader, value: Any) -> tuple[Any, ...]:
    """A list of what ``reader`` reads."""
    # An empty tuple is the default of a key that is left out.
    if not isinstance(value, list) and value != ():
        raise unexpected("a list", value)
    result = []
    try:
        for item in value:
            result.append(reader(item))
    except WrongValue as wrong:
        wrong.keys.append(f"[{len(result)}]")
        raise
    return tuple(result)


def shown(value: object) -> str:
    """The value in a message."""
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= 40 else f"{text[:39]}…"
