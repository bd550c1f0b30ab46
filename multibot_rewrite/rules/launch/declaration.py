# SPDX-License-Identifier: Apache-2.0
"""How a rule about a launch file is declared."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

from multibot_rewrite.base.findings.finding import ERROR, Finding
from multibot_rewrite.base.findings.rule import Rule, rule
from multibot_rewrite.system.records import Place

LAUNCH = "launch"
_Check = TypeVar("_Check", bound=Callable[..., Any])


def launch_rule(code: str, name: str, *, level: str = ERROR) -> Callable[[_Check], Rule]:
    """Make a function a rule about what a launch starts: it gets a ``Launched`` and yields findings."""
    return rule(code, name, level, formats=(LAUNCH,))


def at(rule_: Rule, place: Place, message: str, hint: str, **more: Any) -> Finding:
    """A finding of a rule at a place."""
    own = {"file": place.file, "line": place.line, "column": place.column or 1}
    return rule_.finding(message, hint, **own, **more)
