"""Checks that rules of several groups share."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from multibot_rewrite.checks.remarks import Remark
from multibot_rewrite.lint.records import Problem, Subject


def found_elsewhere(subject: Subject) -> Iterator[Problem]:
    """The check of a rule that no document is asked about, see its comment for who reports it."""
    return iter(())


def problems(remarks: Iterable[Remark]) -> Iterator[Problem]:
    """What a check of the rewrite found, as problems."""
    for it in remarks:
        yield Problem(it.element, it.message, it.attribute, it.hint)
