# SPDX-License-Identifier: Apache-2.0
"""The JSON schema of a file of a system: ``python -m multibot_rewrite.system.schema``."""

from __future__ import annotations

import json
from types import NoneType
from typing import Any, get_args, get_origin, get_type_hints

from multibot_rewrite.system.json import (
    ALLOWED_WORDS,
    FULL_NAMES,
    LEFT_OUT,
    MAYBE_FULL_NAMES,
    SCHEMA,
)
from multibot_rewrite.system.records import System

_PLAIN = {str: "string", int: "integer", bool: "boolean"}


def schema() -> dict[str, object]:
    """JSON schema, draft 2020-12."""
    found: dict[str, object] = {}
    top = _record(System, found)
    top["properties"] = {"schema": {"const": SCHEMA}, **top["properties"]}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "$id": "urn:multibot_rewrite:system",
        "title": "A system of robots: multibot snapshot",
        **top,
        "required": ["schema"],
        "$defs": dict(sorted(found.items())),
    }


def _record(kind: Any, found: dict[str, object]) -> dict[str, Any]:
    hints = get_type_hints(kind)
    usual = kind._field_defaults
    return {
        "type": "object",
        "description": " ".join(kind.__doc__.split()),
        "properties": {
            name: _field(kind, name, it, found)
            for name, it in hints.items()
            if LEFT_OUT.get(kind) != name
        },
        "required": [name for name in hints if name not in usual],
        "additionalProperties": False,
    }


def _field(kind: Any, name: str, hint: Any, found: dict[str, object]) -> dict[str, object]:
    if words := ALLOWED_WORDS.get((kind, name)):
        return {"enum": list(words)}
    made = _value(hint, found)
    if MAYBE_FULL_NAMES.get(kind) == name:
        return {**made, "pattern": "^(/|$)"}
    return {**made, "pattern": "^/"} if (kind, name) in FULL_NAMES else made


def _value(hint: Any, found: dict[str, object]) -> dict[str, object]:
    options = get_args(hint)
    if NoneType in options:
        return {"anyOf": [_value(options[0], found), {"type": "null"}]}
    if get_origin(hint) is tuple:
        return {"type": "array", "items": _value(options[0], found)}
    if hasattr(hint, "_fields"):
        if hint.__name__ not in found:
            found[hint.__name__] = {}
            found[hint.__name__] = _record(hint, found)
        return {"$ref": f"#/$defs/{hint.__name__}"}
    return {"type": ["number", "null"]} if hint is float else {"type": _PLAIN[hint]}


if __name__ == "__main__":
    print(json.dumps(schema(), indent=1))
