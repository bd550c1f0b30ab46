"""A remark: what a check says about a value, before it is a finding with a line and a level.

A rewrite prints it with the place of its element; the lint needs the element and the attribute.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.model import Claim, Finding
from multibot_rewrite.steps.document import Document, finding


class Remark(NamedTuple):
    """``start`` is the offset of the element's start tag; ``attribute`` is empty for its text and
    None for the element itself."""

    element: _Element
    start: int
    attribute: str | None
    code: str
    message: str
    hint: str = ""


def about(claim: Claim, code: str, message: str, hint: str = "") -> Remark:
    """A remark about a claimed value."""
    return Remark(claim.element, claim.start, claim.attribute, code, message, hint)


def to_findings(document: Document, remarks: Iterable[Remark], level: str) -> Iterator[Finding]:
    """The remarks as findings."""
    for it in remarks:
        yield finding(document, it.start, it.code, level, it.message, it.hint)
