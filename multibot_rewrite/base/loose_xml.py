# SPDX-License-Identifier: Apache-2.0
"""XML that TinyXML-2 reads and a complete parser refuses or reads otherwise, made well-formed for lxml.

TinyXML-2 knows no namespaces, so that a prefix is part of a name and ``xmlns`` any attribute; a
comment ends at the first ``-->`` whatever is in it; declarations come before all else, blanks aside.
Source: leethomason/tinyxml2 tinyxml2.cpp (XMLComment::ParseDeep, XMLNode::ParseDeep: "all declarations
must occur before anything else"). urdfdom, sdformat, srdfdom, ros2_control and pinocchio read with it.

All but the root's tag keeps its length, and every tag its place among the others.
"""

import re
from collections.abc import Iterator
from typing import NamedTuple

from multibot_rewrite.base.lazy import ATTRIBUTES, SILENT, lazy_compile

_STAGE = "http://playerstage.sourceforge.net/gazebo/xmlschema/#"
# What prefixes of descriptions stand for; a document may bind others to the same namespaces.
NAMESPACES = {
    "gz": "http://gazebosim.org/schema",
    "ignition": "http://ignitionrobotics.org/schema",
    "drake": "http://drake.mit.edu",
    **{prefix: _STAGE + prefix for prefix in ("controller", "sensor", "joint", "slider", "body")},
}
# What is wrong with a part.
DASHES = "-- in a comment"
LATE = "an XML declaration that is not at the very start"
DEFAULT = "a default namespace, xmlns="
# Before the prefix of anybody else that nothing declares.
UNBOUND = "unbound:"
# No robot has as many; lxml looks through all of them at each name.
MAX_PREFIXES = 50
# What stands for the characters of markup in a text or in a value between double quotes.
ESCAPES = str.maketrans({"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;"})
_BOM = b"\xef\xbb\xbf"
# Who writes one of these without its declaration meant another program, which refuses it.
_KEPT = {b"xacro", b"xml", b"xmlns"}
_PART = lazy_compile(SILENT + rb"|<[^\s/>!?<]" + ATTRIBUTES + rb">")
_BEFORE_ALL = lazy_compile(rb"(?:\xef\xbb\xbf)?(?:\s|<\?xml\s.*?\?>)*", re.DOTALL)
_DEFAULT = lazy_compile(rb"xmlns\s*=")
_SPACED = lazy_compile(rb"\sxmlns\s*=\s*(?:\"[^\"]*\"|'[^']*')")
_VALUE = lazy_compile(rb"\"[^\"]*\"|'[^']*'")
_PREFIXED = lazy_compile(rb"[<\s]([A-Za-z_][\w.-]*):[A-Za-z_]")
_BOUND = lazy_compile(rb"\sxmlns:([\w.-]+)\s*=")


class Mended(NamedTuple):
    """A text for a complete parser; from ``at`` on it is ``more`` bytes longer than its source."""

    text: bytes
    at: int
    more: int

    def column(self, line: int, column: int) -> int:
        """Return the column in the source of a place in the text."""
        before = self.text.rfind(b"\n", 0, self.at) + 1
        same = line == self.text.count(b"\n", 0, self.at) + 1
        return column - self.more if same and column > self.at - before + self.more else column


class Slip(NamedTuple):
    """A part of a text that only TinyXML-2 reads as it is meant: its offset, and what it is."""

    offset: int
    what: str


def well_formed(source: bytes) -> Mended:
    """Return the text for a strict parser, as TinyXML-2 would read it."""
    first = _before_all(source)
    text = _PART.sub(lambda it: _mended(it, first)[0], source)
    root = next((it for it in _PART.finditer(text) if _is_tag(it[0])), None)
    if root is None:
        return Mended(text, 0, 0)
    at = root.end() - (2 if root[0].endswith(b"/>") else 1)
    # Declarations for all prefixes that the root does not declare: an inner one counts below it.
    tags = (it[0] for it in _PART.finditer(text) if _is_tag(it[0]))
    used = {prefix for tag in tags for prefix in _PREFIXED.findall(_VALUE.sub(b"", tag))}
    left = sorted(used - _KEPT - set(_BOUND.findall(root[0])))
    left = left if len(left) <= MAX_PREFIXES else []
    uris = ((it, NAMESPACES.get(it.decode(), UNBOUND + it.decode())) for it in left)
    missing = b"".join(b' xmlns:%s="%s"' % (prefix, uri.encode()) for prefix, uri in uris)
    return Mended(text[:at] + missing + text[at:], at, len(missing))


def slips(source: bytes) -> Iterator[Slip]:
    """Yield comments, declarations and default namespaces that a complete parser reads otherwise."""
    first = _before_all(source)
    for it in _PART.finditer(source):
        new, what = _mended(it, first)
        if new != it[0]:
            yield Slip(it.start(), what)


def is_loose(source: bytes) -> bool:
    """Return whether a strict parser may read other names than TinyXML-2; a quick test."""
    return b"xmlns" in source and _DEFAULT.search(source) is not None


def _before_all(source: bytes) -> int:
    """Return the offset up to which there are only blanks and declarations."""
    found = _BEFORE_ALL.match(source)
    return found.end() if found else 0


def _mended(part: re.Match[bytes], first: int) -> tuple[bytes, str]:
    """Return a part of the text with its faults blanked, as long as before, and what was wrong."""
    text = part[0]
    if text.startswith(b"<!--"):
        inner = text[4:-3]
        wrong = text.endswith(b"-->") and (b"--" in inner or inner.endswith(b"-"))
        return b"<!--%s-->" % inner.replace(b"-", b"=") if wrong else text, DASHES
    start = len(_BOM) if part.string.startswith(_BOM) else 0
    if text.startswith(b"<?xml") and part.end() <= first and part.start() != start:
        return b" " * len(text), LATE
    if not _is_tag(text) or b"xmlns" not in text:
        return text, ""
    # Without its default namespace; a value may hold the same words.
    values = _VALUE.sub(lambda it: b'"' + b"x" * (len(it[0]) - 2) + b'"', text)
    found = _SPACED.search(values)
    if found:
        text = text[: found.start()] + b" " * len(found[0]) + text[found.end() :]
    return text, DEFAULT


def _is_tag(part: bytes) -> bool:
    return not part.startswith((b"<!", b"<?"))
