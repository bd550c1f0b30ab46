# SPDX-License-Identifier: Apache-2.0
"""Links, joints and other names that are used and not declared."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from multibot_rewrite.base.findings.finding import ERROR, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.references import where
from multibot_rewrite.rules.description.references.lookup import references, undeclared
from multibot_rewrite.rules.subject import Subject

undeclared_link = rule("MB202", "undeclared-link", ERROR)(partial(undeclared, "MB202"))

undeclared_joint = rule("MB211", "undeclared-joint", ERROR)(partial(undeclared, "MB211"))

undeclared_sdf_name = rule("MB219", "undeclared-sdf-name", WARNING)(partial(undeclared, "MB219"))


@rule("MB221", "padded-reference", ERROR)
def padded_reference(subject: Subject) -> Iterator[Problem]:
    """Attributes that are the name of a link or joint."""
    declared = subject.inventory.declared
    for claim in references(subject).doubtful:
        name = claim.value.strip()
        if not claim.attribute or name == claim.value or claim.site.form != "whole":
            continue
        found = [declared[kind][name] for kind in claim.site.kinds if name in declared[kind]]
        if found and all(it.value != claim.value for it in found):
            message = f"{where(claim)} is {claim.value!r}, the {claim.site.kinds[0]} is {name!r}"
            yield Problem(claim.element, message, claim.attribute, "delete the white space")
