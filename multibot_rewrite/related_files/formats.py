# SPDX-License-Identifier: Apache-2.0
"""The kinds of related files: how each is read, and rewritten for any robot or alone."""

from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from typing import NamedTuple

from multibot_rewrite.base.file_kinds import refuse_others
from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError
from multibot_rewrite.knowledge.parameters import built_in_nodes
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.related_files.behavior_tree.rewrite import named_tree, rewrite_behavior_tree
from multibot_rewrite.related_files.bridge import MODEL_SLOT, read_bridge, rewrite_bridge
from multibot_rewrite.related_files.context import Context, fill_template
from multibot_rewrite.related_files.lua import read_lua, rewrite_lua
from multibot_rewrite.related_files.moveit.file_kind import find_kind
from multibot_rewrite.related_files.moveit.rewrite import read_moveit, rewrite_moveit
from multibot_rewrite.related_files.named_file import (
    BRIDGE,
    LUA,
    MOVEIT,
    PARAMS,
    RVIZ,
    TREE,
    NamedFile,
    RelatedFile,
    kind_of,
)
from multibot_rewrite.related_files.names.rename_map import KINDS, is_declared, spell
from multibot_rewrite.related_files.params.rewrite import read_params, rewrite_params
from multibot_rewrite.related_files.rviz.read_config import RvizRobot
from multibot_rewrite.related_files.rviz.rewrite import read_rviz, rewrite_rviz
from multibot_rewrite.related_files.yaml_text import read_yaml

_Reader = Callable[[bytes, str, Context], NamedFile]
_Writer = Callable[[bytes, str, Context, Iterable[NodeFacts]], RelatedFile]


def read_named(kind: str, data: bytes, file: str, context: Context) -> NamedFile:
    """Return the names of a file of a kind; raises InputError for one that its reader rejects."""
    return _READERS[kind](data, file, context)


def made_for_any(
    kind: str, data: bytes, file: str, context: Context, facts: Iterable[NodeFacts] = ()
) -> RelatedFile:
    """Return a file with slots for a robot; raises InputError as ``read_named``."""
    # Remap rules of the robot's nodes, ``facts``, move topics too.
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


# A file of parameters that is written in braces.
_IN_BRACES = lazy_compile(rb"\bros__parameters\b")


def kind_alone(data: bytes, file: str) -> str:
    """Return the kind of a file by its contents; raises InputError for a file of no kind."""
    found = kind_of(data)
    if found or _IN_BRACES.search(data):
        return found or PARAMS
    with suppress(InputError):
        if find_kind(read_yaml(data, file)):
            return MOVEIT
    if not data.strip():
        raise InputError(f"{file}: the file is empty; a robot description starts with <robot>")
    refuse_others(data, file)
    hint = "name a description, parameters, a tree, or a file of RViz, MoveIt, ros_gz_bridge or Lua"
    raise InputError(f"{file}:1:1: it is none of the files that are rewritten; {hint}")


class OneFile(NamedTuple):
    """A file for one robot; ``kept`` is how many declared names did not become the robot's."""

    text: str
    file: NamedFile
    findings: tuple[Finding, ...]
    kept: int


def rewrite_alone(
    kind: str, data: bytes, file: str, context: Context, robot: str, number: int
) -> OneFile:
    """Return the file for a robot, the ``number``-th after the first; raises InputError."""
    # Topics that a bridge has for all robots are in the file of the first.
    if kind == RVIZ:
        document = read_yaml(data, file)
        names, topics = (it._replace(robot=robot) for it in (context.names, context.topics))
        texts, found = rewrite_rviz(document, [RvizRobot(robot, names, topics)])
        text, named = texts[0].text, read_rviz(document, context)
    else:
        if kind == BRIDGE:
            bridge = rewrite_bridge(read_yaml(data, file), context)
            made, template = bridge.own, bridge.own.template if number else bridge.whole
        else:
            made = made_for_any(kind, data, file, context)
            template = made.template
        text = fill_template(template, robot, robot, number).replace(MODEL_SLOT, robot)
        named, found = made.file, made.findings
    kept = _unrenamed_count(
        named, read_named(kind, text.encode(), file, _own_context(context, robot)), robot
    )
    return OneFile(text, named, found, kept)


def _own_context(context: Context, robot: str) -> Context:
    """Return the context of the robot's own description, in which every name is the robot's."""
    names = context.names._replace(robot=robot)
    declared = {
        kind: {spell(names, kind, it): at for it, at in its.items()} if kind in KINDS else its
        for kind, its in names.declared.items()
    }
    own = names._replace(declared=declared)
    return context._replace(names=own, topics=own)


def _unrenamed_count(before: NamedFile, after: NamedFile, robot: str) -> int:
    """Return how many names declared by the description are not the robot's in the result."""
    names = before.context.names._replace(robot=robot)
    wanted = Counter(
        spell(names, it.kind, it.text)
        for it in before.names
        if it.kind in _PARTS and is_declared(names, it.kind, it.text)
    )
    return (wanted - Counter(it.text for it in after.names)).total()


# Names that are spelled without regard to the node.
_PARTS = frozenset(("link", "joint", "frame", "sensor", "gpio"))
