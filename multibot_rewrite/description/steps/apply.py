# SPDX-License-Identifier: Apache-2.0
"""Plan -> text: a template is cut once at every slot, then each robot is one ``bytes.join``."""

from __future__ import annotations

from collections.abc import Iterable

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import Edit
from multibot_rewrite.base.naming import Naming
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.rewriters.forms import Declared
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.description.steps.plan import Plan


def cut(source: bytes, edits: Iterable[Edit]) -> list[bytes]:
    """The source with all edits made, in pieces; the robot's name goes between them.

    ``edits`` are in source order and do not overlap.
    """
    pieces = []
    held: list[bytes] = []
    last = 0
    for start, end, before, after in edits:
        held += (source[last:start], before)
        if after is not None:
            pieces.append(b"".join(held))
            held = [after]
        last = end
    pieces.append(b"".join(held) + source[last:])
    return pieces


def fill(pieces: list[bytes], robot: str) -> bytes:
    """The text for one robot."""
    return robot.encode().join(pieces)


class Template(NamedTuple):
    """A description ready for any number of robots: parsed, planned and cut once."""

    inventory: Inventory
    plan: Plan
    pieces: list[bytes]
    findings: list[Finding]
    naming: Naming
    tree: Tree
    urdf_declarations: Declared
