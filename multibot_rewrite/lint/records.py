"""Frozen records of the lint: subject (what a rule looks at), problem (what it yields), rule, finding
(what a person reads)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

from lxml.etree import _Element

from multibot_rewrite.lint.facts.elements import Elements
from multibot_rewrite.lint.facts.robot import Robot
from multibot_rewrite.lint.schema.faults import Fault
from multibot_rewrite.lint.settings import Settings
from multibot_rewrite.model import ERROR, WARNING, Edit
from multibot_rewrite.rewriters.tree import Tree
from multibot_rewrite.steps.collect import Inventory
from multibot_rewrite.steps.document import Document

if TYPE_CHECKING:
    from multibot_rewrite.sources.trace import Origin

NOTE = "note"
# From the worst on; a note never makes a lint fail.
LEVELS = (ERROR, WARNING, NOTE)
URDF, SRDF, XACRO = "urdf", "srdf", "xacro"
NOTHING: Mapping[str, str] = {}


class Subject(NamedTuple):
    """One document to lint.

    ``format`` is ``urdf``, ``srdf`` or ``xacro`` (the source as it is written). ``beside`` is the
    robot that an SRDF belongs to, if it was found. Where the document was expanded, ``origins``
    says where its elements were written, in document order, and ``sources`` has those files;
    ``arguments`` are the ones it was expanded with. ``faults`` are those of a URDF's shape.
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
    origins: tuple[Origin | None, ...] = ()
    sources: Mapping[str, bytes] = {}
    arguments: str = ""
    faults: tuple[Fault, ...] = ()


class Problem(NamedTuple):
    """What a rule found, at an element of its subject's document.

    ``attribute`` is the name of the attribute at fault, empty for the element's text, None for the
    element itself. ``edits`` mend it without a change of meaning; empty where that is not safe.
    """

    element: _Element
    message: str
    attribute: str | None = None
    hint: str = ""
    edits: tuple[Edit, ...] = ()


Check = Callable[[Subject], Iterable[Problem]]


class Rule(NamedTuple):
    """A rule, its words and its examples, which are its documentation and its tests.

    ``what`` it finds, ``why`` that bites at run time, how to ``fix`` it. ``bad`` holds the problem
    exactly once, ``good`` does not; text that starts with neither ``<?xml`` nor ``<robot`` stands
    inside ``<robot name="r">``. ``beside`` maps names to the content of files beside the example,
    ``options`` are the settings it is linted with. ``formats`` are what it is asked about: a
    ``urdf`` (xacro is expanded), an ``srdf``, the ``xacro`` source itself.
    """

    code: str
    name: str
    level: str
    what: str
    why: str
    fix: str
    bad: str
    good: str
    check: Check
    formats: tuple[str, ...] = (URDF,)
    beside: Mapping[str, str] = NOTHING
    options: Mapping[str, object] = {}


def rule(
    code: str,
    name: str,
    level: str,
    *,
    what: str,
    why: str,
    fix: str,
    bad: str,
    good: str,
    formats: tuple[str, ...] = (URDF,),
    beside: Mapping[str, str] = NOTHING,
    options: Mapping[str, object] = {},
) -> Callable[[Check], Rule]:
    """Makes a function that looks at a subject and yields problems a ``Rule``."""
    words = partial(Rule, code, name, level, what, why, fix, bad, good)
    return partial(words, formats=formats, beside=beside, options=options)


class LintFinding(NamedTuple):
    """A finding of the lint; lines and columns count from 1.

    ``calls`` are the xacro macro calls that made the element, the innermost first, as
    ``file:line: name``; ``arguments`` are the xacro arguments under which it is found, empty for
    the default ones. ``edits`` mend it in ``file``.
    """

    code: str
    level: str
    message: str
    hint: str
    file: str
    line: int
    column: int
    calls: tuple[str, ...] = ()
    arguments: str = ""
    edits: tuple[Edit, ...] = ()
