# SPDX-License-Identifier: Apache-2.0
"""The page of all measurements: each program writes a section of its own."""

from __future__ import annotations

import re
from pathlib import Path

PAGE = Path(__file__).parent.parent / "docs" / "contributing" / "measurements.md"
_FENCED = re.compile(r"(^```.*?^```$)", re.MULTILINE | re.DOTALL)


def write_section(text: str) -> None:
    """Put a text in the place of the section with its title, or behind the last one."""
    parts = _FENCED.split(text)
    lower = (it if it.startswith("```") else re.sub(r"^#", "##", it, flags=re.M) for it in parts)
    section = "".join(lower).strip() + "\n"
    title = section.partition("\n")[0]
    before, found, after = PAGE.read_text().partition(f"\n{title}\n")
    _, next_one, rest = after.partition("\n## ") if found else ("", "", "")
    PAGE.write_text(f"{before.rstrip()}\n\n{section}" + f"{next_one}{rest}")
