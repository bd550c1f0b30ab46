# SPDX-License-Identifier: Apache-2.0
"""What goes with a robot that a launch file starts: the files that its nodes read, and the stacks for
what is not here to be read.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from types import MappingProxyType

from multibot_rewrite.fleet.proposal.companions import (
    Companions,
    companions_of,
    moveit_beside,
    srdf_of,
)
from multibot_rewrite.fleet.proposal.launches import Bringup
from multibot_rewrite.fleet.proposal.looking import Looked
from multibot_rewrite.fleet.proposal.searching import Found, text_of
from multibot_rewrite.knowledge.stacks import load_stack
from multibot_rewrite.producers.launch.records import LaunchGraph, LaunchInclude

# Stacks of our own for launch files of packages that are not installed, by package and name.
_STACKS: Mapping[tuple[str, str], str] = MappingProxyType(
    {
        ("nav2_bringup", "bringup_launch.py"): "nav2",
        ("nav2_bringup", "localization_launch.py"): "localization",
        ("nav2_bringup", "navigation_launch.py"): "navigation",
        ("nav2_bringup", "slam_launch.py"): "slam_toolbox",
        ("slam_toolbox", "online_async_launch.py"): "slam_toolbox",
        ("slam_toolbox", "online_sync_launch.py"): "slam_toolbox",
    }
)
_MOVEIT, _MAKES_MOVEIT = "move_group", "moveit_configs_utils"
# Kinds of which a node names the file that it reads.
_NAMED = ("rviz", "bridge", "behavior_trees")


def companions_launched(
    robot: Looked, bringup: Bringup, found: Found, release: str, asked: Mapping[str, str]
) -> Companions:
    """What the launch file of a robot gives its nodes, but for the parameter files that a build finds
    there itself, and what goes with the stacks that were ``asked`` for."""
    graph = bringup.graph
    words = "\n".join(_words(graph))

    def is_read(path: str) -> bool:
        return path in found.meant or os.path.realpath(path) in words

    files = {kind: [*filter(is_read, getattr(found, kind))] for kind in _NAMED}
    files["rviz"] = files["rviz"][:1]
    lost = [it for it in graph.includes if not os.path.isabs(it.file)]
    handed = "\n".join(value for it in lost for _, value in it.arguments)
    params = [it for it in found.params if it in found.meant or os.path.realpath(it) in handed]
    params += _of_stacks(companions_of(robot, found, release), asked, release) if asked else []
    stacks, srdf = dict(_stacks_of(lost, bringup)), ""
    if _runs_moveit(graph):
        read = {it.file for it in graph.read}
        own = tuple(it for it in found.srdf if os.path.realpath(it) in read) or found.srdf
        srdf = srdf_of(robot, found._replace(srdf=own))
        files["moveit"] = [*moveit_beside(robot, srdf, found, {})]
    if srdf and not any(it.executable == _MOVEIT for it in graph.nodes):
        stacks["moveit"] = (
            f"{_MAKES_MOVEIT}, which makes what {bringup.name} starts, is not installed"
        )
    files["params"] = [*dict.fromkeys(params)]
    kept = {kind: tuple(its) for kind, its in files.items() if its}
    return Companions(kept, srdf, {**stacks, **asked}, {})


def _words(graph: LaunchGraph) -> Iterator[str]:
    """The words and texts that nodes get, in which the files that they read are named."""
    yield from (word for it in graph.nodes for word in it.arguments)
    yield from graph.texts


def _stacks_of(lost: list[LaunchInclude], bringup: Bringup) -> Iterator[tuple[str, str]]:
    """Yield the stacks for launch files of packages that are not installed, each with the reason."""
    for it in lost:
        key = it.file.partition("/")[0], os.path.basename(it.file)
        if key in _STACKS:
            place = f"{os.path.basename(it.place.file)}:{it.place.line}"
            why = (
                f"for {key[1]} of {key[0]}, which {place} includes and which is not installed here"
            )
            yield _STACKS[key], why


def _runs_moveit(graph: LaunchGraph) -> bool:
    return any(it.executable == _MOVEIT for it in graph.nodes) or any(
        it.missing == _MAKES_MOVEIT for it in graph.notes
    )


def _of_stacks(guessed: Companions, stacks: Mapping[str, str], release: str) -> list[str]:
    """The parameter files that have a node of the stacks."""
    nodes = {os.path.basename(it.name) for one in stacks for it in load_stack(one, release)}
    every = guessed.files.get("params", ())
    return [it for it in every if any(f"{name}:" in text_of(it) for name in nodes)]
