# SPDX-License-Identifier: Apache-2.0
"""MoveIt's YAML files for any number of robots: the new text of their names.

MoveItConfigsBuilder reads them with PyYAML and passes them to move_group as parameters. So there are
no sections of nodes, anchors are legal, and of a repeated key the last value counts.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import yaml

from multibot_rewrite.base.model import InputError
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.related_files.context import Context
from multibot_rewrite.related_files.engine import with_slots
from multibot_rewrite.related_files.moveit.file_kind import (
    OF_SERVO,
    MoveitKind,
    entries,
    find_kind,
    find_names,
)
from multibot_rewrite.related_files.named_file import MOVEIT, NamedFile, RelatedFile
from multibot_rewrite.related_files.names.by_kind import SPELLERS
from multibot_rewrite.related_files.names.node_topics import facts_by_name
from multibot_rewrite.related_files.yaml_text import Splice, YamlText, newline


def rewrite_moveit(
    document: YamlText, context: Context, facts: Iterable[NodeFacts] = ()
) -> RelatedFile:
    """Return a MoveIt file with slots for a robot.

    Groups of an SRDF are known if they are declared (``with_srdf``); ``facts`` are those of the robot's
    nodes, whose remap rules move topics too. Raises InputError for a file that is not MoveIt's, and for
    an alias whose value would need two new names.
    """
    try:
        file = read_moveit(document, context)
    except RecursionError:
        what = "the YAML is nested too deeply for MoveIt; write it with fewer levels"
        raise InputError(f"{document.file}:1: {what}") from None
    shift = [Splice(0, 0, document.bom)] if document.bom else []
    more = (*shift, *inserted_namespace(document, context))
    return with_slots(file, facts_by_name(facts, context.distro), more)


# moveit_ros_control_interface looks for the manager below the root unless the namespace is set.
_MANAGER = "moveit_controller_manager"
_ROS_CONTROL, _CONTROL_NAMESPACE = "moveit_ros_control_interface/", "ros_control_namespace"


def inserted_namespace(document: YamlText, context: Context) -> Iterator[Splice]:
    """Yield the line with the controller manager's namespace, if the file does not set it."""
    key = asks_below_root(document)
    default = SPELLERS["namespace"](context, "/")
    flow = isinstance(document.root, yaml.MappingNode) and document.root.flow_style
    if key is None or default == "/":
        return
    if flow:
        at = key.start_mark.index
        yield Splice(at, at, f"{_CONTROL_NAMESPACE}: {default}, ")
        return
    end = newline(document)
    at = key.start_mark.index
    yield Splice(at, at, f"{_CONTROL_NAMESPACE}: {default}{end}{' ' * key.start_mark.column}")


def asks_below_root(document: YamlText) -> yaml.ScalarNode | None:
    """Return the key that selects ros2_control, if the file does not set the manager's namespace."""
    keys = {str(key.value): (key, value) for key, value in entries(document.root)}
    if _MANAGER not in keys or _CONTROL_NAMESPACE in keys:
        return None
    key, value = keys[_MANAGER]
    return key if str(value.value).startswith(_ROS_CONTROL) else None


# The nodes that read these files, as the node sets call them.
MOVE_GROUP, SERVO = "move_group", "servo_node"


def node_of(kind: MoveitKind | None) -> str:
    """Return the node whose parameters a file of this kind has."""
    return SERVO if kind and kind.name == OF_SERVO else MOVE_GROUP


def read_moveit(document: YamlText, context: Context) -> NamedFile:
    """Return the names of a file; raises InputError for one that is not MoveIt's."""
    kind = find_kind(document)
    node = node_of(kind)
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
