"""What several rules need of one document is computed once and kept with its subject."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import TypeVar

from multibot_rewrite.rules.subject import Subject

_Made = TypeVar("_Made")


def memoized(make: Callable[[Subject], _Made]) -> Callable[[Subject], _Made]:
    """Decorates a function of a subject: it runs once for each, ``subject.memo`` has the result."""

    @wraps(make)
    def look_up(subject: Subject) -> _Made:
        memo = subject.memo
        if make not in memo:
            memo[make] = make(subject)
        made: _Made = memo[make]
        return made

    return look_up
