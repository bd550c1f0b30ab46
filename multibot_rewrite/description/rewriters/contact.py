# SPDX-License-Identifier: Apache-2.0
"""Contact sensors name collisions that the URDF -> SDF conversion makes up from link names.

A lumped name depends on the tree (which fixed joints are merged, in which order) and on how the
names begin, so it is computed anew from the structure and never edited as text. Measured with
libsdformat 12.3: ``{collision or link}_collision[_N]``, N counting over all collisions of the link
that is left, and ``{left}_fixed_joint_lump__`` in front unless the text begins with that link.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator

from lxml import etree

from multibot_rewrite.base.model import Claim
from multibot_rewrite.description.rewriters.forms import Declared, is_included
from multibot_rewrite.description.rewriters.text import kept_joints

Respell = Callable[[str, str], str]
Links = dict[str, etree._Element]
Lumped = dict[str, list[tuple[str, str]]]
LUMP = "_fixed_joint_lump__"


def respell_collisions(
    root: etree._Element, claims: Iterable[Claim], declared: Declared, respell: Respell
) -> list[tuple[Claim, str]]:
    """Return each renamed contact collision and its text, by the new names of ``respell``."""
    contacts = [claim for claim in claims if claim.site.form == "collision"]
    if not contacts:
        return []
    names = collision_map(root, respell)
    result = []
    for claim in contacts:
        *scopes, old = claim.value.split("::")
        new = "::".join([*_scopes(scopes, declared, respell), names.get(old, old)])
        if new != claim.value:
            result.append((claim, new))
    return result


def _scopes(names: list[str], declared: Declared, respell: Respell) -> Iterator[str]:
    """Yield the scopes of a collision, renamed; as they are where the model is of another file."""
    elsewhere = len(names) > 1 and names[0] not in declared["model"]
    for name in names:
        kinds = [kind for kind in ("model", "link") if name in declared[kind]]
        yield respell(kinds[0], name) if kinds and not elsewhere else name
        elsewhere = elsewhere or is_included(name, declared)


def collision_map(root: etree._Element, respell: Respell) -> dict[str, str]:
    """Return by old generated name the new one, for every collision of the description."""
    new = collisions(root, respell)
    old = collisions(root)
    return {name: new[left][key] for left, names in old.items() for key, name in names.items()}


def collisions(
    root: etree._Element, respell: Respell = lambda kind, name: name
) -> dict[str, dict[tuple[str, int], str]]:
    """Return by each link that is left the names of its collisions, by their link and index."""
    links = {link.get("name", ""): link for link in root.iterchildren("link")}
    lumped = _lumped(root)
    merged_away = {child for children in lumped.values() for _, child in children}
    return {it: _names(it, links, lumped, respell) for it in links if it not in merged_away}


def _names(left: str, links: Links, lumped: Lumped, spell: Respell) -> dict[tuple[str, int], str]:
    """Return the names of collisions that end up in link ``left``, by link and index."""
    found: dict[tuple[str, int], str] = {}
    there = spell("link", left)
    waiting = [left]
    seen = set()
    while waiting:
        link = waiting.pop()
        if link in seen or link not in links:
            continue
        seen.add(link)
        for place, collision in enumerate(links[link].iterchildren("collision")):
            own = collision.get("name", "")
            start = spell("shape", own) if own else spell("link", link)
            name = f"{start}_collision" + (f"_{len(found)}" if found else "")
            found[link, place] = name if name.startswith(there) else f"{there}{LUMP}{name}"
        # urdfdom sorts sibling joints by name: children come in the order of their new spelling.
        below = sorted((spell("joint", joint), child) for joint, child in lumped.get(link, ()))
        waiting += [child for _, child in reversed(below)]
    return found


def _lumped(root: etree._Element) -> Lumped:
    """Return by parent link (joint, child link) of the fixed joints that are merged."""
    kept = kept_joints(root)
    lumped = defaultdict(list)
    for joint in root.iterchildren("joint"):
        if joint.get("type") != "fixed" or joint.get("name") in kept:
            continue
        parent, child = joint.find("parent"), joint.find("child")
        if parent is not None and child is not None and parent.get("link") != "world":
            lumped[parent.get("link", "")].append((joint.get("name", ""), child.get("link", "")))
    return lumped
