# SPDX-License-Identifier: Apache-2.0
"""The kinds of files beside a description, and how they are told by their texts."""

from __future__ import annotations

from multibot_rewrite.base.bounded import MAX_BYTES, read_start
from multibot_rewrite.base.file_kinds import BESIDE, BRIDGE, LUA, MOVEIT, PARAMS, RVIZ, TREE

SUFFIXES = (".yaml", ".yml", ".rviz", ".lua", ".xml")
EVERY = (PARAMS, RVIZ, MOVEIT, BRIDGE, TREE, LUA)
_XML = ".xml"
_IS_TREE = dict(BESIDE)[TREE]


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
        return read_start(path, MAX_BYTES)
    except OSError:
        return None


def kind_of(data: bytes) -> str:
    """The kind of a file by its text; empty for all others."""
    return next((kind for kind, mark in BESIDE if mark.search(data)), "")


__all__ = ["BRIDGE", "EVERY", "LUA", "MOVEIT", "PARAMS", "RVIZ", "SUFFIXES", "TREE"]
