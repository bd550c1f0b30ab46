# SPDX-License-Identifier: Apache-2.0
"""Inserted elements in the bytes: how they are written, and how ``--undo`` finds them again.

They come first in their parent element, after a marker comment:

    <!-- multibot robot1 +2 (added, or all robots would share odom, cmd_vel) -->

The number counts the inserted elements that follow; ``expanded`` after it means that the parent was
``<a/>`` before, ``filled namespace`` that the parent's first ``<namespace>`` was there and empty. The
text holds no ": ": launch files pass a description on as a YAML string. The
marker is a comment because TinyXML-2, which urdfdom and sdformat read with, refuses processing
instructions inside the root element.
"""

from collections.abc import Iterator
from typing import NamedTuple

from lxml import etree

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.loose_xml import ESCAPES
from multibot_rewrite.base.model import Edit, InputError
from multibot_rewrite.description.rewriters.insert import Insertion, query, without
from multibot_rewrite.description.rewriters.own_defaults import SHOWN
from multibot_rewrite.description.rewriters.plugin_definitions import is_step
from multibot_rewrite.description.rewriters.renaming import ROBOT_SLOT
from multibot_rewrite.description.rewriters.text import text_of
from multibot_rewrite.description.steps.document import (
    Document,
    emptied,
    fillable,
    tag_end,
    text_slot,
)

MARKER = b"<!-- multibot "


class Marker(NamedTuple):
    """A marker comment read back."""

    comment: etree._Element
    robot: str
    elements: int
    expanded: bool
    filled: tuple[str, ...]


def insertion_edits(document: Document, items: list[Insertion], release: str) -> list[Edit]:
    """Return one edit group per parent element, right after its start tag, for a release."""
    if not items:
        return []
    starts = dict(zip(document.root.iter("*"), document.starts, strict=True))
    groups = lists_by_key((starts[item.parent], item) for item in items)
    edits = []
    for start in sorted(groups):
        edits += _parent_edits(document.source, start, groups[start], release)
    for item in items:
        if item.filled is not None:
            start, end, opening, close = fillable(document.source, starts[item.filled])
            text = item.new.translate(ESCAPES)
            edits += slot_edits(start, end, f"{opening.decode()}{text}{close.decode()}")
    return edits


def _parent_edits(source: bytes, start: int, items: list[Insertion], release: str) -> list[Edit]:
    end = tag_end(source, start)
    expanded = source[end - 2 : end] == b"/>"
    lead = lead_of(source, end)
    elements = elements_of([item for item in items if not item.step], lead)
    filled = [item.step for item in items if item.step]
    words = ["expanded"] if expanded else ["filled", *filled] if filled else []
    head = " ".join(["multibot", ROBOT_SLOT, f"+{len(elements)}", *words])
    added = "added, " if elements else ""
    marker = f"<!-- {head} ({added}or {_why(items, release)}) -->"
    text = "".join(lead + part for part in (marker, *elements))
    if expanded:
        name = source[start + 1 : end].split(None, 1)[0].rstrip(b"/>").decode()
        return slot_edits(end - 2, end, f">{text}{lead}</{name}>")
    return slot_edits(end, end, text)


def _why(items: list[Insertion], release: str) -> str:
    """Return what would be wrong without the inserted elements, as a text for a comment."""
    texts = lists_by_key((without(item, release), item) for item in items)
    parts = [f"{text} {_replaced_names(found)}" for text, found in texts.items()]
    # A comment may not hold "--", a YAML string may not hold a colon and a space.
    return ", and ".join(parts).replace("--", "- -").replace(": ", ":")


def _replaced_names(items: list[Insertion]) -> str:
    names = ("the root namespace" if item.kind == "namespace" else item.old for item in items)
    return ", ".join(dict.fromkeys(name.replace(SHOWN, "MODEL/") for name in names))


def lead_of(source: bytes, end: int) -> str:
    """Return line break and indentation of the parent's first child, as the file has them."""
    space = source[end : len(source) - len(source[end:].lstrip())].decode()
    if "\n" in space and source[end + len(space) : end + len(space) + 2] != b"</":
        return space[space.rindex("\n") - space.count("\r\n", space.rindex("\n") - 1) :]
    return ""


def elements_of(items: list[Insertion], lead: str) -> list[str]:
    """Return the texts of the elements, those of one new parent together."""
    plain = [item.xml for item in items if not item.wrap]
    for wrap in dict.fromkeys(item.wrap for item in items if item.wrap):
        inner = "".join(f"{lead}{lead and '  '}{item.xml}" for item in items if item.wrap == wrap)
        plain.append(f"<{wrap}>{inner}{lead}</{wrap}>")
    return plain


def slot_edits(start: int, end: int, text: str) -> list[Edit]:
    """Return the edits that put ``text``, with the robot's name at each ``ROBOT_SLOT``, in place."""
    first, *rest = (piece.encode() for piece in text.split(ROBOT_SLOT))
    if not rest:
        return [Edit(start, end, first, None)]
    return [Edit(start, end, first, rest[0])] + [Edit(end, end, b"", piece) for piece in rest[1:]]


def markers(document: Document) -> list[Marker]:
    """Return all markers of a document; raises InputError for one that was edited by hand."""
    if MARKER not in document.source:
        return []
    found = []
    for comment in document.root.iter(etree.Comment):
        words = (comment.text or "").partition("(")[0].split()
        # A person may write a comment that starts with this word, too.
        if words[:1] == ["multibot"] and words[2:3] and words[2][0] == "+":
            found.append(_read_marker(document, comment, words))
    return found


def _read_marker(document: Document, comment: etree._Element, words: list[str]) -> Marker:
    _, robot, number, *rest = words
    filled = rest[1:] if rest[:1] == ["filled"] else []
    known = rest in ([], ["expanded"]) or (filled and all(map(is_step, filled)))
    if not number[1:].isdigit() or not known:
        place = f"{document.file}:{comment.sourceline}:1"
        raise InputError(f"{place}: this marker was edited by hand; undo that")
    return Marker(comment, robot, int(number[1:]), rest == ["expanded"], tuple(filled))


def removals(document: Document, robot: str) -> list[Edit]:
    """Return edits that take out what was inserted for ``robot``."""
    mine = [marker for marker in markers(document) if marker.robot == robot]
    if not mine:
        return []
    starts = dict(zip(document.root.iter("*"), document.starts, strict=True))
    edits: list[Edit] = []
    for marker in mine:
        try:
            edits += _removal_edits(document, marker, starts)
        except ValueError:  # an end tag is not where this module writes it
            raise _error_for_edit_by_hand(document, marker) from None
    return edits


def _removal_edits(
    document: Document, marker: Marker, starts: dict[etree._Element, int]
) -> Iterator[Edit]:
    source = document.source
    parent = marker.comment.getparent()
    inserted = list(marker.comment.itersiblings("*"))[: marker.elements]
    if parent is None or len(inserted) != marker.elements:
        raise _error_for_edit_by_hand(document, marker)
    at = source.index(b"<!--%s-->" % (marker.comment.text or "").encode(), starts[parent])
    # Everything back to the tag before it is white space that was written with it.
    begin = source.rindex(b">", 0, at) + 1
    end = end_of(source, starts[inserted[-1]]) if inserted else source.index(b"-->", at) + 3
    if marker.expanded:
        yield Edit(begin - 1, source.index(b">", source.index(b"</", end)) + 1, b"/>", None)
    else:
        yield Edit(begin, end, b"", None)
    for step in marker.filled:
        # The whole element, up to the end of the text that was put into it, as it was before.
        filled = parent.find(query(step))
        start = starts[filled] if filled is not None else 0
        text = text_of(filled) if filled is not None else ""
        slot = text_slot(document.source, start, text) if text else None
        if slot is None:
            raise _error_for_edit_by_hand(document, marker)
        begin, end, before, _ = emptied(document.source, slot)
        yield Edit(start, end, document.source[start:begin] + before, None)


def _error_for_edit_by_hand(document: Document, marker: Marker) -> InputError:
    place = f"{document.file}:{marker.comment.sourceline}:1"
    return InputError(f"{place}: the elements this marker counts were edited by hand; undo that")


def end_of(source: bytes, start: int) -> int:
    """Return the end of an element that a rewrite put in: no child has its tag."""
    end = tag_end(source, start)
    if source[end - 2 : end] == b"/>":
        return end
    name = source[start + 1 : end - 1].split(None, 1)[0]
    close = b"</" + name + b">"
    return source.index(close, end) + len(close)
