# SPDX-License-Identifier: Apache-2.0
"""One file -> its findings. Whatever a file contains, there is no traceback and no endless run."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from functools import lru_cache, partial
from itertools import count
from typing import TYPE_CHECKING, Any, NoReturn

from lxml.etree import _Element

from multibot_rewrite.base.file_kinds import refuse_templates
from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding, Rule, by_place, locate
from multibot_rewrite.base.findings.selection import level_of
from multibot_rewrite.base.lazy import gc_paused, lazy_compile
from multibot_rewrite.base.model import DefinitionsError, InputError
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.description.steps.document import tag_end
from multibot_rewrite.lint.failures import breakdown, crash, failure, too_long
from multibot_rewrite.lint.files.subjects import Failed, read_subjects
from multibot_rewrite.lint.groups import active_rules
from multibot_rewrite.related_files.named_file import has_related_name, kind_of
from multibot_rewrite.rules.facts.source_values import is_argument
from multibot_rewrite.rules.settings import MARK, Settings, file_of, is_silent
from multibot_rewrite.rules.subject import Subject

if TYPE_CHECKING:
    from multibot_rewrite.description.sources.trace import Call

AGAIN = 0.5
# Names that do not tell what a file is.
_BY_TEXT = (".xml", "<stdin>")


class _TooLongError(BaseException):
    """The time of a file is over; not an Exception, so that nothing on the way catches it."""


def lint_file(path: str, settings: Settings) -> list[Finding]:
    """Return all findings of a file, in order; a file that cannot be read is a finding."""
    return _lint_source(path, partial(read_file, path), settings)


def lint_data(
    path: str, data: bytes, settings: Settings, wanted: Callable[[Rule], bool] = bool
) -> list[Finding]:
    """Return what the ``wanted`` rules find in a text; xacro resolves includes from ``path``."""
    return _lint_source(path, lambda: data, settings, wanted)


def _lint_source(
    path: str, read: Callable[[], bytes], settings: Settings, wanted: Callable[[Rule], bool] = bool
) -> list[Finding]:
    """Return the findings of what ``read`` returns, those about its comments too, in order."""
    found: list[Finding] = []
    sources: dict[str, bytes] = {}
    try:
        with _limited(settings.seconds), gc_paused():
            sources[path] = data = read()
            beside = has_related_name(path) or (path.endswith(_BY_TEXT) and kind_of(data))
            if not beside or kind_of(data):
                refuse_templates(data, path)
            if beside:
                # A description needs none of it.
                from multibot_rewrite.lint.beside import related_file_findings

                its = list(related_file_findings(path, data, settings))
                return sorted(unsuppressed(its, {}, settings), key=by_place)
            _add_findings(path, data, settings, wanted, found, sources)
    except InputError as error:
        found.append(failure(path, error, settings))
    except _TooLongError:
        found.append(too_long(path, settings.seconds))
    except DefinitionsError:
        raise
    except Exception as error:  # the other files are still linted
        found.append(breakdown(path, error))
    # A finding that several expansions have is reported once, for the first of them.
    first: dict[Finding, Finding] = {}
    for finding in found:
        first.setdefault(finding._replace(arguments=""), finding)
    return sorted(unsuppressed(list(first.values()), sources, settings), key=by_place)


def _add_findings(
    path: str,
    data: bytes,
    settings: Settings,
    wanted: Callable[[Rule], bool],
    found: list[Finding],
    sources: dict[str, bytes],
) -> None:
    """Add findings and the files that were read; it releases the subjects before it returns."""
    for subject in read_subjects(path, data, settings):
        if isinstance(subject, Failed):
            it = failure(path, subject.error, settings)
            found.append(it._replace(arguments=subject.arguments))
            continue
        found += lint_subject(subject, wanted)
        sources |= {**subject.sources, path: data}


def lint_subject(subject: Subject, wanted: Callable[[Rule], bool] = bool) -> list[Finding]:
    """Return what the active and ``wanted`` rules find in one document."""
    found: list[tuple[Rule, list[Problem]]] = []
    crashes: list[Finding] = []
    for rule in filter(wanted, active_rules(subject.settings, subject.format)):
        try:
            problems = list(rule.check(subject)) if rule.check else []
        except Exception as error:  # reported as a finding, and the other rules still run
            crashes.append(crash(rule, subject, error))
            continue
        if problems:
            found.append((rule, problems))
    if not found:
        return crashes
    numbers = numbered(subject, [it for _, its in found for it in its])
    return crashes + [placed(subject, numbers, it, rule) for rule, its in found for it in its]


@contextmanager
def _limited(seconds: float) -> Iterator[None]:
    """Raise _TooLongError after that time; only a process's main thread can be stopped like that."""
    before: Any = None
    with suppress(ValueError):  # raised in other threads; to ask threading is slow to import
        before = signal.signal(signal.SIGALRM, _raise_too_long)
    if before is None:
        yield
        return
    # Repeated: an exception that is raised in a destructor or callback is lost.
    signal.setitimer(signal.ITIMER_REAL, seconds, AGAIN)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def _raise_too_long(*_: object) -> NoReturn:
    raise _TooLongError


def unsuppressed(
    findings: Sequence[Finding], sources: Mapping[str, bytes], settings: Settings
) -> list[Finding]:
    """Return the findings that no comment or setting suppresses, and those about comments.

    The first of ``sources`` is the file that is linted, the others are those it includes."""
    reported = [it for it in findings if not is_silent(settings, file_of(it), it.code)]
    if not any(MARK in source for source in sources.values()):
        return reported
    # Few files have a comment for the lint.
    from multibot_rewrite.lint.config.comments import after_comments

    return after_comments(reported, {it.code for it in findings}, sources, settings)


Numbers = Mapping[_Element, int]
# To look for so many elements is quicker than to number all.
FEW = 5
_BLANK = lazy_compile(rb"\s*")
_ATTRIBUTE = lazy_compile(rb"\s((?:[^\s=:/>\"']+:)?([^\s=:/>\"']+))\s*=\s*(?:\"[^\"]*\"|'[^']*')")


def placed(subject: Subject, numbers: Numbers, problem: Problem, rule: Rule) -> Finding:
    """Return the finding for a problem; ``numbers`` are those of ``numbered``."""
    number, level = numbers[problem.element], problem.level or rule.level
    sources = subject.sources
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
        tuple(f"{it.file}:{locate(sources[it.file], it.start)[0]}: {it.macro}" for it in calls),
        subject.arguments,
        # An edit is one of the text that was looked at.
        () if sources else problem.edits,
    )


def numbered(subject: Subject, problems: Iterable[Problem]) -> Numbers:
    """Return the elements that problems are about, and their numbers in document order."""
    elements, asked = subject.document.elements, {it.element for it in problems}
    if len(asked) > FEW:
        return dict(zip(elements, count()))
    return {it: elements.index(it) for it in asked}


def _place(
    subject: Subject, number: int, attribute: str | None
) -> tuple[str, bytes, int, tuple[Call, ...]]:
    """Return the file and its text, a byte offset in it, and the macro calls that led there."""
    origin = subject.origins.of(number) if subject.origins else None
    if origin is None:
        document = subject.document
        start = document.starts[number]
        offset = start + _value_offset(document.source, start, attribute)
        return document.file, document.source, offset, ()
    source = subject.sources[origin.file]
    offset = origin.start + _value_offset(source, origin.start, attribute)
    return origin.file, source, offset, origin.calls


def _is_argument(subject: Subject, number: int, attribute: str | None) -> bool:
    origin = subject.origins.of(number) if subject.origins and attribute is not None else None
    return origin is not None and is_argument(subject.sources, origin, attribute or "")


def _value_offset(source: bytes, start: int, attribute: str | None) -> int:
    """Return the offset of a value from the start of its tag; 0 for an attribute that is missing."""
    if attribute is None:
        return 0
    if not attribute:
        end = tag_end(source, start)
        return next(_BLANK.finditer(source, end)).end() - start
    at = _attribute_offsets(source, start).get(attribute.rpartition("}")[2].encode())
    return at - start if at else 0


@lru_cache(maxsize=64)
def _attribute_offsets(source: bytes, start: int) -> dict[bytes, int]:
    """Return the offsets of the names of a tag's attributes, with their prefixes and without."""
    found = list(_ATTRIBUTE.finditer(source, start, tag_end(source, start)))
    bare = {it[2]: it.start(2) for it in found}
    return bare | {it[1]: it.start(1) for it in found}
