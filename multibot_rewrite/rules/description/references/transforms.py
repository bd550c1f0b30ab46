# SPDX-License-Identifier: Apache-2.0
"""Frames that are no links, and frames that the joints of a description place and a plugin as well."""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.base.conventions import SENT_FRAMES
from multibot_rewrite.base.findings.finding import NOTE, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.model import Claim
from multibot_rewrite.base.naming import FRAME_KINDS, make_naming
from multibot_rewrite.base.nearest import HINTED, meant_name
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.references import where
from multibot_rewrite.description.rewriters.own_defaults import frame_sites
from multibot_rewrite.description.rewriters.spelling import must_be_declared, names_in
from multibot_rewrite.description.rewriters.text import text_at
from multibot_rewrite.rules.description.references.undeclared import references
from multibot_rewrite.rules.subject import Subject

AS_WRITTEN = make_naming("tf-per-robot")


@rule("MB230", "frame-of-joint-and-plugin", WARNING)
def frame_with_two_parents(subject: Subject) -> Iterator[Problem]:
    """Plugins that send odometry to a link below the root."""
    for plugin, parent, child in _sent(subject):
        if parent == child:
            hint = "name the odometry frame and the robot's root link"
            yield Problem(plugin, f"sends {parent} -> {child}, a frame to itself", None, hint)
        for joint in subject.robot.above.get(child, ())[:1]:
            message = (
                f"sends {parent} -> {child}, and so does joint {joint.name!r} from {joint.parent}"
            )
            hint = f"name the robot's root link, or switch one of them off; joint {joint.name}"
            line = "" if subject.origins else f": line {joint.element.sourceline}"
            yield Problem(plugin, message, None, hint + line)


def _sent(subject: Subject) -> Iterator[tuple[_Element, str, str]]:
    """Each plugin with the transform of odometry that it sends."""
    root, served = subject.document.root, subject.inventory.served
    for host, section in served:
        # gz-sim's send theirs by a bridge.
        frames = [text_at(host, it.path) for it in frame_sites(host, section, AS_WRITTEN)]
        if len(frames) == 2 and all(frames):
            yield host, frames[0], frames[1]
    if any("/tf" in section.publishes for _, section in served):
        # Most descriptions need none of it.
        from multibot_rewrite.description.readback.reading import transforms_sent

        yield from transforms_sent(root, subject.tree.vocabulary)


@rule("MB217", "frame-not-a-link", WARNING)
def frame_not_a_link(subject: Subject) -> Iterator[Problem]:
    """Frames that the robot does not have; others than misspelt ones may be a localisation's."""
    for claim, name, near in _frames(subject):
        message = f"{where(claim)} names the frame {name!r}, which is not a link"
        place = (claim.element, message, claim.attribute)
        if near:
            yield Problem(*place, f"did you mean {near!r}?")
        elif not claim.site.default and not name.endswith(SENT_FRAMES):
            yield Problem(*place, "another node must publish it", level=NOTE)


def _frames(subject: Subject) -> Iterator[tuple[Claim, str, str]]:
    """Frames that nothing declares, and the link that was meant, if one is near enough."""
    declared = subject.inventory.declared
    links = declared["link"]
    meant: dict[str, str] = {}
    for claim in references(subject).doubtful if links else ():
        site = claim.site
        if FRAME_KINDS.isdisjoint(site.kinds) or "frame" not in site.kinds:
            continue
        if must_be_declared(site) or site.form != "whole":
            continue
        for name in (part.text for part in names_in(claim, declared)):
            # A frame_prefix or namespace may come before the link's name at run time.
            own = name.rpartition("/")[2]
            known = (it in declared[kind] for it in (own, name) for kind in ("link", *site.kinds))
            if own in SENT_FRAMES or f"/{own}" in links or any(known):
                continue
            if name not in meant:
                meant[name] = meant_name(own, links) if len(meant) < HINTED else ""
            yield claim, name, meant[name]
