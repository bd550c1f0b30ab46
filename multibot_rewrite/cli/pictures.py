# SPDX-License-Identifier: Apache-2.0
"""The page of a checked graph: the file that ``--report`` asks for."""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterable, Sequence
from contextlib import suppress

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import MultibotError, UsageError
from multibot_rewrite.base.releases import facts_of_release
from multibot_rewrite.cli.output import STANDARD, note, write_files
from multibot_rewrite.cli.report import About, counted_findings, with_coverage
from multibot_rewrite.cli.walk import check_folder, check_target
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.live.watching import Outcome
from multibot_rewrite.system.records import System

# What a command may have read.
_INPUTS = ("plan", "input")
# How much of a source is shown: lines before and after the one, letters of each.
_AROUND, _LONGEST = 2, 160
_SOURCES = (".urdf", ".xacro", ".srdf", ".sdf", ".xml", ".world", ".yaml", ".yml")


def check(options: argparse.Namespace) -> None:
    """Raise UsageError, before any work, for a report that cannot be written to its file."""
    target = vars(options).get("report")
    if target is None:
        return
    if target == STANDARD:
        raise UsageError(f"--report {target} is not a file; standard output has the findings")
    given = vars(options)
    other = given.get("output")
    if other and os.path.realpath(target) == os.path.realpath(other):
        raise UsageError(f"{target}: two results would go to this one file, give each its own")
    inputs = [given[name] for name in _INPUTS if given.get(name)]
    check_target(target, [*inputs, *given.get("snapshot", ())], "--report")
    check_folder(target)


def deliver(
    options: argparse.Namespace,
    plan: System,
    graph: System,
    found: Sequence[Finding],
    outcome: Outcome,
) -> None:
    """Write the page if it is asked for; raises UsageError where it cannot be written."""
    if not options.report:
        return
    from multibot_rewrite.cli.view import framed
    from multibot_rewrite.lint.catalogue import rules
    from multibot_rewrite.pages.page import to_html  # few checks draw
    from multibot_rewrite.pages.scene import make_scene

    scene = make_scene(plan, graph, found, outcome)
    lines = snippets(row.place for row in scene.rows)
    page = to_html(scene, rules=rules(), snippets=lines, robots=framed(options, graph))
    write_files(options, [(options.report, page)])


def conclude(
    options: argparse.Namespace,
    plan: System,
    graph: System,
    found: Sequence[Finding],
    outcome: Outcome,
    about: About,
) -> None:
    """Write the page if it is asked for, and print the verdict behind how much it is about."""
    deliver(options, plan, graph, found, outcome)
    verdict = f"{counted_findings(found)}: {outcome.words}{facts_of_release(about.release)}"
    note(options, with_coverage(about.coverage, verdict))


def snippets(places: Iterable[str]) -> dict[str, list[str]]:
    """Return by ``file:line`` the numbered lines around it; none for missing files and no texts."""
    found = {}
    for place in dict.fromkeys(places):
        file, _, number = place.rpartition(":")
        # A plan may be somebody else's: it does not say that any file is read.
        if not number.isdecimal() or not file.endswith(_SOURCES) or not os.path.isfile(file):
            continue
        first, end = max(int(number) - 1 - _AROUND, 0), int(number) + _AROUND
        with suppress(MultibotError, ValueError):
            lines = enumerate(read_file(file).decode().splitlines()[first:end], first + 1)
            found[place] = [f"{at:5d} {it.rstrip()[:_LONGEST]}" for at, it in lines]
    return {place: lines for place, lines in found.items() if lines}
