"""Numbers in attributes. What is no finite number is None: another rule tells of it."""

from __future__ import annotations

from math import isfinite

from lxml.etree import _Element

Vector = tuple[float, float, float]


def number(text: str | None) -> float | None:
    """The finite number that a text is; ``1_0`` is one to Python only."""
    if text is None or "_" in text:
        return None
    try:
        value = float(text)
    except ValueError:
        return None
    return value if isfinite(value) else None


def value_of(element: _Element, name: str, default: float | None = None) -> float | None:
    """An attribute's number, ``default`` where the attribute is missing."""
    text = element.get(name)
    return default if text is None else number(text)


def vector(text: str | None) -> Vector | None:
    """The three numbers of a text."""
    parts = (text or "").split()
    if len(parts) != 3:
        return None
    x, y, z = (number(it) for it in parts)
    return None if x is None or y is None or z is None else (x, y, z)
