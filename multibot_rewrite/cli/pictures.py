"""Pictures of a checked graph as options of a command, and the files that are asked for."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator, Sequence

from multibot_rewrite.cli.files import write_all
from multibot_rewrite.cli.walk import check_folder, check_target
from multibot_rewrite.findings.finding import Finding
from multibot_rewrite.graph.expectation import Expectation
from multibot_rewrite.graph.pictures.dot import to_dot
from multibot_rewrite.graph.pictures.mermaid import to_mermaid
from multibot_rewrite.graph.pictures.page import to_html
from multibot_rewrite.graph.pictures.scene import Scene, make_scene
from multibot_rewrite.graph.snapshot import Snapshot
from multibot_rewrite.model import UsageError

PICTURES: dict[str, tuple[str, Callable[[Scene], bytes]]] = {
    "report": ("a page to look at, one HTML file", to_html),
    "mermaid": ("a flowchart for a page of Markdown", to_mermaid),
    "dot": ("a graph for Graphviz", to_dot),
}
# What a command may have read.
_INPUTS = ("plan", "snapshot", "input")


def options(parser: argparse.ArgumentParser) -> None:
    """Add the options of the pictures."""
    for name, (about, _) in PICTURES.items():
        parser.add_argument(f"--{name}", metavar="FILE", help=f"write {about}")


def check(options: argparse.Namespace) -> None:
    """Raises UsageError for a picture that cannot go where it is asked for, before any work."""
    list(_wanted(options))


def deliver(
    options: argparse.Namespace, plan: Expectation, graph: Snapshot, found: Sequence[Finding]
) -> None:
    """Write the pictures asked for, all or none; raises UsageError where one cannot be written."""
    wanted = list(_wanted(options))
    if wanted:
        scene = make_scene(plan, graph, found)
        write_all([(target, PICTURES[name][1](scene)) for name, target in wanted])


def _wanted(options: argparse.Namespace) -> Iterator[tuple[str, str]]:
    """Which pictures go where."""
    given = vars(options)
    inputs = [given[name] for name in _INPUTS if given.get(name)]
    for name in PICTURES:
        target = given.get(name)
        if target is None:
            continue
        if target in ("", "-"):
            raise UsageError(f"--{name} {target!r} is no file; standard output has the findings")
        check_target(target, inputs, f"--{name}")
        check_folder(target)
        yield name, target
