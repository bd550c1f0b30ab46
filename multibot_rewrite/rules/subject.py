# SPDX-License-Identifier: Apache-2.0
"""The subject of lint rules: one document and what is known about it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from multibot_rewrite.base.findings.finding import URDF
from multibot_rewrite.description.checks.links_and_joints import Robot, read_robot
from multibot_rewrite.description.rewriters.forms import Declared
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.description.steps.document import Document
from multibot_rewrite.rules.facts.elements import Elements
from multibot_rewrite.rules.settings import Settings

if TYPE_CHECKING:
    from multibot_rewrite.description.sources.trace import Origins


# How the file of a document that xacro made is called.
EXPANDED = " (expanded)"


class Subject(NamedTuple):
    """One document to lint.

    ``format`` is ``urdf``, ``srdf`` or ``xacro`` (the source as it is written). ``beside`` is the
    robot of an SRDF's URDF, if it was found. Where the document was expanded, ``origins``
    says where its elements were written, in document order, and ``sources`` has those files,
    or that which includes models;
    ``arguments`` are the ones it was expanded with, ``given`` their names.
    ``memo`` is each subject's own, and filled while rules look at it (``facts.memo``).
    """

    format: str
    document: Document
    elements: Elements
    inventory: Inventory
    tree: Tree
    robot: Robot
    settings: Settings
    memo: dict[object, Any]
    beside: Robot | None = None
    origins: Origins | None = None
    sources: Mapping[str, bytes] = {}
    arguments: str = ""
    given: tuple[str, ...] = ()


def subject_of(inventory: Inventory, tree: Tree, settings: Settings) -> Subject:
    """The subject of a URDF as it is written."""
    document = inventory.document
    elements, robot = Elements(document), read_robot(document.root)
    return Subject(URDF, document, elements, inventory, tree, robot, settings, {})


class Robots(NamedTuple):
    """The names of all descriptions by kind, and each description; ``is_whole``: all could be read."""

    declared: Declared
    subjects: tuple[Subject, ...]
    is_whole: bool


NO_ROBOTS = Robots({}, (), False)
