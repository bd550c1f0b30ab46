# SPDX-License-Identifier: Apache-2.0
"""What the rules of descriptions find in those of a fleet's robots: every error of the lint, and what a
simulator leaves out."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding, locate
from multibot_rewrite.base.findings.rule import Rule
from multibot_rewrite.fleet.robots.member import Member
from multibot_rewrite.rules.settings import LEFT_OUT, Settings


def wrong_in_descriptions(
    members: Iterable[Member],
    vocabulary: tuple[str, ...],
    chosen: Iterable[Member] = (),
    real: Iterable[Member] = (),
) -> Iterator[Finding]:
    """What the lint calls an error in the descriptions, each once, and what Gazebo leaves out of those
    that are for it. Of robots that run in it (``chosen``) that is an error; of ``real`` ones nothing
    counts that is for a simulator."""
    sure, not_simulated = ({it.source.file for it in its} for its in (chosen, real))
    documents = {it.source.file: it for it in members}
    for file, it in documents.items():
        is_real = file in not_simulated - sure
        weighed = () if is_real or not (file in sure or _is_for_gazebo(it)) else LEFT_OUT
        asked = Settings(
            vocabulary=vocabulary, distro=it.vocabulary.release, simulated=file in sure
        )
        for found in _linted(it, asked, weighed):
            if is_real and _is_for_a_simulator(it, found):
                continue
            stops = found.code in LEFT_OUT and file in sure
            yield found if stops or found.level != ERROR else found._replace(level=WARNING)


def _linted(it: Member, settings: Settings, weighed: Collection[str]) -> Iterator[Finding]:
    # What only looks at a robot's files needs none of the lint.
    from multibot_rewrite.lint.check import lint_subject, unsuppressed
    from multibot_rewrite.lint.files.subjects import make_subject

    subject = make_subject(it.source, settings)
    every = lint_subject(subject, _may_stop)
    found = [one for one in every if one.level == ERROR or one.code in weighed]
    told = {(one.code, one.message) for one in it.shared}
    for one in unsuppressed(found, {it.source.file: it.source.source}, settings):
        is_asked = one.code in weighed or one.code not in LEFT_OUT
        if is_asked and (one.code, one.message) not in told:
            yield one


def _may_stop(rule: Rule) -> bool:
    """Can a finding of the rule be an error?"""
    return rule.level == ERROR or rule.code in LEFT_OUT


def _is_for_gazebo(member: Member) -> bool:
    blocks = member.inventory.document.root.iter("gazebo")
    return any(it.find(tag) is not None for it in blocks for tag in ("plugin", "sensor"))


def _is_for_a_simulator(member: Member, found: Finding) -> bool:
    """Is it about a ``<gazebo>`` block?"""
    document = member.source
    starts = zip(document.elements, document.starts, strict=True)
    before = [
        it
        for it, at in starts
        if it.getparent() is document.root and locate(document.source, at)[0] <= found.line
    ]
    return bool(before) and before[-1].tag == "gazebo"
