# SPDX-License-Identifier: Apache-2.0
"""How a rule about a system, or a plan and a system, is declared: on the function that finds it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, Literal, TypeVar

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.findings.rule import Rule, rule
from multibot_rewrite.base.record import NamedTuple

if TYPE_CHECKING:
    from multibot_rewrite.system.index import Index

_Check = TypeVar("_Check", bound=Callable[..., Any])
_Pair = Callable[["Index", "Index"], Iterator[Finding]]
# How pictures show what a finding is about; "" is violet for an error, blue for a warning.
Drawn = Literal["", "missing", "leak", "cross-talk", "unexpected"]
# What the examples of a rule are written in: lines of a system, or of a plan and a system.
SYSTEM, PAIR = "system", "pair"


class Finder(NamedTuple):
    """A function that finds by a plan what ``rule`` is about. With ``nodes`` it asks which nodes run,
    which a recording does not know."""

    rule: Rule
    find: _Pair
    nodes: bool


def system_rule(
    code: str,
    name: str,
    level: str,
    *,
    absence: bool = False,
    drawn: Drawn = "",
    all_ends: bool = False,
    meant: tuple[str, ...] = (),
    robot_wide: bool = False,
) -> Callable[[_Check], Rule]:
    """Makes a function a rule about any system: it gets an ``Index`` and yields what its own
    ``finding`` makes.

    ``absence``: the rule finds that something is missing, which an incomplete view cannot prove.
    ``all_ends``: a finding names one node, and is about all nodes that use the names. ``meant`` are
    roles: where all who have them at the names of a finding are planned to, it is no fault.
    ``robot_wide``: what a plan finds of a robot is all that there is of it. The examples are lines of
    ``tests/support/graph_examples.py`` that begin with ``running:``.
    """
    options = system_options(absence, drawn, all_ends, meant, robot_wide)
    return rule(code, name, level, formats=(SYSTEM,), options=options)


def system_options(
    absence: bool = False,
    drawn: Drawn = "",
    all_ends: bool = False,
    meant: tuple[str, ...] = (),
    robot_wide: bool = False,
) -> dict[str, object]:
    """The options of a rule about any system, as in ``system_rule``."""
    options: dict[str, object] = {"absence": absence, "drawn": drawn, "all_ends": all_ends}
    return {**options, "meant": meant, "robot_wide": robot_wide}


def pair_rule(
    code: str,
    name: str,
    level: str,
    *,
    absence: bool = False,
    drawn: Drawn = "",
    nodes: bool = True,
) -> Callable[[_Check], Rule]:
    """Makes a function a rule about a plan and what is seen: it gets the ``Index`` of
    each.

    ``nodes``: it asks which nodes run, which a recording does not know. The rest is as for
    ``system_rule``.
    """
    options = {"absence": absence, "drawn": drawn, "all_ends": False, "nodes": nodes}
    return rule(code, name, level, formats=(PAIR,), options=options)


def found_by_plan(*rules: Rule, nodes: bool = True) -> Callable[[_Pair], Finder]:
    """Makes a function one that finds, by a plan, what system rules are about: the same fault, which
    the plan shows where the system alone does not, or of which it knows the cause."""
    return lambda find: Finder(rules[0], find, nodes)
