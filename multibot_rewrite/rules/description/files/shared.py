"""What rules about the structure of a URDF share."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.subject import Subject


def faults(kind: str, subject: Subject, *, substitutions: bool = True) -> Iterator[Problem]:
    """The faults of a document's structure (``schema.faults``) of one kind, the name of its rule.

    Without ``substitutions`` values with a ``$`` are left out: MB105 reports them.
    """
    for it in subject.faults:
        if it.kind == kind and (substitutions or "$" not in it.message):
            yield Problem(it.element, it.message, it.attribute, it.hint)
