# SPDX-License-Identifier: Apache-2.0
"""Files that cannot be read, or are not a robot description as they are."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.base.findings.rule import URDF, declare, rule
from multibot_rewrite.base.nearest import did_you_mean_one_of
from multibot_rewrite.companions.kinds import EVERY
from multibot_rewrite.description.checks.audit import leftover_xacro, worlds
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.twice import already_rewritten
from multibot_rewrite.rules.declaration import OF_TWO
from multibot_rewrite.rules.settings import EVERY_FILE, ArgumentSet
from multibot_rewrite.rules.subject import Subject

# These five are reported where a file is read or expanded: see ``failures``.
not_xml = declare("MB101", "not-xml", ERROR)

unreadable = declare("MB102", "unreadable", ERROR)

xacro_failed = declare("MB103", "xacro-failed", ERROR)

needs_argument = declare("MB145", "needs-argument", NOTE)

package_not_found = declare("MB119", "not-expanded", NOTE)


@rule("MB105", "placeholder-left", WARNING, formats=(URDF, *EVERY))
def leftover(subject: Subject) -> Iterator[Problem]:
    """One finding for a description, at the first of them."""
    return leftover_xacro(subject.inventory)


@rule("MB106", "already-rewritten", WARNING, options=OF_TWO)
def already(subject: Subject) -> Iterator[Problem]:
    """One finding per file, for the first robot whose name is in it."""
    # What has a robot's name by an argument has it by its author.
    robots = [it for it in subject.settings.robots if it not in subject.arguments]
    found = already_rewritten(subject.inventory, robots, False)
    for it in islice(found, 1):
        yield it._replace(hint="lint the source it was made from")


@rule("MB109", "sdf-world", ERROR, options=OF_TWO)
def sdf_world(subject: Subject) -> Iterator[Problem]:
    """Every world of the file; one that is only a world has no robots."""
    return worlds(subject.inventory) if subject.settings.robots else iter(())


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
