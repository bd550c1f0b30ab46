"""How a rule of the live graph is declared: on the function that finds it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal, TypeVar

from multibot_rewrite.findings.rule import Rule, rule

_Check = TypeVar("_Check", bound=Callable[..., Any])
# How pictures show what a finding is about; "" is violet for an error, blue for a warning.
Drawn = Literal["", "missing", "leak", "cross-talk", "unexpected"]


def graph_rule(
    code: str,
    name: str,
    level: str,
    *,
    absence: bool = False,
    drawn: Drawn = "",
    all_ends: bool = False,
    **words: str | int,
) -> Callable[[_Check], Rule]:
    """Makes a function a rule: it gets a ``View`` and yields what its own ``finding`` makes.

    ``absence``: the rule finds that something is missing, which an incomplete view cannot prove.
    ``all_ends``: a finding names one node, and is about all nodes that use the names. The other
    ``words`` are those of ``findings.rule.declare``; the examples are lines of
    ``tests/support/graph_examples.py``.
    """
    options = {"absence": absence, "drawn": drawn, "all_ends": all_ends}
    return rule(code, name, level, formats=("graph",), options=options, **words)


def danger_rule(
    code: str,
    name: str,
    level: str,
    *,
    absence: bool = False,
    drawn: Drawn = "",
    planned: str = "",
    **words: str | int,
) -> Callable[[_Check], Rule]:
    """Makes a function a rule about any system of several robots: it gets a ``Seen``.

    ``planned`` is the code of the rule that says the same of what is in a plan. Examples have the
    lines of ``graph_rule`` that begin with ``running:``; a robot is every ``robot1``, ``robot2`` ...
    """
    options = {"absence": absence, "drawn": drawn, "all_ends": False, "planned": planned}
    return rule(code, name, level, formats=("danger",), options=options, **words)
