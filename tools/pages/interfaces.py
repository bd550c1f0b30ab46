# SPDX-License-Identifier: Apache-2.0
"""The page of what sources say, against what is known."""

from __future__ import annotations

from pathlib import Path

from tools.pages import declared, endpoints

FIXTURES = Path(__file__).parents[2] / "fixtures"
HEAD = """\
# Interfaces

What the sources of each supported release say, and how our tables differ from it. Public sources
are read and not copied; facts are kept with their place.

"""


def page() -> str:
    """Return the page, from the committed tables."""
    tables = FIXTURES / "interfaces"
    return f"{HEAD}{endpoints.section(FIXTURES)}\n{declared.section(tables)}"
