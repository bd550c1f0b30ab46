"""What each claimed value becomes: its names found, resolved to a kind, and spelled."""

from __future__ import annotations

from collections.abc import Iterable

from multibot_rewrite.model import Claim, Site
from multibot_rewrite.naming import (
    CLOSED_KINDS,
    FRAME_KINDS,
    PREFIX,
    Affix,
    Naming,
    affix,
    is_keyword,
    removal,
)
from multibot_rewrite.rewriters.forms import FORMS, Declared, Kinds, Part
from multibot_rewrite.rewriters.scopes import in_scope, scope_of

HOLE = "\0"
# Kind and affix of each renamed name in one value, in order; ``at`` counts from the value's start.
Spelling = tuple[tuple[str, Affix], ...]


def names_in(claim: Claim, declared: Declared) -> tuple[Part, ...]:
    """The names in a claimed value; none where it stands in the scope of another model."""
    site = claim.site
    parts = FORMS[site.form](claim.value, site.kinds, declared)
    return in_scope(claim.element, parts, declared) if site.form == "scoped" else parts


def spelled_in(claim: Claim, declared: Declared, naming: Naming) -> tuple[Part, ...]:
    """Those of them that the naming can reach: no postfix is where a prefix is asked for."""
    site = claim.site
    if site.form == "prefix" and (naming.affix != PREFIX or not (claim.value or takes_empty(site))):
        return ()
    return names_in(claim, declared)


def takes_empty(site: Site) -> bool:
    """An empty text is a value too: the prefix of names that have none yet."""
    return site.form == "prefix" and site.role == "uses" and "@" not in site.path.rpartition("]")[2]


def spelling_key(claim: Claim) -> tuple[object, str]:
    """Claims of one key are spelled alike: a link or joint at every site, others at each site."""
    site = claim.site
    if site.form == "scoped":
        return (id(site), scope_of(claim.element)), claim.value
    return site.plain or id(site), claim.value


def spell(claim: Claim, declared: Declared, naming: Naming) -> Spelling:
    """Kind and affix of every name in the claimed value; empty where it stays as it is."""
    plain = claim.site.plain
    if plain and claim.value in declared[plain]:
        there = affix(naming, plain, claim.value)
        return ((plain, there),) if there else ()
    return _spelling(
        spelled_in(claim, declared, naming), claim.site, claim.site.role, declared, naming
    )


def spell_default(site: Site, value: str, declared: Declared, naming: Naming) -> Spelling:
    """The same for a value that would stand at a site if the file had it."""
    if site.form == "prefix" and naming.affix != PREFIX:
        return ()
    parts = FORMS[site.form](value, site.kinds, declared)
    return _spelling(parts, site, "uses", declared, naming)


def _spelling(
    parts: Iterable[Part], site: Site, role: str, declared: Declared, naming: Naming
) -> Spelling:
    result = []
    for part in parts:
        kind = kind_of(part, role, declared)
        there = affix(naming, kind, part.text, site.namespaced) if kind else None
        if there is not None:
            result.append((kind, there._replace(at=part.at + there.at) if part.at else there))
    return tuple(result)


def must_be_declared(site: Site) -> bool:
    """A use of a name that this file must declare."""
    return site.kinds[-1] in CLOSED_KINDS or site.form == "scoped"


def kind_of(part: Part, role: str, declared: Declared) -> str:
    """Which of its kinds a name is; empty for a use of something that is not declared."""
    if part.matched:
        return part.matched[0]
    return resolve(part.text, part.kinds, role, declared, part.closed)


def resolve(text: str, kinds: Kinds, role: str, declared: Declared, closed: bool = False) -> str:
    """Which of ``kinds`` a name is; empty for a use of something that must be declared and is not.

    A frame that names a link is spelled like the link, one leading slash aside.
    """
    if role == "declares":
        return kinds[0]
    for kind in kinds:
        if text in declared.get(kind, ()):
            return kind
    bare = text[1:] if text.startswith("/") and not text.startswith("//") else text
    if not FRAME_KINDS.isdisjoint(kinds) and bare in declared["link"]:
        return "link"
    if closed or is_keyword(text):
        return ""
    return next((kind for kind in kinds if kind not in CLOSED_KINDS), "")


def respelled(value: str, spelling: Spelling, robot: str) -> str:
    """The value with every affix in place."""
    for _, there in reversed(spelling):
        value = there.spell(value, robot)
    return value


def respelled_names(declared: Declared, naming: Naming, robot: str) -> Declared:
    """Declarations by the names they have for ``robot``."""
    return {
        kind: {_spelled(naming, kind, name, robot): claim for name, claim in names.items()}
        for kind, names in declared.items()
    }


def _spelled(naming: Naming, kind: str, name: str, robot: str) -> str:
    there = affix(naming, kind, name)
    return there.spell(name, robot) if there else name


def stripped_names(declared: Declared, naming: Naming, robot: str) -> Declared:
    """Declarations by the names they had before a rewrite for ``robot``."""
    return {
        kind: {unspelled(naming, kind, name, robot): claim for name, claim in names.items()}
        for kind, names in declared.items()
    }


def unspelled(naming: Naming, kind: str, name: str, robot: str) -> str:
    """``name`` without what ``affix`` put there for ``robot``."""
    span = removal(naming, robot, kind, name)
    return name[: span[0]] + name[span[1] :] if span else name
