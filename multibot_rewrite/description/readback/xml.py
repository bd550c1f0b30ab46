# SPDX-License-Identifier: Apache-2.0
"""XML as TinyXML-2 and sdformat read it.

Sources: leethomason/tinyxml2 tinyxml2.cpp (XMLElement::GetText: comments in front are skipped, then
the first text counts; text of white space alone is none), gazebosim/sdformat Param.cc (booleans).
"""

from __future__ import annotations

from collections.abc import Iterator

from lxml import etree
from lxml.etree import _Element

from multibot_rewrite.base.loose_xml import is_loose, well_formed
from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.rewriters.plugin_definitions import split_path, split_step

# Blanks between elements are most of a tree, and no text that a consumer reads.
_PARSER = etree.XMLParser(resolve_entities=False, huge_tree=True, remove_blank_text=True)


def read_xml(data: bytes, file: str) -> _Element:
    """Return the root element; raises InputError."""
    try:
        return etree.fromstring(well_formed(data).text if is_loose(data) else data, _PARSER)
    except etree.XMLSyntaxError:
        try:
            return etree.fromstring(well_formed(data).text, _PARSER)
        except etree.XMLSyntaxError as error:
            raise InputError(f"{file}: cannot be read again: {error}") from None


def text_of(element: _Element) -> str:
    """Return the text of an element, without white space around it."""
    text = (element.text or "").strip()
    for child in element:
        if text or not isinstance(child, etree._Comment):
            break
        text = (child.tail or "").strip()
    return text


def child_text(element: _Element, tag: str) -> str | None:
    """Return the text of the first child with this tag; None without one."""
    child = element.find(tag)
    return None if child is None else text_of(child)


def values_at(element: _Element, path: str) -> Iterator[str]:
    """Yield the values at a path of a plugin definition, empty ones too: each attribute or text."""
    steps, attribute = split_path(path)
    for found in elements_at(element, steps):
        value = found.get(attribute) if attribute else text_of(found)
        if value is not None:
            yield value.strip()


def elements_at(element: _Element, steps: tuple[str, ...]) -> Iterator[_Element]:
    """Yield the elements at the steps of a path below an element."""
    if not steps:
        yield element
        return
    tag, attribute, wanted = split_step(steps[0])
    for child in element.iterchildren(tag):
        if not attribute or child.get(attribute, "") == wanted:
            yield from elements_at(child, steps[1:])


def plain(element: _Element) -> tuple[object, ...]:
    """Return an element as readers see it: no comments, no blanks between, sorted attributes."""
    parts = tuple(plain(it) for it in element.iterchildren("*"))
    return element.tag, frozenset(element.items()), text_of(element), parts


def is_on(text: str | None, usual: bool) -> bool:
    """Return what a text sets a boolean parameter to; a text that is none gives ``usual``."""
    known = {"true": True, "1": True, "false": False, "0": False}
    return known.get((text or "").strip().lower(), usual)


def root_of(text: object) -> _Element | None:
    """Return the root of a description; None where it is not known."""
    if not isinstance(text, str) or not text.strip():
        return None
    try:
        return read_xml(text.encode(), "")
    except InputError:
        return None
