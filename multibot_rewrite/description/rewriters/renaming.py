# SPDX-License-Identifier: Apache-2.0
"""The names in each claimed value: where they are, of what kind, and how they are renamed.

The plan knows names by kind only. SDF looks a name up in the model it is in, where a link and a joint
cannot share it; where two models of a file use one name for two kinds, the model that the reference
leads to decides.
"""

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from lxml import etree

from multibot_rewrite.base.model import Claim, SiteRow
from multibot_rewrite.base.naming import (
    CLOSED_KINDS,
    FRAME_KINDS,
    PREFIX,
    Affix,
    Naming,
    affix,
    is_keyword,
    removal,
    spelled,
)
from multibot_rewrite.description.rewriters.forms import FORMS, IN_FRONT, Declared, Kinds, NamePart

ROBOT_SLOT = "\0"
# Number of a claim -> the names in the remap rule that it holds.
Rules = Mapping[int, tuple[NamePart, ...]]
NO_RULES: Rules = {}


class ResolvedName(NamedTuple):
    """A name in a value, from character ``at``; ``kind`` is empty if it lacks a declaration."""

    at: int
    text: str
    kind: str
    kinds: Kinds


class Renamed(NamedTuple):
    """A name in a value that changes; ``affix.at`` counts from the start of the value."""

    kind: str
    text: str
    namespaced: bool
    affix: Affix


# The names that change in one value, in order.
Spelling = tuple[Renamed, ...]


def resolved_names(
    claims: Iterable[Claim], declared: Declared, apart: bool = False, rules: Rules = NO_RULES
) -> list[tuple[ResolvedName, ...]]:
    """Return the names in each claimed value; ``rules`` are those in remap rules of plugins."""
    known: dict[tuple[object, str], tuple[ResolvedName, ...]] = {}
    result = []
    for at, claim in enumerate(claims):
        site = claim.site
        if at in rules:
            result.append(_with_kinds(rules[at], site.role, declared, apart))
            continue
        # A link or joint is the same at every site, others at each site.
        of: object = site.whole_value_kind or id(site)
        key = (of, scope_of(claim.element)) if site.form == "scoped" else of, claim.value
        names = known.get(key)
        if names is None:
            names = known[key] = _resolved_names(claim, declared, apart)
        result.append(names)
    return result


def _resolved_names(claim: Claim, declared: Declared, apart: bool) -> tuple[ResolvedName, ...]:
    site, value = claim.site, claim.value
    if site.whole_value_kind and value in declared[site.whole_value_kind]:
        return (ResolvedName(0, value, site.whole_value_kind, site.kinds),)
    if site.role == "declares" and site.form == "whole" and value and value == value.strip():
        return (ResolvedName(0, value, site.kinds[0], site.kinds),)
    return _with_kinds(names_in(claim, declared), site.role, declared, apart)


def _with_kinds(
    parts: Iterable[NamePart], role: str, declared: Declared, apart: bool
) -> tuple[ResolvedName, ...]:
    """Return the names, each resolved to one of its kinds."""
    return tuple(
        ResolvedName(part.at, part.text, kind_of(part, role, declared, apart), part.kinds)
        for part in parts
    )


def names_in(claim: Claim, declared: Declared) -> tuple[NamePart, ...]:
    """Return the names in a value, none if another model's; a scope decides among several kinds."""
    site = claim.site
    parts = FORMS[site.form](claim.value, site.kinds, declared)
    if site.form != "scoped" or not parts:
        return parts
    *models, last = parts
    kinds = [kind for kind in last.kinds if last.text in declared.get(kind, ())]
    if len(kinds) < 2:
        return parts
    scope = scope_of(claim.element)
    for model in models:
        scope = _named_child(scope, "model", model.text)
    here = [kind for kind in kinds if _named_child(scope, kind, last.text) is not None]
    return (*models, last._replace(matched=tuple(here[:1])))


def is_reached(claim: Claim, naming: Naming) -> bool:
    """Return whether the naming can change this value. A postfix cannot where a prefix is expected."""
    site = claim.site
    if site.form not in IN_FRONT:
        return True
    return naming.affix == PREFIX and bool(claim.value or takes_empty(site))


def takes_empty(site: SiteRow) -> bool:
    """Return whether an empty text is a value too, as for a prefix that is not yet set."""
    is_one = site.form == "prefix" and site.role == "uses" and site.empty == "itself"
    return is_one and "@" not in site.path.rpartition("]")[2]


def spell_default(site: SiteRow, value: str, declared: Declared, naming: Naming) -> Spelling:
    """Return the changes in a default value, as if it were written at a site."""
    if site.form in IN_FRONT and naming.affix != PREFIX:
        return ()
    result = []
    for part in FORMS[site.form](value, site.kinds, declared):
        kind = kind_of(part, "uses", declared, naming.layout.at_run_time)
        there = affix(naming, kind, part.text, site.namespaced) if kind else None
        if there is not None:
            result.append(renamed_at(part.at, kind, part.text, site.namespaced, there))
    return tuple(result)


def renamed_at(at: int, kind: str, text: str, namespaced: bool, there: Affix) -> Renamed:
    """Return a name that starts at character ``at`` of its value and has the affix ``there``."""
    return Renamed(kind, text, namespaced, there._replace(at=at + there.at) if at else there)


def must_be_declared(site: SiteRow) -> bool:
    """Return whether this file must declare the names that are used at this site."""
    if site.form in ("scoped", "member"):
        return True
    return site.kinds[0 if site.form == "suffixed" else -1] in CLOSED_KINDS


def kind_of(part: NamePart, role: str, declared: Declared, apart: bool = False) -> str:
    """Return which of its kinds a name is; empty for a use of something that is not declared."""
    if part.matched:
        return part.matched[0]
    return resolve(part.text, part.kinds, role, declared, part.closed, apart)


def resolve(
    text: str,
    kinds: Kinds,
    role: str,
    declared: Declared,
    closed: bool = False,
    apart: bool = False,
) -> str:
    """Return which of ``kinds`` a name is; empty if it is used and not declared as needed.

    A frame that names a link is renamed like it, with or without a leading slash; not if frames
    are ``apart`` from links, because nodes name them at run time."""
    if role == "declares":
        return kinds[0]
    for kind in kinds:
        if text in declared.get(kind, ()):
            return kind
    bare = text[1:] if text.startswith("/") and not text.startswith("//") else text
    is_frame = not FRAME_KINDS.isdisjoint(kinds) and not (apart and kinds == ("frame",))
    if is_frame and not {text, bare}.isdisjoint(declared["link"]):
        return "link"
    if closed or is_keyword(text):
        return ""
    return next((kind for kind in kinds if kind not in CLOSED_KINDS), "")


def respelled(value: str, spelling: Spelling, robot: str) -> str:
    """Return the value with every affix in place."""
    for name in reversed(spelling):
        value = name.affix.spell(value, robot)
    return value


def renamed_names(declared: Declared, naming: Naming, robot: str) -> Declared:
    """Return declarations by the names they have after a rewrite for ``robot``."""
    return {
        kind: {spelled(naming, robot, kind, name): claim for name, claim in names.items()}
        for kind, names in declared.items()
    }


def stripped_names(declared: Declared, naming: Naming, robot: str) -> Declared:
    """Return declarations by the names they had before a rewrite for ``robot``."""
    return {
        kind: {unspelled(naming, kind, name, robot): claim for name, claim in names.items()}
        for kind, names in declared.items()
    }


def unspelled(naming: Naming, kind: str, name: str, robot: str) -> str:
    """Return ``name`` without what ``affix`` added for ``robot``."""
    span = removal(naming, robot, kind, name)
    return name[: span[0]] + name[span[1] :] if span else name


def scope_of(element: etree._Element) -> etree._Element | None:
    """Return the model (or robot) in which names of ``element`` are looked up.

    A model's own pose is looked up among its siblings.
    """
    parent = element.getparent()
    if element.tag == "pose" and parent is not None and parent.tag == "model":
        element = parent
    elif element.tag == "model":
        return element
    return next(element.iterancestors("model", "robot"), None)


def _named_child(scope: etree._Element | None, tag: str, name: str) -> etree._Element | None:
    found = scope.iterchildren(tag) if scope is not None else iter(())
    return next((child for child in found if child.get("name") == name), None)
