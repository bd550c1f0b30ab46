# SPDX-License-Identifier: Apache-2.0
"""What ``urdf-lint --lsp`` answers. Each function runs in a process of its own, where files that are
open in the editor are read as they are there."""

from __future__ import annotations

import argparse
import os
from collections.abc import Mapping, Sequence
from contextlib import suppress
from multiprocessing.connection import Connection

from multibot_rewrite.base.bounded import OPEN_TEXTS
from multibot_rewrite.base.config import configured_vocabulary
from multibot_rewrite.base.file_kinds import BESIDE, DESCRIPTIONS, FLEET, SRDF, WORLD, recognised
from multibot_rewrite.base.findings.codes import explained
from multibot_rewrite.base.findings.finding import Finding, RewriteRefused
from multibot_rewrite.base.model import InputError, MultibotError, UsageError
from multibot_rewrite.base.releases import release_here
from multibot_rewrite.cli.inspect import details
from multibot_rewrite.cli.lint import given, of_release
from multibot_rewrite.cli.tables import render
from multibot_rewrite.description.rewriters.lookup import look_up
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.rewriters.vocabulary import TYPES, load_vocabulary
from multibot_rewrite.description.sources.packages import package_of
from multibot_rewrite.description.sources.processes import server
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.fleet.checks.closed_plan import closed_plan
from multibot_rewrite.fleet.file.fleet_file import read_fleet
from multibot_rewrite.fleet.fleet_plan import plan_fleet
from multibot_rewrite.lint.catalogue import rules
from multibot_rewrite.lint.check import lint_file
from multibot_rewrite.lint.config.configured import (
    Configured,
    configured,
    is_excluded,
    with_options,
)
from multibot_rewrite.lint.failures import failure
from multibot_rewrite.lint.files.included import set_among
from multibot_rewrite.lint.files.named import descriptions_below
from multibot_rewrite.lint.fix import fix
from multibot_rewrite.refactor.rename import rename_symbol
from multibot_rewrite.refactor.symbols import Place, find_places
from multibot_rewrite.rules.settings import Settings

_LINTED = (*DESCRIPTIONS, SRDF, WORLD, *(kind for kind, _ in BESIDE))
_ENDS = (".urdf", ".xacro", ".srdf", ".sdf")


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
        config = _configured(options, path)
        if is_excluded(path, config):
            return ()
        if kind == FLEET:
            fleet = closed_plan(plan_fleet(read_fleet(path, config.settings.distro, os.environ)))
            found = (*fleet.table.problems, *fleet.gaps)
            return [it if it.file else it._replace(file=path) for it in found]
        is_linted = kind in _LINTED or path.endswith(_ENDS)
        return lint_file(path, set_among([path], config.settings)) if is_linted else ()
    except RewriteRefused as error:
        return error.findings
    except MultibotError as error:
        own = error if isinstance(error, InputError) else InputError(f"{path}: {error}")
        return [failure(path, own, Settings())]


def _configured(options: argparse.Namespace, path: str) -> Configured:
    config = with_options(configured(path, options.config), **given(options))
    return of_release(options, config, [path])[0]


def fixed(options: argparse.Namespace, path: str, only: Finding | None) -> bytes:
    """Return the text of a file with all its safe fixes, or that of one finding."""
    settings = set_among([path], _configured(options, path).settings)
    return fix(path, read_file(path), settings, only)[0]


def explain(options: argparse.Namespace, path: str, word: str, codes: Sequence[str]) -> str:
    """Return what ``multibot inspect`` says of a name or code, and of the codes of findings there."""
    vocabulary, known = load_vocabulary(_vocabulary(options, path), options.distro or ""), rules()
    found = look_up(vocabulary, word, TYPES)
    its = [explained(known[it]) for it in dict.fromkeys((word, *codes)) if it in known]
    return "\n".join([render(details(found)), *its] if found else its)


def places(options: argparse.Namespace, path: str, at: tuple[int, int]) -> list[Place]:
    """Return all places of the link, joint, frame or topic at a place of a file, in its package."""
    tree = builtin_tree(_vocabulary(options, path), release_here(options.distro))
    return find_places(path, at, _folder(path), tree)


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
