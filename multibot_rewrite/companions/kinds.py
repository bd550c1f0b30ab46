"""The kinds of files beside a description, and how they are told by their texts."""

from __future__ import annotations

from multibot_rewrite.bounded import MAX_BYTES
from multibot_rewrite.lazy import lazy_compile

SUFFIXES = (".yaml", ".yml", ".rviz")
PARAMS, RVIZ, BRIDGE, MOVEIT, TREE, LUA = "params", "rviz", "bridge", "moveit", "tree", "lua"
EVERY = (PARAMS, RVIZ, MOVEIT, BRIDGE, TREE, LUA)
# What only files of one kind have at the start of a line or an item. A file of one node's sections may
# be MoveIt's as well: that is a parameter file for its reader.
_MARKS = (
    (PARAMS, lazy_compile(rb"^\s+[\"']?ros__parameters[\"']?\s*:", 8)),
    (RVIZ, lazy_compile(rb"^Visualization Manager\s*:", 8)),
    (BRIDGE, lazy_compile(rb"^-\s*\{?\s*[\"']?(?:ros_|gz_)?topic_name[\"']?\s*:", 8)),
    (
        MOVEIT,
        lazy_compile(
            rb"^(?:joint_limits|moveit_simple_controller_manager|controller_names|controller_list"
            rb"|\w+:\s*\n\s+kinematics_solver)\b",
            8,
        ),
    ),
)


def is_beside(path: str) -> bool:
    """Is a file called like one of these?"""
    return path.lower().endswith(SUFFIXES)


def is_linted(path: str) -> bool:
    """Is a file that was found in a folder one to lint? Most YAML files are not; one that cannot be
    read is reported."""
    if not is_beside(path):
        return True
    try:
        with open(path, "rb") as file:
            return bool(kind_of(file.read(MAX_BYTES)))
    except OSError:
        return True


def kind_of(data: bytes) -> str:
    """The kind of a file by its text; empty for all others."""
    return next((kind for kind, mark in _MARKS if mark.search(data)), "")
