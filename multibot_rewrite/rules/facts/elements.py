# SPDX-License-Identifier: Apache-2.0
"""The elements of a document by their tags: found once for all rules."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from lxml.etree import _Element

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.description.steps.document import Document

_ByTag = Mapping[str, Sequence[_Element]]
# The parts of a <ros2_control> that have interfaces, and these.
OWNERS = ("joint", "sensor", "gpio")
COMMAND, STATE = "command_interface", "state_interface"
STANDARD = ("position", "velocity", "effort", "acceleration")


class Elements:
    """The elements of one document."""

    __slots__ = ("_every", "_first", "_tops", "root")

    def __init__(self, document: Document) -> None:
        self.root = document.root
        self._every = _by_tag(document.elements)
        self._tops = _by_tag(document.root.iterchildren("*"))
        self._first: dict[str, Mapping[_Element | None, _Element]] = {}

    def every(self, *tags: str) -> Sequence[_Element]:
        """All of these tags, tag by tag in document order."""
        return _of(self._every, tags)

    def tops(self, *tags: str) -> Sequence[_Element]:
        """The same, only of the root's children."""
        return _of(self._tops, tags)

    def owners(self) -> Iterator[_Element]:
        """What has interfaces in every <ros2_control>: joints, sensors, gpios."""
        for system in self.tops("ros2_control"):
            yield from system.iterchildren(*OWNERS)

    def first(self, tag: str) -> Mapping[_Element | None, _Element]:
        """The first child of that tag, by its parent: for rules that ask every element for one."""
        found = self._first.get(tag)
        if found is None:
            below = self._every.get(tag, ())
            found = self._first[tag] = {it.getparent(): it for it in reversed(below)}
        return found


def _of(found: _ByTag, tags: tuple[str, ...]) -> Sequence[_Element]:
    if len(tags) == 1:
        return found.get(tags[0], ())
    return [it for tag in tags for it in found.get(tag, ())]


def _by_tag(elements: Iterable[_Element]) -> _ByTag:
    return lists_by_key((it.tag, it) for it in elements)


def name_of(element: _Element) -> str:
    """The name of an element without the white space around it."""
    return element.get("name", "").strip()
