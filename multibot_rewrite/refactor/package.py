# SPDX-License-Identifier: Apache-2.0
"""Reads a folder's descriptions, each xacro with its default arguments and with one other.

A switch is turned; an argument that an expression compares with a word gets that word, under
whatever name a property or a macro has it. Several at a time are not tried."""

import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import redirect_stderr, suppress
from io import StringIO
from itertools import chain, islice
from types import MappingProxyType
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.base.nearest import did_you_mean_one_of
from multibot_rewrite.description.joining.part import reasons_against_joining
from multibot_rewrite.description.reports.xacro_arguments import declared_in
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.sources.access import Reach
from multibot_rewrite.description.sources.expand import Expansion, expand_traced
from multibot_rewrite.description.sources.known_arguments import known_arguments
from multibot_rewrite.description.sources.read import is_xacro, read_file
from multibot_rewrite.description.steps.collect import SRDF as SRDF_SECTION, Inventory, collect
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.lint.files.subjects import NO_URDF
from multibot_rewrite.proposal.searching import Found, search


class Expanding(NamedTuple):
    """How xacros are expanded: how far they may reach, and the arguments that are given."""

    reach: Reach
    arguments: Mapping[str, str]


class Description(NamedTuple):
    """A description file and what is in it; ``read`` is how a xacro was expanded.

    ``arguments`` are those of this configuration alone."""

    path: str
    inventory: Inventory
    read: Expansion | None = None
    arguments: Mapping[str, str] = MappingProxyType({})

    @property
    def words(self) -> str:
        """The description's path with its arguments, for messages."""
        return " ".join((self.path, *(f"{name}:={it}" for name, it in self.arguments.items())))

    @property
    def sources(self) -> Mapping[str, bytes]:
        """The text of each file that the description is made of, by path."""
        return self.read.sources if self.read else {self.path: self.inventory.document.source}


class Package(NamedTuple):
    """A folder's files by kind, its descriptions and SRDFs, and unreadable ones with the reason."""

    found: Found
    descriptions: tuple[Description, ...]
    unread: Mapping[str, str]


def read_package(folder: str, tree: Tree, how: Expanding) -> Package:
    """Read every description in a folder; raises UsageError for a folder or argument not there."""
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
    made += _included(found.parts, tree, how)
    known = known_arguments(data for it in made for data in it.sources.values())
    if (lacking := known.lacks(how.arguments)) and made and not unread:
        near = did_you_mean_one_of(lacking[0], known.names) or "leave it out"
        raise UsageError(f"{folder}: no xacro has the argument {lacking[0]!r}; {near}")
    return Package(found, tuple(made), unread)


def _included(paths: Iterable[str], tree: Tree, how: Expanding) -> Iterator[Description]:
    """Yield the files that others include and that are complete robots themselves."""
    for path in paths:
        with suppress(InputError):
            data, read = read_text(path, how)
            inventory = inventory_of(data, path, tree)
            if inventory.declared.get("joint") and not any(reasons_against_joining(inventory)):
                yield Description(path, inventory, read)


def read_text(
    path: str, how: Expanding, texts: Mapping[str, bytes] | None = None, in_pieces: bool = True
) -> tuple[bytes, Expansion | None]:
    """Return the text of a description, with ``texts`` of changed files by real path."""
    # Raises InputError.
    known = texts or {}
    data = known.get(os.path.realpath(path)) or read_file(path)
    if not is_xacro(path):
        return data, None
    # What xacro warns about is not said here.
    with redirect_stderr(StringIO()):
        read = expand_traced(path, data, how.arguments, None, how.reach, in_pieces, known)
    return read.data, read


def inventory_of(data: bytes, path: str, tree: Tree, urdfs: Iterable[Inventory] = ()) -> Inventory:
    """Return what is in a description; an SRDF is read with the URDF whose names it has."""
    document = read_document(data, path)
    alone = collect(document, tree)
    if alone.format != SRDF_SECTION:
        return alone
    pairs = [collect(document, tree, it.declared) for it in urdfs if it.format != SRDF_SECTION]
    return min(pairs, key=_count_undeclared, default=collect(document, tree, NO_URDF))


def _count_undeclared(pair: Inventory) -> int:
    return sum(not name.kind for names in pair.names for name in names)


def texts_of(descriptions: Iterable[Description]) -> dict[str, bytes]:
    """Return the bytes of all files that make the descriptions, by their real paths."""
    every = (pair for it in descriptions for pair in it.sources.items())
    return {os.path.realpath(path): data for path, data in every}


def as_named(files: Mapping[str, bytes], descriptions: Iterable[Description]) -> dict[str, bytes]:
    """Return files by the paths that they were read under, in place of their real ones."""
    read = (name for it in descriptions for name in (it.path, *it.sources))
    named = {os.path.realpath(name): name for name in read}
    return {named.get(path, path): data for path, data in files.items()}


# So many are tried of one xacro.
MOST = 32
_TURNED = {"true": "false", "false": "true", "True": "False", "False": "True", "1": "0", "0": "1"}
# What an attribute has under another name: an argument or property alone.
_ALONE = re.compile(r"\s*(?:\$\(arg ([\w-]+)\)|\$\{\s*(\w+)\s*\})\s*")
# A name, as it is or in its argument, beside the words that it is compared with.
_NAME = r"(?:\$\(arg\s+)?(?<![\w-])([\w-]+)\)?['\"]?\s*"
_COMPARED = re.compile(_NAME + r"(?:[!=]=\s*(['\"][^'\"$]*['\"])|in\s*[\[(]([^\])]*))")
_BEHIND = re.compile(r"(['\"][^'\"$]*['\"])\s*[!=]=\s*['\"]?" + _NAME)
_WORD = re.compile(r"['\"]([^'\"]*)['\"]")


def configurations(
    it: Description, how: Expanding, tree: Tree, urdfs: Sequence[Inventory], unread: dict[str, str]
) -> Iterator[Description]:
    """Yield a xacro's other configurations with other texts; failures are noted in ``unread``."""
    assert it.read is not None
    known = {it.inventory.document.source}
    for name, value in islice(_other_values(it.read.sources, how.arguments), MOST):
        given = Expanding(how.reach, {**how.arguments, name: value})
        try:
            data, read = read_text(it.path, given)
            if data not in known:
                inventory = inventory_of(data, it.path, tree, urdfs)
                yield Description(it.path, inventory, read, {name: value})
        except InputError as error:
            unread[f"{it.path} {name}:={value}"] = f"with {name}:={value}: {error}"
            continue
        known.add(data)


def _other_values(
    sources: Mapping[str, bytes], given: Mapping[str, str]
) -> Iterator[tuple[str, str]]:
    """Yield (argument, value) that is neither given nor the default."""
    roots = [read_document(data, it).root for it, data in sources.items() if b"<robot" in data]
    elements = [it for root in roots for it in root.iter("*")]
    others = list(_aliases(elements))
    words = set(
        chain.from_iterable(_compared_words(str(it)) for one in elements for it in one.values())
    )
    for name, default in declared_in(sources).items():
        if name in given:
            continue
        names = [name]
        for known in names:  # grows
            names += {other for one, other in others if one == known} - set(names)
        found = {_TURNED[default]} if default in _TURNED else set()
        found |= {word for one, word in words if one in names}
        yield from ((name, word) for word in sorted(found - {"", default}))


def _aliases(elements: Iterable[_Element]) -> Iterator[tuple[str, str]]:
    """Yield (name, other name): a value is only the second one, as in ``${arm_prefix}``."""
    for element in elements:
        is_property = str(element.tag).endswith("xacro}property")
        for key, value in element.items():
            if found := _ALONE.fullmatch(str(value)):
                yield found[1] or found[2], element.get("name", "") if is_property else str(key)


def _compared_words(text: str) -> Iterator[tuple[str, str]]:
    """Yield (name, value) for each comparison in an expression, as of ``sim == 'gz'``."""
    for it in _COMPARED.finditer(text):
        yield from ((it[1], word[1]) for word in _WORD.finditer(it[2] or it[3]))
    yield from ((it[2], it[1][1:-1]) for it in _BEHIND.finditer(text))
