# SPDX-License-Identifier: Apache-2.0
"""What editors read in a file that a command begins for its user."""

from __future__ import annotations

import os

from multibot_rewrite.base.bounded import read_bytes

_PACKAGE = os.path.dirname(os.path.dirname(__file__))
# The schemas of what people edit, below this package.
FLEET, NODES, PLAN = (
    "fleet/fleet.schema.json",
    "knowledge/nodes.schema.json",
    "spelling/plan.schema.json",
)


def schema_line(schema: str, folder: str) -> str:
    """The comment by which yaml-language-server (VS Code, Vim, Emacs) finds a schema of this package:
    relative where it is installed below ``folder``, in which the file will be."""
    path = os.path.join(_PACKAGE, schema)
    below = os.path.relpath(path, folder or os.curdir)
    return line_of(path if below.startswith(os.pardir) else below)


def line_of(path: str) -> str:
    """The comment that names the schema at a path, which is relative to the file or absolute."""
    return f"# yaml-language-server: $schema={path}"


def schema_text(schema: str) -> bytes:
    """A schema of this package, to be written beside a file that is the same on every machine."""
    return read_bytes(os.path.join(_PACKAGE, schema))
