# SPDX-License-Identifier: Apache-2.0
"""What a file is, by its text: asked before the reader of a command rejects it by its own schema."""

import re
from codecs import BOM_UTF8
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.base.bounded import own_text
from multibot_rewrite.base.conventions import FILES
from multibot_rewrite.base.lazy import COMMENT, lazy_compile, without_comments
from multibot_rewrite.base.model import TEMPLATE, InputError

PARAMS, RVIZ, BRIDGE, MOVEIT, TREE, LUA = "params", "rviz", "bridge", "moveit", "tree", "lua"
URDF, XACRO, SDF, WORLD, SRDF = "urdf", "xacro", "sdf", "world", "srdf"
FLEET, PLAN, SNAPSHOT, LAUNCH, BAG, MAP = "fleet", "plan", "snapshot", "launch", "bag", "map"
STAGE, WEBOTS, MUJOCO, USD, MESH = "stage", "webots", "mujoco", "usd", "mesh"
MANIFEST, CONFIG = "manifest", "config"
BUILT, RULES, SESSION = "built", "rules", "session"
DESCRIPTIONS = (URDF, XACRO, SDF)
_LOOKED_AT = 200_000


class FileKind(NamedTuple):
    """What a kind of file is called, and which command takes it."""

    words: str
    use: str


KINDS = {kind: FileKind(*words) for kind, words in FILES.items()}
_ROOT = r"\A\s*(?:<!DOCTYPE[^<>\[]*(?:\[[^\]]*\]\s*)?>\s*)?<"
ROBOTS = rb"^robots:(?:\s|#[^\n]*\n)*"
_TEXT = own_text(__file__, "file_kinds.txt").replace("ROOT", _ROOT)
_LINES = _TEXT.replace("ROBOTS", ROBOTS.decode()).splitlines()
_ROWS = [it.split(None, 2) for it in _LINES if it and not it.startswith("#")]
# The kinds with what is found in their files, by the texts that are asked.
_MARKS: Mapping[str, Sequence[tuple[str, re.Pattern[bytes]]]] = {
    texts: [
        (kind, lazy_compile(mark.encode(), re.MULTILINE))
        for of, kind, mark in _ROWS
        if texts in of.split(",")
    ]
    for texts in ("text", "beside", "xml", "json")
}
BESIDE = _MARKS["beside"]
# Of Jinja and its kin; ${{ is xacro's, and in a comment it is nothing.
_TEMPLATE = lazy_compile(
    COMMENT + rb"|^[ \t]*#(?!\{)[^\n]*|((?<!\$)\{\{-?[ \t]*[A-Za-z_.][^{}\n]*\}\}"
    rb"|\{%[-+]?[ \t]*(?:if|for|set|macro|include|block|extends)\b[^{}\n]*%\})",
    re.DOTALL | re.MULTILINE,
)


def recognised(data: bytes) -> str:
    """Return the kind of a file by its contents, empty for one of no known kind."""
    text, of = data[:_LOOKED_AT].removeprefix(BOM_UTF8).lstrip(), "text"
    if text.startswith(b"<"):
        text, of = without_comments(data.removeprefix(BOM_UTF8))[:_LOOKED_AT], "xml"
    elif text.startswith(b"{"):
        of = "json"
    return next((kind for kind, mark in _MARKS[of] if mark.search(text)), "")


def refuse_others(data: bytes, file: str, *wanted: str) -> None:
    """Raise InputError, with the command to use, for a file of a known kind that is not ``wanted``."""
    kind = recognised(data)
    if kind and kind not in wanted:
        raise InputError(f"{file}: {KINDS[kind].words}; {KINDS[kind].use}")


def refuse_templates(data: bytes, file: str) -> None:
    """Raise InputError for a text that a template language has yet to fill in."""
    # One character is found in a hundredth of the time of two, and most descriptions have none.
    if b"{" not in data or (b"{{" not in data and b"{%" not in data):
        return
    found = next((it for it in _TEMPLATE.finditer(data) if it[1]), None)
    if found:
        line, words = data.count(b"\n", 0, found.start(1)) + 1, found[1].decode(errors="replace")
        raise InputError(
            f"{file}:{line}: a template, in which another program fills in {words}; lint what it makes",
            TEMPLATE,
        )
