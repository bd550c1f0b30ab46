# SPDX-License-Identifier: Apache-2.0
"""The kinds of files beside a description: how each is read, and made for any robot."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from multibot_rewrite.companions.behavior_tree.rewrite import named_tree, rewrite_behavior_tree
from multibot_rewrite.companions.bridge import read_bridge
from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.kinds import BRIDGE, LUA, MOVEIT, PARAMS, RVIZ, TREE
from multibot_rewrite.companions.lua import read_lua, rewrite_lua
from multibot_rewrite.companions.moveit.rewrite import read_moveit, rewrite_moveit
from multibot_rewrite.companions.named_file import Companion, NamedFile
from multibot_rewrite.companions.params.rewrite import read_params, rewrite_params
from multibot_rewrite.companions.rviz.rewrite import read_rviz
from multibot_rewrite.companions.yaml_text import read_yaml
from multibot_rewrite.knowledge.parameters import built_in_nodes
from multibot_rewrite.knowledge.records import NodeFacts

_Reader = Callable[[bytes, str, Context], NamedFile]
_Writer = Callable[[bytes, str, Context, Iterable[NodeFacts]], Companion]


def read_named(kind: str, data: bytes, file: str, context: Context) -> NamedFile:
    """The names of a file of a kind; raises InputError for one that its reader rejects."""
    return _READERS[kind](data, file, context)


def made_for_any(
    kind: str, data: bytes, file: str, context: Context, facts: Iterable[NodeFacts] = ()
) -> Companion:
    """A file with slots for a robot; ``facts`` are those of the robot's nodes, whose remap rules move
    topics too. RViz and bridges are for all robots. Raises InputError as ``read_named``."""
    return _WRITERS[kind](data, file, context, facts)


_READERS: Mapping[str, _Reader] = {
    PARAMS: lambda data, file, context: read_params(
        read_yaml(data, file), context, built_in_nodes(context.distro)
    ),
    RVIZ: lambda data, file, context: read_rviz(read_yaml(data, file), context),
    MOVEIT: lambda data, file, context: read_moveit(read_yaml(data, file), context),
    BRIDGE: lambda data, file, context: read_bridge(read_yaml(data, file), context),
    TREE: named_tree,
    LUA: read_lua,
}
_WRITERS: Mapping[str, _Writer] = {
    PARAMS: lambda data, file, context, facts: rewrite_params(
        read_yaml(data, file), context, facts=facts
    ),
    MOVEIT: lambda data, file, *more: rewrite_moveit(read_yaml(data, file), *more),
    TREE: lambda data, file, context, _: rewrite_behavior_tree(data, file, context),
    LUA: lambda data, file, context, _: rewrite_lua(data, file, context),
}
