"""A text with holes for a robot's two names: made once, filled for each robot."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import NamedTuple

from multibot_rewrite.companions.yaml_text import Splice

# Stand for the robot's name in the ROS graph, and for what is spelled into its frames and joints:
# ordinary letters, so that quoting and checks of names treat them as they will treat the names.
NAMESPACE_SLOT, TAG_SLOT = "multibotNamespaceSlot", "multibotTagSlot"
_SLOT = re.compile(f"({NAMESPACE_SLOT}|{TAG_SLOT})")


class FileTemplate(NamedTuple):
    """Pieces of text, every second one a hole."""

    pieces: tuple[str, ...]


def make_template(text: str, splices: Iterable[Splice]) -> FileTemplate:
    """The text with the splices made; their new text may hold holes. They do not overlap."""
    held: list[str] = [""]
    at = 0
    for start, end, new in sorted(set(splices)):
        assert start >= at, "two splices overlap"
        first, *rest = _SLOT.split(new)
        held[-1] += text[at:start] + first
        held += rest
        at = end
    held[-1] += text[at:]
    return FileTemplate(tuple(held))


def fill_template(template: FileTemplate, graph: str, spelled: str) -> str:
    """The text for a robot."""
    pieces = list(template.pieces)
    pieces[1::2] = [graph if hole == NAMESPACE_SLOT else spelled for hole in pieces[1::2]]
    return "".join(pieces)
