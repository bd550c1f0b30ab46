# SPDX-License-Identifier: Apache-2.0
"""Findings that comments suppress, and comments that suppress nothing."""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import Finding, locate
from multibot_rewrite.base.findings.selection import is_on, level_of
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.lazy import ATTRIBUTES, lazy_compile
from multibot_rewrite.base.model import Edit
from multibot_rewrite.lint.config.directives import (
    ALWAYS_REPORTED,
    IGNORE_FILE,
    CodeName,
    Directive,
    read_directives,
)
from multibot_rewrite.lint.registry import RULES
from multibot_rewrite.rules.settings import MARK, Settings, file_of, is_silent

UNUSED, BROKEN = "MB002", "MB003"
_CALL = lazy_compile(r"(.*):(\d+): ")
# A xacro file whose root has no name is a part of another one.
_NAMED = lazy_compile(rb"<robot\s" + ATTRIBUTES + rb"?\bname\s*=")
# With one of these the file was not checked completely.
_UNFINISHED = ALWAYS_REPORTED - {UNUSED, BROKEN}
Position = tuple[int, int]


class Comment(NamedTuple):
    """A comment of a file, with the lines it is on and the element it is about."""

    file: str
    source: bytes
    it: Directive
    lines: tuple[int, int]
    element: tuple[Position, Position] | None


def after_comments(
    findings: Iterable[Finding],
    codes: Collection[str],
    sources: Mapping[str, bytes],
    settings: Settings,
) -> list[Finding]:
    """Return the findings that no comment suppresses, and those about comments.

    ``codes`` are all that were found. The first of ``sources`` is the file that is linted, the
    others are those it includes."""
    comments = [it for file, source in sources.items() for it in _lint_comments(file, source)]
    left, used = _unsuppressed(findings, comments)
    faults = ((it, fault) for it in comments for fault in it.it.faults)
    broken = (
        Finding(BROKEN, "", what.message, what.hint, it.file, *locate(it.source, what.start))
        for it, what in faults
    )
    left += _with_level(broken, BROKEN, settings)
    if _UNFINISHED.isdisjoint(codes):
        own = [it for it in comments if it.file == next(iter(sources)) and _is_whole(it, settings)]
        left += _with_level(_unused_comments(own, used, settings), UNUSED, settings)
    return left


def _lint_comments(file: str, source: bytes) -> Iterator[Comment]:
    for it in read_directives(source) if MARK in source else ():
        first, last = (locate(source, offset)[0] for offset in it.lines)
        span = it.element and (locate(source, it.element[0]), locate(source, it.element[1]))
        yield Comment(file, source, it, (first, last), span)


def _unsuppressed(
    findings: Iterable[Finding], comments: Iterable[Comment]
) -> tuple[list[Finding], set[tuple[str, int]]]:
    """Return the findings that are left, and the codes that suppressed one, by file and offset."""
    by_code = lists_by_key((code.text, (it, code)) for it in comments for code in it.it.codes)
    left, used = [], set()
    for finding in findings:
        there = by_code.get(finding.code, ())
        hits = {(it.file, code.start) for it, code in there if _reaches(it, finding)}
        used |= hits
        left += [] if hits else [finding]
    return left, used


def _reaches(comment: Comment, finding: Finding) -> bool:
    """Return whether a comment reaches a finding; a comment at a macro reaches those in its output."""
    if comment.it.word == IGNORE_FILE:
        return file_of(finding) == comment.file
    if finding.file == comment.file and _covers(comment, (finding.line, finding.column)):
        return True
    spans = [comment.lines]
    if comment.element:
        spans.append((comment.element[0][0], comment.element[1][0]))
    calls = (_CALL.match(call) for call in finding.calls)
    lines = [int(it[2]) for it in calls if it and it[1] == comment.file]
    return any(first <= line <= last for line in lines for first, last in spans)


def _covers(comment: Comment, at: Position) -> bool:
    """Return whether a position is on the comment's lines or in the element it is about."""
    first, last = comment.lines
    element = comment.element
    return first <= at[0] <= last or (element is not None and element[0] <= at < element[1])


def _with_level(found: Iterable[Finding], code: str, settings: Settings) -> Iterator[Finding]:
    """Yield findings of a rule about comments, with its level, if the rule is on in their file."""
    if not is_on(settings, code):
        return
    level = level_of(settings, code, RULES[code].level)
    for finding in found:
        if not is_silent(settings, finding.file, code):
            yield finding._replace(code=code, level=level)


def _is_whole(comment: Comment, settings: Settings) -> bool:
    """Return whether what a comment is about is in every expansion of its file."""
    if comment.file in settings.included:
        return False
    if not comment.file.endswith(".xacro"):
        return True
    return _NAMED.search(comment.source) is not None and not comment.it.sometimes


def _unused_comments(
    comments: Iterable[Comment], used: set[tuple[str, int]], settings: Settings
) -> Iterator[Finding]:
    for comment in comments:
        codes = comment.it.codes
        idle = [it for it in codes if (comment.file, it.start) not in used]
        idle = [
            it for it in idle if comment.it.idle or _is_checked(it.text, comment.file, settings)
        ]
        for code, edits in zip(idle, _removals(comment, idle), strict=True):
            line, column = locate(comment.source, code.start)
            message = f"this comment suppresses no {code.text} finding"
            hint = "delete it" if not comment.it.idle else "put it on the line above the element"
            yield Finding(UNUSED, "", message, hint, comment.file, line, column, edits=edits)


def _is_checked(code: str, file: str, settings: Settings) -> bool:
    """Return whether a rule is on in that file, with its settings and without other files."""
    rule = RULES[code]
    possible = not rule.page.beside and all(getattr(settings, it, True) for it in rule.options)
    return possible and is_on(settings, code) and not is_silent(settings, file, code)


def _removals(comment: Comment, idle: Sequence[CodeName]) -> Iterator[tuple[Edit, ...]]:
    """Yield for each of the codes the edit that removes it; all can be applied together."""
    codes = comment.it.codes
    if comment.it.faults or len(idle) == len(codes):
        yield from [() if comment.it.faults else _removal(comment)] * len(idle)
        return
    kept = next(at for at, it in enumerate(codes) if it not in idle)
    for code in idle:
        at = codes.index(code)
        # With the spaces up to the next code; after the first code that stays, from the one before.
        span = (code.start, codes[at + 1].start) if at < kept else (codes[at - 1].end, code.end)
        yield (Edit(*span, b"", None),)


def _removal(comment: Comment) -> tuple[Edit, ...]:
    """Return the edit that removes a comment, with a line that has nothing else; none inside a text."""
    source, it = comment.source, comment.it
    start = len(source[: it.start].rstrip())
    end = len(source) - len(source[it.end :].lstrip())
    around = source[max(start - 1, 0) : start], source[end : end + 1]
    if around[0] not in (b">", b"") or around[1] not in (b"<", b""):
        return ()
    first, last = it.lines
    if not source[first : it.start].strip() and not source[it.end : last].strip():
        return (Edit(first, min(last + 1, len(source)), b"", None),)
    return (Edit(max(start, first), it.end, b"", None),)
