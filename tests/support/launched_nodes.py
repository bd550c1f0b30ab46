# SPDX-License-Identifier: Apache-2.0
"""Nodes as launch files start them, and the robot that runs them."""

from __future__ import annotations

from collections.abc import Mapping

from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.fleet.fleet import facts_of, known_nodes
from multibot_rewrite.fleet.launch.launched_robot import given_with, nodes_with
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.planning.start import AS_USUAL
from multibot_rewrite.producers.launch.of_robot import Launched, with_launched
from multibot_rewrite.producers.launch.records import LaunchedNode, LaunchGraph, LaunchNote
from multibot_rewrite.system.records import Place

AT = Place("/ws/bringup.launch.py", 12)


def started(package: str, executable: str, name: str = "", **more: object) -> LaunchedNode:
    words = (
        dict.fromkeys(LaunchedNode._fields, ())
        | {"process": AS_USUAL, "number": -1}
        | {
            "package": package,
            "executable": executable,
            "name": name,
            "namespace": "/",
            "container": "",
            "later": "",
            "place": AT,
        }
    )
    return LaunchedNode(**{**words, **more})


def launched(
    *nodes: LaunchedNode,
    node_sets: tuple[str, ...] = (),
    notes: tuple[LaunchNote, ...] = (),
    release: str = NEWEST_LTS,
) -> Launched:
    node_set = facts_of(node_sets, None, NEWEST_LTS)
    known = known_nodes(None, NEWEST_LTS, ()).library.nodes
    parameters = load_known_nodes("", NEWEST_LTS)
    return with_launched(
        node_set, LaunchGraph(nodes, notes), known, {"robot1", "r"}, parameters, release
    )


def runs(found: Launched) -> Mapping[str, NodeFacts]:
    known = known_nodes(None, NEWEST_LTS, ()).library.nodes
    return {it.name: it for it in nodes_with(found, (), given_with(found, ()), known).nodes}


AMCL = started("nav2_amcl", "amcl", "amcl")
