# SPDX-License-Identifier: Apache-2.0
"""What is known about the values on one line of a document, and what becomes of them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import locate
from multibot_rewrite.base.model import Claim, SiteRow
from multibot_rewrite.base.naming import FRAME_KINDS, PREFIX, TOPIC_KINDS, Naming
from multibot_rewrite.description.checks.mentions import MENTIONED, kept, mentioned
from multibot_rewrite.description.reports.paths import tag_path
from multibot_rewrite.description.rewriters.forms import IN_FRONT
from multibot_rewrite.description.rewriters.insert import Insertion, without
from multibot_rewrite.description.rewriters.spelling import ROBOT_SLOT, ResolvedName, respelled
from multibot_rewrite.description.rewriters.text import text_of
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.description.steps.document import value_slot
from multibot_rewrite.description.steps.plan import Plan, make_plan


class Explanation(NamedTuple):
    """One value: its place, the site that claims or keeps it if any, and in words what follows.

    ``new`` is the value for the robot; ``inserted`` are elements the plugin at this place gets.
    ``source`` is where the vocabulary has it from, empty where it does not say. ``made_of`` are the
    pieces that a xacro makes the value of, in words. ``within`` is the description that includes the
    file of the line, empty where the file is that itself.
    """

    line: int
    column: int
    path: str
    value: str
    site: SiteRow | None
    reason: str
    new: str
    inserted: tuple[str, ...] = ()
    source: str = ""
    made_of: tuple[str, ...] = ()
    within: str = ""


def explain_line(
    inventory: Inventory, naming: Naming, tree: Tree, robot: str, line: int
) -> list[Explanation]:
    """Everything that starts on ``line``, in source order; empty where nothing does."""
    plan = make_plan(inventory, naming)
    found = [*_claimed(inventory, plan, naming, robot, line), *_others(inventory, tree, line)]
    found += _inserted(inventory, plan, robot, line)
    found = [it._replace(source=_source(tree, it.site)) if it.site else it for it in found]
    return sorted(found, key=lambda item: (item.column, item.path))


def _source(tree: Tree, site: SiteRow) -> str:
    """The source of the section that has the site."""
    type_, name, *_ = site.section.split(" ")
    sections = tree.vocabulary.find(type_, name)
    return next((it.source for it in sections if it.source and site in it.sites), "")


def _claimed(
    inventory: Inventory, plan: Plan, naming: Naming, robot: str, line: int
) -> Iterator[Explanation]:
    recomputed = {claim.start: new.replace(ROBOT_SLOT, robot) for claim, new in plan.collisions}
    values = zip(inventory.claims, inventory.names, plan.renames.values, strict=True)
    for claim, names, spelling in values:
        place = _place(inventory, claim.start, claim.attribute, claim.value)
        if place[0] != line:
            continue
        new = respelled(claim.value, spelling, robot)
        if claim.site.form == "collision":
            new = recomputed.get(claim.start, claim.value)
        reason = "; ".join(_reasons(inventory, claim, names, naming)) or "it holds no name"
        path = tag_path(claim.element, claim.attribute)
        yield Explanation(*place, path, claim.value, claim.site, reason, new)


def _reasons(
    inventory: Inventory, claim: Claim, names: Iterable[ResolvedName], naming: Naming
) -> Iterator[str]:
    """What each name in the value is, and why it stays where it does."""
    declared = inventory.declared
    if claim.site.form == "collision":
        yield "a collision, named after its link by the conversion to SDF"
    if claim.site.form in IN_FRONT and naming.affix != PREFIX:
        yield "the plugin puts it in front of names, so a postfix cannot be added"
        return
    for name in names:
        kind = name.kind
        where = declared.get(kind, {}).get(name.text)
        known = f", declared at {_line_of(inventory, where)}" if where not in (None, claim) else ""
        stays = _stays(naming, kind, name.text, claim.site.namespaced)
        yield f"{kind or ' or '.join(name.kinds)} {name.text!r}{known}{stays and ': '}{stays}"


def _line_of(inventory: Inventory, claim: Claim | None) -> str:
    assert claim is not None
    here = claim.element.getroottree().getroot() is inventory.document.root
    return f"line {claim.element.sourceline}{'' if here else ' of the URDF'}"


def _stays(naming: Naming, kind: str, name: str, namespaced: bool) -> str:
    """Why a name is not spelled; empty where it is, or where only its look forbids it."""
    bare = name.strip("/")
    reasons = (
        (not kind, "not declared, so it is not renamed"),
        ((kind, name) in naming.own, "the xacro's arguments have put the robot's name into it"),
        (kind not in naming.separators, f"layout {naming.layout.name} does not rename {kind}s"),
        (kind in FRAME_KINDS and bare in naming.shared_frames, "a shared frame (--shared)"),
        (kind in TOPIC_KINDS and bare in naming.shared_topics, "a shared topic (--shared)"),
        (kind in TOPIC_KINDS and name.startswith("~"), "private to its node"),
        (kind in TOPIC_KINDS and namespaced and name[:1] != "/" and naming.topics == "namespace",
         "the namespace reaches it"),
    )  # fmt: skip
    return next((words for holds, words in reasons if holds), "")


def _others(inventory: Inventory, tree: Tree, line: int) -> Iterator[Explanation]:
    """Values on the line that no site claims."""
    document = inventory.document
    claimed = {(claim.start, claim.attribute) for claim in inventory.claims}
    for element, start in zip(document.root.iter("*"), document.starts, strict=True):
        slots = [(str(key), str(value)) for key, value in element.items()]
        slots.append(("", text_of(element)))
        for attribute, value in slots:
            place = _place(inventory, start, attribute, value)
            if value and place[0] == line and (start, attribute) not in claimed:
                site = kept(element, attribute, tree, {})
                reason = site.note if site else _unclaimed(inventory, value)
                path = tag_path(element, attribute)
                yield Explanation(*place, path, value, site, reason, value)


def _unclaimed(inventory: Inventory, value: str) -> str:
    names = frozenset(name for kind in MENTIONED for name in inventory.declared[kind])
    name = mentioned(value, names)
    return f"it holds the name {name!r}" if name else "it holds no declared name"


def _inserted(inventory: Inventory, plan: Plan, robot: str, line: int) -> Iterator[Explanation]:
    """Plugins on the line that get elements of their own, and empty elements on it that get a text."""
    source = inventory.document.source
    starts = dict(zip(inventory.document.elements, inventory.document.starts, strict=True))
    for host in inventory.hosts if plan.insertions else ():
        name = host.node.section.name if host.node.section else ""
        place = locate(source, host.start)
        inside = {host.element, *host.element.iterchildren("ros")}
        mine = [item for item in plan.insertions if item.parent in inside]
        added = tuple(item.xml.replace(ROBOT_SLOT, robot) for item in mine if not item.step)
        if place[0] == line and added:
            reason = f"added, or {without(mine[0], inventory.release)} the default"
            yield Explanation(*place, tag_path(host.element, ""), name, None, reason, name, added)
        for item in mine:
            there = item.filled
            place = (0, 0) if there is None else locate(source, starts[there])
            if there is not None and place[0] == line:
                text = item.xml.replace(ROBOT_SLOT, robot)
                reason = f"filled: empty it is read as {item.old!r}, which {_who(item)}"
                path = tag_path(there, "")
                yield Explanation(*place, path, name, None, reason, name, (text,))


def _who(item: Insertion) -> str:
    return "all robots would share" if item.shared else "nothing else has"


def _place(inventory: Inventory, start: int, attribute: str, value: str) -> tuple[int, int]:
    source = inventory.document.source
    slot = value_slot(source, start, attribute, value) if value else None
    return locate(source, slot[0] if slot else start)
