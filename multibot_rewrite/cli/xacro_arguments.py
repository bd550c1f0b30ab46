# SPDX-License-Identifier: Apache-2.0
"""``multibot inspect FILE.xacro``: which argument goes into which names."""

from __future__ import annotations

import argparse
import os
import shlex
from collections.abc import Iterator, Sequence

from multibot_rewrite.base.config import configured_vocabulary
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.releases import release_here
from multibot_rewrite.base.wording import clip
from multibot_rewrite.cli.output import deliver
from multibot_rewrite.cli.process import DONE
from multibot_rewrite.cli.tables import JSON, Grid, deliver_report, json_bytes
from multibot_rewrite.cli.usage import check_xacro, xacro_args
from multibot_rewrite.cli.walk import check_target
from multibot_rewrite.description.reports.xacro_arguments import (
    Argument,
    XacroArguments,
    as_json,
    find_arguments,
)
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.sources.access import Reach
from multibot_rewrite.description.sources.own_names import filled
from multibot_rewrite.description.sources.read import is_xacro

COLUMNS = ("argument", "default", "goes into", "as", "count", "example")


def run(options: argparse.Namespace, words: Sequence[str]) -> int:
    """Try the arguments of a xacro file and report; returns the exit code."""
    path = _only_xacro(options, words)
    if options.output:
        check_target(options.output, [path, *options.vocabulary])
    tree = builtin_tree(
        (*configured_vocabulary(path), *options.vocabulary), release_here(options.distro)
    )
    reach = Reach(trust=options.trust)
    found = find_arguments(path, filled(xacro_args(options)), tree, reach=reach)
    if options.output:
        check_target(options.output, found.read)
    if options.form == JSON:
        deliver(options, json_bytes({"xacro": as_json(found)}))
    else:
        deliver_report(options, report(found))
    return DONE


def _only_xacro(options: argparse.Namespace, words: Sequence[str]) -> str:
    """The one word, which is a xacro file; raises UsageError."""
    missing = next((it for it in words if not os.path.lexists(it)), None)
    if missing is not None:
        raise UsageError(f"{missing}: there is no such file or folder")
    if not words:
        raise UsageError(f"{options.words[0]} is an argument of a xacro file; name the file")
    check_xacro(options, words)
    other = next((it for it in words if not is_xacro(it)), None)
    if other is not None:
        linted = shlex.join(["urdf-lint", other])
        raise UsageError(f"{other} is no xacro; {linted} tells what is not known in it")
    if len(words) > 1:
        raise UsageError(f"{words[1]}: the arguments of one xacro file are shown; leave it out")
    return words[0]


def report(found: XacroArguments) -> Iterator[str | Grid]:
    """What is printed of a xacro's arguments."""
    rows = [row for it in found.arguments for row in _rows(it)]
    if rows:
        yield Grid(COLUMNS, rows)
        yield ""
    without = [it.name for it in found.arguments if not it.uses and not it.fault]
    if without:
        yield f"go into no names: {', '.join(without)}"
    refused = [it.name for it in found.arguments if it.fault]
    if refused:
        yield f"take no name of a robot: {', '.join(refused)}"
    if found.untried:
        yield f"too many to try: {', '.join(found.untried)}"
    yield from _advice(found)


def _rows(it: Argument) -> Iterator[tuple[str, ...]]:
    first = it.name, clip(it.default)
    for use in it.uses:
        how = f"{use.how} {use.separator}".rstrip()
        yield *first, use.kind, how, f"{use.names} of {use.total}", use.example
        first = "", ""


def _advice(found: XacroArguments) -> Iterator[str]:
    """The command that uses the arguments for robots."""
    command = ["urdf-postfix", found.file, "robot1", "robot2", "-o", "out/{robot}.urdf"]
    line = shlex.join([*command, *found.words])
    if found.words:
        yield "each robot by its own argument, and everything else rewritten as usual:"
    else:
        yield "no argument gives each robot its own names; the rewrite does it:"
    yield f"  {line}"
