# SPDX-License-Identifier: Apache-2.0
"""The JSON schema of a file of nodes and node sets: ``python -m tools.schemas.nodes``.

It has the keys that the reader takes; what their values may be the reader says.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any

from multibot_rewrite.base import editors
from multibot_rewrite.knowledge.node_entries import ENDPOINT_KEYS, KINDS, PARAM_KEYS
from multibot_rewrite.knowledge.node_library import (
    ENTRY_KEYS,
    ENTRY_OF_NODE,
    FILE_KEYS,
    NODE_SET_KEYS,
)
from multibot_rewrite.system.records import ROLES
from tools.schemas import address

Schema = dict[str, Any]


def schema() -> Schema:
    """JSON schema, draft 2020-12."""
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "$id": address(editors.NODES),
        "title": "Nodes and node sets: multibot plan --nodes, nodes: of a fleet file",
        **_keys(
            FILE_KEYS, parts=_named("part"), nodes=_named("node"), node_sets=_named("node_set")
        ),
        "$defs": {
            "part": _keys(ROLES, **_roles()),
            "node": _keys(ENTRY_OF_NODE, **_roles(), params=_named("param")),
            "node_set": _keys(
                NODE_SET_KEYS, nodes={"type": "array", "items": _or_word(_keys(ENTRY_KEYS))}
            ),
            "endpoint": _or_several(_or_word(_keys(ENDPOINT_KEYS))),
            "param": _or_several({"anyOf": [{"enum": list(KINDS)}, _keys(PARAM_KEYS)]}),
        },
    }


def _keys(keys: Iterable[str], **known: Schema) -> Schema:
    """Return a mapping with these keys alone; of some more is ``known`` than that they may be there."""
    properties = {key: known.get(key, {}) for key in keys}
    return {"type": "object", "properties": properties, "additionalProperties": False}


def _named(kind: str) -> Schema:
    """Return what has names of the user's own."""
    return {"type": "object", "additionalProperties": {"$ref": f"#/$defs/{kind}"}}


def _roles() -> dict[str, Schema]:
    return {role: _named("endpoint") for role in ROLES}


def _or_word(one: Schema) -> Schema:
    return {"anyOf": [{"type": "string"}, one]}


def _or_several(one: Schema) -> Schema:
    """Return what differs from release to release is a list."""
    return {"anyOf": [*one["anyOf"], {"type": "array", "items": one}]}


if __name__ == "__main__":
    print(json.dumps(schema(), indent=1))
