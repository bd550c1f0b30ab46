"""The text of the tables that lie beside this module."""

from __future__ import annotations

import os

_FOLDER = os.path.dirname(__file__)


def table_text(file: str) -> str:
    """A table as it is written; ``pathlib`` would be loaded for it alone."""
    with open(os.path.join(_FOLDER, file), encoding="utf-8") as table:
        return table.read()
