# SPDX-License-Identifier: Apache-2.0
"""Is data as a JSON Schema wants it? Yes or no, for the keywords that the fleet file's schema has.

jsonschema says what is wrong. It is asked only then: it takes longer to import than a fleet to plan.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Any

Schema = Mapping[str, Any]


def is_valid(data: Any, schema: Schema, named: Mapping[str, Schema]) -> bool:
    """Does the data follow the schema? ``named`` are those that it refers to (``$defs``).

    KeyError for a keyword that has no rule here.
    """
    if "$ref" in schema and not is_valid(data, named[schema["$ref"].rpartition("/")[2]], named):
        return False
    below = _below(data, schema)
    return (
        all(_RULES[key](data, wanted) for key, wanted in schema.items() if key not in _OTHERS)
        and all(is_valid(value, wanted, named) for value, wanted in below)
        and ("oneOf" not in schema or sum(is_valid(data, it, named) for it in schema["oneOf"]) == 1)
    )


def _below(data: Any, schema: Schema) -> list[tuple[Any, Schema]]:
    """The values in the data, each with its schema."""
    if isinstance(data, list):
        return [(it, schema["items"]) for it in data if "items" in schema]
    if not isinstance(data, dict):
        return []
    known, others = schema.get("properties", {}), schema.get("additionalProperties", {})
    each = ((value, known.get(key, others)) for key, value in data.items())
    return [(value, _NEVER if wanted is False else wanted) for value, wanted in each]


def _has_type(data: Any, wanted: str | list[str]) -> bool:
    return any(_TYPES[it](data) for it in ([wanted] if isinstance(wanted, str) else wanted))


def _is_number(data: Any) -> bool:
    return isinstance(data, int | float) and not isinstance(data, bool)


_NEVER: Schema = {"enum": ()}
_OTHERS = {
    *("$schema", "$id", "$defs", "$comment", "title", "description"),  # words
    *("$ref", "oneOf", "items", "properties", "additionalProperties"),  # followed above
}
_TYPES: Mapping[str, Callable[[Any], bool]] = {
    "array": lambda it: isinstance(it, list),
    "object": lambda it: isinstance(it, dict),
    "string": lambda it: isinstance(it, str),
    "boolean": lambda it: isinstance(it, bool),
    "number": _is_number,
    "integer": lambda it: _is_number(it) and it == it // 1,
}
_RULES: Mapping[str, Callable[[Any, Any], bool]] = {
    "type": _has_type,
    "enum": lambda it, words: it in words,
    "required": lambda it, keys: not isinstance(it, dict) or all(key in it for key in keys),
    "pattern": lambda it, text: not isinstance(it, str) or bool(re.search(text, it)),
    "minLength": lambda it, least: not isinstance(it, str) or len(it) >= least,
    "minItems": lambda it, least: not isinstance(it, list) or len(it) >= least,
    "maxItems": lambda it, most: not isinstance(it, list) or len(it) <= most,
    "minimum": lambda it, least: not _is_number(it) or it >= least,
    "maximum": lambda it, most: not _is_number(it) or it <= most,
}
