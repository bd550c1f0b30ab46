# SPDX-License-Identifier: Apache-2.0
"""A rule: its code, its words and the examples that are its documentation and its test."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, TypeVar

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.record import NamedTuple

URDF, SRDF, XACRO = "urdf", "srdf", "xacro"
NOTHING: Mapping[str, Any] = {}
_Check = TypeVar("_Check", bound=Callable[..., Any])


class Rule(NamedTuple):
    """A rule, its words and its examples.

    ``what`` it finds, ``why`` that hurts at run time, how to ``fix`` it. ``bad`` has the finding
    exactly once, in line ``line``; ``good`` does not have it; ``fixed`` is what the fix makes of
    ``bad``, empty where there is none. ``beside`` maps names to the content of files beside the
    example, ``options`` say how it is checked. ``formats`` are what the examples are written in; in
    a ``urdf``, ``srdf`` or ``xacro`` a text that starts with neither ``<?xml`` nor ``<robot``
    belongs inside ``<robot name="r">``. ``check`` is the function that finds it, None where several
    functions raise it.
    """

    code: str
    name: str
    level: str
    what: str
    why: str
    fix: str
    bad: str
    good: str
    line: int = 1
    fixed: str = ""
    check: Callable[..., Any] | None = None
    formats: tuple[str, ...] = (URDF,)
    beside: Mapping[str, str] = NOTHING
    options: Mapping[str, object] = NOTHING

    def finding(self, message: str, hint: str = "", **place: Any) -> Finding:
        """A finding of this rule; ``place`` are the other fields of ``Finding``; one of a line alone
        is at its first column."""
        if "line" in place:
            place.setdefault("column", 1)
        level = place.pop("level", self.level)
        return Finding(self.code, level, message, hint or self.advice, **place)

    @property
    def advice(self) -> str:
        """What to do in few words: the first sentence of ``fix``, as a hint is written.

        Empty where that sentence says to do nothing, or what the hint of each finding has.
        """
        first = self.fix.partition(". ")[0].removesuffix(".")
        if first.startswith("Nothing") or "the hint" in first:
            return ""
        return first[:1].lower() + first[1:]


def declare(
    code: str,
    name: str,
    level: str,
    check: Callable[..., Any] | None = None,
    *,
    what: str,
    why: str,
    fix: str,
    bad: str,
    good: str,
    line: int = 1,
    fixed: str = "",
    formats: tuple[str, ...] = (URDF,),
    beside: Mapping[str, str] = NOTHING,
    options: Mapping[str, object] = NOTHING,
) -> Rule:
    """A rule; without a function of its own it is for what a step or several functions find."""
    words = (code, name, level, what, why, fix, bad, good, line, fixed)
    return Rule(*words, check, formats, beside, options)


def rule(code: str, name: str, level: str, **words: Any) -> Callable[[_Check], Rule]:
    """Makes the function that looks for it a ``Rule``; ``words`` are those of ``declare``."""
    return partial(declare, code, name, level, **words)
