# SPDX-License-Identifier: Apache-2.0
"""Writes the text of a plan: cut once at every slot, then joined for each robot."""

from bisect import bisect_left
from collections.abc import Iterable
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import Finding, locate
from multibot_rewrite.base.model import Change, Claim, Edit
from multibot_rewrite.base.naming import Naming
from multibot_rewrite.description.rewriters.forms import Declared
from multibot_rewrite.description.rewriters.renaming import ROBOT_SLOT, respelled
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.description.steps.document import Document, path_of, silenced, tag_end
from multibot_rewrite.description.steps.plan import Plan


def cut(source: bytes, edits: Iterable[Edit]) -> list[bytes]:
    """Return the source with all edits applied, in pieces; the robot's name goes between them.

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
    """Return the text for one robot."""
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


def list_changes(template: Template, robot: str) -> list[Change]:
    """Return every renamed value at its place in the source, and every inserted one at its parent's."""
    inventory, plan = template.inventory, template.plan
    source = inventory.document.source
    changes = []
    for claim, spelling in zip(inventory.claims, plan.renames.values, strict=True):
        if spelling:
            new = respelled(claim.value, spelling, robot)
            changes.append(_value_change(source, claim, spelling[0].kind, new))
    for claim, text in plan.collisions:
        changes.append(_value_change(source, claim, "collision", text.replace(ROBOT_SLOT, robot)))
    starts = dict(zip(inventory.document.root.iter("*"), inventory.document.starts, strict=True))
    for item in plan.insertions:
        place = locate(source, starts[item.parent])
        new = item.new.replace(ROBOT_SLOT, robot)
        changes.append(Change(*place, item.kind, path_of(item.parent), item.old, new, "inserted"))
    return sorted(changes)


def _value_change(source: bytes, claim: Claim, kind: str, new: str) -> Change:
    attribute = f"@{claim.attribute}" if claim.attribute else ""
    path = path_of(claim.element) + attribute
    place = locate(source, claim.start)
    return Change(*place, kind, path, claim.value, new, claim.site.section)


class Spans:
    """The place of each element; it ends before its next sibling, or its parent's end tag."""

    def __init__(self, document: Document) -> None:
        self.document = document
        self._silent = silenced(document.source)
        self._starts = dict(zip(document.elements, document.starts, strict=True))

    def start_of(self, element: _Element) -> int:
        """Return the offset of its start tag."""
        return self._starts[element]

    def end_of(self, element: _Element) -> int:
        """Return the offset right after the element."""
        beside, above = next(element.itersiblings("*"), None), element.getparent()
        # Where something else starts: nothing of the element is there or later.
        if beside is not None:
            behind = self._starts[beside]
        elif above is None:
            behind = len(self._silent)
        else:
            behind = self._silent.rindex(b"</", 0, self.end_of(above))
        return self._silent.rindex(b">", 0, behind) + 1

    def of(self, element: _Element) -> tuple[int, int]:
        """Return where the element starts and ends."""
        return self.start_of(element), self.end_of(element)

    def text_of(self, element: _Element) -> bytes:
        """Return the bytes of the element."""
        return self.document.source[slice(*self.of(element))]

    def inside(self, element: _Element) -> tuple[int, int]:
        """Return the inside of an element, between its tags; twice its end if it has no end tag."""
        start = tag_end(self.document.source, self.start_of(element))
        end = self.end_of(element)
        return (start, self._silent.rindex(b"</", 0, end)) if start < end else (end, end)

    def first_from(self, offset: int) -> _Element | None:
        """Return the first element that starts there or later."""
        at = bisect_left(self.document.starts, offset)
        return self.document.elements[at] if at < len(self.document.elements) else None
