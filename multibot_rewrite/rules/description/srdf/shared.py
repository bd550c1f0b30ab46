# SPDX-License-Identifier: Apache-2.0
"""What rules about an SRDF share."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial, wraps

from multibot_rewrite.base.findings.finding import WARNING
from multibot_rewrite.base.findings.rule import SRDF, rule
from multibot_rewrite.description.checks.planning_groups import is_pinocchios
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.description.references.undeclared import undeclared
from multibot_rewrite.rules.subject import Subject

SHOWN = 5
# A rule about an SRDF.
srdf_rule = partial(rule, formats=(SRDF,))


def of_moveit(
    check: Callable[[Subject], Iterator[Problem]],
) -> Callable[[Subject], Iterator[Problem]]:
    """A check of what MoveIt alone reads: an SRDF for Pinocchio is left alone."""

    @wraps(check)
    def found(subject: Subject) -> Iterator[Problem]:
        if not is_pinocchios(subject.document.root):
            yield from check(subject)

    return found


def level_of(subject: Subject) -> str:
    """How bad a name is that the URDF does not have, where it is no error: Pinocchio leaves a joint
    of a state out and reads no group; a URDF that was found may be another variant of the robot."""
    is_named = subject.settings.urdf and not is_pinocchios(subject.document.root)
    return "" if is_named else WARNING


def undeclared_for_moveit(code: str) -> Callable[[Subject], Iterator[Problem]]:
    """The names of a rule that nothing declares, in an SRDF for MoveIt."""

    def check(subject: Subject) -> Iterator[Problem]:
        return undeclared(code, subject)

    return of_moveit(check)
