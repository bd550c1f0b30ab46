# SPDX-License-Identifier: Apache-2.0
"""Writes the fleet file of a proposal, with the reason of each key as a comment."""

from __future__ import annotations

import os
import re
import shlex
from collections.abc import Iterable, Iterator
from math import inf
from typing import Any

from multibot_rewrite.base.naming import LAYOUTS
from multibot_rewrite.base.wording import one_line, shorten
from multibot_rewrite.description.sources.included_by import data_of_file
from multibot_rewrite.description.sources.own_names import ROBOT
from multibot_rewrite.description.sources.packages import package_of
from multibot_rewrite.fleet.file.fleet_data import fleet_yaml
from multibot_rewrite.fleet.file.robot_spec import REAL
from multibot_rewrite.fleet.robots.robot_nodes import RVIZ, why_for_each
from multibot_rewrite.producers.launch.programs import once_for_all
from multibot_rewrite.proposal.launches import Bringup, Row, order_text, said_of
from multibot_rewrite.proposal.looking import Looked
from multibot_rewrite.proposal.propose import Member, Proposal

# Files not taken that are named, and launch files beside the robot's that cannot be read.
MOST, MOST_UNREAD = 10, 3
_MAP = re.compile(rb"""^[ \t]*yaml_filename:[ \t]*["']?[^\s"'#]""", re.MULTILINE)
_NO_MAP = "Nav2 waits for a map: write its yaml_filename for map_server into a parameter file"


def text_of(it: Proposal, file: str) -> str:
    """Return the text of a fleet file at the path ``file``, with paths relative to its folder."""
    lines = _file_lines(it, os.path.dirname(file) or os.curdir, os.path.basename(file))
    return "".join(f"{one_line(line) if line.startswith('#') else line}\n" for line in lines)


def _file_lines(it: Proposal, folder: str, name: str) -> Iterator[str]:
    yield "# A fleet of robots, for multibot_rewrite. Change what you like, then:"
    yield f"#   multibot build {name} -o out/     writes everything that the robots need"
    yield f"#   multibot rehearse {name}          tries the plan on a real ROS graph, no simulator"
    if any(member.bringup for member in it.members):
        yield f"#   multibot inspect {name}           shows each process with its place and files"
    yield from (f"# {note}" for note in it.notes)
    for key, choice in it.keys.items():
        yield ""
        yield f"# {choice.why[:1].upper()}{choice.why[1:]}"
        if key == "layout":
            yield "# The other layouts:"
            others = (layout for layout in LAYOUTS if layout.name != choice.value)
            yield from (f"#   {layout.name}: {layout.about}" for layout in others)
        yield f"{key}: {_one_line(choice.value)}"
    # What all robots have, if they have one description, with the reasons.
    layout = it.keys["layout"].value
    common = _member_keys(it.members[0], folder, layout) if len(it.members) == 1 else ()
    for key, (value, whys) in common:
        yield ""
        yield from (f"# {line}" for line in whys)
        yield from _key_lines(key, value)
    left = dict(_unused_files(it, folder))
    first = {os.path.relpath(path, folder) for path in (*it.refused, *it.broken)}
    home = os.path.relpath(it.members[0].looked.path, folder)
    if left:
        yield ""
        yield "# Other files in these folders, not taken:"
        rows = sorted(
            left.items(),
            key=lambda row: (row[0] not in first, os.path.relpath(row[0], home).count(".."), row),
        )
        yield from _capped(f"{path}: {' '.join(why.split())}" for path, why in rows)
    if it.started:
        yield ""
        yield "# No launch file is taken: none, or no single one, starts this robot. What they start;"
        yield f"# to say which: multibot init {shlex.quote(home)} --launch FILE NAME:=VALUE"
        yield from _lines_of_rows(it.started, folder)
    few = it.others_unread if len(it.others_unread) <= MOST_UNREAD else ()
    if it.unread or few:
        yield ""
        yield "# Of launch files could not be read:"
        yield from _lines_of_rows((*it.unread, *few), folder)
    if len(it.others_unread) > len(few):
        yield ""
        names = shorten([os.path.relpath(file, folder) for file, _, _ in it.others_unread], 1)
        many = f"{len(it.others_unread)} launch files could not be read: {names}"
        yield f"# {many}; init --verbose says why of each"
    yield ""
    yield "# Start poses in metres and radians: x, y, z, roll, pitch, yaw"
    yield "robots:"
    yield from (f"  - {_one_line(robot)}" for robot in _robot_rows(it, folder))


def _lines_of_rows(rows: Iterable[Row], folder: str) -> Iterator[str]:
    return _capped(f"{os.path.relpath(file, folder)}:{at}: {text}" for file, at, text in rows)


def _capped(lines: Iterable[str]) -> Iterator[str]:
    """Yield the first lines as comments, and how many more there are."""
    yield from (f"# {line}" for line in _first_rows(lines))


def _unused_files(it: Proposal, folder: str) -> Iterator[tuple[str, str]]:
    """Yield (path, reason) for each refused, unreadable or unused file."""
    for path, why in {**it.refused, **it.broken}.items():
        yield os.path.relpath(path, folder), why
    taken = {
        path
        for member in it.members
        for path in (*member.looked.files, *member.related_files.paths)
    }
    packages = {*map(package_of, taken)}
    left = dict.fromkeys(it.others, "another description")
    for member in it.members:
        left |= member.related_files.left
    for path in left.keys() - taken - it.broken.keys():
        if package_of(path) in packages:
            yield os.path.relpath(path, folder), left[path]


def _key_lines(key: str, value: Any) -> Iterator[str]:
    if not isinstance(value, dict):
        yield f"{key}: {_one_line(value)}"
        return
    yield f"{key}:"
    yield from (f"  {name}: {_one_line(inner)}" for name, inner in value.items())


def _one_line(value: Any) -> str:
    text = fleet_yaml(value, default_flow_style=True, width=inf)
    return text.removesuffix("\n").removesuffix("\n...")


def _member_keys(
    member: Member, folder: str, layout: str
) -> Iterator[tuple[str, tuple[Any, tuple[str, ...]]]]:
    """Yield the keys of a description and its files: key, its value, and the reasons for that."""

    def here(path: str) -> str:
        return os.path.relpath(path, folder)

    looked, beside = member.looked, member.related_files
    yield "description", (here(looked.path), (f"The description has {looked.links} links",))
    if member.is_real:
        yield "simulator", (REAL, ())
    if looked.model:
        yield "simulated", (here(looked.model), ("The same robot as the simulator gets it",))
    if looked.arguments:
        why = "Arguments of the xacro: {robot} stands for the robot's name"
        yield "arguments", (dict(looked.arguments), (why, *_argument_comments(looked)))
    if member.bringup:
        told = order_text(member.bringup.order, folder)
        config = next(iter(beside.files.get("rviz", ())), "")
        apart = why_for_each(config, layout)
        yield "launch", (told, (*_launch_comments(member.bringup, apart),))
    if beside.srdf:
        yield "srdf", (here(beside.srdf), ("The planning groups of MoveIt",))
    if beside.node_sets:
        whys = tuple(f"{node_set}: {reason}" for node_set, reason in beside.node_sets.items())
        maps = any(_MAP.search(data_of_file(it)) for it in beside.files.get("params", ()))
        lacks = not maps and bool({"nav2", "localization"} & beside.node_sets.keys())
        yield "node_sets", (list(beside.node_sets), (*whys, *[_NO_MAP] * lacks))
    files: dict[str, Any] = {
        kind: here(its[0]) if kind == "rviz" and len(its) == 1 else [here(path) for path in its]
        for kind, its in beside.files.items()
    }
    whys = ("Files for one robot; the build writes one of each for every robot",)
    if files:
        yield "related_files", (files, whys)


def _launch_comments(it: Bringup, apart: str) -> Iterator[str]:
    """Yield what a launch file starts for each robot and once for all, and other launch files."""
    # ``apart`` is why each robot has its own RViz, if it has one.
    each = {node: apart if node.executable == RVIZ else "" for node in it.graph.nodes}
    whys = {node: "" if each[node] else once_for_all(node) for node in it.graph.nodes}
    texts = {it: said_of(it) + (f", {it.later}" if it.process.off else "") for it in whys}
    own = [
        f"{texts[node]}, since {each[node]}" if each[node] else texts[node]
        for node, why in whys.items()
        if not why
    ]
    once = [f"{texts[node]}, since {why}" for node, why in whys.items() if why]
    yield f"What {it.name} starts for each robot:"
    yield from _first_rows(own)
    if once:
        yield "Once for all robots; `own_nodes: [NAME]` gives each its own:"
        yield from _first_rows(once)
    if idle := [f"{one.what}: {one.why}" for one in it.graph.idle]:
        yield "Not started, by its conditions; another value behind its file here starts it:"
        yield from _first_rows(idle)
    if named := [name for name, value in it.order.arguments if ROBOT in value]:
        yield f"{', '.join(named)}: the name of the vendor's robot there; each robot has its own"
    if it.others:
        yield "It starts the most; others start this robot as well:"
        yield from _first_rows([f"--launch {order_text(one, os.curdir)}" for one in it.others])


def _first_rows(rows: Iterable[str]) -> Iterator[str]:
    """Yield the first rows, indented and each once, and how many more there are."""
    every = [*dict.fromkeys(rows)]
    yield from (f"  {row}" for row in every[:MOST])
    if every[MOST:]:
        yield f"  and {len(every) - MOST} more"


def _argument_comments(it: Looked) -> Iterator[str]:
    """Yield comments on arguments that the xacro needs, and on its simulated-or-real switch."""
    arguments = dict(it.arguments)
    if it.switch:
        yield f"{it.switch} is the switch between the simulated and the real robot"
    if found := [name for name in it.needed if name in arguments]:
        yield f"It needs {', '.join(found)}; init chose a value: is it right?"


def _robot_rows(it: Proposal, folder: str) -> Iterator[dict[str, Any]]:
    for member in it.members:
        layout = it.keys["layout"].value
        own = _member_keys(member, folder, layout) if len(it.members) > 1 else ()
        keys = {key: value for key, (value, _) in own}
        for name in member.names:
            pose = {"pose": dict(it.poses[name])} if name in it.poses else {}
            yield {"name": name, **keys, **pose}
