# SPDX-License-Identifier: Apache-2.0
"""Renames one name of a package's descriptions wherever it is made or used.

Which values hold the name is what a rewrite asks, too: the rewriters find it, the map of renames has
nothing but this one name. It is changed in the source of each xacro, and verified by expanding all of
them again: nothing else may have changed."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from itertools import chain
from typing import NamedTuple

from multibot_rewrite.base.arguments import checked
from multibot_rewrite.base.bounded import read_bytes
from multibot_rewrite.base.findings.finding import locate
from multibot_rewrite.base.model import InputError, MultibotError, UsageError
from multibot_rewrite.base.naming import Affix, Naming, make_naming
from multibot_rewrite.base.nearest import did_you_mean_one_of
from multibot_rewrite.base.releases import release_here
from multibot_rewrite.description.rewriters.contact import respell_collisions
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.sources.access import BOUNDED, TRUSTED
from multibot_rewrite.description.sources.trace import WrittenAt
from multibot_rewrite.description.steps.document import tag_end
from multibot_rewrite.description.steps.renames import make_renames
from multibot_rewrite.library.one_file import names_in_file
from multibot_rewrite.refactor.launch_argument import literal_parameters
from multibot_rewrite.refactor.launches import respelled, starts_of
from multibot_rewrite.refactor.named_elsewhere import mentions
from multibot_rewrite.refactor.package import (
    Description,
    Expanding,
    Package,
    as_named,
    read_package,
    read_text,
    texts_of,
)
from multibot_rewrite.refactor.placing import Left
from multibot_rewrite.refactor.source_edits import (
    Composed,
    SourceEdit,
    ValueEdit,
    change_of,
    edited,
    expected,
    first_difference,
    place,
    source_edit,
    spans,
)
from multibot_rewrite.related_files.named_file import NamedFile
from multibot_rewrite.related_files.names.rename_map import KINDS as OF_FILES

# What a name of a kind may be called where it is used: a link's is that of a frame.
KINDS: Mapping[str, tuple[str, ...]] = {
    "link": ("link", "frame"),
    "joint": ("joint",),
    "frame": ("frame",),
    "topic": ("topic", "subtopic"),
}
_NAME = re.compile(r"[^\s<>&\"'{}$]+")


class Renaming(NamedTuple):
    """What a rename changes: ``before`` and ``after`` are the bytes of files, by path.

    ``places`` is their number; ``left`` are lines that still have the name, and why; ``unread``
    are descriptions that could not be read, with the reason."""

    before: Mapping[str, bytes]
    after: Mapping[str, bytes]
    places: int
    left: tuple[Left, ...]
    unread: Mapping[str, str]


class _Symbol(NamedTuple):
    old: str
    new: str
    kind: str

    @property
    def naming(self) -> Naming:
        """The naming that puts a mark in front of this name and changes nothing else."""
        own = {(kind, self.old): Affix(0, "", "") for kind in KINDS[self.kind]}
        return make_naming()._replace(separators={}, own=own)

    def respelled(self, kind: str, name: str) -> str:
        """Return the new name of a name."""
        return self.new if name == self.old and kind in KINDS[self.kind] else name


@checked
def rename_symbol(
    old: str,
    new: str,
    folder: str,
    *,
    kind: str = "link",
    xacro_args: Mapping[str, str] | None = None,
    definitions: Iterable[str] = (),
    trust: bool = False,
    distro: str = "",
) -> Renaming:
    """Rename a link, joint, frame or topic in all descriptions and related files of ``folder``.

    These are xacro files that make its name, SRDFs, parameters, RViz configs, bridges, MoveIt's
    files and behavior trees. Writes nothing. Raises UsageError for names that cannot be,
    InputError where the name is put together so that no edit changes it alone."""
    symbol = _Symbol(old, new, kind)
    if symbol.kind not in KINDS:
        raise UsageError(f"kind {symbol.kind!r} is not known, use one of {', '.join(KINDS)}")
    for name in symbol[:2]:
        if not _NAME.fullmatch(name):
            raise UsageError(f"{name!r} is no name of a {symbol.kind}: write it without blanks")
    if symbol.old == symbol.new:
        raise UsageError(f"{symbol.old!r} has this name already; give another")
    tree = builtin_tree(tuple(definitions), release_here(distro))
    how = Expanding(TRUSTED if trust else BOUNDED, xacro_args or {})
    package = read_package(folder, tree, how)
    if not package.descriptions:
        raise InputError(next(iter(package.unread.values()), f"{folder}: it has no description"))
    return _renaming_of(symbol, package, folder, how)


def _renaming_of(symbol: _Symbol, package: Package, folder: str, how: Expanding) -> Renaming:
    """Return the package with the name changed in its descriptions and the related files."""
    changes = {it.path: list(_name_edits(it, symbol)) for it in package.descriptions}
    if not any(changes.values()):
        # One that is nowhere declared is of no kind.
        every = chain.from_iterable(chain(*(it.inventory.names for it in package.descriptions)))
        known = sorted({it.text for it in every if it.kind in KINDS[symbol.kind]})
        near = did_you_mean_one_of(symbol.old, known)
        what = f"a {symbol.kind} {symbol.old!r}" + (f"; {near}" if near else "")
        raise UsageError(f"{folder}: no description has {what}")
    _check_free(symbol, package, changes)
    edits = set(chain.from_iterable(_to_edits(it, changes[it.path]) for it in package.descriptions))
    after = edited(texts_of(package.descriptions), edits)
    for it in package.descriptions:
        wanted = expected(it.inventory.document, changes[it.path])
        data, _ = read_text(it.path, how, after)
        if data != wanted:
            line = first_difference(data, wanted)
            others = "what makes the name makes others, too"
            why = others if line else "the name cannot be changed alone"
            then = f"then there would be {line}; change what makes it by hand"
            raise InputError(f"{it.path}: {why}: {then}")
    beside = dict(_changed_related_files(package, symbol, changes, after))
    places = len(edits) + sum(count for _, count in beside.values())
    after |= {path: data for path, (data, _) in beside.items()}
    changed = {os.path.realpath(path): data for path, data in after.items()}
    found = tuple(mentions(package.found.folders, symbol.old, symbol.new, changed))
    after = as_named(after, package.descriptions)
    before = {path: read_bytes(path) for path in after}
    return Renaming(before, after, places, found, package.unread)


def _check_free(
    symbol: _Symbol, package: Package, changes: Mapping[str, Sequence[ValueEdit]]
) -> None:
    """Raise UsageError if the folder has or uses the new name, as a link or frame, too."""
    kinds = next(it for it in KINDS.values() if symbol.kind in it)
    for it in package.descriptions:
        for one in chain.from_iterable(it.inventory.names):
            own = (one.kind,) if one.kind else one.kinds
            if one.text == symbol.new and not set(own).isdisjoint(kinds):
                what = f"has a {one.kind}" if one.kind else f"uses the {symbol.kind}"
                raise UsageError(f"{it.path} {what} {symbol.new!r}; give another")
    for path, _, file, starts in _files_with(symbol.new, kinds, package, changes):
        line, _ = locate(file.text.encode(), len(file.text[: min(starts)].encode()))
        raise UsageError(f"{path}:{line} uses the {symbol.kind} {symbol.new!r}; give another")


def _name_edits(it: Description, symbol: _Symbol) -> Iterator[ValueEdit]:
    document, claims, _, declared, *_ = it.inventory
    renames = make_renames(it.inventory, symbol.naming)
    for claim, spelling in zip(claims, renames.values, strict=True):
        for found in spelling:
            at = found.affix.at
            yield change_of(document, claim, at, at + len(symbol.old), symbol.new)
    for claim, text in respell_collisions(document.root, claims, declared, symbol.respelled):
        yield change_of(document, claim, 0, len(claim.value), text)


def _to_edits(it: Description, changes: Sequence[ValueEdit]) -> Iterator[SourceEdit]:
    """Yield the edits of sources that make the changes; raises InputError where none can."""
    document = it.inventory.document
    for change in changes:
        found = _edit_of(it, change)
        if found is None:
            where = place(it.path, document.source, document.starts[change.element])
            raise InputError(
                f"{where}: {change.value!r} cannot be edited in place; write it as plain text"
            )
        if isinstance(found, Composed):
            what = f"{found.place}: {found.value!r} cannot be renamed here: {found.why}"
            raise InputError(f"{what}; write the name out, or change what makes it by hand")
        yield found._replace(file=os.path.realpath(found.file))


def _edit_of(it: Description, change: ValueEdit) -> SourceEdit | Composed | None:
    """Return the edit that makes a change; None where escapes hide the value."""
    if it.read:
        return source_edit(it.read, it.inventory.document, change)
    span = next(spans(it.inventory.document, [change]))
    return span and SourceEdit(it.path, *span)


def _changed_related_files(
    package: Package,
    symbol: _Symbol,
    changes: Mapping[str, Sequence[ValueEdit]],
    after: Mapping[str, bytes],
) -> Iterator[tuple[str, tuple[bytes, int]]]:
    """Yield (path, (new bytes, number of places)) for each related file that changes."""
    kinds = KINDS[symbol.kind]
    for path, data, file, starts in _files_with(symbol.old, kinds, package, changes):
        if os.path.realpath(path) not in after:
            made = respelled(file, data, starts, len(symbol.old), symbol.new)
            yield path, (made, len(starts))
    urdf = next(it for it in package.descriptions if changes[it.path]).inventory.document.source
    old, new = symbol.old.encode(), symbol.new.encode()
    for path, data in ((it, read_bytes(it)) for it in package.found.launch):
        with suppress(MultibotError):
            slots = literal_parameters(path, data, symbol.old) if old in data else ()
            own = (start for start, node, key in slots if _is_named(node, key, symbol, urdf))
            edits = [SourceEdit(path, start, start + len(old), new) for start in own]
            if edits:
                yield path, (edited({path: data}, edits)[path], len(edits))


def _is_named(node: str, key: str, symbol: _Symbol, urdf: bytes) -> bool:
    """Return whether a parameter file with the node and the key would have the symbol there."""
    text = json.dumps({node: {"ros__parameters": {key: symbol.old}}}).encode()
    with suppress(MultibotError):
        file = names_in_file(text, "launch.yaml", urdf)
        return any(starts_of(file, (symbol.old,), KINDS[symbol.kind]))
    return False


def _files_with(
    name: str,
    kinds: Collection[str],
    package: Package,
    changes: Mapping[str, Sequence[ValueEdit]],
) -> Iterator[tuple[str, bytes, NamedFile, set[int]]]:
    """Yield path, bytes, names and offsets for each related file that has a name of these kinds."""
    urdf = next(path for path, found in changes.items() if found)
    described = next(it.inventory.document.source for it in package.descriptions if it.path == urdf)
    for path, data, file in _related_files(package, described, name):
        if starts := set(starts_of(file, (name,), kinds)):
            yield path, data, file, starts


def _related_files(
    package: Package, described: bytes, name: str = ""
) -> Iterator[tuple[str, bytes, NamedFile]]:
    """Yield the related files with that text in them: their path, bytes, and names."""
    found = package.found
    for path in (*found.params, *found.rviz, *found.bridge, *found.moveit, *found.behavior_trees):
        data = read_bytes(path)
        if name.encode() in data:
            with suppress(MultibotError):
                yield path, data, names_in_file(data, path, described)


class Place(NamedTuple):
    """A name in a file, from ``start`` to ``end``: each line and column, from 1.

    A name that a xacro puts together is at the tag that has it."""

    file: str
    start: tuple[int, int]
    end: tuple[int, int]
    kind: str
    name: str
    declares: bool


def find_places(
    path: str, at: tuple[int, int], folder: str, definitions: Iterable[str] = (), distro: str = ""
) -> list[Place]:
    """Return all places in ``folder`` of the name that is at line and column ``at`` of a file."""
    tree = builtin_tree(tuple(definitions), release_here(distro))
    package = read_package(folder, tree, Expanding(BOUNDED, {}))
    urdf = next((it.inventory.document.source for it in package.descriptions), b"<robot/>")
    files = (_places_in_file(path, data, it) for path, data, it in _related_files(package, urdf))
    described = map(_places_in_description, package.descriptions)
    places = list(dict.fromkeys(chain.from_iterable(chain(described, files))))
    real = os.path.realpath(path)
    here = (it for it in places if it.start <= at <= it.end and os.path.realpath(it.file) == real)
    # Of a tag and a name in it, the name begins last; a declaration says more than a use.
    found = max(here, key=lambda it: (it.start, it.declares), default=None)
    return [it for it in places if found and (it.name, it.kind) == (found.name, found.kind)]


def _kind_of(kinds: Iterable[str]) -> str:
    """Return the first of ``KINDS`` that is one of these, "" for none."""
    return next((own for kind in kinds for own, its in KINDS.items() if kind in its), "")


def _places_in_description(it: Description) -> Iterator[Place]:
    for claim, names in zip(it.inventory.claims, it.inventory.names, strict=True):
        for name in names:
            end = name.at + len(name.text)
            change = change_of(it.inventory.document, claim, name.at, end, "")
            found: SourceEdit | Composed | WrittenAt | None = _edit_of(it, change)
            if isinstance(found, Composed):
                found = it.read.origins.of(change.element) if it.read else None
            kind = _kind_of((name.kind, *name.kinds[:1]))
            if found and kind:
                source, start = it.sources[found.file], found.start
                last = found.end if isinstance(found, SourceEdit) else tag_end(source, start)
                ends = locate(source, start), locate(source, last)
                yield Place(found.file, *ends, kind, name.text, claim.site.role == "declares")


def _places_in_file(path: str, data: bytes, file: NamedFile) -> Iterator[Place]:
    mark = len(data) - len(file.text.encode())
    for site in file.names:
        kind = _kind_of((site.kind, *OF_FILES.get(site.kind, ())))
        at = file.text.find(site.text, site.slot.start + site.at, site.slot.end)
        if kind and at >= 0:
            both = (len(file.text[:it].encode()) for it in (at, at + len(site.text)))
            start, end = (locate(data, mark + it) for it in both)
            yield Place(path, start, end, kind, site.text, False)
