"""The kinds of files beside a description, each with its reader."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from multibot_rewrite.companions.bridge import read_bridge
from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.kinds import BRIDGE, MOVEIT, PARAMS, RVIZ
from multibot_rewrite.companions.moveit.read import read_moveit
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.params.read import read_params
from multibot_rewrite.companions.rviz.read import read_rviz
from multibot_rewrite.companions.yaml_text import YamlText
from multibot_rewrite.knowledge.parameters import built_in_nodes

Reader = Callable[[YamlText, Context], NamedFile]


def read_named(kind: str, document: YamlText, context: Context) -> NamedFile:
    """The names of a file of a kind; raises InputError for one that its reader rejects."""
    return READERS[kind](document, context)


def _params(document: YamlText, context: Context) -> NamedFile:
    return read_params(document, context, built_in_nodes(context.distro))


READERS: Mapping[str, Reader] = {
    PARAMS: _params,
    RVIZ: read_rviz,
    MOVEIT: read_moveit,
    BRIDGE: read_bridge,
}
