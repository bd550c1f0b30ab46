# SPDX-License-Identifier: Apache-2.0
"""XML namespaces that a part declares on its root, said again by its own elements that use them."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from lxml import etree
from lxml.etree import _Element

from multibot_rewrite.base.model import Edit
from multibot_rewrite.description.joining.kept import was
from multibot_rewrite.description.steps.document import Document, tag_end
from multibot_rewrite.description.steps.spans import Spans


def own_spaces(joined: Document, spans: Spans, others: Collection[Edit]) -> list[Edit]:
    """The edits that declare them; elements that the ``others`` leave out need none."""
    return list(_edits(joined, spans, {it.start for it in others if it.start < it.end}))


def _edits(joined: Document, spans: Spans, edited: Collection[int]) -> Iterator[Edit]:
    lacking = _declared(spans.document) - _declared(joined)
    for it in spans.document.root.iterchildren("*") if lacking else ():
        used = sorted(_spaces(it) & {uri for _, uri in lacking})
        start = spans.start_of(it)
        if not used or start in edited:
            continue
        old = spans.text_of(it)
        words = (b' xmlns:%s="%s"' % pair for pair in sorted(lacking) if pair[1] in used)
        at = 1 + len(_name(old))
        yield was(start, spans.end_of(it), old, old[:at] + b"".join(words) + old[at:])


def _name(element: bytes) -> bytes:
    return element[1:].split(b">", 1)[0].split(None, 1)[0].rstrip(b"/")


def _declared(document: Document) -> set[tuple[bytes, bytes]]:
    """Prefixes and namespaces that the root's start tag has itself."""
    start = document.starts[0]
    tag = document.source[start : tag_end(document.source, start)]
    found = ((prefix, uri) for prefix, uri in document.root.nsmap.items() if prefix)
    pairs = {(prefix.encode(), uri.encode()) for prefix, uri in found}
    return {pair for pair in pairs if b"xmlns:%s" % pair[0] in tag}


def _spaces(element: _Element) -> set[bytes]:
    names = (name for it in element.iter("*") for name in (it.tag, *it.attrib))
    found = (etree.QName(str(name)).namespace for name in names)
    return {uri.encode() for uri in found if uri}
