# SPDX-License-Identifier: Apache-2.0
"""What the rules of descriptions find in those of a fleet's robots: every error of the lint, and what a
simulator leaves out."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.description.steps.document import Document
from multibot_rewrite.fleet.robots.member import Member
from multibot_rewrite.rules.settings import Settings


def wrong_in_descriptions(
    members: Iterable[Member], vocabulary: tuple[str, ...], simulated: Iterable[Member]
) -> Iterator[Finding]:
    """What stops robots with these descriptions, each once; the ``simulated`` ones run in Gazebo."""
    in_gazebo = {it.source.file for it in simulated}
    documents = {one.file: (one, it) for it in members for one in (it.sent, it.source)}
    for file, (document, it) in documents.items():
        distro = it.vocabulary.release
        settings = Settings(vocabulary=vocabulary, distro=distro, simulated=file in in_gazebo)
        told = {(one.code, one.message) for one in it.shared}
        for one in _linted(document, settings):
            if (one.code, one.message) not in told:
                yield one


def _linted(document: Document, settings: Settings) -> Iterator[Finding]:
    # What only looks at a robot's files needs none of the lint.
    from multibot_rewrite.lint.check import lint_subject, unsuppressed
    from multibot_rewrite.lint.described import in_use, may_stop
    from multibot_rewrite.lint.files.subjects import make_subject

    found = lint_subject(make_subject(document, settings), may_stop)
    asked = unsuppressed(found, {document.file: document.source}, settings)
    return in_use(asked, document, settings.simulated)
