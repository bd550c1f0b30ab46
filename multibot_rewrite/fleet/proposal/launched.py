# SPDX-License-Identifier: Apache-2.0
"""What goes with a robot that a launch file starts: the files that its nodes read."""

from __future__ import annotations

import os
from collections.abc import Mapping

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

_MOVEIT, _UTILITIES = "move_group", "moveit_configs_utils"
# What of these makes a move_group.
_MAKE_MOVEIT = ("generate_demo_launch", "generate_move_group_launch")
# Kinds of which a node names the file that it reads.
_NAMED = ("rviz", "bridge", "behavior_trees")


def companions_launched(
    robot: Looked, bringup: Bringup, found: Found, release: str, asked: Mapping[str, str]
) -> Companions:
    """Return the files that a robot's launch file gives its nodes, except parameter files, which a
    build finds itself, and those of the node sets that were ``asked`` for."""
    graph = bringup.graph
    # The words and texts that nodes get, in which the files that they read are named.
    words = "\n".join((*(word for it in graph.nodes for word in it.arguments), *graph.texts))

    def is_read(path: str) -> bool:
        return path in found.meant or os.path.realpath(path) in words

    files = {kind: [*filter(is_read, getattr(found, kind))] for kind in _NAMED}
    files["rviz"] = files["rviz"][:1]
    lost = [it for it in graph.includes if not os.path.isabs(it.file)]
    handed = "\n".join(value for it in lost for _, value in it.arguments)
    params = [it for it in found.params if it in found.meant or os.path.realpath(it) in handed]
    params += _of_stacks(companions_of(robot, found, release), asked, release) if asked else []
    starts = any(it.executable == _MOVEIT for it in graph.nodes)
    # A launch file may start a move_group by a package that is not here.
    texts = (text_of(it) for it in (bringup.order.file, *(one.file for one in graph.includes)))
    makes = any(word in text for text in texts for word in _MAKE_MOVEIT)
    srdf = ""
    if starts or makes:
        read = {it.file for it in graph.read}
        own = tuple(it for it in found.srdf if os.path.realpath(it) in read) or found.srdf
        srdf = srdf_of(robot, found._replace(srdf=own))
        files["moveit"] = [*moveit_beside(robot, srdf, found, {})]
    why = f"{bringup.name} starts it by {_UTILITIES}, which is not installed here"
    stacks = {"moveit": why} if srdf and not starts else {}
    files["params"] = [*dict.fromkeys(params)]
    kept = {kind: tuple(its) for kind, its in files.items() if its}
    return Companions(kept, srdf, {**stacks, **asked}, {})


def _of_stacks(guessed: Companions, stacks: Mapping[str, str], release: str) -> list[str]:
    """Return the parameter files that have a node of the node sets."""
    nodes = {os.path.basename(it.name) for one in stacks for it in load_stack(one, release)}
    every = guessed.files.get("params", ())
    return [it for it in every if any(f"{name}:" in text_of(it) for name in nodes)]
