# SPDX-License-Identifier: Apache-2.0
"""What the readers of a robot take, and complete XML parsers refuse or read otherwise."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import locate
from multibot_rewrite.base.loose_xml import DASHES, DEFAULT, LATE, slips
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.steps.document import Document, tag_end

CODE = "MB146"
_READERS = "urdfdom and sdformat read it, but Python's XML parsers and xacro do not"
_MENDS = {
    DASHES: "write == for --",
    LATE: "delete what is before <?xml",
    DEFAULT: "delete xmlns=, or give it a prefix",
}


def loosely_written(document: Document) -> Iterator[Problem]:
    """The first of each kind, at the element that is next, and of each prefix that nothing declares."""
    if not document.is_mended:
        return
    source, starts = document.source, document.starts
    seen = set()
    for offset, what in slips(source):
        if what not in seen:
            seen.add(what)
            element = document.elements[min(bisect_left(starts, offset), len(starts) - 1)]
            line, _ = locate(source, offset)
            hint = f"{_MENDS[what]}; {_READERS}"
            yield Problem(element, f"{what} in line {line}", None, hint, (), CODE)
    for prefix, uri in _undeclared(document):
        found = next((it for it in document.elements if _uses(it, uri)), document.root)
        message = f"the prefix {prefix!r} is not declared"
        hint = f'declare it on the root element: xmlns:{prefix}="{uri}"; {_READERS}'
        yield Problem(found, message, None, hint, (), CODE)


def _undeclared(document: Document) -> Iterator[tuple[str, str]]:
    """The prefixes that reading added to the root, with what they stand for."""
    start = document.starts[0]
    written = document.source[start : tag_end(document.source, start)]
    for prefix, uri in document.root.nsmap.items():
        if prefix and b"xmlns:" + prefix.encode() not in written:
            yield prefix, uri


def _uses(element: _Element, uri: str) -> bool:
    names = (str(element.tag), *map(str, element.attrib))
    return any(it.startswith(f"{{{uri}}}") for it in names)
