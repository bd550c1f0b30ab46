"""A file beside a description, rewritten for a robot without a fleet: its kind and its text."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.companions.behavior_tree.read import named_tree
from multibot_rewrite.companions.behavior_tree.rewrite import rewrite_behavior_tree
from multibot_rewrite.companions.bridge import rewrite_bridge
from multibot_rewrite.companions.bridge_entry import MODEL_SLOT
from multibot_rewrite.companions.companion import Companion
from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.formats import read_named
from multibot_rewrite.companions.kinds import (
    BRIDGE,
    IS_TREE,
    LUA,
    MOVEIT,
    PARAMS,
    RVIZ,
    TREE,
    kind_of,
)
from multibot_rewrite.companions.lua import read_lua, rewrite_lua
from multibot_rewrite.companions.moveit.file_kind import find_kind
from multibot_rewrite.companions.moveit.rewrite import rewrite_moveit
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.names.rename_map import KINDS, is_declared, spell
from multibot_rewrite.companions.params.rewrite import rewrite_params
from multibot_rewrite.companions.rviz.read import read_rviz
from multibot_rewrite.companions.rviz.rewrite import rewrite_rviz
from multibot_rewrite.companions.rviz.values import RvizRobot
from multibot_rewrite.companions.sites import Site
from multibot_rewrite.companions.template import FileTemplate, fill_template
from multibot_rewrite.companions.yaml_text import read_yaml

_Rewrite = Callable[[bytes, str, Context], Companion]


# What tells the kind of a file that is not linted as one, or is written in braces.
_OTHERS = (
    (TREE, IS_TREE),
    (PARAMS, re.compile(rb"\bros__parameters\b")),
    (LUA, re.compile(rb"^\s*(?:tracking_frame|published_frame|map_frame)\s*=", re.MULTILINE)),
)


def kind_alone(data: bytes, file: str) -> str:
    """The kind of a file by its text; InputError for a file of no kind."""
    found = kind_of(data) or next((kind for kind, mark in _OTHERS if mark.search(data)), "")
    if found:
        return found
    with suppress(InputError):
        if find_kind(read_yaml(data, file)):
            return MOVEIT
    if not data.strip():
        raise InputError(f"{file}: the file is empty; a robot description starts with <robot>")
    hint = "name a description, or a file of parameters, RViz, MoveIt, ros_gz_bridge, Nav2 or Lua"
    raise InputError(f"{file}:1:1: it is none of the files that are rewritten; {hint}")


class OneFile(NamedTuple):
    """A file for one robot: its text, what was read, what its rewrite found, and how many names of the
    description did not become the robot's."""

    text: str
    file: NamedFile
    findings: tuple[Finding, ...]
    kept: int


def rewrite_alone(
    kind: str, data: bytes, file: str, context: Context, robot: str, first: bool
) -> OneFile:
    """The file for a robot whose word in names and in the graph is one; what a bridge carries for all
    robots is in that of the ``first``. Raises InputError for a file that its reader rejects."""
    if kind == RVIZ:
        text, named, found = _shown(data, file, context, robot)
    else:
        made, template = _made(kind, data, file, context, first)
        text = fill_template(template, robot, robot).replace(MODEL_SLOT, robot)
        named, found = made.file, made.findings
    kept = _kept(named, named_file(kind, text.encode(), file, _of(context, robot)), robot)
    return OneFile(text, named, found, kept)


def _made(
    kind: str, data: bytes, file: str, context: Context, first: bool
) -> tuple[Companion, FileTemplate]:
    if kind == BRIDGE:
        bridge = rewrite_bridge(read_yaml(data, file), context)
        return bridge.own, bridge.whole if first else bridge.own.template
    made = _REWRITES[kind](data, file, context)
    return made, made.template


def named_file(kind: str, data: bytes, file: str, context: Context) -> NamedFile:
    """The names of a file of any kind; raises InputError for one that its reader rejects."""
    if kind == TREE:
        return named_tree(data, file, context)
    if kind == LUA:
        return read_lua(_text(data, file), file, context)
    return read_named(kind, read_yaml(data, file), context)


def _of(context: Context, robot: str) -> Context:
    """The context of the robot's own description, in which every name is the robot's."""
    names = context.names._replace(robot=robot)
    declared = {
        kind: {spell(names, kind, it): at for it, at in its.items()} if kind in KINDS else its
        for kind, its in names.declared.items()
    }
    own = names._replace(declared=declared)
    return context._replace(names=own, topics=own)


def _kept(before: NamedFile, after: NamedFile, robot: str) -> int:
    """How many names that the description declares are not those of the robot in the result."""
    names = before.context.names._replace(robot=robot)
    wanted = Counter(spell(names, it.kind, it.text) for it in _declared(before))
    return (wanted - Counter(it.text for it in after.names)).total()


def _declared(file: NamedFile) -> Iterator[Site]:
    names = file.context.names
    yield from (
        it for it in file.names if it.kind in _PARTS and is_declared(names, it.kind, it.text)
    )


# Names that are spelled without regard to the node.
_PARTS = frozenset(("link", "joint", "frame", "sensor", "gpio"))


def _text(data: bytes, file: str) -> str:
    try:
        return data.decode()
    except UnicodeDecodeError:
        raise InputError(f"{file}: it is not UTF-8; save it as UTF-8") from None


def _shown(
    data: bytes, file: str, context: Context, robot: str
) -> tuple[str, NamedFile, tuple[Finding, ...]]:
    document = read_yaml(data, file)
    names, topics = (it._replace(robot=robot) for it in (context.names, context.topics))
    texts, found = rewrite_rviz(document, [RvizRobot(robot, names, topics)])
    return texts[0].text, read_rviz(document, context), found


def _params(data: bytes, file: str, context: Context) -> Companion:
    return rewrite_params(read_yaml(data, file), context)


def _moveit(data: bytes, file: str, context: Context) -> Companion:
    return rewrite_moveit(read_yaml(data, file), context)


def _lua(data: bytes, file: str, context: Context) -> Companion:
    return rewrite_lua(_text(data, file), file, context)


_REWRITES: Mapping[str, _Rewrite] = {
    PARAMS: _params,
    MOVEIT: _moveit,
    TREE: rewrite_behavior_tree,
    LUA: _lua,
}
