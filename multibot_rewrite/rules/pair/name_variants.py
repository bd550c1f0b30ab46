# SPDX-License-Identifier: Apache-2.0
"""Wrong names of a frame that are usual: without the robot's name, or with it once more."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.system.ownership import SEPARATORS


def name_variants(plain: str, frame: str, tag: str) -> Iterator[str]:
    """Without the robot's name (``plain``), and with its ``tag`` added once more."""
    if plain != frame:
        yield plain
    for separator in ("/", *SEPARATORS):
        yield f"{tag}{separator}{frame}"
        yield f"{frame}{separator}{tag}"
