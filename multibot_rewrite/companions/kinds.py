"""The kinds of files beside a description, and how they are told by their texts."""

from __future__ import annotations

from multibot_rewrite.base.bounded import MAX_BYTES
from multibot_rewrite.base.lazy import lazy_compile

SUFFIXES = (".yaml", ".yml", ".rviz", ".lua", ".xml")
PARAMS, RVIZ, BRIDGE, MOVEIT, TREE, LUA = "params", "rviz", "bridge", "moveit", "tree", "lua"
EVERY = (PARAMS, RVIZ, MOVEIT, BRIDGE, TREE, LUA)
_XML = ".xml"
_IS_TREE = lazy_compile(
    rb"<BehaviorTree\b|<root\b[^>]*\b(?:BTCPP_format|main_tree_to_execute)\b", 0
)
# What only files of one kind have at the start of a line or an item. A file of one node's sections may
# be MoveIt's as well: that is a parameter file for its reader.
_MARKS = (
    (PARAMS, lazy_compile(rb"^\s+[\"']?ros__parameters[\"']?\s*:", 8)),
    (RVIZ, lazy_compile(rb"^Visualization Manager\s*:", 8)),
    (
        BRIDGE,
        lazy_compile(rb"^-\s*\{?\s*[\"']?(?:(?:ros_|gz_)?topic_name|service_name)[\"']?\s*:", 8),
    ),
    (
        MOVEIT,
        lazy_compile(
            rb"^(?:joint_limits|moveit_simple_controller_manager|controller_names|controller_list"
            rb"|\w+:\s*\n\s+kinematics_solver)\b",
            8,
        ),
    ),
    (TREE, _IS_TREE),
    (LUA, lazy_compile(rb"^\s*(?:tracking_frame|published_frame|map_frame)\s*=", 8)),
)


def is_named_beside(path: str) -> bool:
    """Is a file called as only files beside a description are?"""
    return path.lower().endswith(SUFFIXES) and not path.lower().endswith(_XML)


def is_beside(source: object) -> bool:
    """Is it the path or the text of such a file, and of no description? One of XML has to be a tree."""
    if isinstance(source, bytes):
        start = source.lstrip(b"\xef\xbb\xbf \t\r\n")[:1]
        return bool(_IS_TREE.search(source)) if start == b"<" else True
    path = str(source)
    if not path.lower().endswith(_XML):
        return is_named_beside(path)
    return bool(_IS_TREE.search(_text_of(path) or b""))


def is_linted(path: str) -> bool:
    """Is a file that was found in a folder one to lint? Most YAML and XML files are not; one that
    cannot be read is reported."""
    if path.lower().endswith(_XML):
        return is_beside(path)
    text = _text_of(path) if is_beside(path) else None
    return text is None or bool(kind_of(text))


def _text_of(path: str) -> bytes | None:
    try:
        with open(path, "rb") as file:
            return file.read(MAX_BYTES)
    except OSError:
        return None


def kind_of(data: bytes) -> str:
    """The kind of a file by its text; empty for all others."""
    return next((kind for kind, mark in _MARKS if mark.search(data)), "")
