# SPDX-License-Identifier: Apache-2.0
"""xacro arguments that are given and that nothing takes."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.nearest import did_you_mean_one_of
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.settings import EVERY_FILE, ArgumentSet
from multibot_rewrite.rules.subject import Subject


@rule(
    "MB144",
    "argument-not-read",
    WARNING,
    options={"arguments": (ArgumentSet(EVERY_FILE, (("tf_prefix", "left_"),)),)},
)
def argument_not_read(subject: Subject) -> Iterator[Problem]:
    """Arguments of one expansion; one that is for many files need not be for each."""
    if not subject.given:
        return
    from multibot_rewrite.description.checks.arguments import unread_arguments
    from multibot_rewrite.description.sources.known_arguments import known_arguments

    known = known_arguments(subject.sources.values())
    lacking = known.lacks(subject.given) if known else ()
    others = subject.settings.elsewhere
    if known and others is not None:
        lacking = others.lacks(it for it in lacking if did_you_mean_one_of(it, known.names))
    if known and lacking:
        yield from unread_arguments(subject.document.root, lacking, known.names)
