# SPDX-License-Identifier: Apache-2.0
"""The JSON schema of a plan's file: ``python -m multibot_rewrite.spelling.plan_schema``."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any

from multibot_rewrite.base.findings.finding import LEVELS
from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.spelling.plan_states import GAP_KEYS, LIFECYCLE
from multibot_rewrite.spelling.plan_states import KEYS as STATE_KEYS
from multibot_rewrite.spelling.plan_value import (
    BY_NODE,
    DOMAINS,
    KEYS,
    OPTIONAL_KEYS,
    OPTIONAL_ROBOT_KEYS,
    QOS_KEYS,
    ROBOT_KEYS,
    SENDS,
    TOPIC_KEYS,
)
from multibot_rewrite.system.environment import MAX_DOMAIN
from multibot_rewrite.system.records import KINDS, PUBLISHES, ROLES, SERVES, SUBSCRIBES

Schema = dict[str, Any]
_TEXT: Schema = {"type": "string"}
_NAME: Schema = {"type": "string", "pattern": "^/"}
_TEXTS: Schema = {"type": "array", "items": _TEXT}
_ROW: Schema = {
    "type": "array",
    "description": "[role, kind, name, type, name in the node's code]",
    "prefixItems": [{"enum": [*ROLES]}, {"enum": [*KINDS]}, _NAME, _TEXT, _TEXT],
    "items": False,
    "minItems": 5,
}
# A node without planned endpoints may have nothing behind its name.
_ROWS: Schema = {"type": ["array", "null"], "items": _ROW}
_PARAMETER: Schema = {"type": ["string", "number", "boolean"]}


def schema() -> Schema:
    """JSON schema, draft 2020-12."""
    known = {
        "layout": _TEXT,
        "shared_nodes": {"anyOf": [_by_name(_ROWS), _TEXTS, {"type": "null"}]},
        "shared_topics": _TEXTS,
        "shared_frames": _TEXTS,
        "robots": {"type": "object", "additionalProperties": _robot()},
        "distro": {"enum": ["", *RELEASES]},
        "ignored_nodes": _said(_TEXTS, "patterns of nodes that may come and go"),
        DOMAINS: _said(
            {
                "type": "object",
                "additionalProperties": {"type": "integer", "minimum": 0, "maximum": MAX_DOMAIN},
            },
            "the ROS_DOMAIN_ID of each robot, and of shared_nodes",
        ),
        "topics": _by_name(_topic()),
        "one_of": _said({"type": "array", "items": _TEXTS}, "nodes of which one runs"),
        "states": _by_name(_state()),
        **{key: _by_name(_TEXT) for key in BY_NODE},
        SENDS: _said(_by_name(_TEXT), "parent -> child, parent -> child"),
        "open": _said({"type": ["array", "null"], "items": _gap()}, "reported with the graph"),
    }
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "$id": "urn:multibot_rewrite:plan",
        "title": "The planned graph of a fleet: multibot plan, multibot check",
        **_keys(known, KEYS, OPTIONAL_KEYS),
    }


def _robot() -> Schema:
    known = {
        "tf": _NAME,
        "frames": _TEXTS,
        "nodes": {**_by_name(_ROWS), "type": ["object", "null"]},
        "other_frames": _said(_TEXTS, "frames that may come besides"),
        "optional": _said(_TEXTS, "nodes that may be missing"),
        "spelled": _said(_TEXT, "what stands for it in its frames, where that is not its name"),
    }
    return _keys(known, ROBOT_KEYS, OPTIONAL_ROBOT_KEYS)


def _keys(known: Schema, needed: Iterable[str], optional: Iterable[str] = ()) -> Schema:
    properties = {key: known[key] for key in (*needed, *optional)}
    closed = {"type": "object", "properties": properties, "additionalProperties": False}
    return {**closed, "required": [*needed]} if needed else closed


def _by_name(value: Schema) -> Schema:
    return {"type": "object", "propertyNames": _NAME, "additionalProperties": value}


def _said(value: Schema, about: str) -> Schema:
    return {"description": about, **value}


def _topic() -> Schema:
    either = {"enum": [PUBLISHES, SUBSCRIBES, SERVES]}
    known = {
        "senders": _TEXTS,
        "one_sender": {"type": "boolean"},
        "qos": _keys(dict.fromkeys(QOS_KEYS, _TEXT), (), QOS_KEYS),
        "bridge": {"type": "array", "items": either, "minItems": 1, "maxItems": 2},
        "type": _TEXT,
    }
    return _keys(known, (), TOPIC_KEYS)


def _state() -> Schema:
    several = {"type": "array", "items": _PARAMETER}
    values = {"type": "object", "additionalProperties": {"anyOf": [_PARAMETER, several]}}
    return _keys(
        {"lifecycle": {"enum": [*LIFECYCLE]}, "host": _TEXT, "parameters": values}, (), STATE_KEYS
    )


def _gap() -> Schema:
    return _keys({**dict.fromkeys(GAP_KEYS, _TEXT), "level": {"enum": [*LEVELS]}}, GAP_KEYS)


if __name__ == "__main__":
    print(json.dumps(schema(), indent=1))
