"""``multibot arguments``: which argument of a xacro goes into which names."""

from __future__ import annotations

import argparse
import shlex
from collections.abc import Iterator

from multibot_rewrite.cli.output import deliver
from multibot_rewrite.cli.process import DONE
from multibot_rewrite.cli.tables import JSON, Grid, clip, deliver_report, json_bytes
from multibot_rewrite.cli.usage import plain_words, xacro_args
from multibot_rewrite.cli.walk import check_target
from multibot_rewrite.config import configured_vocabulary
from multibot_rewrite.model import UsageError
from multibot_rewrite.releases import release_here
from multibot_rewrite.reports.xacro_arguments import (
    Argument,
    XacroArguments,
    as_json,
    find_arguments,
)
from multibot_rewrite.rewriters.builtin import builtin_tree
from multibot_rewrite.sources.access import Reach
from multibot_rewrite.sources.own_names import filled
from multibot_rewrite.sources.read import is_xacro

COLUMNS = ("argument", "default", "goes into", "as", "count", "example")


def run(options: argparse.Namespace) -> int:
    """Expand, compare, report; returns the exit code."""
    path = _path(options)
    if options.output:
        check_target(options.output, [path, *options.vocabulary])
    tree = builtin_tree(
        (*configured_vocabulary(path), *options.vocabulary), release_here(options.distro)
    )
    found = find_arguments(
        path, filled(xacro_args(options)), tree, reach=Reach(trust=options.trust)
    )
    if options.output:
        check_target(options.output, found.read)
    if options.form == JSON:
        deliver(options, json_bytes(as_json(found)))
    else:
        deliver_report(options, _parts(found))
    return DONE


def _path(options: argparse.Namespace) -> str:
    words = plain_words(options)
    if len(words) != 1:
        raise UsageError("give one FILE.xacro; for example: multibot arguments arm.urdf.xacro")
    if not is_xacro(words[0]):
        raise UsageError(f"{words[0]}: only xacro has arguments; give a xacro")
    return words[0]


def _parts(found: XacroArguments) -> Iterator[str | Grid]:
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
