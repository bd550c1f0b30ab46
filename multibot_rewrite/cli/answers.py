# SPDX-License-Identifier: Apache-2.0
"""What ``urdf-lint --lsp`` answers. Each function runs in a process of its own, where files that are
open in the editor are read as they are there."""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from itertools import chain
from multiprocessing.connection import Connection
from typing import NamedTuple

from multibot_rewrite.base.bounded import OPEN_TEXTS, read_bytes
from multibot_rewrite.base.config import configured_vocabulary
from multibot_rewrite.base.file_kinds import BESIDE, DESCRIPTIONS, FLEET, SRDF, WORLD, recognised
from multibot_rewrite.base.findings.codes import explained
from multibot_rewrite.base.findings.finding import Finding, RewriteRefused, locate
from multibot_rewrite.base.model import InputError, MultibotError, UsageError
from multibot_rewrite.base.releases import release_here
from multibot_rewrite.cli.inspect import details
from multibot_rewrite.cli.lint import given, of_release
from multibot_rewrite.cli.tables import render
from multibot_rewrite.companions.names.rename_map import KINDS as OF_FILES
from multibot_rewrite.description.rewriters.lookup import look_up
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.rewriters.vocabulary import TYPES, load_vocabulary
from multibot_rewrite.description.sources.access import BOUNDED
from multibot_rewrite.description.sources.packages import package_of
from multibot_rewrite.description.sources.processes import server
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.description.steps.document import tag_end
from multibot_rewrite.fleet.checks.closed_plan import closed_plan
from multibot_rewrite.fleet.file.fleet_file import read_fleet
from multibot_rewrite.fleet.fleet_plan import plan_fleet
from multibot_rewrite.fleet.one_file import names_in_file
from multibot_rewrite.lint.catalogue import rules
from multibot_rewrite.lint.check import lint_file
from multibot_rewrite.lint.config.configured import configured, is_excluded, with_options
from multibot_rewrite.lint.failures import failure
from multibot_rewrite.lint.files.included import set_among
from multibot_rewrite.lint.files.named import descriptions_below
from multibot_rewrite.lint.fix import fix
from multibot_rewrite.refactor import source_edits as edits
from multibot_rewrite.refactor.package import Description, Expanding, Package, read_package
from multibot_rewrite.refactor.rename import KINDS, rename_symbol
from multibot_rewrite.rules.settings import Settings

_LINTED = (*DESCRIPTIONS, SRDF, WORLD, *(kind for kind, _ in BESIDE))
_ENDS = (".urdf", ".xacro", ".srdf", ".sdf")


class Place(NamedTuple):
    """A name in a file, from ``start`` to ``end``: line and column, from 1. A name that a xacro puts
    together is at the tag that has it."""

    file: str
    start: tuple[int, int]
    end: tuple[int, int]
    kind: str
    name: str
    declares: bool


def answer(connection: Connection) -> None:
    """Answer one question: with what a function returns, or an error that is meant for a person. It
    comes with the texts that the editor has open, by the real paths of the files."""
    os.dup2(2, 1)  # the server's output is for the editor alone
    server(os.getpid())  # the first xacro would wait for it
    with suppress(EOFError):  # the editor is gone
        texts, function, *given = connection.recv()
        OPEN_TEXTS.update(texts)
        try:
            connection.send(function(*given))
        except MultibotError as error:
            connection.send(UsageError(str(error)))


def diagnose(options: argparse.Namespace, path: str) -> Sequence[Finding]:
    """Return the findings of a file; none for a file of a kind that is not linted."""
    kind = recognised(read_file(path))
    try:
        settings = _settings(options, path)
        if settings and kind == FLEET:
            fleet = closed_plan(plan_fleet(read_fleet(path, settings.distro, os.environ)))
            found = (*fleet.table.problems, *fleet.gaps)
            return [it if it.file else it._replace(file=path) for it in found]
        is_linted = kind in _LINTED or path.endswith(_ENDS)
        return lint_file(path, settings) if settings and is_linted else ()
    except RewriteRefused as error:
        return error.findings
    except MultibotError as error:
        own = error if isinstance(error, InputError) else InputError(f"{path}: {error}")
        return [failure(path, own, Settings())]


def _settings(options: argparse.Namespace, path: str) -> Settings | None:
    """Return the settings for a file; None for one that the configuration leaves out."""
    config = with_options(configured(path, options.config), **given(options))
    settings, _ = of_release(options.distro or config.distro, config.settings, [path])
    return None if is_excluded(path, config) else set_among([path], settings)


def fixed(options: argparse.Namespace, path: str) -> bytes:
    """Return the text of a file with all its safe fixes."""
    settings = _settings(options, path)
    return fix(path, read_file(path), settings)[0] if settings else read_file(path)


def explain(options: argparse.Namespace, path: str, word: str, codes: Sequence[str]) -> str:
    """Return what ``multibot inspect`` says of a name or code, and of the codes of findings there."""
    vocabulary, known = load_vocabulary(_vocabulary(options, path), options.distro or ""), rules()
    found = look_up(vocabulary, word, TYPES)
    its = [explained(known[it]) for it in dict.fromkeys((word, *codes)) if it in known]
    return "\n".join([render(details(found)), *its] if found else its)


def renamed(options: argparse.Namespace, path: str, place: Place, new: str) -> Mapping[str, bytes]:
    """Return the files that ``multibot rename`` changes, by path."""
    folder, known, distro = _folder(path), _vocabulary(options, path), options.distro or ""
    made = rename_symbol(place.name, new, folder, kind=place.kind, vocabulary=known, distro=distro)
    return made.after


def _vocabulary(options: argparse.Namespace, path: str) -> tuple[str, ...]:
    return (*configured_vocabulary(path), *options.vocabulary)


def _folder(path: str) -> str:
    """Return the package of a file; where that has no description, the folder of packages around it."""
    own = package_of(path)
    folder = own[1] if own else os.path.dirname(path)
    return os.path.dirname(folder) if own and not descriptions_below(folder) else folder


def places(options: argparse.Namespace, path: str, at: tuple[int, int]) -> list[Place]:
    """Return all places of the link, joint, frame or topic at a place of a file, in its package."""
    tree = builtin_tree(_vocabulary(options, path), release_here(options.distro))
    package = read_package(_folder(path), tree, Expanding(BOUNDED, {}))
    described = chain.from_iterable(map(_in_description, package.descriptions))
    every = dict.fromkeys((*described, *_in_other_files(package)))
    real = os.path.realpath(path)
    here = (it for it in every if it.start <= at <= it.end and os.path.realpath(it.file) == real)
    # Where tags and names begin, the name is the last; a declaration says more than a use.
    found = max(here, key=lambda it: (it.start, it.declares), default=None)
    return [it for it in every if found and (it.name, it.kind) == (found.name, found.kind)]


def _in_description(it: Description) -> Iterator[Place]:
    document = it.inventory.document
    for claim, names in zip(it.inventory.claims, it.inventory.names, strict=True):
        for name in names:
            kind = _kind(name.kind, *name.kinds[:1])
            change = edits.change_of(document, claim, name.at, name.at + len(name.text), "")
            if kind and (found := _span(it, change)):
                source = it.sources.get(found.file) or document.source
                ends = locate(source, found.start), locate(source, found.end)
                yield Place(found.file, *ends, kind, name.text, claim.site.role == "declares")


def _kind(*kinds: str) -> str:
    """Return the first kind that a rename takes, that of a link for a frame; empty for none."""
    return next((own for kind in kinds for own, its in KINDS.items() if kind in its), "")


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
    """Return the names in the files that belong to the first description."""
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
