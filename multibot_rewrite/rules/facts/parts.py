"""The visuals and collisions of links, with their shapes: found once for all rules."""

from __future__ import annotations

from lxml.etree import _Element

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.subject import Subject


class Part(NamedTuple):
    """A ``<visual>`` or ``<collision>`` of a link: its first ``<geometry>``, and the shape in that."""

    link: _Element
    element: _Element
    geometry: _Element | None
    shape: _Element | None


@memoized
def parts(subject: Subject) -> list[Part]:
    """All visuals of links in document order, then all collisions."""
    geometries = subject.elements.first("geometry")
    found = []
    for element in subject.elements.every("visual", "collision"):
        link = element.getparent()
        if link is not None and link.tag == "link":
            geometry = geometries.get(element)
            shape = None if geometry is None else _first(geometry)
            found.append(Part(link, element, geometry, shape))
    return found


def _first(geometry: _Element) -> _Element | None:
    """The first element in it. Mostly there is no comment before it, and that is quick to see."""
    if not len(geometry):
        return None
    first = geometry[0]
    return first if isinstance(first.tag, str) else next(geometry.iterchildren("*"), None)
