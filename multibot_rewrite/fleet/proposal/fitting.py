# SPDX-License-Identifier: Apache-2.0
"""Which of several parameter files for one node goes with a robot: by how many of its names it has."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from lxml import etree

from multibot_rewrite.base.conventions import SENT_FRAMES
from multibot_rewrite.description.sources.packages import package_of
from multibot_rewrite.fleet.proposal.choosing import Undecided
from multibot_rewrite.fleet.proposal.looking import Looked
from multibot_rewrite.fleet.proposal.owners import own_names
from multibot_rewrite.fleet.proposal.searching import Found, text_of
from multibot_rewrite.knowledge.parameters import KnownNodes, is_called
from multibot_rewrite.spelling.records import Run

_OF_ROBOT = ("frame", "link", "joint")
# With so many times as many names that the robot has not, another file is no rival.
_MORE = 2


class Fitting(NamedTuple):
    """A parameter file: the nodes that it is for, and its names that the robot has not."""

    path: str
    nodes: frozenset[str]
    strange: frozenset[str]


def fitting(
    robot: Looked, path: str, nodes: Sequence[Run], known: KnownNodes, bridges: Iterable[str]
) -> Fitting:
    """How a file goes with a robot: frames, links and joints are those of its description, a sensor's
    topic of several words stands in it or in a bridge."""
    own = own_names(robot) | {*SENT_FRAMES}
    text = etree.tostring(robot.root).decode() if robot.root is not None else ""
    said = "\n".join((text, *map(text_of, bridges)))
    found = {
        value
        for kind, value in _named(nodes, known)
        if (value not in own if kind in _OF_ROBOT else _is_strange(value, said))
    }
    names = frozenset(word for it in nodes for word in (it.node, it.fact.known) if word)
    return Fitting(path, names, frozenset(found))


def not_started(path: str, nodes: Sequence[Run], known: KnownNodes) -> str:
    """Why a file of another package than the description's is not the robot's, where no launch file
    starts that; empty where it may be: it is an example beside the code of a node, or nobody knows its
    nodes."""
    own = package_of(path)
    packages = {known.nodes[it.fact.known].package for it in nodes if it.fact.known in known.nodes}
    if own and own[0] in packages:
        return f"it is an example of {own[0]}"
    who = nodes[0].node if nodes else "any node"
    return "" if packages else f"it is for {who}, which no launch file of the robot starts"


def _named(nodes: Iterable[Run], known: KnownNodes) -> Iterator[tuple[str, str]]:
    """The names in values of known parameters, each with its kind."""
    for node in (it for it in nodes if it.fact.known in known.nodes):
        params = [*known.nodes[node.fact.known].params.values()]
        for name, given in node.values.items():
            kind = next((it.kind for it in params if is_called(it, name) and not it.own), "")
            is_sensor = kind == "topic" and name.endswith(("scan_topic", ".topic"))
            if kind in _OF_ROBOT or is_sensor:
                values = given.value if isinstance(given.value, list | tuple) else (given.value,)
                yield from ((kind, it) for it in values if isinstance(it, str) and "$" not in it)


def _is_strange(topic: str, said: str) -> bool:
    words = topic.strip("/")
    return "/" in words and words not in said


def check_winner(its: Sequence[Fitting], robot: Looked, found: Found) -> None:
    """Raise Undecided where two files for one node go as badly with the robot: each has names that it
    has not. A file without any has no rival."""
    for at, best in enumerate(its):
        if any(best.nodes & it.nodes for it in its[:at]):
            continue
        rivals = [it for it in its[at + 1 :] if it.nodes & best.nodes and _is_rival(it, best)]
        if best.strange and rivals:
            both = {it.path: _shown(it.strange) for it in (best, *rivals)}
            node = sorted(best.nodes & rivals[0].nodes)[0]
            what = f"{len(both)} files have parameters of {node}, and names that the robot has not"
            raise Undecided(what, both, found, robot.path)


def _is_rival(it: Fitting, best: Fitting) -> bool:
    return len(it.strange) <= _MORE * len(best.strange)


def _shown(names: Iterable[str]) -> str:
    every = sorted(names)
    return f"{', '.join(every[:2])} ..." if every[2:] else ", ".join(every)
