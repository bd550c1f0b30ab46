"""Frames that are not links of the robot."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.conventions import SENT_FRAMES
from multibot_rewrite.base.findings.finding import NOTE, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.model import Claim
from multibot_rewrite.base.naming import FRAME_KINDS
from multibot_rewrite.base.nearest import HINTED, meant_name
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.references import where
from multibot_rewrite.description.rewriters.spelling import must_be_declared, names_in
from multibot_rewrite.rules.description.examples import a_link
from multibot_rewrite.rules.description.references.lookup import references
from multibot_rewrite.rules.description.references.shared import a_plugin
from multibot_rewrite.rules.subject import Subject


@rule(
    "MB217",
    "frame-not-a-link",
    WARNING,
    what="The frame of a sensor or plugin is not a link of the robot. It is a note where no link "
    "has almost the same name.",
    why="Unless another node publishes that frame, tf does not have it and every subscriber drops the "
    "messages ('frame does not exist').",
    fix="Use the name of a link; if another node publishes the frame, suppress the finding.",
    bad=a_link("base_link")
    + a_plugin("gazebo_ros_p3d", "p", "<ros/>", "<frame_name>base_lnik</frame_name>"),
    good=a_link("base_link")
    + a_plugin("gazebo_ros_p3d", "p", "<ros/>", "<frame_name>base_link</frame_name>"),
    line=5,
)
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
