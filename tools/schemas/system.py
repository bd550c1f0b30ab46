# SPDX-License-Identifier: Apache-2.0
"""The JSON schema of a file of a system: ``python -m tools.schemas.system``."""

from __future__ import annotations

import json
from collections.abc import Mapping
from types import NoneType
from typing import Annotated, Any, get_args, get_origin, get_type_hints

from multibot_rewrite.base import editors
from multibot_rewrite.system.json import BEFORE, SCHEMA
from multibot_rewrite.system.nested import ROW, WHEN
from multibot_rewrite.system.record_values import LEFT_OUT, POLICIES, POLICY_NAMES, SHORT, needed
from multibot_rewrite.system.records import KINDS, ROLES, SURE_WORDS, End, Node, Robot, Sure, System
from tools.schemas import address

_PLAIN = {str: "string", int: "integer", bool: "boolean"}
_TEXT = {"type": "string"}
_ROW = {
    "type": "array",
    "description": f"[{', '.join(ROW)}], and {WHEN} for what only may be there; types are"
    " joined with |",
    "prefixItems": [
        {"enum": [*ROLES]}, {"enum": [*KINDS]}, {"type": "string", "pattern": "^/"},
        _TEXT, _TEXT, _TEXT,
    ],
    "items": False,
    "minItems": len(ROW),
}  # fmt: skip
_SCALAR = {"type": ["string", "number", "boolean"]}
_SCALARS = {"anyOf": [_SCALAR, {"type": "array", "items": _SCALAR}]}
# What may be below a record; what it is of is not said again.
_BELOW: Mapping[type, dict[str, dict[str, object]]] = {
    Robot: {"nodes": {"type": ["array", "null"], "items": {"$ref": "#/$defs/Node"}}},
    Node: {
        "ends": {"type": ["array", "null"], "items": {"anyOf": [_ROW, {"$ref": "#/$defs/End"}]}},
        "parameters": {"type": ["object", "null"], "additionalProperties": _SCALARS},
    },
}


def schema() -> dict[str, object]:
    """JSON schema, draft 2020-12."""
    found: dict[str, object] = {}
    top = _record(System, found)
    top["properties"] = {"schema": {"enum": [BEFORE, SCHEMA]}, **top["properties"]}
    top["properties"]["ends"]["items"]["required"] = ["node"]
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "$id": address(editors.PLAN),
        "title": "A system of robots: multibot snapshot, plan, build, check",
        **top,
        "required": ["schema"],
        "$defs": dict(sorted(found.items())),
    }


def _record(kind: Any, found: dict[str, object]) -> dict[str, Any]:
    hints = get_type_hints(kind, include_extras=True)
    return {
        "type": "object",
        "description": " ".join(kind.__doc__.split()),
        "properties": {
            name: _value(it, found) for name, it in hints.items() if LEFT_OUT.get(kind) != name
        }
        | _BELOW.get(kind, {}),
        "required": [it for it in needed(kind, hints) if (kind, it) != (End, "node")],
        "additionalProperties": False,
    }


def _value(hint: Any, found: dict[str, object]) -> dict[str, object]:
    options = get_args(hint)
    if hint == POLICIES:
        names = {"enum": [*POLICY_NAMES]}
        return {"type": "object", "propertyNames": names, "additionalProperties": _TEXT}
    if get_origin(hint) is Annotated:
        return _limited(options[0], options[1], found)
    if NoneType in options:
        return {"anyOf": [_value(options[0], found), {"type": "null"}]}
    if get_origin(hint) is tuple:
        return {"type": "array", "items": _value(options[0], found)}
    if hasattr(hint, "_fields"):
        if hint.__name__ not in found:
            found[hint.__name__] = {}
            found[hint.__name__] = _record(hint, found)
        whole: dict[str, object] = {"$ref": f"#/$defs/{hint.__name__}"}
        short = {"enum": [*SURE_WORDS]} if hint is Sure else _TEXT
        return {"anyOf": [short, whole]} if hint in SHORT else whole
    return {"type": ["number", "null"]} if hint is float else {"type": _PLAIN[hint]}


def _limited(inner: Any, limit: object, found: dict[str, object]) -> dict[str, object]:
    if isinstance(limit, tuple):
        return {"enum": [*limit]}
    return {**_value(inner, found), **({"pattern": limit} if isinstance(limit, str) else {})}


if __name__ == "__main__":
    print(json.dumps(schema(), indent=1))
