# SPDX-License-Identifier: Apache-2.0
"""What a file is, by its text: asked before the reader of a command rejects it by its own schema."""

from __future__ import annotations

import re
from codecs import BOM_UTF8
from typing import NamedTuple

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
# Of XML: how the root begins; comments and declarations are left out before.
_ROOT = rb"\A\s*(?:<!DOCTYPE[^<>\[]*(?:\[[^\]]*\]\s*)?>\s*)?<"
_TREE = rb"<BehaviorTree\b|<root\b[^<>]*\b(?:BTCPP_format|main_tree_to_execute)\b"
_XML = (
    (CONFIG, lazy_compile(_ROOT + rb"model>")),
    (LAUNCH, lazy_compile(_ROOT + rb"launch[\s>]")),
    (TREE, lazy_compile(_TREE)),
    (WORLD, lazy_compile(_ROOT + rb"sdf\b[^<>]*>\s*<world\b")),
    (SDF, lazy_compile(_ROOT + rb"sdf\b")),
    (XACRO, lazy_compile(_ROOT + rb"robot\b[^<>]*\sxmlns:xacro")),
    (
        SRDF,
        lazy_compile(
            _ROOT + rb"robot\b(?s:.*?)<(?:group|group_state|disable_collisions|virtual_joint)\s"
        ),
    ),
    (URDF, lazy_compile(_ROOT + rb"robot\b")),
    (MUJOCO, lazy_compile(_ROOT + rb"mujoco\b")),
    (MESH, lazy_compile(_ROOT + rb"COLLADA\b")),
    (MANIFEST, lazy_compile(_ROOT + rb"package\b")),
)
# Of YAML, Python, Lua: what only files of one kind have at the start of a line or an item. A file of
# one node's sections may be MoveIt's as well: that is a parameter file for its reader.
BESIDE = (
    (PARAMS, lazy_compile(rb"^[^\S\n]+[\"']?ros_+parameters?[\"']?\s*:", re.MULTILINE)),
    (RVIZ, lazy_compile(rb"^Visualization Manager\s*:", re.MULTILINE)),
    (
        BRIDGE,
        lazy_compile(
            rb"^(?:-\s*(?:\{\s*)?[\"']?(?:topic_name|service_name|(?:ros|gz)_topic_name)"
            rb"|(?:ros|gz)_(?:topic|type)_name)[\"']?\s*:",
            re.MULTILINE,
        ),
    ),
    (
        MOVEIT,
        lazy_compile(
            rb"^(?:joint_limits|moveit_simple_controller_manager|controller_names|controller_list"
            rb"|planner_configs|planning_plugins?|request_adapters"
            rb"|\w+:[^\S\n]*\n\s+(?:kinematics_solver|planner_configs|default_planner_config))\b",
            re.MULTILINE,
        ),
    ),
    (TREE, lazy_compile(_TREE)),
    (
        LUA,
        lazy_compile(rb"^[^\S\n]*(?:tracking_frame|published_frame|map_frame)\s*=", re.MULTILINE),
    ),
)
# What follows ``robots:`` in a fleet file is a list; a plan has its schema, or had its ignored nodes,
# and rules alone have no more than a layout and a release.
ROBOTS = rb"^robots:(?:\s|#[^\n]*\n)*"
_OTHERS = (
    (PLAN, lazy_compile(rb"^(?:schema:[ ]?\d|ignored_nodes:)", re.MULTILINE)),
    (FLEET, lazy_compile(ROBOTS + rb"[-\[]", re.MULTILINE)),
    (RULES, lazy_compile(rb"^layout:[^\n]*\n(?:distro:[^\n]*\n)?robots:", re.MULTILINE)),
    (LAUNCH, lazy_compile(rb"^def generate_launch_description\b|^launch:\s*-", re.MULTILINE)),
    (BAG, lazy_compile(rb"^rosbag2_bagfile_information:", re.MULTILINE)),
    (MAP, lazy_compile(rb"^image:(?:[^\n]*\n(?!image:))+?resolution:", re.MULTILINE)),
    (STAGE, lazy_compile(rb"^(?:define\s+\w+\s+\w+|floorplan|window)\s*\(\s*$", re.MULTILINE)),
)
_ENDS = rb'"(?:nodes|ends|endpoints)"\s*:'
_JSON = (
    (BUILT, lazy_compile(rb'"format": "multibot build')),
    (SESSION, lazy_compile(rb"\b(?:connect|listen)[\"']?\s*:\s*\{")),
    (PLAN, lazy_compile(rb'\A(?=.*?"layout").*?' + _ENDS, re.DOTALL)),
    # Of a graph without nodes it has the environment alone.
    (SNAPSHOT, lazy_compile(_ENDS + rb'|"settled"\s*:')),
    (FLEET, lazy_compile(rb'"robots"')),
)
# Of Jinja and its kin; ${{ is xacro's, and in a comment it is nothing.
_TEMPLATE = lazy_compile(
    COMMENT + rb"|^[ \t]*#(?!\{)[^\n]*|((?<!\$)\{\{-?[ \t]*[A-Za-z_.][^{}\n]*\}\}"
    rb"|\{%[-+]?[ \t]*(?:if|for|set|macro|include|block|extends)\b[^{}\n]*%\})",
    re.DOTALL | re.MULTILINE,
)
_STARTS = {
    b"\x89MCAP0\r\n": BAG,
    b"SQLite format 3\0": BAG,
    b"#VRML_SIM": WEBOTS,
    b"#usda": USD,
    b"PXR-USDC": USD,
    b"glTF": MESH,
    b"solid ": MESH,
}


def recognised(data: bytes) -> str:
    """Return the kind of a file by its contents, empty for one of no known kind."""
    text = data[:_LOOKED_AT].removeprefix(BOM_UTF8).lstrip()
    started = next((kind for start, kind in _STARTS.items() if text.startswith(start)), "")
    if started:
        return started
    if text.startswith(b"<"):
        return _first(_XML, without_comments(data.removeprefix(BOM_UTF8))[:_LOOKED_AT])
    return _first(_JSON if text.startswith(b"{") else (*BESIDE, *_OTHERS), text)


def _first(marks: tuple[tuple[str, re.Pattern[bytes]], ...], text: bytes) -> str:
    return next((kind for kind, mark in marks if mark.search(text)), "")


def refuse_others(data: bytes, file: str, *wanted: str) -> None:
    """Raise InputError that names the kind of a file and the command for it, unless it is of a wanted
    kind or of no known one."""
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
