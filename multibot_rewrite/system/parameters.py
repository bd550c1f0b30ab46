"""The value of a parameter as a text, by which two are compared."""

from __future__ import annotations

import json


def parameter_text(value: object) -> str:
    """A value as JSON: ``true``, ``1``, ``1.0``, ``"base_link"``."""
    return json.dumps(value, ensure_ascii=False)


def parameter_value(text: str) -> object:
    """What a ``parameter_text`` was made of; the text itself where a file has something else there."""
    try:
        return json.loads(text)
    except (ValueError, RecursionError):
        return text
