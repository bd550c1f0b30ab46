"""A MoveIt file as rules ask it: its names, and the texts of unknown use."""

from __future__ import annotations

from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.kinds import MOVEIT
from multibot_rewrite.companions.moveit.file_kind import find_kind
from multibot_rewrite.companions.moveit.name_sites import find_names
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.yaml_text import YamlText

# The nodes that read these files, as the stacks call them.
MOVE_GROUP, SERVO = "move_group", "servo_node"


def read_moveit(document: YamlText, context: Context) -> NamedFile:
    """The names of a file; raises InputError for one that is not MoveIt's."""
    kind = find_kind(document)
    node = SERVO if kind and kind.name == "servo" else MOVE_GROUP
    names, others, twice = find_names(document.root, kind.names if kind else {}, context.names)
    return NamedFile(
        MOVEIT,
        document.file,
        document.text,
        context,
        {},
        tuple(it._replace(node=node) for it in names),
        tuple(others),
        tuple(twice),
        document,
    )
