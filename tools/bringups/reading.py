# SPDX-License-Identifier: Apache-2.0
"""What a launch file would start, where launch is not installed: read by the stand-in of the package.

It is a weaker referee: ``init`` reads with the same reader, and nothing is started.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

from multibot_rewrite.base.model import InputError
from multibot_rewrite.producers.launch.child import read_launch_files
from multibot_rewrite.producers.launch.records import LaunchedNode, LaunchGraph, LaunchOrder
from tools.bringups.running import PATIENCE, Process, Ran, by_controller, parameters_of


def read(file: Path, given: Sequence[str], sources: Iterable[Path]) -> Ran:
    """Return what a launch file would start, as ``start`` returns what it starts."""
    pairs = (it.partition(":=") for it in given)
    arguments = tuple((name, value) for name, _, value in pairs)
    order = LaunchOrder(str(file), arguments, tuple(map(str, sources)))
    (found,) = read_launch_files([order], PATIENCE)
    if isinstance(found, InputError):
        return Ran((), str(found))
    return Ran(tuple(_processes(found)), "")


def _processes(graph: LaunchGraph) -> Iterator[Process]:
    for node in graph.nodes:
        yield from by_controller(_process(node))
    for it in graph.includes:
        if not Path(it.file).is_absolute():
            package, _, inside = it.file.partition("/")
            words = tuple(f"{name}:={value}" for name, value in sorted(it.arguments))
            yield Process(package, inside, "include", words=words)


def _process(node: LaunchedNode) -> Process:
    parameters: dict[str, Any] = {}
    for it in node.parameters:
        parameters |= parameters_of(it.text, node.name, node.namespace)
    return Process(
        node.package,
        node.executable,
        "component" if node.container else "program",
        node.name,
        node.namespace,
        node.remappings,
        parameters,
        node.arguments,
        dict(node.environment),
    )
