# SPDX-License-Identifier: Apache-2.0
"""Which of several parameter files for one node goes with a robot: by how many of its names it has."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence, Set
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
    """A parameter file: the nodes that it is for, its names that the robot has not, and whether a
    launch file gives it to a node."""

    path: str
    nodes: frozenset[str]
    strange: frozenset[str]
    given: bool = False

    @property
    def rank(self) -> tuple[bool, bool, int]:
        """The first of these go best with the robot; raises nothing."""
        return bool(self.strange), not self.given, len(self.strange)


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


def not_started(
    path: str,
    nodes: Sequence[Run],
    known: KnownNodes,
    launched: Sequence[str],
    given: Set[str],
) -> str:
    """Why a file of another package than the description's is not the robot's, empty where it may be:
    it is an example beside the code of a node, or its nodes are known to nobody and not started.
    ``given`` are the packages of the nodes that get it from launch files."""
    base, own = os.path.basename(path), package_of(path)
    naming = {package_of(it) for it in launched if base in text_of(it)}
    packages = {known.nodes[it.fact.known].package for it in nodes if it.fact.known in known.nodes}
    if own and own[0] in packages and naming <= {own}:
        return f"it is an example of {own[0]}, and no launch file of another package names it"
    if not nodes and own and given and given <= {own[0], ""}:
        return f"it is for any node, and launch files give it to nodes of {own[0]} alone"
    if not launched or packages or given & {"", *(it.package for it in known.nodes.values())}:
        return ""
    if not nodes:
        return "it is for any node, and no launch file gives it to a node that is known"
    return "" if given or naming else f"no launch file starts {nodes[0].node}"


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
    return it.given == best.given and len(it.strange) <= _MORE * len(best.strange)


def _shown(names: Iterable[str]) -> str:
    every = sorted(names)
    return f"{', '.join(every[:2])} ..." if every[2:] else ", ".join(every)
