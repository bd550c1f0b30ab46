# SPDX-License-Identifier: Apache-2.0
"""Explains the values on one line of a document or xacro: what makes them, and their new names."""

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, NamedTuple

from multibot_rewrite.base.findings.finding import locate
from multibot_rewrite.base.loose_xml import NAMESPACES
from multibot_rewrite.base.model import Claim, InputError, SiteRow
from multibot_rewrite.base.naming import FRAME_KINDS, PREFIX, TOPIC_KINDS, Naming
from multibot_rewrite.description.checks.mentions import MENTIONED, kept, mentioned
from multibot_rewrite.description.rewriters.forms import IN_FRONT
from multibot_rewrite.description.rewriters.insert import without
from multibot_rewrite.description.rewriters.renaming import ROBOT_SLOT, ResolvedName, respelled
from multibot_rewrite.description.rewriters.text import text_of
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.sources.access import BOUNDED, TRUSTED
from multibot_rewrite.description.sources.expand import Expansion, expand_traced
from multibot_rewrite.description.sources.included_by import whole_robots
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.description.sources.trace import EXPRESSION, GIVEN, LITERAL, Piece
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.description.steps.document import Document, tag_end, value_slot
from multibot_rewrite.description.steps.plan import Plan, make_plan

if TYPE_CHECKING:
    from lxml.etree import _Element


_PREFIXES = {uri: prefix for prefix, uri in NAMESPACES.items()}


def tag_path(element: "_Element", attribute: str) -> str:
    """Return the path of a value: the tags from the root on, and the attribute."""
    steps = [_path_step(element), *(_path_step(above) for above in element.iterancestors())]
    path = "/".join(reversed(steps))
    return f"{path}@{short_name(attribute)}" if attribute else path


def _path_step(element: "_Element") -> str:
    tag = short_name(str(element.tag), element.prefix)
    if tag == "plugin":
        return f"{tag}[{plugin_name(element)}]"
    name = element.get("name") if tag in ("param", "parameter") else None
    return f"{tag}[{name}]" if name else tag


def short_name(name: str, prefix: str | None = None) -> str:
    """Return a tag or attribute as definitions write it; ``prefix`` is for unknown namespaces."""
    uri, brace, local = name.removeprefix("{").partition("}")
    short = _PREFIXES.get(uri, prefix) if brace else None
    return f"{short}:{local}" if short else name


def plugin_name(element: "_Element") -> str:
    """Return the name of a ``<plugin>``: its library without folders, or its class."""
    library = element.get("filename", "").strip().rpartition("/")[2]
    return library or element.get("name", "").strip()


class Explanation(NamedTuple):
    """One value: its place, the site that claims or keeps it if any, and in words what follows.

    ``new`` is the value for the robot; ``inserted`` are elements the plugin at this place gets.
    ``source`` is where the plugin definitions have it from, or empty. ``made_of`` are the pieces
    that a xacro makes the value of, in words. ``within`` is the description that includes the file
    of the line, empty where the file is that itself."""

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
    """Return everything that starts on ``line``, in source order; empty where nothing does."""
    plan = make_plan(inventory, naming)
    found = [
        *_explained_claims(inventory, plan, naming, robot, line),
        *_others(inventory, tree, line),
    ]
    found += _inserted(inventory, plan, robot, line)
    found = [it._replace(source=_source(tree, it.site)) if it.site else it for it in found]
    return sorted(found, key=lambda item: (item.column, item.path))


def _source(tree: Tree, site: SiteRow) -> str:
    """Return the source of the section that has the site."""
    type_, name, *_ = site.section.split(" ")
    sections = tree.definitions.find(type_, name)
    return next((it.source for it in sections if it.source and site in it.sites), "")


def _explained_claims(
    inventory: Inventory, plan: Plan, naming: Naming, robot: str, line: int
) -> Iterator[Explanation]:
    recomputed = {claim.start: new.replace(ROBOT_SLOT, robot) for claim, new in plan.collisions}
    values = zip(inventory.claims, inventory.names, plan.renames.values, strict=True)
    for claim, names, spelling in values:
        place = _position(inventory, claim.start, claim.attribute, claim.value)
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
    """Yield the kind of each name in the value, and the reason why it is not renamed."""
    declared = inventory.declared
    if claim.site.form == "collision":
        yield "a collision, named after its link by the conversion to SDF"
    if claim.site.form in IN_FRONT and naming.affix != PREFIX:
        yield "the plugin puts it in front of names, so a postfix cannot be added"
        return
    for name in names:
        kind = name.kind
        where = declared.get(kind, {}).get(name.text)
        known = ""
        if where is not None and where != claim:
            here = where.element.getroottree().getroot() is inventory.document.root
            of_urdf = "" if here else " of the URDF"
            known = f", declared at line {where.element.sourceline}{of_urdf}"
        stays = _stays(naming, kind, name.text, claim.site.namespaced)
        yield f"{kind or ' or '.join(name.kinds)} {name.text!r}{known}{stays and ': '}{stays}"


def _stays(naming: Naming, kind: str, name: str, namespaced: bool) -> str:
    """Return why a name is not renamed; empty if it is, or if only its form prevents it."""
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
    """Yield values on the line that no site claims."""
    document = inventory.document
    claimed = {(claim.start, claim.attribute) for claim in inventory.claims}
    names = frozenset(name for kind in MENTIONED for name in inventory.declared[kind])
    for element, start in zip(document.root.iter("*"), document.starts, strict=True):
        slots = [(str(key), str(value)) for key, value in element.items()]
        slots.append(("", text_of(element)))
        for attribute, value in slots:
            place = _position(inventory, start, attribute, value)
            if value and place[0] == line and (start, attribute) not in claimed:
                site = kept(element, attribute, tree, {})
                name = mentioned(value, names)
                held = f"it holds the name {name!r}" if name else "it holds no declared name"
                reason = site.note if site else held
                path = tag_path(element, attribute)
                yield Explanation(*place, path, value, site, reason, value)


def _inserted(inventory: Inventory, plan: Plan, robot: str, line: int) -> Iterator[Explanation]:
    """Yield plugins on the line that get new elements, and empty elements on it that get a text."""
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
                who = "all robots would share" if item.shared else "nothing else has"
                reason = f"filled: empty it is read as {item.old!r}, which {who}"
                path = tag_path(there, "")
                yield Explanation(*place, path, name, None, reason, name, (text,))


def _position(inventory: Inventory, start: int, attribute: str, value: str) -> tuple[int, int]:
    """Return line and column of a value, or of its element."""
    source = inventory.document.source
    slot = value_slot(source, start, attribute, value) if value else None
    return locate(source, slot[0] if slot else start)


# What is on a line of a document.
OnLine = Callable[[int], list[Explanation]]


def explain_source(
    path: str,
    line: int,
    arguments: Mapping[str, str],
    trust: bool,
    explaining: Callable[[str], tuple[Document, OnLine]],
) -> list[Explanation]:
    """Return the values that ``line`` of ``path`` makes, there or in a description including it.

    These are elements on the line, and values with a piece of it, as of a macro's call. Raises
    InputError if no description with the file can be read."""
    reach = TRUSTED if trust else BOUNDED
    failed: list[InputError] = []
    wholes = (path, *whole_robots(path))
    for it in wholes:
        try:
            read = expand_traced(it, read_file(it), arguments, None, reach, True)
            same = (one for one in read.sources if os.path.realpath(one) == os.path.realpath(path))
            made = _made_on(_Line(read, next(same, ""), line), *explaining(it))
            found = dict.fromkeys(made)
        except InputError as error:
            failed.append(error)
            continue
        if found:
            return [one._replace(within="" if it == path else it) for one in found]
    if len(failed) == len(wholes):
        raise failed[0]
    return []


class _Line(NamedTuple):
    """A line of a file that an expansion reads."""

    read: Expansion
    file: str
    line: int

    def has(self, start: int, end: int) -> bool:
        """Return whether some of these bytes of the file are on the line."""
        source = self.read.sources[self.file]
        return locate(source, start)[0] <= self.line <= locate(source, end)[0]

    def begins(self, pieces: Iterable[Piece]) -> int | None:
        """Return where the first of some pieces that is on the line begins; None without."""
        mine = (it.start for it in pieces if it.file == self.file and self.has(it.start, it.start))
        return next(mine, None)


def _made_on(it: _Line, document: Document, explain: OnLine) -> Iterator[Explanation]:
    """Yield explanations of the values that a line makes, each at its place there."""
    for number, element in enumerate(document.elements):
        origin = it.read.origins.of(number)
        written = None
        if origin and origin.file == it.file:
            end = tag_end(it.read.sources[it.file], origin.start)
            written = origin.start if it.has(origin.start, end) else None
        values = [*element.attrib.items(), ("", element.text or "")]
        every = (it.read.pieces.of(number, str(key), str(value)) for key, value in values)
        if written is None and all(it.begins(one) is None for one in every):
            continue
        for found in explain(locate(document.source, document.starts[number])[0]):
            attribute = found.path.rpartition("@")[2] if "@" in found.path else ""
            pieces = it.read.pieces.of(number, attribute, found.value)
            at = it.begins(pieces) if written is None else written
            if at is not None:
                line, column = locate(it.read.sources[it.file], at)
                plain = len(pieces) < 2 and all(one.kind == LITERAL for one in pieces)
                made_of = () if plain else tuple(_piece_lines(it.read, pieces))
                yield found._replace(line=line, column=column, made_of=made_of)


def _piece_lines(read: Expansion, pieces: tuple[Piece, ...]) -> Iterator[str]:
    """Yield each piece, what wrote it, and where."""
    for piece in pieces:
        if piece.kind == GIVEN:
            yield f"{piece.text!r} (argument {piece.file} that was given)"
            continue
        source = read.sources.get(piece.file, b"")
        where = ":".join(map(str, (piece.file, *locate(source, piece.start))))
        made = source[piece.start : piece.end].decode() if piece.kind == EXPRESSION else piece.kind
        yield f"{piece.text!r} ({made}, {where})"
