# SPDX-License-Identifier: Apache-2.0
"""C++ of simulator plugins -> which parameters they need, and which words they compare one with."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from multibot_rewrite.producers.sources.expressions import nodes_of, text_of

if TYPE_CHECKING:
    from multibot_rewrite.producers.sources.expressions import Node

# What is inside of these may be left out.
CONDITIONAL = (
    *("if_statement", "for_statement", "while_statement", "for_range_loop"),
    *("try_statement", "lambda_expression", "conditional_expression", "switch_statement"),
)
_MISSING = re.compile(
    r"\(\s*!\s*[\w.>-]*->\s*(?:HasElement|FindElement|GetElement)\(\"(\w+)\"\)\s*\)"
)
_THERE = re.compile(r"\(\s*[\w.>-]*->\s*HasElement\(\"(\w+)\"\)\s*\)")
_COMPLAINS = re.compile(r"err\b|ERROR|throw|FATAL|ASSERT|FailedToLoad")


def required_in(text: str) -> Iterator[str]:
    """Names whose absence ends the function: ``if (!_sdf->HasElement("x")) return;``, or in the
    else."""
    for it in nodes_of(text, ("if_statement",)):
        if is_conditional(it):
            continue
        condition = text_of(it.child_by_field_name("condition"))
        missing, there = _MISSING.fullmatch(condition), _THERE.fullmatch(condition)
        if missing and _ends(it.child_by_field_name("consequence")):
            yield missing[1]
        elif there and _ends(it.child_by_field_name("alternative")):
            yield there[1]


def _ends(branch: Any) -> bool:
    if branch is None:
        return False
    statements = [branch, *branch.named_children]
    statements += [below for it in branch.named_children for below in it.named_children]
    ends = any(it.type in ("return_statement", "throw_statement") for it in statements)
    return ends and _COMPLAINS.search(text_of(branch)) is not None


def is_conditional(node: Node) -> bool:
    """Return whether it is in a part of its function that may be left out."""
    above = node.parent
    while above is not None and above.type != "function_definition":
        if above.type in CONDITIONAL:
            return True
        above = above.parent
    return False


def words_in(text: str, variables: dict[str, str]) -> dict[str, tuple[str, ...]]:
    """Return the words that the value of a parameter is compared with, where there are two or more."""
    found: dict[str, dict[str, None]] = {}
    for variable, name in variables.items():
        for it in re.finditer(rf'\b{re.escape(variable)} == "(\w+)"', text):
            found.setdefault(name, {})[it[1]] = None
    return {name: tuple(words) for name, words in found.items() if len(words) > 1}
