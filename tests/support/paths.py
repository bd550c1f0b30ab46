# SPDX-License-Identifier: Apache-2.0
"""Where things are in the repository, and beside it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

ROOT = Path(__file__).parents[2]
SUPPORT = ROOT / "tests" / "support"
FIXTURES = ROOT / "fixtures"
ROBOTS = FIXTURES / "robots"
CORPUS = ROOT.parent / "shared" / "corpus"


def fixture_text(name: str) -> str:
    """Return a text that a test alone reads; it may be no valid file of its kind."""
    return (FIXTURES / "texts" / name).read_text()


def write_files(folder: Path, texts: Mapping[str, str]) -> None:
    """Write texts into files of a folder, by their paths below it."""
    for path, text in texts.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text)
