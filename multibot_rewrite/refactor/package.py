# SPDX-License-Identifier: Apache-2.0
"""A folder -> its descriptions, each xacro expanded with what its arguments are by default."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from contextlib import redirect_stderr
from io import StringIO
from types import MappingProxyType

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.sources.access import Reach
from multibot_rewrite.description.sources.expand import Expansion, expand_traced
from multibot_rewrite.description.sources.read import is_xacro, read_file
from multibot_rewrite.description.steps.collect import SRDF as SRDF_SECTION, Inventory, collect
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.fleet.proposal.searching import Found, search
from multibot_rewrite.lint.files.subjects import NO_URDF


class Expanding(NamedTuple):
    """How xacros are expanded: how far they may reach, and the arguments that are given."""

    reach: Reach
    arguments: Mapping[str, str]


class Description(NamedTuple):
    """A description file, what is in it, and, of a xacro, how it was expanded; ``arguments`` are those
    of this configuration alone."""

    path: str
    inventory: Inventory
    read: Expansion | None = None
    arguments: Mapping[str, str] = MappingProxyType({})

    @property
    def words(self) -> str:
        """Its path, with its arguments."""
        return " ".join((self.path, *(f"{name}:={it}" for name, it in self.arguments.items())))

    @property
    def sources(self) -> Mapping[str, bytes]:
        """The files that make it."""
        return self.read.sources if self.read else {self.path: self.inventory.document.source}


class Package(NamedTuple):
    """What a folder has: its files by kind, its descriptions, SRDFs among them, and those that could
    not be read, with the reason."""

    found: Found
    descriptions: tuple[Description, ...]
    unread: Mapping[str, str]


def read_package(folder: str, tree: Tree, how: Expanding) -> Package:
    """Read every description in a folder; raises UsageError for one that is not there."""
    found = search([folder])
    texts: dict[str, tuple[bytes, Expansion | None]] = {}
    unread: dict[str, str] = {}
    for path in (*found.descriptions, *found.srdf):
        try:
            texts[path] = read_text(path, how)
        except InputError as error:
            unread[path] = str(error)
    made: list[Description] = []
    for path, (data, read) in texts.items():
        try:
            urdfs = [it.inventory for it in made] if path in found.srdf else ()
            made.append(Description(path, inventory_of(data, path, tree, urdfs), read))
        except InputError as error:
            unread[path] = str(error)
    return Package(found, tuple(made), unread)


def read_text(
    path: str,
    how: Expanding,
    texts: Mapping[str, bytes] | None = None,
) -> tuple[bytes, Expansion | None]:
    """The text of a description; ``texts`` are the bytes of files that are not as on the disk, by their
    real paths. Raises InputError."""
    known = texts or {}
    data = known.get(os.path.realpath(path)) or read_file(path)
    if not is_xacro(path):
        return data, None
    # What xacro warns about is not said here.
    with redirect_stderr(StringIO()):
        read = expand_traced(path, data, how.arguments, None, how.reach, True, known)
    return read.data, read


def inventory_of(data: bytes, path: str, tree: Tree, urdfs: Iterable[Inventory] = ()) -> Inventory:
    """What is in a description; of an SRDF with what the URDF declares whose names it has."""
    document = read_document(data, path)
    alone = collect(document, tree)
    if alone.format != SRDF_SECTION:
        return alone
    pairs = [collect(document, tree, it.declared) for it in urdfs if it.format != SRDF_SECTION]
    return min(pairs, key=_lacks, default=collect(document, tree, NO_URDF))


def _lacks(pair: Inventory) -> int:
    return sum(not name.kind for names in pair.names for name in names)


def texts_of(descriptions: Iterable[Description]) -> dict[str, bytes]:
    """The bytes of all files that make the descriptions, by their real paths."""
    every = (pair for it in descriptions for pair in it.sources.items())
    return {os.path.realpath(path): data for path, data in every}


def as_named(files: Mapping[str, bytes], descriptions: Iterable[Description]) -> dict[str, bytes]:
    """Files by the paths that they were read under, in place of their real ones."""
    read = (name for it in descriptions for name in (it.path, *it.sources))
    named = {os.path.realpath(name): name for name in read}
    return {named.get(path, path): data for path, data in files.items()}
