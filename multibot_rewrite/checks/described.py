# SPDX-License-Identifier: Apache-2.0
"""Errors of the lint in the descriptions of a fleet's robots, and what a simulator leaves out."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.releases import ROS_2
from multibot_rewrite.description.steps.document import Document
from multibot_rewrite.fleet.robots.member import Member
from multibot_rewrite.rules.settings import Settings

_REAL = "for a real robot write simulator: none"
ALREADY = "the robot's own {} for one robot, too"


def wrong_in_descriptions(
    members: Iterable[Member],
    definitions: tuple[str, ...],
    simulated: Iterable[Member],
    said: Iterable[Member] = (),
    launched: Iterable[Member] = (),
    unplaced: Iterable[Member] = (),
) -> Iterator[Finding]:
    """Yield findings about what stops the robots of these descriptions, each once.

    ``simulated`` robots run in Gazebo; for those not in ``said`` (by the fleet file) the hint
    says how to deny it. In descriptions that the user's launch files start (``launched``) errors
    are warnings, except for a model that is missing in the simulator of the fleet file
    (``unplaced``)."""
    # What only looks at a robot's files needs none of the lint.
    from multibot_rewrite.lint.launched import is_of_simulator
    from multibot_rewrite.rules.description.names import reserved_name

    its = (simulated, said, launched, unplaced)
    in_gazebo, sure, own, added = ({it.source.file for it in one} for one in its)
    documents = {
        source.file: (source, made.document, it)
        for it in members
        for source, made in ((it.sent, it.described), (it.source, it.inventory))
    }
    for file, (document, made, it) in documents.items():
        distro = it.definitions.release
        settings = Settings(
            definitions=definitions, distro=distro, ros=ROS_2, simulated=file in in_gazebo
        )
        shared = {(one.code, one.message) for one in it.shared}
        for one in _lint_findings(document, made, settings):
            if (one.code, one.message) in shared:
                continue
            of_simulator = one.level == ERROR and is_of_simulator(one, document)
            hints = (one.hint, _REAL if of_simulator and file in in_gazebo - sure else "")
            found = one._replace(hint="; ".join(filter(None, hints)))
            is_not_made = one.code == reserved_name.code and file in sure & added
            is_own = one.level == ERROR and file in own and not is_not_made
            yield as_known(found, "description has it") if is_own else found


def as_known(it: Finding, what: str) -> Finding:
    """Return a finding as a warning that says what one robot has by itself already."""
    already = ALREADY.format(what)
    hint = f"{it.hint}; {already}" if it.hint else already
    return it._replace(level=WARNING, hint=hint)


def _lint_findings(document: Document, made: Document, settings: Settings) -> Iterator[Finding]:
    """Yield the errors in a document, except those that are mended in ``made``."""
    from multibot_rewrite.lint.check import lint_subject, unsuppressed
    from multibot_rewrite.lint.files.subjects import make_subject
    from multibot_rewrite.lint.launched import in_use, may_stop
    from multibot_rewrite.rules.description.names import reserved_name

    found = lint_subject(make_subject(document, settings), may_stop)
    asked = unsuppressed(found, {document.file: document.source}, settings)
    if any(it.code == reserved_name.code for it in asked):
        left = lint_subject(make_subject(made, settings), lambda it: it is reserved_name)
        asked = [it for it in asked if left or it.code != reserved_name.code]
    return in_use(asked, document, settings.simulated)
