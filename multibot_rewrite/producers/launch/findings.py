# SPDX-License-Identifier: Apache-2.0
"""What is said of launch files: what they hide, what they start, and what they do not start."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from multibot_rewrite.base.findings.finding import INCONCLUSIVE, NOTE, WARNING, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.producers.launch.records import LaunchedNode, LaunchGraph
from multibot_rewrite.system.records import Place

_ROBOTS = """\
robots:
  - {name: robot1, description: robot.urdf}
  - {name: robot2, description: robot.urdf}
"""
_AMCL = "structure:\n  nodes:\n    /amcl: {pkg: nav2_amcl, exec: amcl, node_name: amcl}\n"
NOT_LAUNCHED = declare(
    "MF821",
    "node-not-launched",
    NOTE,
    what="A stack has a node that none of the robot's launch files starts; it is left out of the plan.",
    why="The launch files say what runs. A plan with another node would report it as missing.",
    fix="Nothing, if the launch files are right. Else start the node, or name its launch file, too.",
    bad=f"launch: system_model.yaml\nstack: [robot_localization]\n{_ROBOTS}",
    good=f"launch: system_model.yaml\n{_ROBOTS}",
    formats=("fleet",),
    beside={"system_model.yaml": _AMCL},
)
NOT_KNOWN = declare(
    "MF822",
    "launched-node-not-known",
    NOTE,
    what="A launch file starts a node that is not known: the plan has its name, and nothing of its "
    "topics, services and frames.",
    why="What it publishes and subscribes to is not remapped and not checked: two robots may share it.",
    fix="Describe it in a file of nodes (docs/stacks.md), or have it written while the node runs:"
    " multibot snapshot --form nodes.",
    bad=f"launch: system_model.yaml\n{_ROBOTS}",
    good=f"{_ROBOTS}launch: known.yaml\n",
    line=3,
    formats=("fleet",),
    beside={
        "system_model.yaml": "structure:\n  nodes:\n    /d: {pkg: my_driver, exec: d, node_name: d}\n",
        "known.yaml": _AMCL,
    },
)
NOT_WHOLE = declare(
    "MF823",
    "launch-not-whole",
    WARNING,
    what="A part of a launch file cannot be read here, or is decided only at run time.",
    why="The nodes that it starts are not in the plan, unless a stack has them.",
    fix="Source the workspace that has the package, or give the folder of its sources as root; name a "
    "stack for what only a run decides.",
    bad=f"launch: system_model.yaml\n{_ROBOTS}",
    good=f"launch: known.yaml\n{_ROBOTS}",
    line=3,
    formats=("fleet",),
    beside={
        "system_model.yaml": "structure:\n  nodes:\n    /d: {exec: ./start.sh}\n",
        "known.yaml": _AMCL,
    },
)
STOOD_IN = "launch is not installed here: a stand-in read the launch file"
_WITHOUT_VALUES = "the node is in the plan without what the file sets"


def launch_findings(
    graph: LaunchGraph, unknown: Iterable[tuple[LaunchedNode, str]], left: Iterable[NodeFacts]
) -> Iterator[Finding]:
    """What of launch files is not known, launched nodes that are not, each with its name, and nodes of
    stacks that are left out."""
    if graph.stood_in:
        place = Place(next((it.place.file for it in graph.nodes), ""), 1)
        yield NOT_WHOLE.finding(STOOD_IN, "", **_place(place))._replace(level=NOTE)
    for note in graph.notes:
        hint = (
            _WITHOUT_VALUES if note.parameters else "the nodes that it starts are not in the plan"
        )
        yield NOT_WHOLE.finding(note.message, hint, **_place(note.place))
    for it, name in unknown:
        message = f"node {name} ({it.package} {it.executable}) is not known"
        hint = "describe it in a file of nodes (docs/stacks.md); the plan has its name alone"
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
