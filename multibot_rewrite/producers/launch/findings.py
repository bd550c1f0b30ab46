# SPDX-License-Identifier: Apache-2.0
"""What is said of launch files: what they hide, what they start, and what they do not start."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from multibot_rewrite.base.findings.finding import INCONCLUSIVE, NOTE, WARNING, Finding, declare
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.producers.launch.handed_on import HandedOn
from multibot_rewrite.producers.launch.records import LaunchedNode, LaunchGraph
from multibot_rewrite.system.records import NOT_READ, Place

NOT_LAUNCHED = declare("MF821", "node-not-launched", NOTE, formats=("fleet",))
NOT_KNOWN = declare("MF822", "launched-node-not-known", NOTE, formats=("fleet",))
NOT_WHOLE = declare(NOT_READ, "launch-not-whole", WARNING, formats=("fleet",))
STOOD_IN = "launch is not installed here: a stand-in read the launch file"
_WITHOUT_VALUES = "the node is in the plan without what the file sets"


def launch_findings(
    graph: LaunchGraph,
    unknown: Mapping[str, LaunchedNode],
    handed: Mapping[str, HandedOn],
    left: Iterable[NodeFacts],
) -> Iterator[Finding]:
    """What of launch files is not known, launched nodes that are not, by their names, with what is
    handed on to them, and nodes of stacks that are left out."""
    if graph.stood_in:
        place = Place(next((it.place.file for it in graph.nodes), ""), 1)
        yield NOT_WHOLE.finding(STOOD_IN, "", **_place(place))._replace(level=NOTE)
    for note in graph.notes:
        hint = (
            _WITHOUT_VALUES if note.parameters else "the nodes that it starts are not in the plan"
        )
        yield NOT_WHOLE.finding(note.message, hint, **_place(note.place))
    for name, it in unknown.items():
        message = f"node {name} ({it.package} {it.executable}) is not known"
        hint = "describe it in a file of nodes (docs/stacks.md); the plan has its name alone"
        if handed[name].names:
            hint = f"{hint}, build hands on as they are: {shorten(handed[name].names)}"
        yield NOT_KNOWN.finding(message, hint, **_place(it.place))
    for node in left:
        if not node.when:
            message = f"{node.name} of {node.origin} is not launched; it is left out"
            hint = "leave out the stack, or name the launch file that starts it, too"
            place = Place(next((it.place.file for it in graph.nodes), ""), 1)
            yield NOT_LAUNCHED.finding(message, hint, **_place(place))


def not_read(graph: LaunchGraph) -> Iterator[Finding]:
    """What of a launch is not known, for those who read no lines of a terminal; each once."""
    first: dict[str, Place] = {}
    for note in (it for it in graph.notes if not it.fails):
        first.setdefault(note.message, note.place)
    for message, place in first.items():
        yield NOT_WHOLE.finding(message, "", level=INCONCLUSIVE, **_place(place))


def _place(place: Place) -> dict[str, object]:
    return {"file": place.file, "line": place.line, "column": 1}
