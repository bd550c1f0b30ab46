# SPDX-License-Identifier: Apache-2.0
"""Where a name is declared and used: in the descriptions of a folder, and in the files with them."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from contextlib import suppress
from itertools import chain
from typing import NamedTuple

from multibot_rewrite.base.bounded import read_bytes
from multibot_rewrite.base.findings.finding import locate
from multibot_rewrite.base.model import MultibotError
from multibot_rewrite.base.releases import release_here
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.sources.access import BOUNDED
from multibot_rewrite.description.steps.document import tag_end
from multibot_rewrite.library.one_file import names_in_file
from multibot_rewrite.refactor import source_edits as edits
from multibot_rewrite.refactor.package import Description, Expanding, Package, read_package
from multibot_rewrite.refactor.rename import KINDS
from multibot_rewrite.related_files.names.rename_map import KINDS as OF_FILES


class Place(NamedTuple):
    """A name in a file, from ``start`` to ``end``: line and column, from 1. A name that a xacro puts
    together is at the tag that has it."""

    file: str
    start: tuple[int, int]
    end: tuple[int, int]
    kind: str
    name: str
    declares: bool


def places_of(
    path: str, at: tuple[int, int], folder: str, definitions: Iterable[str] = (), distro: str = ""
) -> list[Place]:
    """Return all places of the link, joint, frame or topic at a place of a file. Raises UsageError for
    a folder that is not there."""
    tree = builtin_tree(tuple(definitions), release_here(distro))
    package = read_package(folder, tree, Expanding(BOUNDED, {}))
    described = chain.from_iterable(map(_in_description, package.descriptions))
    every = dict.fromkeys((*described, *_in_other_files(package)))
    real = os.path.realpath(path)
    here = (it for it in every if it.start <= at <= it.end and os.path.realpath(it.file) == real)
    # Where tags and names begin, the name is the last; a declaration says more than a use.
    found = max(here, key=lambda it: (it.start, it.declares), default=None)
    return [it for it in every if found and (it.name, it.kind) == (found.name, found.kind)]


def _kind(*kinds: str) -> str:
    """Return the first kind that a rename takes, that of a link for a frame; empty for none."""
    return next((own for kind in kinds for own, its in KINDS.items() if kind in its), "")


def _in_description(it: Description) -> Iterator[Place]:
    document = it.inventory.document
    for claim, names in zip(it.inventory.claims, it.inventory.names, strict=True):
        for name in names:
            kind = _kind(name.kind, *name.kinds[:1])
            change = edits.change_of(document, claim, name.at, name.at + len(name.text), "")
            if kind and (found := _span(it, change)):
                source = it.sources[found.file]
                ends = locate(source, found.start), locate(source, found.end)
                yield Place(found.file, *ends, kind, name.text, claim.site.role == "declares")


def _span(it: Description, change: edits.ValueEdit) -> edits.SourceEdit | None:
    """Return the edit that makes a change; where none does, one of the tag that has the value."""
    document = it.inventory.document
    if it.read is None:
        span = next(edits.spans(document, [change]))
        return span and edits.SourceEdit(it.path, *span)
    found = edits.source_edit(it.read, document, change)
    if isinstance(found, edits.SourceEdit):
        return found
    origin = it.read.origins.of(change.element)
    end = tag_end(it.read.sources[origin.file], origin.start) if origin else 0
    return origin and edits.SourceEdit(origin.file, origin.start, end, b"")


def _in_other_files(package: Package) -> Iterator[Place]:
    """Yield the names in the files that belong to the first description."""
    found = package.found
    own = (it for it in package.descriptions if it.path in found.descriptions)
    urdf = next((it.inventory.document.source for it in own), b"<robot/>")
    files = (*found.params, *found.rviz, *found.bridge, *found.moveit, *found.behavior_trees)
    for path in files:
        data = read_bytes(path)
        with suppress(MultibotError):
            file = names_in_file(data, path, urdf)
            text, mark = file.text, len(data) - len(file.text.encode())
            for site in file.names:
                kind = _kind(site.kind, *OF_FILES.get(site.kind, ()))
                at = text.find(site.text, site.slot.start + site.at, site.slot.end)
                if kind and at >= 0:
                    both = (len(text[:it].encode()) for it in (at, at + len(site.text)))
                    start, end = (locate(data, mark + it) for it in both)
                    yield Place(path, start, end, kind, site.text, False)
