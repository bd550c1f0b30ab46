# SPDX-License-Identifier: Apache-2.0
"""The JSON schemas of files that people edit, made of the records and keys of their readers."""

# Where a branch's files are read by whoever has no checkout: SchemaStore, editors.
_RAW = "https://raw.githubusercontent.com/multibot-rewrite/multibot_rewrite/main/multibot_rewrite"


def address(schema: str) -> str:
    """Return the ``$id`` of a schema, a file below the package: it stays, whatever the version."""
    return f"{_RAW}/{schema}"
