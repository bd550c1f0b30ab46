"""Pictures of a checked graph: the files that the options ask for."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence

from multibot_rewrite.cli.output import STANDARD, write_files
from multibot_rewrite.cli.walk import check_folder, check_target
from multibot_rewrite.findings.finding import Finding
from multibot_rewrite.graph.expectation import Expectation
from multibot_rewrite.graph.snapshot import Snapshot
from multibot_rewrite.model import UsageError

NAMES = ("report", "mermaid", "dot")
# What a command may have read.
_INPUTS = ("plan", "input")


def check(options: argparse.Namespace) -> None:
    """Raises UsageError for a picture that cannot go where it is asked for, before any work."""
    list(_wanted(options))


def deliver(
    options: argparse.Namespace, plan: Expectation, graph: Snapshot, found: Sequence[Finding]
) -> None:
    """Write the pictures asked for, all or none; raises UsageError where one cannot be written."""
    wanted = list(_wanted(options))
    if not wanted:
        return
    from multibot_rewrite.graph.pictures.dot import to_dot  # few checks draw
    from multibot_rewrite.graph.pictures.mermaid import to_mermaid
    from multibot_rewrite.graph.pictures.page import to_html
    from multibot_rewrite.graph.pictures.scene import make_scene

    drawn = dict(zip(NAMES, (to_html, to_mermaid, to_dot), strict=True))
    scene = make_scene(plan, graph, found)
    write_files(options, [(target, drawn[name](scene)) for name, target in wanted])


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
