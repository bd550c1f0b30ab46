# SPDX-License-Identifier: Apache-2.0
"""A problem at an element of a document: what checks and lint rules find, before it has a line."""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import Claim, Edit
from multibot_rewrite.description.steps.document import Document, finding


class Problem(NamedTuple):
    """What is wrong at an element.

    ``attribute`` is the name of the attribute at fault, empty for the element's text, None for the
    element itself. ``edits`` fix it without a change of meaning; empty where that is not safe.
    ``code`` and ``level`` are the rule's; they may be empty in a lint rule, which has them itself. What
    one look at a document finds for several rules has the word of its rule as the code.
    """

    element: _Element
    message: str
    attribute: str | None = None
    hint: str = ""
    edits: tuple[Edit, ...] = ()
    code: str = ""
    level: str = ""


def fault(
    word: str,
    element: _Element,
    attribute: str | None,
    message: str,
    hint: str = "",
    level: str = "",
) -> Problem:
    """Return a problem for the rule that reports the kind ``word``."""
    return Problem(element, message, attribute, hint, (), word, level)


def about(claim: Claim, code: str, message: str, hint: str = "") -> Problem:
    """Return a problem of a claimed value."""
    return Problem(claim.element, message, claim.attribute, hint, (), code)


def to_findings(
    document: Document, problems: Iterable[Problem], level: str, *, of_file: bool = False
) -> Iterator[Finding]:
    """Yield the problems as findings at their elements, or ``of_file`` at its start."""
    found = list(problems)
    pairs = zip(document.elements, document.starts, strict=True)
    starts = dict(pairs) if found and not of_file else {}
    for it in found:
        start = starts.get(it.element, 0)
        yield finding(document, start, it.code, level, it.message, it.hint)
