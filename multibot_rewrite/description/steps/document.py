# SPDX-License-Identifier: Apache-2.0
"""Reads source bytes as an lxml tree with byte positions; edits are made in the bytes.

A position is found by scanning one start tag; a value is editable only if the bytes there read
back as the parsed value. What would make that unsafe (other encodings, DOCTYPE) is refused here."""

import re
from collections.abc import Iterable, Sequence
from contextlib import suppress
from functools import lru_cache
from operator import sub
from typing import NamedTuple

from lxml import etree

from multibot_rewrite.base.bounded import MAX_BYTES
from multibot_rewrite.base.conventions import ROWS
from multibot_rewrite.base.findings.finding import Finding, locate
from multibot_rewrite.base.lazy import ATTRIBUTES, SILENT, lazy_compile
from multibot_rewrite.base.loose_xml import is_loose, well_formed
from multibot_rewrite.base.model import NOT_UTF8, REFUSED, Edit, InputError

# No element of a robot has fifty.
MAX_ATTRIBUTES = 1000
# Entities are never resolved, nothing is loaded: the input may come from anywhere. (collect_ids
# stays on: without it lxml makes libxml2 load external DTDs.) Blanks between elements are most of a
# tree, and mean nothing.
_PARSER = etree.XMLParser(
    resolve_entities=False, no_network=True, load_dtd=False, remove_blank_text=True
)
_OPENING = lazy_compile(rb"<[A-Za-z_:\x80-\xff]")
_SILENT = lazy_compile(SILENT)
_TAG = lazy_compile(rb"<[^\s/<>]" + ATTRIBUTES + rb">")
_COMMENTS = lazy_compile(rb"\s*(?:<!--.*?-->\s*)*", re.DOTALL)
_ATTRIBUTE = lazy_compile(rb"\s([^\s=/>\"']+)\s*=\s*(\"[^\"]*\"|'[^']*')")
_ATTRIBUTES = etree.XPath("//@*", smart_strings=False)
_TEXTS = etree.XPath("/descendant::text()[normalize-space()]", smart_strings=False)
# How far the common spelling of an attribute is looked for.
_NEAR = 4096
CORRECT = "correct the XML and try again"
# What libxml2 says -> the cause.
_CAUSES = {"entity amplification": REFUSED, "Invalid bytes in character encoding": NOT_UTF8}
_HINTS = tuple((" ".join(said), hint) for said, hint in ROWS["words of libxml2"])


class Document(NamedTuple):
    """One parsed file with all its elements in order; ``file`` is the name in messages.

    ``starts`` are the byte offsets of start tags, or numbers if no place is asked for.
    ``is_mended``: a complete parser would read the text otherwise, or not."""

    source: bytes
    file: str
    root: etree._Element
    elements: list[etree._Element]
    starts: Sequence[int]
    is_mended: bool = False


def read_document(source: bytes, file: str, placed: bool = True) -> Document:
    """Return the parsed document; raises InputError. Not ``placed``: elements have no offsets."""
    _refuse_unreadable_bytes(source, file)
    root, is_mended = _parsed(source, file)
    elements = list(root.iter("*"))
    starts = start_offsets(source) if placed else range(len(elements))
    document = Document(source, file, root, elements, starts, is_mended)
    _refuse_doctype_and_encoding(document)
    if placed:
        _refuse_wide(document)
    return document


def _parsed(source: bytes, file: str) -> tuple[etree._Element, bool]:
    """Return (root as TinyXML-2 reads the text, whether the text had to be mended)."""
    if not is_loose(source):
        with suppress(etree.XMLSyntaxError):
            return etree.fromstring(source, _PARSER), False
    mended = well_formed(source)
    try:
        return etree.fromstring(mended.text, _PARSER), True
    except etree.XMLSyntaxError as error:
        # What is no XML at all is told by what it is.
        text = source[:1000].removeprefix(b"\xef\xbb\xbf").lstrip()
        if text and not text.startswith(b"<"):
            from multibot_rewrite.base.file_kinds import DESCRIPTIONS, SRDF, refuse_others

            refuse_others(source, file, *DESCRIPTIONS, SRDF)
        message = " ".join(str(error.msg).split()).partition(", line ")[0]
        message = message.partition(", use XML_PARSE_HUGE")[0].partition(", see xml")[0]
        hint = next((hint for start, hint in _HINTS if start in message), CORRECT)
        line, column = error.position
        column = mended.column(line, column)
        message = f"{file}:{line or 1}:{column or 1}: not well-formed XML: {message}; {hint}"
        cause = next((_CAUSES[said] for said in _CAUSES if said in str(error.msg)), "")
        raise InputError(message, cause) from None


def _refuse_unreadable_bytes(source: bytes, file: str) -> None:
    if not source or source.isspace():
        raise InputError(f"{file}: the file is empty; a robot description starts with <robot>")
    if len(source) > MAX_BYTES:
        sizes = f"{len(source):,} bytes, over the limit of {MAX_BYTES:,}"
        raise InputError(f"{file}: {sizes}; is this a mesh?")
    if source.startswith((b"\xff\xfe", b"\xfe\xff", b"<\0", b"\0<", b"\0\0\xfe\xff", b"\0\0\0<")):
        width = 32 if b"\0\0" in source[:8] else 16
        name = f"UTF-{width}"
        raise InputError(f"{file}: the text is {name}; convert it: iconv -f {name} -t UTF-8")
    at = source.find(b"\0")
    # The libxml2 of Ubuntu 22.04 takes it for the end of the file.
    if at >= 0 and source[:at].strip():
        line, column = locate(source, at)
        raise InputError(f"{file}:{line}:{column}: not well-formed XML: a NUL byte; {CORRECT}")


def _refuse_doctype_and_encoding(document: Document) -> None:
    source, file, root, *_ = document
    info = root.getroottree().docinfo
    if info.internalDTD is not None:
        what = f"{file}: DOCTYPE and entities are not accepted; expand them first"
        raise InputError(what, REFUSED)
    encoding = (info.encoding or "UTF-8").upper()
    if encoding not in ("UTF-8", "UTF8", "ASCII", "US-ASCII") and not source.isascii():
        raise InputError(
            f"{file}: the encoding is {encoding}; convert it: iconv -f {encoding} -t UTF-8",
            REFUSED,
        )


def _refuse_wide(document: Document) -> None:
    """Refuse elements with too many attributes: lxml compares each with all others."""
    source, file, _, elements, starts, _ = document
    # ` a=""`
    least = 5 * MAX_ATTRIBUTES
    half = least // 2
    # A tag as long has one of these parts all to itself.
    if all(source.find(b"<", at, at + half) >= 0 for at in range(0, len(source) - half, half)):
        return
    for at, length in enumerate(map(sub, (*starts[1:], len(source)), starts)):
        if length <= least:
            continue
        start = starts[at]
        count = len(elements[at].attrib) + source.count(b" xmlns:", start, tag_end(source, start))
        if count > MAX_ATTRIBUTES:
            line, column = locate(source, start)
            what = f"an element has {count:,} attributes, over {MAX_ATTRIBUTES:,}; leave some out"
            raise InputError(f"{file}:{line}:{column}: {what}")


def start_offsets(source: bytes) -> list[int]:
    """Return the byte offsets of the start tags of a well-formed text, in document order."""
    source = silenced(source)
    return [found.start() for found in _OPENING.finditer(source)]


def silenced(source: bytes) -> bytes:
    """Return the text with blanks, as many, for comments, CDATA and processing instructions."""
    after_declaration = 5 if source.startswith(b"<?xml ") else 0
    if b"<!--" in source or b"<![CDATA[" in source or source.find(b"<?", after_declaration) >= 0:
        return _SILENT.sub(lambda found: b" " * len(found[0]), source)
    return source


def slot_values(root: etree._Element) -> list[str]:
    """Return the value of every attribute and of every text that is more than white space."""
    texts: list[str] = _TEXTS(root)  # type: ignore[assignment]
    attributes: list[str] = _ATTRIBUTES(root)  # type: ignore[assignment]
    return attributes + [text.strip() for text in texts]


def value_slot(source: bytes, start: int, attribute: str, value: str) -> tuple[int, int] | None:
    """Return where a value is (``attribute`` empty: the text); None if it does not read back."""
    if not attribute:
        return text_slot(source, start, value)
    # The common spelling, inside this tag and not inside another value; else the exact way.
    written = f' {attribute}="{value}"'.encode()
    begin = source.find(written, start, start + _NEAR)
    earlier = source[start:begin]
    if begin < 0 or b">" in earlier:
        return attribute_slot(source, start, attribute, value)
    if b"=" in earlier and (b"'" in earlier or earlier.count(b'"') % 2):
        return attribute_slot(source, start, attribute, value)
    return begin + len(attribute) + 3, begin + len(written) - 1


def value_places(
    source: bytes, start: int, attribute: str, value: str, characters: Iterable[int]
) -> list[int] | None:
    """Return the byte offsets of ``characters`` of a value; None if escapes hide one of them."""
    slot = value_slot(source, start, attribute, value)
    if slot is None:
        return None
    places = [place_in(source, slot, value, at) for at in characters]
    found = [place for place in places if place is not None]
    return found if len(found) == len(places) else None


def place_in(source: bytes, slot: tuple[int, int], value: str, at: int) -> int | None:
    """Return the byte offset of character ``at`` of the value in ``slot``; None if escapes hide it."""
    begin, end = slot
    # As many bytes as characters: nothing is escaped.
    if end - begin == len(value):
        return begin + at
    raw = source[begin:end]
    head, tail = value[:at].encode(), value[at:].encode()
    if raw.endswith(tail) and b";" not in tail:
        return end - len(tail)
    for written in (head, head.replace(b"\n", b"\r\n")):
        if raw.startswith(written):
            return begin + len(written)
    return None


def attribute_slot(source: bytes, start: int, name: str, value: str) -> tuple[int, int] | None:
    """Return where the value of an attribute is, with any quotes, spaces and escapes."""
    slot = written_slot(source, start, name)
    return slot if slot and _reads_as(b'<a b="%s"/>', source[slice(*slot)], value) else None


def written_slot(source: bytes, start: int, name: str) -> tuple[int, int] | None:
    """Return where an attribute is, whatever its value; ``{uri}local`` matches with any prefix."""
    uri, _, local = name.encode().rpartition(b"}")
    there = attribute_slots(source, start)
    # Without a prefix a name is in no namespace.
    names = (it for it in there if it.endswith(b":" + local)) if uri else (local,)
    return next((there[it] for it in names if it in there), None)


# A tag may have thousands of attributes.
@lru_cache(maxsize=4)
def attribute_slots(source: bytes, start: int) -> dict[bytes, tuple[int, int]]:
    """Return where the values of a tag's attributes are, as they are written."""
    found = _ATTRIBUTE.finditer(source, start, tag_end(source, start))
    return {it[1]: (it.start(2) + 1, it.end(2) - 1) for it in found}


def text_slot(source: bytes, start: int, value: str) -> tuple[int, int] | None:
    """Return where the text after a start tag is, without comments and white space before it."""
    # None if it does not read back, or if a comment cuts it: readers differ then.
    raw = value.encode()
    begin = source.find(b">", start) + 1
    end = begin + len(raw)
    if source.startswith(raw, begin) and source.startswith(b"</", end):
        return begin, end
    begin = _after_comments(source, tag_end(source, start))
    text = source[begin : source.find(b"<", begin)].rstrip()
    end = begin + len(text)
    rest = _after_comments(source, end)
    whole = source.startswith(b"<", rest) and not source.startswith(b"<!", rest)
    return (begin, end) if whole and _reads_as(b"<a>%s</a>", text, value) else None


def _after_comments(source: bytes, at: int) -> int:
    found = _COMMENTS.match(source, at)
    return found.end() if found else at


def fillable(source: bytes, start: int) -> tuple[int, int, bytes, bytes]:
    """Return (start, end, before, behind): where text goes in an element, and what to write around."""
    # A filled ``<a/>`` ends in ``</a>``, a filled ``<a></a>`` in ``</a >``: so both can be emptied
    # again. Before white space, a comment or anything else, the text is written without more.
    end = tag_end(source, start)
    if source[end - 2 : end] == b"/>":
        name = source[start + 1 : end].split(None, 1)[0].rstrip(b"/>")
        return end - 2, end, b">", b"</%s>" % name
    if not source.startswith(b"</", end):
        return end, end, b"", b""
    close = source.index(b">", end)
    return end, close, b"", source[end:close] + b" "


def emptied(source: bytes, slot: tuple[int, int]) -> Edit:
    """Return the edit that removes the text of a filled element again."""
    begin, end = slot
    if not source.startswith(b"</", end):
        return Edit(begin, end, b"", None)
    close = source.index(b">", end)
    if source[close - 1 : close].isspace():
        return Edit(begin, close, source[end : close - 1], None)
    return Edit(begin - 1, close + 1, b"/>", None)


def _reads_as(frame: bytes, raw: bytes, value: str) -> bool:
    """Return whether a parser reads ``raw``, put into ``frame``, as ``value``."""
    element = etree.fromstring(frame % raw.replace(b'"', b"&quot;"))
    return (element.get("b") if b"b=" in frame else element.text or "") == value


def tag_end(source: bytes, start: int) -> int:
    """Return the offset right after the ``>`` of the start tag at ``start``."""
    tag = _TAG.match(source, start)
    assert tag is not None, "lxml read a start tag here"
    return tag.end()


def path_of(element: etree._Element) -> str:
    """Return the tags from the root to an element, as ``robot/gazebo/plugin``."""
    return "/".join(str(it.tag) for it in (*[*element.iterancestors()][::-1], element))


def finding(
    document: Document, offset: int, code: str, level: str, message: str, hint: str = ""
) -> Finding:
    """Return a finding at a byte offset of the document."""
    return Finding(code, level, message, hint, document.file, *locate(document.source, offset))
