"""The kinds of files beside a description, and how they are told by their texts."""

from __future__ import annotations

from multibot_rewrite.base.bounded import MAX_BYTES
from multibot_rewrite.base.lazy import lazy_compile

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
IS_TREE = lazy_compile(rb"<BehaviorTree\b|<root\b[^>]*\b(?:BTCPP_format|main_tree_to_execute)\b", 0)


def is_beside(path: str) -> bool:
    """Is a file called like one of these?"""
    return path.lower().endswith(SUFFIXES)


def is_text_beside(source: object) -> bool:
    """Is it the path or the bytes of such a file, or of a tree or Lua file, and of no description?"""
    if isinstance(source, bytes):
        return bool(IS_TREE.search(source)) or not source.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(
            b"<"
        )
    path = str(source).lower()
    if not path.endswith(".xml"):
        return path.endswith((*SUFFIXES, ".lua"))
    try:
        with open(str(source), "rb") as file:
            return bool(IS_TREE.search(file.read(MAX_BYTES)))
    except OSError:
        return False


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
