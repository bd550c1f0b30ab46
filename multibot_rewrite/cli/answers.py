# SPDX-License-Identifier: Apache-2.0
"""What ``urdf-lint --lsp`` answers, each time in a process of its own.

Files that are open in the editor are read there as they are in it."""

from __future__ import annotations

import argparse
import gc
import os
from collections.abc import Sequence
from contextlib import redirect_stdout, suppress
from difflib import SequenceMatcher
from io import BytesIO, TextIOWrapper
from multiprocessing.connection import Connection

from multibot_rewrite.base.bounded import OPEN_TEXTS
from multibot_rewrite.base.config import configured_definitions
from multibot_rewrite.base.file_kinds import BESIDE, DESCRIPTIONS, FLEET, SRDF, WORLD, recognised
from multibot_rewrite.base.findings.finding import Finding, RewriteRefused
from multibot_rewrite.base.model import InputError, MultibotError, UsageError
from multibot_rewrite.checks.closed_plan import closed_plan
from multibot_rewrite.checks.judged_plan import plan_fleet
from multibot_rewrite.cli.lint import given, of_release
from multibot_rewrite.cli.multibot import run
from multibot_rewrite.description.sources.packages import package_of
from multibot_rewrite.description.sources.processes import server
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.fleet.file.fleet_file import read_fleet
from multibot_rewrite.lint.check import lint_file
from multibot_rewrite.lint.config import configured
from multibot_rewrite.lint.config.baseline import beyond, read_baseline
from multibot_rewrite.lint.failures import failure
from multibot_rewrite.lint.files.included import set_among
from multibot_rewrite.lint.files.named import descriptions_below
from multibot_rewrite.lint.fix import fix
from multibot_rewrite.refactor.rename import Place, find_places, rename_symbol
from multibot_rewrite.rules.settings import Settings

_LINTED = (*DESCRIPTIONS, SRDF, WORLD, *(kind for kind, _ in BESIDE))
# Each: file, first line, the one after the last, from 0, and new text, with the line ends of a buffer.
Edits = list[tuple[str, int, int, str]]
_ENDS = (".urdf", ".xacro", ".srdf", ".sdf")


def answer(connection: Connection) -> None:
    """Send the answer to the one question that comes, or an error that is meant for a person."""
    gc.disable()
    os.dup2(2, 1)  # the server's output is for the editor alone
    server(os.getpid())  # the first xacro would wait for it
    with suppress(EOFError):  # the editor is gone
        texts, function, *words = connection.recv()
        OPEN_TEXTS.update(texts)
        try:
            connection.send(function(*words))
        except MultibotError as error:
            connection.send(UsageError(str(error)))


def diagnose(options: argparse.Namespace, path: str) -> Sequence[Finding]:
    """Return the findings of a file; none for a file of a kind that is not linted."""
    try:
        kind, config = recognised(read_file(path)), _configured(options, path)
        if config and kind == FLEET:
            fleet = closed_plan(plan_fleet(read_fleet(path, config.settings.distro, os.environ)))
            found = (*fleet.table.problems, *fleet.gaps)
            return [it if it.file else it._replace(file=path) for it in found]
        if not config or (kind not in _LINTED and not path.endswith(_ENDS)):
            return ()
        findings, baseline = lint_file(path, config.settings), config.baseline
        known = read_baseline(baseline) if baseline else {}
        return beyond(findings, known, baseline, [path])[0] if known else findings
    except RewriteRefused as error:
        return error.findings
    except MultibotError as error:
        own = error if isinstance(error, InputError) else InputError(f"{path}: {error}")
        return [failure(path, own, Settings())]


def _configured(options: argparse.Namespace, path: str) -> configured.Configured | None:
    """Return the configuration for a file; None for one that it leaves out."""
    alone = configured.configured(path, options.config)
    config = configured.with_options(alone, **given(options))
    settings, _ = of_release(options.distro or config.distro, config.settings, [path])
    config = config._replace(settings=set_among([path], settings))
    return None if configured.is_excluded(path, config) else config


def fixed(options: argparse.Namespace, path: str) -> Edits:
    """Return the edits that fix all in a file that is safe to fix."""
    config, text = _configured(options, path), read_file(path)
    return _edits(path, text, fix(path, text, config.settings)[0]) if config else []


def _edits(path: str, before: bytes, after: bytes) -> Edits:
    old, new = before.splitlines(keepends=True), after.splitlines(keepends=True)
    return [
        (path, start, end, b"".join(new[first:last]).decode().replace("\r\n", "\n"))
        for tag, start, end, first, last in SequenceMatcher(None, old, new).get_opcodes()
        if tag != "equal"
    ]


def explain(options: argparse.Namespace, path: str, words: Sequence[str]) -> str:
    """Return what ``multibot inspect`` prints about words; "" for unknown ones."""
    definitions, distro = _definitions(options, path)
    others = [f"--definitions={it}" for it in definitions] + [f"--distro={distro}"] * bool(distro)
    printed = TextIOWrapper(BytesIO(), "utf-8")
    with redirect_stdout(printed):
        for it in filter(None, dict.fromkeys(words)):
            with suppress(MultibotError):
                run(["inspect", it, *others])
    return printed.buffer.getvalue().decode()


def places(options: argparse.Namespace, path: str, at: tuple[int, int]) -> list[Place]:
    """Return all places in a file's package of the name at line and column ``at``."""
    return find_places(path, at, _folder(path), *_definitions(options, path))


def renamed(options: argparse.Namespace, path: str, place: Place, new: str) -> Edits:
    """Return the edits of ``multibot rename``."""
    definitions, distro = _definitions(options, path)
    name, kind, folder = place.name, place.kind, _folder(path)
    made = rename_symbol(name, new, folder, kind=kind, definitions=definitions, distro=distro)
    return [it for file, text in made.after.items() for it in _edits(file, made.before[file], text)]


def _definitions(options: argparse.Namespace, path: str) -> tuple[tuple[str, ...], str]:
    """Return the definition files and the release that are asked for."""
    return (*configured_definitions(path), *options.definitions), options.distro or ""


def _folder(path: str) -> str:
    """Return a file's package, or the folder above one that has no description."""
    own = package_of(path)
    folder = own[1] if own else os.path.dirname(path)
    return os.path.dirname(folder) if own and not descriptions_below(folder) else folder
