# SPDX-License-Identifier: Apache-2.0
"""The JSON schema of ``urdf-lint.toml``: ``python -m tools.schemas.lint``.

It has the keys that the reader takes. A code may be that of a later rule: the reader knows them all.
"""

from __future__ import annotations

import json
from typing import Any

from multibot_rewrite.base import editors
from multibot_rewrite.base.findings.finding import LEVELS
from multibot_rewrite.base.findings.selection import OFF
from multibot_rewrite.base.naming import SEPARATORS
from multibot_rewrite.lint.config.values import READERS
from multibot_rewrite.rules.settings import TARGETS
from tools.schemas import address

Schema = dict[str, Any]
_TEXT: Schema = {"type": "string", "minLength": 1}
# A code, the beginning of one, or the name of a rule.
_CODE = "^(M[A-Z][0-9]{0,3}|[a-z][a-z0-9-]+)$"
_VALUE: Schema = {"type": ["string", "number", "boolean"]}


def schema() -> Schema:
    """JSON schema, draft 7: what editors of TOML know."""
    known = _known()
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "$id": address(editors.LINT),
        "title": "urdf-lint: urdf-lint.toml, [tool.urdf-lint] of pyproject.toml",
        "type": "object",
        "additionalProperties": False,
        "properties": {key: known[key] for key in READERS},
    }


def _known() -> dict[str, Schema]:
    fleet = json.loads(editors.schema_text(editors.FLEET))["properties"]
    codes = _list({"type": "string", "pattern": _CODE})
    separators = dict.fromkeys(SEPARATORS, _TEXT)
    return {
        "select": _said("codes, their beginnings, or names of rules that are on", codes),
        "ignore": _said("codes, their beginnings, or names of rules that are off", codes),
        "per-file-ignores": _said(
            "a pattern of files -> rules that are off in them",
            {"type": "object", "additionalProperties": codes},
        ),
        "levels": _said(
            "a code or its beginning -> the level of what it finds",
            {
                "type": "object",
                "propertyNames": {"pattern": _CODE},
                "additionalProperties": {"enum": [*LEVELS, OFF]},
            },
        ),
        "robots": _said("robots that will be in one system: what they would share", _list(_TEXT)),
        **{key: _alone(fleet[key]) for key in ("layout", "affix", "topics", "groups", "distro")},
        "separators": _said(
            "a kind of name -> what is between it and the robot", _keys(separators)
        ),
        "shared-frames": _said("frames that all robots share", _list({"type": "string"})),
        "shared-topics": _said("topics that all robots share", _list({"type": "string"})),
        "targets": _said(
            "formats that the description is converted to", _list({"enum": [*TARGETS]})
        ),
        "roots": _said("folders in which package://NAME is looked for", _list(_TEXT)),
        "urdf": _said("the URDF of SRDF files, where it is not the one of that name", _TEXT),
        "definitions": _said("files of plugins and their parameters", _list(_TEXT)),
        "xacro": _said(
            "each is one more expansion of the files, with these arguments",
            _list(
                {
                    **_keys({"files": _TEXT, "arguments": _arguments()}),
                    "required": ["arguments"],
                }
            ),
        ),
        "exclude": _said("patterns of files that are skipped in folders", _list(_TEXT)),
        "baseline": _said("a file of findings that are known", _TEXT),
        "fail-on": _said("the lowest level at which the lint fails", {"enum": [*LEVELS]}),
        "seconds": _said(
            "the time limit for one file",
            {"type": "number", "exclusiveMinimum": 0, "maximum": 86400},
        ),
    }


def _said(about: str, it: Schema) -> Schema:
    return {"description": about, **it}


def _alone(it: Schema) -> Schema:
    """Return a key of a fleet file, with the values that are the same here."""
    return {"description": it["description"].partition(";")[0], "enum": it["enum"]}


def _list(of: Schema) -> Schema:
    return {"type": "array", "items": of}


def _keys(known: dict[str, Schema]) -> Schema:
    return {"type": "object", "properties": known, "additionalProperties": False}


def _arguments() -> Schema:
    return {"type": "object", "additionalProperties": _VALUE}


if __name__ == "__main__":
    print(json.dumps(schema(), indent=1))
