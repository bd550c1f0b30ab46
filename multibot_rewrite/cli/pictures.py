"""Pictures of a checked graph: the files that the options ask for."""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING

from multibot_rewrite.cli.output import STANDARD, write_files
from multibot_rewrite.cli.walk import check_folder, check_target
from multibot_rewrite.findings.finding import Finding
from multibot_rewrite.graph.expectation import Expectation
from multibot_rewrite.live.watching import Outcome
from multibot_rewrite.model import MultibotError, UsageError
from multibot_rewrite.sources.read import read_file
from multibot_rewrite.system.records import System

if TYPE_CHECKING:
    from multibot_rewrite.pages.page import Framed

NAMES = ("report", "mermaid", "dot")
# What a command may have read.
_INPUTS = ("plan", "input")
# How much of a source is shown: lines before and after the one, letters of each.
_AROUND, _LONGEST = 2, 160
_SOURCES = (".urdf", ".xacro", ".srdf", ".sdf", ".xml", ".world", ".yaml", ".yml")


def check(options: argparse.Namespace) -> None:
    """Raises UsageError for a picture that cannot go where it is asked for, before any work."""
    list(_wanted(options))


def deliver(
    options: argparse.Namespace,
    plan: Expectation,
    graph: System,
    found: Sequence[Finding],
    outcome: Outcome,
) -> None:
    """Write the pictures asked for, all or none; raises UsageError where one cannot be written."""
    wanted = list(_wanted(options))
    if not wanted:
        return
    from multibot_rewrite.catalogue import rules
    from multibot_rewrite.pages.dot import to_dot  # few checks draw
    from multibot_rewrite.pages.mermaid import to_mermaid
    from multibot_rewrite.pages.page import to_html
    from multibot_rewrite.pages.scene import Scene, make_scene

    scene = make_scene(plan, graph, found, outcome)
    page = partial(
        to_html, rules=rules(), snippets=snippets(row.place for row in scene.rows),
        robots=_robots(options, graph),
    )  # fmt: skip
    draw: tuple[Callable[[Scene], bytes], ...] = (page, to_mermaid, to_dot)
    drawn = dict(zip(NAMES, draw, strict=True))
    write_files(options, [(target, drawn[name](scene)) for name, target in wanted])


def _robots(options: argparse.Namespace, graph: System) -> Framed | None:
    """Only a page of HTML has them."""
    if not options.report:
        return None
    from multibot_rewrite.cli.view import framed

    return framed(options, graph)


def snippets(places: Iterable[str]) -> dict[str, list[str]]:
    """By ``file:line``: that line of the file with those around it, each with its number.

    A file that is not there any more, or is no text, has none.
    """
    found = {}
    for place in dict.fromkeys(places):
        file, _, line = place.rpartition(":")
        if file and line.isdecimal():
            found[place] = _lines_around(file, int(line))
    return {place: lines for place, lines in found.items() if lines}


def _lines_around(file: str, line: int) -> list[str]:
    first = max(line - 1 - _AROUND, 0)
    # A plan may be somebody else's: it does not say that any file is read.
    if not file.endswith(_SOURCES) or not os.path.isfile(file):
        return []
    try:
        lines = read_file(file).decode().splitlines()[first : line + _AROUND]
    except (MultibotError, ValueError):
        return []
    return [
        f"{number:5d} {it.rstrip()[:_LONGEST]}" for number, it in enumerate(lines, start=first + 1)
    ]


def _wanted(options: argparse.Namespace) -> Iterator[tuple[str, str]]:
    """Which pictures go where."""
    given = vars(options)
    inputs = [given[name] for name in _INPUTS if given.get(name)]
    inputs += given.get("snapshot", ())
    for name in NAMES:
        target = given.get(name)
        if target is None:
            continue
        if target == STANDARD:
            raise UsageError(f"--{name} {target} is not a file; standard output has the findings")
        check_target(target, inputs, f"--{name}")
        check_folder(target)
        yield name, target
