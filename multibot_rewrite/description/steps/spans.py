# SPDX-License-Identifier: Apache-2.0
"""Where whole elements are in the bytes of a document."""

from __future__ import annotations

from bisect import bisect_left

from lxml.etree import _Element

from multibot_rewrite.description.steps.document import Document, silenced, tag_end


class Spans:
    """The place of each element; an element ends before its next sibling, or before the end tag
    of the one it is in."""

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
