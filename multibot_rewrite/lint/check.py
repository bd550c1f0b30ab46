# SPDX-License-Identifier: Apache-2.0
"""One file -> its findings. Whatever a file contains, there is no traceback and no endless run."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from functools import partial
from typing import Any, NoReturn

from multibot_rewrite.base.file_kinds import refuse_templates
from multibot_rewrite.base.findings.finding import Finding, by_place
from multibot_rewrite.base.findings.rule import Rule
from multibot_rewrite.base.gc_pause import gc_paused
from multibot_rewrite.base.model import InputError, VocabularyError
from multibot_rewrite.companions.named_file import is_named_beside, kind_of
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.lint.failures import breakdown, crash, failure, too_long
from multibot_rewrite.lint.files.subjects import Failed, read_subjects
from multibot_rewrite.lint.groups import active_rules
from multibot_rewrite.lint.places import numbered, placed
from multibot_rewrite.rules.settings import MARK, Settings, file_of, is_silent
from multibot_rewrite.rules.subject import Subject

AGAIN = 0.5
# Names that do not tell what a file is.
_BY_TEXT = (".xml", "<stdin>")


class _TooLongError(BaseException):
    """The time of a file is over; not an Exception, so that nothing on the way catches it."""


def lint_file(path: str, settings: Settings) -> list[Finding]:
    """All findings of a file, in order; a file that cannot be read is a finding."""
    return _linted(path, partial(read_file, path), settings)


def lint_data(
    path: str, data: bytes, settings: Settings, wanted: Callable[[Rule], bool] = bool
) -> list[Finding]:
    """The same for given text; ``path`` is its name, and xacro resolves includes from there. Of a
    description the ``wanted`` rules are asked."""
    return _linted(path, lambda: data, settings, wanted)


def _linted(
    path: str,
    read: Callable[[], bytes],
    settings: Settings,
    wanted: Callable[[Rule], bool] = bool,
) -> list[Finding]:
    found: list[Finding] = []
    sources: dict[str, bytes] = {}
    try:
        with _limited(settings.seconds), gc_paused():
            sources[path] = data = read()
            beside = is_named_beside(path) or (path.endswith(_BY_TEXT) and kind_of(data))
            if not beside or kind_of(data):
                refuse_templates(data, path)
            if beside:
                return sorted(_beside(path, data, settings), key=by_place)
            _look(path, data, settings, wanted, found, sources)
    except InputError as error:
        found.append(failure(path, error, settings))
    except _TooLongError:
        found.append(too_long(path, settings.seconds))
    except VocabularyError:
        raise
    except Exception as error:  # the other files are still linted
        found.append(breakdown(path, error))
    return sorted(unsuppressed(_merged(found), sources, settings), key=by_place)


def _look(
    path: str,
    data: bytes,
    settings: Settings,
    wanted: Callable[[Rule], bool],
    found: list[Finding],
    sources: dict[str, bytes],
) -> None:
    """Adds findings, and the files that were read; the subjects are let go before the garbage
    collector is back, which would look through all of them."""
    for subject in read_subjects(path, data, settings):
        if isinstance(subject, Failed):
            it = failure(path, subject.error, settings)
            found.append(it._replace(arguments=subject.arguments))
            continue
        found += lint_subject(subject, wanted)
        sources |= {**subject.sources, path: data}


def _beside(path: str, data: bytes, settings: Settings) -> list[Finding]:
    from multibot_rewrite.lint.beside import beside_findings  # a description needs none of it

    return unsuppressed(list(beside_findings(path, data, settings)), {}, settings)


def lint_subject(subject: Subject, wanted: Callable[[Rule], bool] = bool) -> list[Finding]:
    """What the active rules find in one document, those that are ``wanted``."""
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


def _merged(found: Iterable[Finding]) -> list[Finding]:
    """A finding that several expansions have is reported once, for the first of them."""
    first: dict[Finding, Finding] = {}
    for finding in found:
        first.setdefault(finding._replace(arguments=""), finding)
    return list(first.values())


@contextmanager
def _limited(seconds: float) -> Iterator[None]:
    """Raise _TooLongError after that time; only a process's main thread can be stopped like that."""
    before: Any = None
    with suppress(ValueError):  # raised in other threads; to ask threading is slow to import
        before = signal.signal(signal.SIGALRM, _stop)
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


def _stop(*_: object) -> NoReturn:
    raise _TooLongError


def unsuppressed(
    findings: Sequence[Finding], sources: Mapping[str, bytes], settings: Settings
) -> list[Finding]:
    """The findings that no comment and no per-file setting suppresses, and those about comments.

    The first of ``sources`` is the file that is linted, the others are those it includes.
    """
    reported = [it for it in findings if not is_silent(settings, file_of(it), it.code)]
    if not any(MARK in source for source in sources.values()):
        return reported
    # Few files have a comment for the lint.
    from multibot_rewrite.lint.config.comments import after_comments

    return after_comments(reported, {it.code for it in findings}, sources, settings)
