"""Cartographer's Lua options for any number of robots: frames in plain strings are renamed.

Cartographer reads its frames from Lua only (cartographer_ros node_options, trajectory_options). Its
topics are fixed relative names that remap rules move. Comments and other strings stay.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from multibot_rewrite.checks.mentions import mentioned
from multibot_rewrite.companions.context import Companion, Context
from multibot_rewrite.companions.names.by_kind import frames_differ, is_plain
from multibot_rewrite.companions.names.rename_map import spell
from multibot_rewrite.companions.names.undeclared import (
    is_undeclared,
    renamed_names,
    undeclared_message,
)
from multibot_rewrite.companions.template import (
    TAG_SLOT,
    check_no_slots,
    make_template,
)
from multibot_rewrite.companions.yaml_text import Splice
from multibot_rewrite.model import WARNING, Finding, InputError

FRAMES = frozenset({"map_frame", "tracking_frame", "published_frame", "odom_frame"})
# Cartographer's own files, which set no frames (cartographer/configuration_files).
OWN_FILES = frozenset(
    f"{it}.lua"
    for it in (
        "map_builder",
        "map_builder_server",
        "pose_graph",
        "trajectory_builder",
        "trajectory_builder_2d",
        "trajectory_builder_3d",
    )
)
# An opening bracket or quote that the patterns before it did not close is an error.
_TOKEN = re.compile(
    r"""(?P<space>\s+)
    |(?P<comment>--\[(?P<c>=*)\[.*?\](?P=c)\]|--(?!\[=*\[)[^\n]*)
    |(?P<long>\[(?P<l>=*)\[.*?\](?P=l)\])
    |(?P<string>"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*')
    |(?P<open>--\[=*\[|\[=*\[|["'])
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


class Option(NamedTuple):
    """An assignment to one of the frames; ``value`` is None if it is not a plain string."""

    name: Token
    value: Token | None


def frames_to_edit(text: str, file: str, context: Context) -> tuple[Finding, ...]:
    """The frames of a Lua file to edit by hand for a robot; ``rewrite_lua`` edits them instead."""
    changes = (_change(context, it) for it in _options(list(tokens_of(text, file))))
    found = [_finding(text, file, at, *draft) for at, draft in filter(None, changes)]
    return tuple(
        sorted((*found, *rewrite_lua(text, file, context).findings), key=lambda it: it[5:])
    )


def rewrite_lua(text: str, file: str, context: Context) -> Companion:
    """A Lua file with slots for a robot, and the findings about it.

    Only ``name = "frame"`` is rewritten; any other assignment is reported. Raises InputError for
    strings and comments that do not end.
    """
    check_no_slots(text, file)
    tokens = list(tokens_of(text, file))
    options = list(_options(tokens))
    splices = [_splice(context, it.value) for it in options if it.value]
    found = [*_about(context, options), *_includes(tokens), *_mentions(context, tokens, options)]
    placed = (_finding(text, file, at, *draft) for at, draft in sorted(found))
    return Companion(make_template(text, [it for it in splices if it]), tuple(placed))


def tokens_of(text: str, file: str) -> Iterator[Token]:
    """The tokens of Lua code without comments; InputError where one does not end."""
    for found in _TOKEN.finditer(text):
        kind = found.lastgroup or "mark"
        if kind == "open":
            place = f"{file}:{text.count(chr(10), 0, found.start()) + 1}"
            raise InputError(f"{place}: not valid Lua: {found[0]} is not closed; close it")
        if kind not in _SILENT:
            yield Token(kind, found[0], found.start())


def _options(tokens: Sequence[Token]) -> Iterator[Option]:
    for at, token in enumerate(tokens):
        name, behind = _assigned(tokens, at)
        if name not in FRAMES or behind >= len(tokens):
            continue
        value = tokens[behind]
        simple = value.kind == "string" and "\\" not in value.text and _ends(tokens, behind + 1)
        yield Option(token, value if simple else None)


def _assigned(tokens: Sequence[Token], at: int) -> tuple[str, int]:
    """The name assigned to at a token, ``name =`` or ``["name"] =``, and where the value starts."""
    token, texts = tokens[at], [it.text for it in tokens[at + 1 : at + 3]]
    if token.kind == "name" and texts[:1] == ["="]:
        return token.text, at + 2
    if token.kind == "string" and texts == ["]", "="] and tokens[at - 1].text == "[":
        return token.text[1:-1], at + 3
    return "", at


def _ends(tokens: Sequence[Token], at: int) -> bool:
    """Does an expression end before this token? If not, it is more than one string."""
    if at >= len(tokens) or tokens[at].text in (",", ";", "}"):
        return True
    return tokens[at].kind == "name" and tokens[at].text not in ("and", "or")


def _splice(context: Context, value: Token) -> Splice | None:
    old = value.text[1:-1]
    new = spell(context.names, "frame", old)
    end = value.at + len(value.text) - 1
    return Splice(value.at + 1, end, new) if new != old else None


_Draft = tuple[int, tuple[str, str, str]]


def _change(context: Context, option: Option) -> _Draft | None:
    there = _splice(context, option.value) if option.value else None
    if option.value is None or there is None:
        return None
    new = there.new.replace(TAG_SLOT, "ROBOT")
    message = f"{option.name.text} = {option.value.text} is the same for all robots"
    hint = f"write {new!r}, with the robot's prefix or postfix instead of ROBOT"
    return option.value.at, ("MF455", message, hint)


def _about(context: Context, options: Sequence[Option]) -> Iterator[_Draft]:
    for name, value in options:
        if value is None:
            if frames_differ(context):
                message = f"{name.text} is not a plain string, so it stays unchanged"
                hint = "each robot needs its own frame here; write the name in quotes"
                yield name.at, ("MF451", message, hint)
        elif is_undeclared(context, "frame", value.text[1:-1]):
            yield value.at, ("MF452", *undeclared_message(context, "frame", value.text[1:-1]))


def _includes(tokens: Sequence[Token]) -> Iterator[_Draft]:
    for at, token in enumerate(tokens):
        behind = [it for it in tokens[at + 1 : at + 3] if it.text != "("][:1]
        if token.text != "include" or not behind or behind[0].kind not in ("string", "long"):
            continue
        if behind[0].text.strip("\"'[]=") not in OWN_FILES:
            message = f"the included file {behind[0].text} is not checked"
            yield token.at, ("MF453", message, "if it sets frames, list it under lua as well")


def _mentions(
    context: Context, tokens: Sequence[Token], options: Sequence[Option]
) -> Iterator[_Draft]:
    names = renamed_names(context)
    claimed = {it.value.at for it in options if it.value}
    for token in tokens:
        if token.kind not in ("string", "long") or token.at in claimed:
            continue
        text = token.text.strip("\"'[]=")
        if is_plain(text) and mentioned(text, names):
            message = f"{text!r} is a name of the robot, but its use here is not known"
            hint = "it stays unchanged; if each robot needs its own, rename it by hand"
            yield token.at, ("MF454", message, hint)


def _finding(text: str, file: str, at: int, code: str, message: str, hint: str) -> Finding:
    line, column = text.count("\n", 0, at) + 1, at - text.rfind("\n", 0, at)
    return Finding(code, WARNING, message, hint, file, line, column)
