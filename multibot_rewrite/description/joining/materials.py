# SPDX-License-Identifier: Apache-2.0
"""Materials of a name that two parts have.

Source: urdfdom model.cpp (``parseURDF``: a material below ``<robot>`` that is there twice is an error;
``assignMaterial``: of a name that the model has, whatever stands in the visual is not read).
"""

from __future__ import annotations

from collections.abc import Collection, Iterator

from lxml.etree import _Element

from multibot_rewrite.base.model import Edit
from multibot_rewrite.description.checks.numbers import numbers
from multibot_rewrite.description.joining.kept import left_out
from multibot_rewrite.description.joining.part import ReadPart
from multibot_rewrite.description.steps.apply import cut
from multibot_rewrite.description.steps.document import Document, read_document, value_slot
from multibot_rewrite.description.steps.spans import Spans

# Colour and texture.
_Look = tuple[tuple[float, ...], str]
_TAG = "material"


def looks(root: _Element) -> dict[str, _Look]:
    """What each material that is described anywhere looks like; those below the root count first."""
    found: dict[str, _Look] = {}
    below = root.iterfind(f"link/visual/{_TAG}")
    for it in (*root.iterchildren(_TAG), *below):
        look = _look(it)
        if look is not None:
            found.setdefault(it.get("name", ""), look)
    found.pop("", None)
    return found


def _look(material: _Element) -> _Look | None:
    colour, texture = material.find("color"), material.find("texture")
    if colour is None and texture is None:
        return None
    rgba = colour.get("rgba", "") if colour is not None else ""
    return numbers(rgba) or (), "" if texture is None else texture.get("filename", "")


def other_looks(joined: _Element, part: ReadPart) -> tuple[str, ...]:
    """The materials of a part that look otherwise before it."""
    known, own = looks(joined), looks(part.inventory.document.root)
    # One without a look below the root is another one, too.
    bare_names = {it.get("name", "") for it in joined.iterchildren(_TAG)} - known.keys()
    met = known.keys() | bare_names
    return tuple(name for name, look in own.items() if name in met and known.get(name) != look)


def word_of(name: str, prefix: str) -> str:
    """What goes before materials of a part: its prefix, else its name."""
    return prefix or f"{name}_"


def prefixed(text: bytes, file: str, prefix: str, names: Collection[str]) -> bytes:
    """The text with a prefix before these materials."""
    starts = _starts(read_document(text, file), names)
    return b"".join(cut(text, (Edit(it, it, prefix.encode(), None) for it in starts)))


def bare(text: bytes, file: str, prefix: str, names: Collection[str]) -> bytes:
    """The text with the prefix taken off these materials."""
    starts = _starts(read_document(text, file), [prefix + it for it in names])
    return b"".join(cut(text, (Edit(it, it + len(prefix), b"", None) for it in starts)))


def _starts(document: Document, names: Collection[str]) -> Iterator[int]:
    """Where these names begin; in a block a material is one of Gazebo's."""
    for element, start in zip(document.elements, document.starts, strict=True):
        above = element.getparent()
        if element.tag != _TAG or above is None or above.tag == "gazebo":
            continue
        name = element.get("name", "")
        slot = value_slot(document.source, start, "name", name) if name in names else None
        if slot is not None:
            yield slot[0]


def repeated(joined: _Element, spans: Spans) -> Iterator[Edit]:
    """Materials below the root that are there already, taken out."""
    names = {it.get("name") for it in joined.iterchildren(_TAG)}
    for it in spans.document.root.iterchildren(_TAG):
        if it.get("name") in names:
            yield left_out(spans, it)
