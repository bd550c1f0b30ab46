# SPDX-License-Identifier: Apache-2.0
"""Cartographer's Lua options for any number of robots: frames in plain strings are renamed.

Cartographer reads its frames from Lua only (cartographer_ros node_options, trajectory_options). Its
topics are fixed relative names that remap rules move. Comments and other strings stay.
"""

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError
from multibot_rewrite.planning.records import Given
from multibot_rewrite.related_files.context import Context
from multibot_rewrite.related_files.engine import with_slots
from multibot_rewrite.related_files.named_file import LUA, NamedFile, RelatedFile
from multibot_rewrite.related_files.sites import AS_IS, Site, Slot
from multibot_rewrite.system.records import Place

FRAMES = frozenset({"map_frame", "tracking_frame", "published_frame", "odom_frame"})
# Cartographer's own files, which set no frames (cartographer/configuration_files).
OWN_FILES = frozenset((
    "map_builder.lua", "map_builder_server.lua", "pose_graph.lua", "trajectory_builder.lua",
    "trajectory_builder_2d.lua", "trajectory_builder_3d.lua",
))  # fmt: skip
# An opening bracket or quote that the patterns before it did not close is an error.
_TOKEN = lazy_compile(
    r"""(?P<space>\s+)
    |(?P<comment>--\[(?P<c>=*)\[.*?\](?P=c)\]|--(?!\[=*\[)[^\n]*)
    |(?P<long>\[(?P<l>=*)\[.*?\](?P=l)\])
    |(?P<string>"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*')
    |(?P<open>(?P<opening>--\[=*\[|\[=*\[|["']).*)
    |(?P<name>[A-Za-z_]\w*)
    |(?P<number>\.?\d(?:[eEpP][-+]|[\w.])*)
    |(?P<mark>\.{2,3}|[=~<>]=|.)""",
    re.VERBOSE | re.DOTALL,
)
_SILENT = frozenset({"space", "comment"})


class Token(NamedTuple):
    """A piece of Lua: what it is, its text and where that starts."""

    kind: str
    text: str
    at: int
    line: int
    column: int


def rewrite_lua(data: bytes, file: str, context: Context) -> RelatedFile:
    """Return a Lua file with slots for a robot.

    Only ``name = "frame"`` is rewritten; any other assignment is ``computed``. Raises InputError for
    strings and comments that do not end, and text that is not UTF-8.
    """
    return with_slots(read_lua(data, file, context), {})


def read_lua(data: bytes, file: str, context: Context) -> NamedFile:
    """Return the names of a file; raises as ``rewrite_lua``."""
    text = _decoded_text(data, file)
    tokens = list(tokens_of(text, file))
    values, computed = {}, []
    for _, key, value in (it for it in _assignments(tokens) if it[0] in FRAMES):
        if value and value.kind == "string":
            values[value.at] = key.text, value
        else:
            computed.append(_token_site("", key, key.text))
    names = tuple(_token_site("frame", it, key) for key, it in values.values())
    strings = (it for it in tokens if it.kind in ("string", "long") and it.at not in values)
    others = tuple(_token_site("", it) for it in strings)
    called = (at for at, it in enumerate(tokens) if it.text == "include")
    files = [next((it for it in tokens[at + 1 : at + 3] if it.text != "("), None) for at in called]
    included = tuple(
        _token_site("", it)
        for it in files
        if it and it.kind in ("string", "long") and _plain_text(it) not in OWN_FILES
    )
    return NamedFile(
        LUA, file, text, context, {}, names, others, included=included, computed=tuple(computed)
    )


def lua_values(data: bytes, file: str) -> dict[str, Given]:
    """Return options that a file sets to plain values, by last name; raises as ``rewrite_lua``."""
    options = _assignments([*tokens_of(_decoded_text(data, file), file)])
    return {name: Given(_plain_text(it), Place(file, it.line)) for name, _, it in options if it}


def _decoded_text(data: bytes, file: str) -> str:
    try:
        return data.decode()
    except UnicodeDecodeError:
        raise InputError(f"{file}: it is not UTF-8; save it as UTF-8") from None


def _assignments(tokens: Sequence[Token]) -> Iterator[tuple[str, Token, Token | None]]:
    """Yield (name, place, value) of each assignment; the value is None unless it is plain."""
    for at, token in enumerate(tokens):
        name, behind = _assigned_name(tokens, at)
        if name and behind < len(tokens):
            value = tokens[behind]
            simple = "\\" not in value.text and _is_expression_end(tokens, behind + 1)
            plain = value.kind in ("string", "number") or value.text in ("true", "false")
            yield name, token, value if simple and plain else None


def tokens_of(text: str, file: str) -> Iterator[Token]:
    """Yield the tokens of Lua code without comments; raises InputError for one that does not end."""
    line, start = 1, 0
    for found in _TOKEN.finditer(text):
        kind = found.lastgroup or "mark"
        if kind == "open":
            place = f"{file}:{line}"
            raise InputError(f"{place}: not valid Lua: {found['opening']} is not closed; close it")
        if kind not in _SILENT:
            yield Token(kind, found[0], found.start(), line, found.start() - start + 1)
        if lines := found[0].count("\n"):
            line, start = line + lines, found.start() + found[0].rfind("\n") + 1


def _assigned_name(tokens: Sequence[Token], at: int) -> tuple[str, int]:
    """Return the name assigned to at a token, ``name =`` or ``["name"] =``; index of the value."""
    token, texts = tokens[at], [it.text for it in tokens[at + 1 : at + 3]]
    if token.kind == "name" and texts[:1] == ["="]:
        return token.text, at + 2
    if token.kind == "string" and texts == ["]", "="] and tokens[at - 1].text == "[":
        return token.text[1:-1], at + 3
    return "", at


def _is_expression_end(tokens: Sequence[Token], at: int) -> bool:
    """Return whether an expression ends before this token. If not, it is more than one string."""
    if at >= len(tokens) or tokens[at].text in (",", ";", "}"):
        return True
    return tokens[at].kind == "name" and tokens[at].text not in ("and", "or")


def _token_site(kind: str, token: Token, key: str = "") -> Site:
    end = token.at + len(token.text)
    value = token.text[1:-1] if kind else _plain_text(token)
    return Site(
        kind, value, key, Slot(token.line, token.column, token.at + 1, end - 1, value, AS_IS)
    )


def _plain_text(token: Token) -> str:
    return token.text.strip("\"'[]=")
