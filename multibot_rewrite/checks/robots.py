"""Checks that hang on the robots' names: is it done already, do names meet, can it be stripped."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from multibot_rewrite.checks.remarks import Remark, about, told
from multibot_rewrite.model import ERROR, Claim, Finding
from multibot_rewrite.naming import Naming, affix, removal
from multibot_rewrite.rewriters.forms import Declared
from multibot_rewrite.rewriters.spelling import (
    kind_of,
    must_be_declared,
    names_in,
    spell,
    spelled_in,
)
from multibot_rewrite.steps.collect import Inventory
from multibot_rewrite.steps.document import finding
from multibot_rewrite.steps.inserted import markers


def already_rewritten(
    inventory: Inventory, naming: Naming, robots: Iterable[str], again: bool
) -> Iterator[Finding]:
    """Refuse a document that carries a robot's affix on every name, or text inserted for it.

    ``again`` insists, but not where inserted text of two rewrites could not be told apart.
    """
    marked = {mark.robot for mark in markers(inventory.document)}
    for robot in robots:
        if robot in marked or (not again and _spelled_for(inventory, naming, robot)):
            message = f"the description is already rewritten for {robot}"
            hint = "--strip takes it back first" if again else "--again insists, --strip undoes"
            yield finding(inventory.document, 0, "MB106", ERROR, message, hint)


def _spelled_for(inventory: Inventory, naming: Naming, robot: str) -> bool:
    """Does every name that a rewrite would spell carry the robot's affix?"""
    some = False
    for kind, name, namespaced in _renamed(inventory, naming):
        if removal(naming, robot, kind, name, namespaced) is None:
            return False
        some = True
    return some


def _renamed(inventory: Inventory, naming: Naming) -> Iterator[tuple[str, str, bool]]:
    """Kind, name and namespaced of everything the naming spells for a robot."""
    for claim in inventory.claims:
        site = claim.site
        for part in spelled_in(claim, inventory.declared, naming):
            kind = kind_of(part, site.role, inventory.declared)
            if kind and affix(naming, kind, part.text, site.namespaced) is not None:
                yield kind, part.text, site.namespaced


def collisions(inventory: Inventory, naming: Naming, robots: Iterable[str]) -> list[Finding]:
    """Names that stay as they are and are what another name becomes for some robot."""
    return list(told(inventory.document, taken_names(inventory, naming, robots), ERROR))


def taken_names(inventory: Inventory, naming: Naming, robots: Iterable[str]) -> Iterator[Remark]:
    """The same as remarks."""
    kept = list(_kept(inventory, naming))
    for robot in robots if kept else ():
        for kind, name, claim in kept:
            if _stem(naming, robot, kind, name) in inventory.declared.get(kind, ()):
                message = f"another {kind} becomes {name!r} for {robot}, which is there already"
                yield about(claim, "MB420", message, "choose another separator")


def _kept(inventory: Inventory, naming: Naming) -> Iterator[tuple[str, str, Claim]]:
    """Declared names no policy spells, and names that are used and declared nowhere."""
    declared = inventory.declared
    for kind, name, claim in _declarations(inventory):
        if not spell(claim, declared, naming):
            yield kind, name, claim
    for claim in inventory.claims:
        if claim.site.role != "uses" or not must_be_declared(claim.site):
            continue
        for part in names_in(claim, declared):
            if not kind_of(part, claim.site.role, declared):
                yield from ((kind, part.text, claim) for kind in part.kinds)


def _declarations(inventory: Inventory) -> Iterator[tuple[str, str, Claim]]:
    """Kind, name and claim of what this document itself declares."""
    for claim in inventory.claims:
        kind, name = claim.site.kinds[0], claim.value.strip()
        if claim.site.role == "declares" and name and kind in inventory.declared:
            yield kind, name, claim


def _stem(naming: Naming, robot: str, kind: str, name: str) -> str:
    span = removal(naming, robot, kind, name)
    return name[: span[0]] + name[span[1] :] if span else ""


def meeting(
    inventory: Inventory, naming: Naming, pairs: Collection[tuple[str, str, str]]
) -> list[Finding]:
    """Names of two different robots that come out alike; ``pairs`` are from ``naming.overlap``."""
    names = set(_renamed(inventory, naming)) if pairs else set()
    found = []
    for robot, other, _ in pairs:
        ours = {(name[0], _spelled(naming, robot, *name)) for name in names}
        for kind, both in sorted(ours & {(n[0], _spelled(naming, other, *n)) for n in names}):
            message = f"{kind} {both!r} comes out for {robot} and for {other}"
            hint = "rename a robot or choose another separator"
            found.append(finding(inventory.document, 0, "MB421", ERROR, message, hint))
    return found


def _spelled(naming: Naming, robot: str, kind: str, name: str, namespaced: bool) -> str:
    there = affix(naming, kind, name, namespaced)
    return there.spell(name, robot) if there else name


def not_rewritten(inventory: Inventory, naming: Naming, robot: str) -> list[Finding]:
    """Links and joints without the affix that ``--strip`` is to take off."""
    for kind, name, claim in _declarations(inventory):
        renamed = spell(claim, inventory.declared, naming)
        if renamed and removal(naming, robot, kind, name) is None:
            message = f"{kind} {name!r} is not spelled for {robot}"
            hint = "give --strip the robot and the options the file was made with"
            return [finding(inventory.document, claim.start, "MB107", ERROR, message, hint)]
    return []


def other_urdf(inventory: Inventory, naming: Naming, robot: str, urdf: Declared) -> list[Finding]:
    """A name of the URDF without that affix: it is not the one the SRDF was rewritten with."""
    for kind, names in urdf.items():
        for name, claim in names.items():
            if spell(claim, urdf, naming) and removal(naming, robot, kind, name) is None:
                message = f"{kind} {name!r} of the URDF is not spelled for {robot}"
                hint = "give --urdf the URDF as it was rewritten with the same options"
                return [finding(inventory.document, 0, "MB107", ERROR, message, hint)]
    return []


def other_options(inventory: Inventory, robot: str) -> Finding:
    """The stripped text does not lead back to the file."""
    message = f"the file is not what a rewrite for {robot} with these options makes"
    hint = "give --strip the options the file was made with"
    return finding(inventory.document, 0, "MB108", ERROR, message, hint)
