# SPDX-License-Identifier: Apache-2.0
"""Numbers in attributes. What is not a finite number is None: another rule reports it."""

from __future__ import annotations

from functools import lru_cache
from math import isfinite

from lxml.etree import _Element

Vector = tuple[float, float, float]


def number(text: str | None) -> float | None:
    """Return the finite number in a text, or None; ``1_0``, which only Python reads, is none."""
    if text is None or "_" in text:
        return None
    try:
        value = float(text)
    except ValueError:
        return None
    return value if isfinite(value) else None


def value_of(element: _Element, name: str, default: float | None = None) -> float | None:
    """Return an attribute's number, ``default`` if the attribute is missing."""
    text = element.get(name)
    return default if text is None else number(text)


@lru_cache(maxsize=4096)  # values come again, and several rules read the same ones
def numbers(text: str) -> tuple[float, ...] | None:
    """Return the finite numbers of a text; None if a part of it is not a number."""
    if "_" in text:
        return None
    try:
        values = tuple(map(float, text.split()))
    except ValueError:
        return None
    return values if all(map(isfinite, values)) else None


def vector(text: str | None) -> Vector | None:
    """Return the three numbers of a text, or None."""
    values = numbers(text or "")
    if values is None or len(values) != 3:
        return None
    x, y, z = values
    return x, y, z
