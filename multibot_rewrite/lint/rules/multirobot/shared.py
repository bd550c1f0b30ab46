"""What rules about several robots share: which claims they check, and examples."""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.lint.records import Subject
from multibot_rewrite.model import Claim, Site
from multibot_rewrite.naming import NOT_PLAIN, make_naming
from multibot_rewrite.rewriters.insert import insertions

TWO = ("robot1", "robot2")
# Frames, tf and topics are all per robot: what a rewrite inserts for that is shared by copies.
APART = make_naming("both")
AS_WRITTEN = make_naming("tf-per-robot")
ONE_TF = make_naming("frames-per-robot")


def claims_of(subject: Subject, kinds: tuple[str, ...]) -> list[Claim]:
    """Claims whose first kind is one of ``kinds``; only plugins, sensors and hardware have them."""
    if not subject.inventory.hosts:
        return []
    return [it for it in subject.inventory.claims if it.site.kinds[0] in kinds]


def is_plain(text: str) -> bool:
    """Is it a name: not empty and not a placeholder?"""
    return bool(text.strip("/")) and NOT_PLAIN.isdisjoint(text) and not text.startswith("__")


def tag_of(claim: Claim) -> str:
    """How a message names the element of a claim."""
    name = claim.element.get("name") if claim.element.tag == "param" else None
    return f"parameter {name!r}" if name else f"<{claim.element.tag}>"


def process_wide_plugins(subject: Subject) -> set[_Element]:
    """The plugins that hand their remap rules to the whole Gazebo process."""
    hosts = subject.inventory.hosts
    return {it.element for it in hosts if it.node.section and it.node.section.process_wide}


def inserted(subject: Subject) -> Iterator[tuple[_Element, tuple[str, str, str]]]:
    """Kind, default and tag of what urdf-postfix would insert, except namespaces."""
    declared = subject.inventory.declared
    for host in subject.inventory.hosts:
        section = host.node.section
        if section is None or not any(map(_may_insert, section.sites)):
            continue
        for it in insertions(host.element, section, declared, APART):
            tag = it.xml[1:].partition(">")[0].partition(" ")[0]
            if it.kind != "namespace" and tag != "remapping":
                yield host.element, (it.kind, it.old, tag)


def _may_insert(site: Site) -> bool:
    return bool(site.default) and "namespace" not in site.kinds
