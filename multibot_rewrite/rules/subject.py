# SPDX-License-Identifier: Apache-2.0
"""The subject of lint rules: one document, its elements by their tags, and what is known about it."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import URDF
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.description.checks.links_and_joints import Robot, read_robot
from multibot_rewrite.description.rewriters.forms import Declared
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.description.steps.document import Document
from multibot_rewrite.rules.settings import Settings

if TYPE_CHECKING:
    from multibot_rewrite.description.sources.trace import Origins


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
        """Return all of these tags, tag by tag in document order."""
        return _elements_of(self._every, tags)

    def tops(self, *tags: str) -> Sequence[_Element]:
        """Return the root's children that have one of these tags."""
        return _elements_of(self._tops, tags)

    def owners(self) -> Iterator[_Element]:
        """Yield the joints, sensors and gpios of every <ros2_control>, which have interfaces."""
        for system in self.tops("ros2_control"):
            yield from system.iterchildren(*OWNERS)

    def first(self, tag: str) -> Mapping[_Element | None, _Element]:
        """Return the first child of a tag by its parent, for rules that ask every element for one."""
        found = self._first.get(tag)
        if found is None:
            below = self._every.get(tag, ())
            found = self._first[tag] = {it.getparent(): it for it in reversed(below)}
        return found


def _elements_of(found: _ByTag, tags: tuple[str, ...]) -> Sequence[_Element]:
    if len(tags) == 1:
        return found.get(tags[0], ())
    return [it for tag in tags for it in found.get(tag, ())]


def _by_tag(elements: Iterable[_Element]) -> _ByTag:
    return lists_by_key((it.tag, it) for it in elements)


def name_of(element: _Element) -> str:
    """Return the name of an element without the white space around it."""
    return element.get("name", "").strip()


# How the file of a document that xacro made is called.
EXPANDED = " (expanded)"


class Subject(NamedTuple):
    """One document to lint.

    ``format`` is ``urdf``, ``srdf`` or ``xacro`` (the source as it is written). ``beside`` is the
    robot of an SRDF's URDF, if it was found. Where the document was expanded, ``origins`` says
    where its elements were written, in document order, and ``sources`` has those files, or that
    which includes models; ``arguments`` are the ones it was expanded with, ``given`` their names.
    ``memo`` is each subject's own, and filled while rules check it (``facts.memo``)."""

    format: str
    document: Document
    elements: Elements
    inventory: Inventory
    tree: Tree
    robot: Robot
    settings: Settings
    memo: dict[object, Any]
    beside: Robot | None = None
    origins: "Origins | None" = None
    sources: Mapping[str, bytes] = {}
    arguments: str = ""
    given: tuple[str, ...] = ()


def subject_of(inventory: Inventory, tree: Tree, settings: Settings) -> Subject:
    """Return the subject of a URDF as it is written."""
    document = inventory.document
    elements, robot = Elements(document), read_robot(document.root)
    return Subject(URDF, document, elements, inventory, tree, robot, settings, {})


class Robots(NamedTuple):
    """The names of all descriptions by kind, and each description; ``is_whole``: all could be read."""

    declared: Declared
    subjects: tuple[Subject, ...]
    is_whole: bool


NO_ROBOTS = Robots({}, (), False)
