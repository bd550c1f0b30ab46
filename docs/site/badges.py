# SPDX-License-Identifier: Apache-2.0
"""Draws the badges of the README from what the package says: ``python docs/site/badges.py``."""

from __future__ import annotations

import re
import sys
from pathlib import Path

from multibot_rewrite.base.releases import RELEASES

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "docs" / "pictures"
# Of a letter of the font, about; ``textLength`` makes it fit where the font is another.
LETTER, MARGIN = 6.6, 8
SVG = """\
<svg xmlns="http://www.w3.org/2000/svg" width="{whole}" height="20" role="img">
<title>{label}: {text}</title>
<rect width="{whole}" height="20" rx="3" fill="{colour}"/>
<path d="M3 0h{inner}v20H3a3 3 0 0 1-3-3V3a3 3 0 0 1 3-3z" fill="#444"/>
<g fill="#fff" font-family="Verdana,DejaVu Sans,sans-serif" font-size="11">
<text x="8" y="14" textLength="{long}">{label}</text>
<text x="{start}" y="14" textLength="{wide}">{text}</text>
</g>
</svg>
"""


def badges() -> dict[str, str]:
    """Every badge by its file."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    pythons = re.findall(r":: (3\.\d+)$", "\n".join(project["classifiers"]), re.MULTILINE)
    return {
        "badge-version.svg": badge("version", project["version"], "#1f5fbf"),
        "badge-licence.svg": badge("licence", project["license"], "#2a7a3a"),
        "badge-python.svg": badge("Python", f"{pythons[0]} to {pythons[-1]}", "#1f5fbf"),
        "badge-ros.svg": badge("ROS 2", ", ".join(RELEASES), "#22314e"),
    }


def badge(label: str, text: str, colour: str) -> str:
    """Return a picture of two words."""
    long, wide = (round(LETTER * len(it)) for it in (label, text))
    left, whole = long + 2 * MARGIN, long + wide + 4 * MARGIN
    return SVG.format(
        label=label, text=text, colour=colour, whole=whole, inner=left - 3, long=long, wide=wide,
        start=left + MARGIN,
    )  # fmt: skip


if __name__ == "__main__":
    for name, picture in badges().items():
        (FOLDER / name).write_text(picture)
