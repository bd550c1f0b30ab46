# SPDX-License-Identifier: Apache-2.0
"""Several descriptions become one robot, and are taken out of it again."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple

from multibot_rewrite.base.arguments import checked
from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.base.releases import release_here
from multibot_rewrite.description.checks.meeting import not_verified
from multibot_rewrite.description.joining.from_file import plain_text, plain_texts
from multibot_rewrite.description.joining.join import GivenPart, JoinedText, Output, join_texts
from multibot_rewrite.description.joining.kept import is_joined_whole
from multibot_rewrite.description.joining.part import Part, ReadPart, prefixing
from multibot_rewrite.description.joining.second_reading import Mounted, split_text
from multibot_rewrite.description.joining.semantic import (
    JoinedSemantics,
    PartSemantics,
    joined_srdf,
    renamed_srdf,
)
from multibot_rewrite.description.readback.meeting import meetings, said
from multibot_rewrite.description.readback.reading import read
from multibot_rewrite.description.rewriters.tree import Tree, builtin_tree
from multibot_rewrite.description.sources.job import read_whole
from multibot_rewrite.description.sources.read import Source, SourceText, args_for, read_file
from multibot_rewrite.description.steps.collect import NOTHING, Inventory, collect
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.related_files.joined import (
    JoinedFile,
    PartMoveit,
    joined_files,
    joined_moveit,
    joined_rviz,
    part_file,
    part_moveit,
    part_rviz,
)


class Joined(NamedTuple):
    """One robot of several descriptions, with the SRDF and related files of all parts.

    They are empty where no part has them: ``srdf``, ``controllers`` (parameters), ``moveit``
    (files by name, one of each kind), ``rviz``. ``parts`` are their names; ``notes`` are what
    was left out and what two parts have in the running system, ``findings`` are about names
    without the prefix."""

    data: bytes
    srdf: bytes
    controllers: bytes
    parts: tuple[str, ...]
    notes: tuple[str, ...]
    findings: tuple[Finding, ...]
    moveit: Mapping[str, bytes] = MappingProxyType({})
    rviz: bytes = b""

    @property
    def text(self) -> str:
        """The description as str, for ``robot_description``; raises nothing."""
        return self.data.decode()

    @property
    def not_verified(self) -> tuple[str, ...]:
        """Why a name may lack its prefix, with counts; empty if verified. Raises nothing."""
        return not_verified(self.findings)


@checked
def join(
    parts: Iterable[Part],
    *,
    definitions: Iterable[str] = (),
    trust: bool = False,
    distro: str = "",
    samples: int = 0,
    output: str = "",
) -> Joined:
    """Join descriptions: each part after the first is fixed to a link of those before it.

    Every part stays as it is but for its prefix, and ``split`` gives it back byte by byte. Where
    ``output`` names the file that it goes to, relative paths and ``<parameters>`` fit that. With
    ``samples`` random poses pinocchio tells which links of two parts never touch, for the SRDF. Raises
    UsageError and InputError, in one line, where parts cannot be joined: a link that is not there, a
    name that two of them have, a part with two roots. Raises ProofError as ``rewrite``.
    """
    given = tuple(parts)
    wrong = next((it for it in given if not isinstance(it, Part)), None)
    if wrong is not None:
        raise UsageError(f"join(): parts has a {type(wrong).__name__}; write Part('arm.urdf')")
    tree = builtin_tree(tuple(definitions), release_here(distro))
    texts = [read_whole(it.description, it.xacro_args, trust) for it in given]
    pairs = zip(given, texts, strict=True)
    controllers = f"{os.path.abspath(output).removesuffix('.urdf')}_controllers.yaml"
    files = Output(output, controllers if output else "")
    made = join_texts([GivenPart(it, text.data, text.file) for it, text in pairs], tree, files)
    found = _with_related_files(given, made, tree, trust, samples)
    unread = (
        f"{text.file}: no file of the xacro has the argument {name}"
        for it, text in zip(given, texts, strict=True)
        for name in (text.known.lacks(sorted(it.xacro_args)) if text.known else ())
    )
    # What is joined already keeps its paths.
    looked_up = _relative_files(
        made.parts[: is_joined_whole(texts[0].data)] if output else made.parts
    )
    return found._replace(notes=(*unread, *looked_up, *found.notes))


def join_plain(parts: Sequence[Part], place: str, tree: Tree, trust: bool) -> Joined:
    """Return the joined parts without comments; raises InputError if a name lacks a prefix."""
    given, _ = plain_texts(parts, trust)
    try:
        made = join_texts(given, tree)
        found = _with_related_files(parts, made, tree, trust)
    except UsageError as error:
        raise InputError(f"{place}: {error}") from None
    notes = (*_relative_files(made.parts), *found.notes)
    return found._replace(data=plain_text(made, place), notes=notes)


def _with_related_files(
    given: Sequence[Part], made: JoinedText, tree: Tree, trust: bool, samples: int = 0
) -> Joined:
    """Return the joined description with the related files of the parts."""
    has_srdf = any(it.srdf for it in given)
    srdfs, controllers, configs = [], [], []
    for it, part in zip(given, (it.part for it in made.parts), strict=True):
        before = _without_prefix(part, tree) if it.controllers or it.rviz else part.inventory
        srdf = _read_srdf(it, it.srdf, trust) if has_srdf and it.srdf is not None else None
        srdfs.append(
            renamed_srdf(part, srdf.data, srdf.file, tree) if srdf else PartSemantics(part, b"", "")
        )
        controllers += [part_file(read_file(at), at, before, part.prefix) for at in it.controllers]
        if it.rviz:
            configs.append(part_rviz(read_file(it.rviz), it.rviz, before, part.name, part.prefix))
    semantics = joined_srdf(srdfs, made.data, samples) if has_srdf else JoinedSemantics(b"", ())
    files = joined_files(controllers) if controllers else JoinedFile(b"", ())
    rviz = joined_rviz(configs) if configs else JoinedFile(b"", ())
    moveit = joined_moveit(_moveit_of_parts(given, made, tree, trust))
    named = {it.part.name: read(it.text, it.part.file, tree.definitions).names for it in made.parts}
    met = (
        f"{said(f'{it.robot} and {it.other}', it.name, it.twin)};"
        " a prefix changes no topics, nodes and ports"
        for it in meetings(named, prefixing())
    )
    told = (f"{file}: {what}" for file, what in moveit.notes)
    notes = (*made.notes, *semantics.notes, *files.notes, *told, *rviz.notes)
    notes, names = (*notes, *met), tuple(it.part.name for it in made.parts)
    return Joined(
        made.data, semantics.data, files.data, names, notes, made.findings, moveit.files, rviz.data
    )


@checked
def split(source: Source, *, definitions: Iterable[str] = (), distro: str = "") -> dict[str, bytes]:
    """Return the parts that ``join`` joined, by name; raises InputError for another or edited text."""
    read_in = read_whole(source, {})
    tree = builtin_tree(tuple(definitions), release_here(distro))
    return split_text(read_in.data, read_in.file, tree)


def _relative_files(parts: Iterable[Mounted]) -> Iterator[str]:
    """Yield notes on meshes and pictures that are looked up from the folder of a part's file."""
    for mounted in parts:
        root, file = mounted.part.inventory.document.root, mounted.part.file
        names = (one.get("filename", "") for one in root.iter("mesh", "texture"))
        found = [name for name in names if name and "://" not in name and name[0] != "/"]
        if found:
            what = f"{file}: {found[0]!r} is looked up from the folder of the file"
            more = f", and {len(found) - 1} more" if len(found) > 1 else ""
            yield f"{what}{more}; write package://NAME/..."


def _read_srdf(part: Part, srdf: Source, trust: bool) -> SourceText:
    return read_whole(srdf, args_for(srdf, part.description, part.xacro_args), trust)


def _moveit_of_parts(
    given: Sequence[Part], made: JoinedText, tree: Tree, trust: bool
) -> Iterator[PartMoveit]:
    for it, mounted in zip(given, made.parts, strict=True):
        part, said = mounted.part, NOTHING
        before = _without_prefix(part, tree) if it.moveit else part.inventory
        if it.moveit and it.srdf is not None:
            text = _read_srdf(it, it.srdf, trust)
            document = read_document(text.data, text.file)
            said = collect(document, tree, before.declared).declared
        for at in it.moveit:
            yield part_moveit(read_file(at), at, before, said, part.prefix)


def _without_prefix(part: ReadPart, tree: Tree) -> Inventory:
    return collect(read_document(part.data, part.file), tree)
