# SPDX-License-Identifier: Apache-2.0
"""A problem's element -> file, line and column, through xacro where the document was expanded."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import lru_cache
from itertools import count
from typing import TYPE_CHECKING

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding, locate
from multibot_rewrite.base.findings.rule import Rule
from multibot_rewrite.base.findings.selection import level_of
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.steps.document import tag_end
from multibot_rewrite.rules.facts.source_values import is_argument
from multibot_rewrite.rules.subject import Subject

if TYPE_CHECKING:
    from multibot_rewrite.description.sources.trace import Call

Numbers = Mapping[_Element, int]
# To look for so many elements is quicker than to number all.
FEW = 5
_BLANK = lazy_compile(rb"\s*")
_ATTRIBUTE = lazy_compile(rb"\s((?:[^\s=:/>\"']+:)?([^\s=:/>\"']+))\s*=\s*(?:\"[^\"]*\"|'[^']*')")


def placed(subject: Subject, numbers: Numbers, problem: Problem, rule: Rule) -> Finding:
    """The finding for a problem; ``numbers`` are those of ``numbered``."""
    number, level = numbers[problem.element], problem.level or rule.level
    file, source, offset, calls = _place(subject, number, problem.attribute)
    line, column = locate(source, offset)
    if level == ERROR and _is_argument(subject, number, problem.attribute):
        level = WARNING  # another one may be passed
    return Finding(
        rule.code,
        level_of(subject.settings, rule.code, level),
        " ".join(problem.message.split()),
        problem.hint or rule.advice,
        file,
        line,
        column,
        tuple(_call_text(subject, call) for call in calls),
        subject.arguments,
        # An edit is one of the text that was looked at.
        () if subject.sources else problem.edits,
    )


def numbered(subject: Subject, problems: Iterable[Problem]) -> Numbers:
    """The elements that problems are about, and their numbers in document order."""
    elements, asked = subject.document.elements, {it.element for it in problems}
    if len(asked) > FEW:
        return dict(zip(elements, count()))
    return {it: elements.index(it) for it in asked}


def _place(
    subject: Subject, number: int, attribute: str | None
) -> tuple[str, bytes, int, tuple[Call, ...]]:
    """The file and its text, a byte offset in it, and the macro calls that led there."""
    origin = subject.origins.of(number) if subject.origins else None
    if origin is None:
        document = subject.document
        start = document.starts[number]
        offset = start + _within(document.source, start, attribute)
        return document.file, document.source, offset, ()
    source = subject.sources[origin.file]
    offset = origin.start + _within(source, origin.start, attribute)
    return origin.file, source, offset, origin.calls


def _is_argument(subject: Subject, number: int, attribute: str | None) -> bool:
    origin = subject.origins.of(number) if subject.origins and attribute is not None else None
    return origin is not None and is_argument(subject.sources, origin, attribute or "")


def _within(source: bytes, start: int, attribute: str | None) -> int:
    """The offset of a value from the start of its tag; 0 for an attribute that is missing."""
    if attribute is None:
        return 0
    if not attribute:
        end = tag_end(source, start)
        return next(_BLANK.finditer(source, end)).end() - start
    at = _attributes(source, start).get(attribute.rpartition("}")[2].encode())
    return at - start if at else 0


@lru_cache(maxsize=64)
def _attributes(source: bytes, start: int) -> dict[bytes, int]:
    """The offsets of the names of a tag's attributes, with their prefixes and without."""
    found = list(_ATTRIBUTE.finditer(source, start, tag_end(source, start)))
    bare = {it[2]: it.start(2) for it in found}
    return bare | {it[1]: it.start(1) for it in found}


def _call_text(subject: Subject, call: Call) -> str:
    line, _ = locate(subject.sources[call.file], call.start)
    return f"{call.file}:{line}: {call.macro}"
