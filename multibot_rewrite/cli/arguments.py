"""Which argument of a xacro goes into which names, and the command that uses them."""

from __future__ import annotations

import argparse
import shlex
from collections.abc import Iterator, Sequence

from multibot_rewrite.cli.tables import Grid, clip
from multibot_rewrite.cli.usage import xacro_args
from multibot_rewrite.cli.walk import check_target
from multibot_rewrite.description.reports.xacro_arguments import (
    Argument,
    XacroArguments,
    find_arguments,
)
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.sources.access import Reach
from multibot_rewrite.description.sources.own_names import filled
from multibot_rewrite.description.sources.read import is_xacro

COLUMNS = ("argument", "default", "goes into", "as", "count", "example")


def arguments_of(
    options: argparse.Namespace, paths: Sequence[str], tree: Tree
) -> XacroArguments | None:
    """The arguments of a xacro that is looked at alone."""
    if len(paths) != 1 or not is_xacro(paths[0]):
        return None
    found = find_arguments(
        paths[0], filled(xacro_args(options)), tree, reach=Reach(trust=options.trust)
    )
    if options.output:
        check_target(options.output, found.read)
    return found


def xacro_parts(found: XacroArguments) -> Iterator[str | Grid]:
    """What is printed of them."""
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
