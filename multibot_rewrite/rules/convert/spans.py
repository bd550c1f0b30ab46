# SPDX-License-Identifier: Apache-2.0
"""Where elements and attributes of a document are, and the edits of attributes."""

from __future__ import annotations

from collections.abc import Mapping

from lxml.etree import _Element

from multibot_rewrite.base.model import Edit
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.steps.document import Document, attribute_slot, tag_end


class Spanned(NamedTuple):
    """A document, and where its elements start."""

    document: Document
    starts: Mapping[_Element, int]

    @property
    def source(self) -> bytes:
        """The bytes of the document."""
        return self.document.source


def text_of(document: Document) -> Spanned:
    """The text of a document."""
    return Spanned(document, dict(zip(document.elements, document.starts, strict=True)))


def end_of(text: Spanned, element: _Element) -> int:
    """The offset right after an element's end tag."""
    end = tag_end(text.source, text.starts[element])
    if text.source[end - 2 : end] == b"/>":
        return end
    return text.source.index(b">", end_tag_of(text, element)) + 1


def end_tag_of(text: Spanned, element: _Element) -> int:
    """The offset of the end tag of an element that has one."""
    *_, last = element.iter("*")
    start, tag = text.starts[last], f"</{element.tag}".encode()
    at = text.source.index(tag, start)
    while _in_comment(text.source[start:at]):
        at = text.source.index(tag, at + 1)
    return at


def _in_comment(before: bytes) -> bool:
    return before.count(b"<!--") > before.count(b"-->")


def renamed(text: Spanned, element: _Element, name: str, new: str, value: str) -> Edit | None:
    """The edit that gives an attribute another name and value; None where it is not found."""
    slot = _slot(text, element, name)
    if slot is None:
        return None
    begin = text.source.rindex(name.encode(), 0, slot[0])
    quote = text.source[slot[0] - 1 : slot[0]].decode()
    return Edit(begin, slot[1], f"{new}={quote}{value}".encode(), None)


def removed(text: Spanned, element: _Element, name: str) -> Edit | None:
    """The edit that takes an attribute out, with the white space before it."""
    slot = _slot(text, element, name)
    if slot is None:
        return None
    begin = text.source.rindex(name.encode(), 0, slot[0])
    before = len(text.source[:begin].rstrip())
    return Edit(before, slot[1] + 1, b"", None)


def revalued(text: Spanned, element: _Element, name: str, value: str) -> Edit | None:
    """The edit that gives an attribute another value, or adds it as the first one."""
    start = text.starts[element]
    if element.get(name) is None:
        tag = text.source[start : start + 1 + len(str(element.tag))]
        return Edit(start, start + len(tag), tag + f' {name}="{value}"'.encode(), None)
    slot = _slot(text, element, name)
    return None if slot is None else Edit(*slot, value.encode(), None)


def _slot(text: Spanned, element: _Element, name: str) -> tuple[int, int] | None:
    return attribute_slot(text.source, text.starts[element], name, element.get(name, ""))
