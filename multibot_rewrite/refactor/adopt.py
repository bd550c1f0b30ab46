# SPDX-License-Identifier: Apache-2.0
"""A description package for one robot gets an argument that puts a prefix before its names.

Which values hold names of the robot is what a rewrite with ``--affix prefix`` asks, too. ``${prefix}``
goes where a name is used, into the xacro sources; where one place makes names of the robot and others,
it goes where the name is made. Proved by expansion: with an empty prefix nothing changes, with
``robot1_`` the result is what the rewrite makes. The name of the robot itself stays."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable, Iterator, Mapping
from itertools import chain
from types import MappingProxyType

from multibot_rewrite.base.arguments import checked
from multibot_rewrite.base.findings.finding import locate
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.base.naming import PREFIX, affix
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.base.releases import release_here
from multibot_rewrite.description.joining.part import PREFIXED, prefixing
from multibot_rewrite.description.reports.xacro_arguments import (
    Argument,
    find_arguments,
    names_robots,
)
from multibot_rewrite.description.rewriters.builtin import builtin_tree
from multibot_rewrite.description.rewriters.insert import insertions
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.sources.access import BOUNDED, TRUSTED
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.description.steps.document import read_document, tag_end
from multibot_rewrite.description.steps.renames import make_renames
from multibot_rewrite.refactor.launches import with_launches
from multibot_rewrite.refactor.named_elsewhere import named_elsewhere
from multibot_rewrite.refactor.package import (
    Description,
    Expanding,
    as_named,
    inventory_of,
    read_package,
    read_text,
)
from multibot_rewrite.refactor.placing import Left, placed
from multibot_rewrite.refactor.source_edits import (
    Change,
    SourceEdit,
    change_of,
    edited,
    expected,
    first_difference,
)

_PARTS = ("link", "joint")
NAMES = ("prefix", "robot_prefix", "tf_prefix", "name_prefix")
TRIED = "robot1_"
_SPACE = b' xmlns:xacro="http://www.ros.org/wiki/xacro"'
_TAKEN = ("arg", "property", "macro")


class Adopted(NamedTuple):
    """A package with its new argument. ``before`` and ``after`` are the bytes of the files that change,
    by path, empty for a new one; ``proved`` are the descriptions that take it, ``left`` is what could
    not be changed, ``unread`` are descriptions that could not be read, with the reason. ``already`` are
    those that have such an argument, with its name: they stay. ``launches`` are the launch files that
    are proved to hand it on."""

    argument: str
    before: Mapping[str, bytes]
    after: Mapping[str, bytes]
    proved: tuple[str, ...]
    left: tuple[Left, ...]
    unread: Mapping[str, str]
    already: Mapping[str, str] = MappingProxyType({})
    launches: tuple[str, ...] = ()


@checked
def adopt(
    folder: str,
    *,
    xacro_args: Mapping[str, str] | None = None,
    vocabulary: Iterable[str] = (),
    trust: bool = False,
    distro: str = "",
) -> Adopted:
    """Give every description of ``folder`` an argument for a prefix, in its xacro sources; a plain URDF
    becomes a xacro. Writes nothing. Raises InputError where there is no description that can be
    expanded, or no place for the prefix changes names alone."""
    tree = builtin_tree(tuple(vocabulary), release_here(distro))
    how = Expanding(TRUSTED if trust else BOUNDED, xacro_args or {})
    package = read_package(folder, tree, how)
    unread = dict(package.unread)
    already = {it.path: name for it in package.descriptions if (name := _has(it, tree, how))}
    others = [it for it in package.descriptions if it.path not in already]
    found = list(_as_xacros(others, tree, how, unread))
    if not found and already:
        return Adopted("", {}, {}, (), (), unread, already)
    if not found:
        why = next(iter(unread.values()), f"{folder}: there is no description of a robot in it")
        raise InputError(why)
    argument = _free_name(found)
    texts = _texts(found)
    edits: set[SourceEdit] = set()
    left: list[Left] = []
    wanted: dict[str, list[Change]] = {}
    for it in found:
        made = placed(it, list(_changes(it)), argument)
        edits |= {one._replace(file=os.path.realpath(one.file)) for one in made.edits}
        edits |= set(_declared(it, texts, argument))
        wanted[it.path] = made.changes
        left += [*made.left, *_not_written(it)]
    after = edited(texts, edits)
    for it in found:
        _prove(it, wanted[it.path], after, argument, how)
    after = as_named(after, found)
    launches = with_launches(folder, package.found.launch, argument, after, TRIED, trust)
    left += launches.left
    # A plain description that becomes a xacro is one of them.
    looked_at = {*texts, *(it.removesuffix(".xacro") for it in texts)}
    left += named_elsewhere(folder, set(_names(found)), looked_at)
    before = {path: data for path, data in as_named(texts, found).items() if path in after}
    before |= dict.fromkeys((path for path in before if not os.path.exists(path)), b"")
    before |= {path: read_file(path) for path in launches.after}
    after |= launches.after
    proved, told = tuple(it.path for it in found), tuple(dict.fromkeys(left))
    return Adopted(argument, before, after, proved, told, unread, already, launches.proved)


def _is_meant(it: Description) -> bool:
    """A URDF or an SRDF."""
    return it.inventory.format in ("robot", "srdf.robot")


def _has(it: Description, tree: Tree, how: Expanding) -> str:
    """The argument of a xacro that puts a prefix before its links already; empty if it has none."""
    if it.read is None or it.inventory.format != "robot":
        return ""
    found = find_arguments(it.path, how.arguments, tree, reach=how.reach, wanted=names_robots)
    return next((one.name for one in found.arguments if _is_prefix(one)), "")


def _is_prefix(it: Argument) -> bool:
    """Is it before links, for each robot another word? ``world`` and some that were forgotten may lack
    it."""
    links = (use for use in it.uses if (use.kind, use.how) == ("link", PREFIX))
    return bool(it.value) and any(2 * use.names >= use.total for use in links)


def _names(found: Iterable[Description]) -> Iterator[str]:
    """What gets the prefix."""
    shared = prefixing().shared_frames
    declared = (it.inventory.declared.get(kind, ()) for it in found for kind in PREFIXED)
    yield from (name for names in declared for name in names if name not in shared)


def _as_xacros(
    descriptions: Iterable[Description], tree: Tree, how: Expanding, unread: dict[str, str]
) -> Iterator[Description]:
    """Each description as a xacro; those that cannot be one are noted in ``unread``."""
    for it in filter(_is_meant, descriptions):
        if it.read is None and os.path.exists(f"{it.path}.xacro"):
            unread[it.path] = f"{it.path}: its xacro is beside it; make it anew from that"
            continue
        try:
            yield it if it.read else _as_xacro(it, tree, how)
        except InputError as error:
            unread[it.path] = str(error)


def _as_xacro(it: Description, tree: Tree, how: Expanding) -> Description:
    """A plain description as the xacro that it becomes."""
    path = f"{it.path}.xacro"
    data, read = read_text(path, how, {os.path.realpath(path): it.inventory.document.source})
    return Description(path, inventory_of(data, path, tree), read)


def _free_name(found: Iterable[Description]) -> str:
    """A name that no argument, property or parameter of a macro has."""
    taken: set[str] = set()
    for it in found:
        sources = it.read.sources if it.read else {}
        # YAML that an expression loads is among them.
        for file, data in ((file, data) for file, data in sources.items() if b"<robot" in data):
            for element in read_document(data, file).root.iter("{*}arg", "{*}property", "{*}macro"):
                words = element.get("params", "").replace(":=", " ").replace("=", " ").split()
                taken |= {element.get("name", ""), *words}
    free = next((name for name in NAMES if name not in taken), None)
    if free is None:
        raise UsageError(f"{', '.join(NAMES)} are all names of its arguments or properties")
    return free


def _texts(found: Iterable[Description]) -> dict[str, bytes]:
    """The files that make the descriptions, by real path."""
    read = chain.from_iterable(it.read.sources.items() for it in found if it.read)
    return {os.path.realpath(path): data for path, data in read}


def _changes(it: Description) -> Iterator[Change]:
    """Where the prefix goes in the values of a description. A link or joint that it does not have is
    one of another description that includes the same file."""
    document, claims, *_ = it.inventory
    naming = prefixing()
    spellings = make_renames(it.inventory, naming).values
    for claim, names, spelling in zip(claims, it.inventory.names, spellings, strict=True):
        places = [found.affix.at for found in spelling]
        for name in names:
            kind = "" if name.kind else next((it for it in name.kinds if it in _PARTS), "")
            there = affix(naming, kind, name.text) if kind else None
            places += [name.at + there.at] if there else []
        for at in places:
            yield change_of(document, claim, at, at, TRIED)


def _declared(it: Description, texts: Mapping[str, bytes], argument: str) -> Iterator[SourceEdit]:
    """The argument and its property, first in the root element of the description's own file."""
    path = os.path.realpath(it.path)
    source = texts[path]
    start = read_document(source, it.path).starts[0]
    end = tag_end(source, start)
    if b"xmlns:xacro" not in source[start:end]:
        at = start + len(b"<robot")
        yield SourceEdit(path, at, at, _SPACE)
    text = (
        f'\n  <xacro:arg name="{argument}" default=""/>'
        f'\n  <xacro:property name="{argument}" value="$(arg {argument})"/>'
    )
    yield SourceEdit(path, end, end, text.encode())


def _not_written(it: Description) -> Iterator[Left]:
    """Names that a plugin takes where none is written: they need an element of their own."""
    document, _, _, declared, *_ = it.inventory
    for one in insertions(it.inventory.served, declared, prefixing()):
        if one.kind in PREFIXED and it.read:
            origin = it.read.origins.of(document.elements.index(one.parent))
            source = it.read.sources[origin.file] if origin else b""
            where = (origin.file, *locate(source, origin.start)) if origin else (it.path,)
            yield Left(
                ":".join(map(str, where)), f"its {one.kind} is {one.old!r}, which no element says"
            )


def _prove(
    it: Description,
    changes: Collection[Change],
    after: Mapping[str, bytes],
    argument: str,
    how: Expanding,
) -> None:
    """Nothing changes without a prefix, and with one the names alone; raises InputError."""
    document = it.inventory.document
    given = {"": document.source, TRIED: expected(document, changes)}
    for prefix, wanted in given.items():
        more = {argument: prefix} if prefix else {}
        made, _ = read_text(it.path, Expanding(how.reach, {**how.arguments, **more}), after)
        if made != wanted:
            what = "no place for the prefix changes names alone"
            line = first_difference(made, wanted)
            raise InputError(f"{it.path}: {what}; with {argument}:={prefix} it has {line}")
