# SPDX-License-Identifier: Apache-2.0
"""What is said of launch files: what they hide, what they start, and what they do not start."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence

from multibot_rewrite.base.findings.finding import INCONCLUSIVE, NOTE, WARNING, Finding, declare
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.producers.launch.bridges import CONFIG_FILE, made_files
from multibot_rewrite.producers.launch.handed_on import HandedOn, Passing
from multibot_rewrite.producers.launch.kept_paths import NOT_KNOWN as LEFT_OUT
from multibot_rewrite.producers.launch.records import LaunchedNode, LaunchGraph
from multibot_rewrite.producers.sources.expressions import or_read
from multibot_rewrite.system.records import NOT_KNOWN_PROCESS, NOT_READ, Place

NOT_LAUNCHED = declare("MF821", "node-not-launched", NOTE, formats=("fleet",))
NOT_KNOWN = declare("MF822", "launched-node-not-known", NOTE, formats=("fleet",))
NOT_WHOLE = declare(NOT_READ, "launch-not-whole", WARNING, formats=("fleet",))
PROCESS = declare(NOT_KNOWN_PROCESS, "launched-process-not-known", NOTE, formats=("fleet",))
TWICE = declare("MF860", "launched-twice", NOTE, formats=("fleet",))
STOOD_IN = "launch is not installed here: a stand-in read the launch file"
_OF_OTHERS = "what it starts for the others is left out; name a launch file of one robot to choose"
_WITHOUT_VALUES = "the node is in the plan without what the file sets"


def launch_findings(
    graph: LaunchGraph,
    unknown: Mapping[str, LaunchedNode],
    handed: Mapping[str, HandedOn],
    left: Iterable[NodeFacts],
    passing: Sequence[Passing],
) -> Iterator[Finding]:
    """Yield findings about what is unknown, missing here, or not started of launch files.

    ``unknown`` are launched nodes by name, with what is ``handed`` to them; ``left`` are nodes of
    node sets."""
    included = {it.node.package for it in passing if it.node.process.is_include}
    if graph.stood_in:
        place = Place(next((it.place.file for it in graph.nodes), ""), 1)
        yield NOT_WHOLE.finding(STOOD_IN, "", **_place(place))._replace(level=NOTE)
    if graph.robots:
        first, place = graph.robots[0], Place(graph.nodes[0].place.file, 1)
        message = f"the launch file starts {shorten(graph.robots)}: each robot is as {first} is"
        yield NOT_WHOLE.finding(message, _OF_OTHERS, **_place(place))._replace(level=NOTE)
    for note in graph.notes:
        hint = "the nodes that it starts are not in the plan"
        if note.parameters:
            hint = _WITHOUT_VALUES
        elif note.missing in included:
            hint = f"{hint}; build starts it in each robot's namespace"
        yield NOT_WHOLE.finding(note.message, hint, **_place(note.place))
    for node in graph.nodes:
        for key in dict.fromkeys(it.untold for it in node.parameters if it.untold):
            if key != CONFIG_FILE or not made_files(node):
                message = f"the parameter {key} of {node.name or node.executable} {LEFT_OUT}"
                yield NOT_WHOLE.finding(message, _WITHOUT_VALUES, **_place(node.place))
    for name, it in unknown.items():
        message = f"node {name} ({it.package} {it.executable}) is not known"
        hint = f"describe it in a file of nodes (docs/node-sets.md){or_read()}"
        hint = f"{hint}; the plan has its name alone"
        if handed[name].names:
            hint = f"{hint}, build hands on {shorten(handed[name].names)}"
        yield NOT_KNOWN.finding(message, hint, **_place(it.place))
    for one in left:
        if not one.when:
            message = f"{one.name} of {one.origin} is not launched; it is left out"
            hint = "leave out the node set, or name the launch file that starts it, too"
            place = Place(next((it.place.file for it in graph.nodes), ""), 1)
            yield NOT_LAUNCHED.finding(message, hint, **_place(place))


def processes_not_known(passing: Iterable[Passing]) -> Iterator[Finding]:
    """Yield the processes that are started as they are, and are no known nodes."""
    for one in (it for it in passing if not it.node.process.is_include):
        words = shorten([one.node.executable, *one.node.arguments])
        how = "once for all robots" if one.once else "for each robot"
        message = f"process {one.name} ({words}) is no node that is known; build starts it {how}"
        hint = "own_nodes and shared_nodes say how often; its words are the same for all robots"
        yield PROCESS.finding(message, hint, **_place(one.node.place))


def started_twice(it: LaunchedNode, other: LaunchedNode, name: str) -> Finding:
    """Return the finding that launch files start two nodes of one name."""
    where = f"{os.path.basename(other.place.file)}:{other.place.line}"
    message = f"node {name} is started twice, also in {where}"
    hint = "ROS wants one name for each: name the launch file that starts one, or give one another name"
    return TWICE.finding(message, hint, **_place(it.place))


def not_read(graph: LaunchGraph) -> Iterator[Finding]:
    """Yield what is unknown of a launch, once each, for those who read no lines of a terminal."""
    first: dict[str, Place] = {}
    for note in (it for it in graph.notes if not it.fails):
        first.setdefault(note.message, note.place)
    for message, place in first.items():
        yield NOT_WHOLE.finding(message, "", level=INCONCLUSIVE, **_place(place))


def _place(place: Place) -> dict[str, object]:
    """Return a place as keywords of a finding."""
    return {"file": place.file, "line": place.line, "column": 1}
