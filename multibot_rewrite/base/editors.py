# SPDX-License-Identifier: Apache-2.0
"""What editors read in a file that a command begins for its user."""

from __future__ import annotations

import os

from multibot_rewrite.base.bounded import load_json, read_bytes

_PACKAGE = os.path.dirname(os.path.dirname(__file__))
# The schemas of what people edit, below this package.
FLEET, NODES, PLAN, LINT = (
    "fleet/fleet.schema.json",
    "knowledge/nodes.schema.json",
    "system/system.schema.json",
    "lint/lint.schema.json",
)


def schema_line(schema: str) -> str:
    """Return the comment by which yaml-language-server finds the schema next to a file."""
    return f"# yaml-language-server: $schema={schema_name(schema)}"


def schema_name(schema: str) -> str:
    """Return what a schema of this package is called next to a file that it is for."""
    return f".{os.path.basename(schema)}"


def schema_text(schema: str) -> bytes:
    """Return the bytes of a schema of this package."""
    return read_bytes(os.path.join(_PACKAGE, schema))


def may_be_written(schema: str, path: str) -> bool:
    """Return whether a path is free for a schema: nothing is there, or another version of it."""
    if not os.path.lexists(path):
        return True
    own = _name_in(os.path.join(_PACKAGE, schema))
    # Before it was an address it was a name.
    return str(_name_in(path)).startswith((str(own), "urn:multibot_rewrite:"))


def _name_in(path: str) -> object:
    """Return the ``$id`` of a schema; None for a file that is none or cannot be read."""
    try:
        read = load_json(read_bytes(path))
    except (OSError, ValueError, RecursionError):
        return None
    return read.get("$id") if isinstance(read, dict) else None
