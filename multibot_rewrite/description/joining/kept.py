# SPDX-License-Identifier: Apache-2.0
"""The comments of a joined text that let each part be taken out of it, byte by byte.

A part is in front of ``</robot>`` of the first one, between two comments:

    <!-- multibot part gripper prefix=left_ materials=grey HEAD -->
    <!-- multibot end gripper TAIL -->

``HEAD`` is what its file has up to the end of its root's start tag, ``TAIL`` what it has from the end
tag on. What was left out or changed is kept where it was, before the 0 or 1 elements in its place; of
an element that refers to another file than before, that name (2):

    <!-- multibot was 1 OLD -->

A comment holds no ``--``, and no colon before a blank: launch files pass a description as YAML.
"""

import re
from collections.abc import Iterator, Mapping
from typing import NamedTuple
from urllib.parse import quote, unquote

from lxml.etree import _Element

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import Edit, InputError
from multibot_rewrite.description.steps.apply import Spans, cut
from multibot_rewrite.description.steps.document import read_document, silenced, value_slot

_BASE = lazy_compile(rb"  <!-- multibot base (\w+)(?: prefix=(\w+))? -->\n")
# No comment holds two dashes.
_INSIDE = rb"(?:[^-]|-(?!-))*?"
_PART = lazy_compile(
    rb"  <!-- multibot part (\w+)(?: prefix=(\w+))?(?: materials=(\S+))? (" + _INSIDE + rb") -->"
)
_LAST = b"<!-- multibot end "
_END = _LAST + b"%s "
_WAS = lazy_compile(rb"<!-- multibot was ([012]) (" + _INSIDE + rb") -->")
_OURS = lazy_compile(rb"<!-- multibot (?:base|part|end|was) ")
_MARKS = lazy_compile(
    rb"  <!-- multibot (?:base %b-->\n|part %b-->)|<!-- multibot (?:was %b-->|end %b-->\n)"
    % ((_INSIDE,) * 4)
)
_ESCAPED = lazy_compile(rb"%|-(?=-|\Z)|(?<=:) ")


class KeptText(NamedTuple):
    """A part inside a joined text: its ``text`` with its prefix, and its prefixed ``materials``."""

    name: str
    prefix: str
    materials: tuple[str, ...]
    text: bytes


def is_joined(text: bytes) -> bool:
    """Return whether a text has a comment of a join."""
    return _OURS.search(text) is not None


def is_joined_whole(text: bytes) -> bool:
    """Return whether a text is the result of a join."""
    return _BASE.search(text) is not None


def without_marks(text: bytes) -> bytes:
    """Return the text without the comments of a join, so that it cannot be split any more."""
    return _MARKS.sub(b"", text)


def was(start: int, end: int, old: bytes, new: bytes = b"") -> Edit:
    """Return the edit that puts ``new`` between two offsets, and keeps ``old`` in a comment."""
    kept = b"<!-- multibot was %d %s -->" % (bool(new), _escaped(old))
    return Edit(start, end, kept + new, None)


def path_edits(spans: Spans, element: _Element, new: bytes) -> Iterator[Edit]:
    """Yield the edit that gives an element another path and keeps the old one, if one can."""
    (start, end), slot = spans.of(element), path_slot(spans, element)
    if slot:
        source = spans.document.source
        kept = b"<!-- multibot was 2 %s -->" % _escaped(source[slice(*slot)])
        yield Edit(start, end, kept + source[start : slot[0]] + new + source[slot[1] : end], None)


def path_slot(spans: Spans, element: _Element | None) -> tuple[int, int] | None:
    """Return where the path is that an element refers to: in ``filename``, or its text."""
    if element is None:
        return None
    name = "filename" if "filename" in element.attrib else ""
    path = (element.get(name) if name else element.text) or ""
    return value_slot(spans.document.source, spans.start_of(element), name, path.strip())


def left_out(spans: Spans, element: _Element) -> Edit:
    """Return the edit that removes an element and keeps it in a comment."""
    return was(spans.start_of(element), spans.end_of(element), spans.text_of(element))


def section(it: KeptText, start: int, end: int) -> bytes:
    """Return a part for a joined text; ``start`` and ``end`` delimit the content of its root."""
    names = ",".join(quote(name, safe="") for name in it.materials).replace("--", "-%2D")
    words = _comment_text(it.name, prefix=it.prefix, materials=names)
    first = b"  <!-- multibot part %s %s -->" % (words, _escaped(it.text[:start]))
    last = _END % it.name.encode() + _escaped(it.text[end:]) + b" -->\n"
    return first + it.text[start:end] + last


def _comment_text(name: str, **more: str) -> bytes:
    return " ".join([name, *(f"{key}={text}" for key, text in more.items() if text)]).encode()


def placed(text: bytes, name: str, prefix: str, more: bytes) -> bytes:
    """Return the text of the first part, or of parts joined so far, with one more section."""
    last = text.rfind(_LAST) if is_joined_whole(text) else -1
    if last >= 0:
        at = text.index(b" -->\n", last) + len(b" -->\n")
        return text[:at] + more + text[at:]
    at = silenced(text).rindex(b"</")
    mark = b"  <!-- multibot base %s -->\n" % _comment_text(name, prefix=prefix)
    return text[:at] + mark + more + text[at:]


def sections(text: bytes, file: str) -> list[KeptText]:
    """Return the parts of a joined text, the first one first; raises InputError."""
    before = _as_it_was(text, file)
    mark = _BASE.search(before)
    if mark is None:
        raise InputError(f"{file}: multibot join did not make it; name the file that it wrote")
    found, last = [], mark.end()
    while part := _PART.match(before, last):
        name, prefix, materials, head = (word or b"" for word in part.groups())
        end = _END % name
        close = before.find(end, part.end())
        stop = before.find(b" -->\n", close + len(end))
        if close < 0 or stop < 0:
            what = f"the comment at the end of part {name.decode()!r} was edited by hand"
            raise InputError(f"{file}: {what}; join the parts again")
        tail = before[close + len(end) : stop]
        whole = _unescaped(head) + before[part.end() : close] + _unescaped(tail)
        names = tuple(unquote(it) for it in materials.decode().split(",") if it)
        found.append(KeptText(name.decode(), prefix.decode(), names, whole))
        last = stop + len(b" -->\n")
    base = before[: mark.start()] + before[last:]
    first, prefix = (word or b"" for word in mark.groups())
    return [KeptText(first.decode(), prefix.decode(), (), base), *found]


def _as_it_was(text: bytes, file: str) -> bytes:
    """Return the text with what was left out or changed in its old place."""
    while _WAS.search(text):
        spans, last = Spans(read_document(text, file)), 0
        edits: list[Edit] = []
        for mark in _WAS.finditer(text):
            # What was changed in what was changed later comes back with that.
            if mark.start() < last:
                continue
            last, old = _end_of_replacement(spans, mark, file), _unescaped(mark[2])
            if mark[1] == b"2":
                slot = path_slot(spans, spans.first_from(mark.end())) or (last, last)
                old = text[mark.end() : slot[0]] + old + text[slot[1] : last]
            edits.append(Edit(mark.start(), last, old, None))
        text = b"".join(cut(text, edits))
    return text


def _end_of_replacement(spans: Spans, found: re.Match[bytes], file: str) -> int:
    if found[1] == b"0":
        return found.end()
    element = spans.first_from(found.end())
    start = found.end() if element is None else spans.start_of(element)
    if element is None or spans.document.source[found.end() : start].strip():
        what = "what followed a comment 'multibot was' was edited by hand"
        raise InputError(f"{file}: {what}: join the parts again")
    return spans.end_of(element)


_SHOWN: Mapping[bytes, bytes] = {b"%25": b"%", b"%2D": b"-", b"%20": b" "}
_HIDDEN = {shown: hidden for hidden, shown in _SHOWN.items()}
_CODE = lazy_compile(rb"%25|%2D|%20")


def _escaped(text: bytes) -> bytes:
    return _ESCAPED.sub(lambda it: _HIDDEN[it[0]], text)


def _unescaped(text: bytes) -> bytes:
    return _CODE.sub(lambda it: _SHOWN[it[0]], text)
