# SPDX-License-Identifier: Apache-2.0
"""A rule: its code, level and check. Its words and examples are its page, ``rules/pages/CODE.md``."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, TypeVar

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.findings.rule_page import RulePage, rule_page
from multibot_rewrite.base.record import NamedTuple

URDF, SRDF, XACRO = "urdf", "srdf", "xacro"
NOTHING: Mapping[str, Any] = {}
_Check = TypeVar("_Check", bound=Callable[..., Any])


class Rule(NamedTuple):
    """A rule, with its words and examples.

    ``check`` is the function that finds the fault, None where several functions raise it.
    ``formats`` are what the examples are written in; in a ``urdf``, ``srdf`` or ``xacro`` a text that
    starts with neither ``<?xml`` nor ``<robot`` belongs inside ``<robot name="r">``. ``options`` say
    how the examples are checked. ``examples`` names the page of the examples where it is not that
    of the code.
    """

    code: str
    name: str
    level: str
    check: Callable[..., Any] | None = None
    formats: tuple[str, ...] = (URDF,)
    options: Mapping[str, object] = NOTHING
    examples: str = ""

    @property
    def what(self) -> str:
        """What the rule finds."""
        return rule_page(self.code).what

    @property
    def why(self) -> str:
        """Why that hurts at run time."""
        return rule_page(self.code).why

    @property
    def fix(self) -> str:
        """How to mend it."""
        return rule_page(self.code).fix

    @property
    def page(self) -> RulePage:
        """The page with the examples."""
        return rule_page(self.examples or self.code)

    @property
    def bad(self) -> str:
        """A text that has the finding exactly once, in line ``line``."""
        return self.page.bad

    @property
    def good(self) -> str:
        """A text that does not have the finding."""
        return self.page.good

    @property
    def fixed(self) -> str:
        """What the fix makes of ``bad``; empty where there is none."""
        return self.page.fixed

    @property
    def line(self) -> int:
        """The line of ``bad`` with the finding."""
        return self.page.line

    @property
    def beside(self) -> Mapping[str, str]:
        """The files beside the example, by name."""
        return self.page.beside

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
    formats: tuple[str, ...] = (URDF,),
    options: Mapping[str, object] = NOTHING,
) -> Rule:
    """Return a rule; without a function of its own it is for what a step or several functions find."""
    return Rule(code, name, level, check, formats, options)


def rule(code: str, name: str, level: str, **about: Any) -> Callable[[_Check], Rule]:
    """Make the function that looks for a fault a ``Rule``; ``about`` is as for ``declare``."""
    return partial(declare, code, name, level, **about)
