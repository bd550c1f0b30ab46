# SPDX-License-Identifier: Apache-2.0
"""What rules about several robots share: which claims they check, and examples."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from operator import itemgetter

from lxml.etree import _Element

from multibot_rewrite.base.model import Claim, SiteRow
from multibot_rewrite.base.naming import NOT_PLAIN, make_naming
from multibot_rewrite.description.rewriters.insert import Insertion, insertions
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.subject import Subject

# Frames, tf and topics are all per robot: what a rewrite inserts for that is shared by copies.
APART = make_naming("both")
AS_WRITTEN = make_naming("tf-per-robot")
ONE_TF = make_naming("frames-per-robot")


def claims_of(subject: Subject, kinds: tuple[str, ...]) -> list[Claim]:
    """Claims whose first kind is one of ``kinds``, which are no names of links or joints; only plugins,
    sensors and hardware have them."""
    by_kind = _claims_by_kind(subject) if subject.inventory.hosts else {}
    found = [it for kind in kinds for it in by_kind.get(kind, ())]
    return [claim for _, claim in sorted(found, key=itemgetter(0))]


@memoized
def _claims_by_kind(subject: Subject) -> Mapping[str, Sequence[tuple[int, Claim]]]:
    """The claims by their first kind, each with its number; most name a link or joint, and are left
    out."""
    found: dict[str, list[tuple[int, Claim]]] = {}
    for at, claim in enumerate(subject.inventory.claims):
        if claim.site.whole_value_kind:
            continue
        found.setdefault(claim.site.kinds[0], []).append((at, claim))
    return found


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
    for host, it in _insertions(subject):
        tag = it.xml[1:].partition(">")[0].partition(" ")[0]
        if it.shared and it.kind != "namespace" and tag != "remapping":
            yield host, (it.kind, it.old, tag)


def missed(subject: Subject) -> Iterator[tuple[_Element, Insertion]]:
    """The defaults that are names of nothing else, which urdf-postfix would replace."""
    yield from ((host, it) for host, it in _insertions(subject) if not it.shared)


@memoized
def _insertions(subject: Subject) -> list[tuple[_Element, Insertion]]:
    """What a rewrite would insert, with the plugin it is for."""
    declared, hosts = subject.inventory.declared, subject.inventory.served
    may = [it for it in hosts if any(map(_may_insert, it[1].sites))]
    plugins = {host for host, _ in may}
    found = []
    for it in insertions(may, declared, APART):
        inside = it.parent
        while inside not in plugins:
            inside = inside.getparent()  # type: ignore[assignment]
        found.append((inside, it))
    return found


def _may_insert(site: SiteRow) -> bool:
    return bool(site.default) and "namespace" not in site.kinds
