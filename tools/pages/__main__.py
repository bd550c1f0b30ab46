# SPDX-License-Identifier: Apache-2.0
"""``python -m tools.pages FOLDER`` writes the pages that are made with the site."""

from __future__ import annotations

import sys
from pathlib import Path

from tools.pages.every import every_page


def main(folder: Path) -> None:
    """Write all of them below a folder."""
    for name, text in every_page().items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
