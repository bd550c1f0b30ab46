# SPDX-License-Identifier: Apache-2.0
"""A proposal -> the text of its fleet file, with the reason of each key as a comment."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from math import inf
from typing import Any

from multibot_rewrite.base.naming import LAYOUTS
from multibot_rewrite.base.wording import one_line
from multibot_rewrite.description.sources.packages import package_of
from multibot_rewrite.fleet.file.fleet_data import fleet_yaml
from multibot_rewrite.fleet.file.robot_spec import REAL
from multibot_rewrite.fleet.proposal.given_by_launch import VALUES
from multibot_rewrite.fleet.proposal.looking import Looked
from multibot_rewrite.fleet.proposal.propose import Member, Proposal

# Files not taken that are named.
MOST = 10


def text_of(it: Proposal, file: str) -> str:
    """Return the text of the fleet file that will be at the path ``file``: what it names is relative to
    its folder."""
    lines = _lines(it, os.path.dirname(file) or os.curdir, os.path.basename(file))
    return "".join(f"{one_line(line) if line.startswith('#') else line}\n" for line in lines)


def _lines(it: Proposal, folder: str, name: str) -> Iterator[str]:
    yield "# A fleet of robots, for multibot_rewrite. Change what you like, then:"
    yield f"#   multibot build {name} -o out/     writes everything that the robots need"
    yield f"#   multibot rehearse {name}          tries the plan on a real ROS graph, no simulator"
    yield from (f"# {note}" for note in it.notes)
    for key, choice in it.keys.items():
        yield ""
        yield f"# {_sentence(choice.why)}"
        if key == "layout":
            yield "# The other layouts:"
            others = (layout for layout in LAYOUTS if layout.name != choice.value)
            yield from (f"#   {layout.name}: {layout.about}" for layout in others)
        yield f"{key}: {_flow(choice.value)}"
    for key, (value, whys) in _common(it, folder).items():
        yield ""
        yield from (f"# {line}" for line in whys)
        yield from _block(key, value)
    left = dict(_left(it, folder))
    first = {_shown(path, folder) for path in (*it.refused, *it.broken)}
    if left:
        yield ""
        yield "# Found beside them and not taken:"
        home = os.path.relpath(it.members[0].looked.path, folder)
        rows = sorted(
            left.items(),
            key=lambda row: (row[0] not in first, os.path.relpath(row[0], home).count(".."), row),
        )
        yield from _capped(f"{path}: {' '.join(why.split())}" for path, why in rows)
    if it.launched.rest:
        yield ""
        yield "# Launch files give nodes more than this fleet has: write the values into params;"
        yield "# a rule FROM:=TO moves a topic, so say TO in the files of who reads it:"
        yield from _placed(it.launched.rest, folder)
    if it.launched.started:
        yield ""
        yield "# Launch files start nodes that this fleet does not. `launch: FILE` gives each robot the"
        yield "# nodes of FILE with their rules:"
        yield from _placed(it.launched.started, folder)
    if it.launched.unread:
        yield ""
        yield "# Of launch files could not be read:"
        yield from _placed(it.launched.unread, folder)
    yield ""
    yield "# Start poses in metres and radians: x, y, z, roll, pitch, yaw"
    yield "robots:"
    yield from (f"  - {_flow(robot)}" for robot in _robots(it, folder))


def _placed(rows: Iterable[tuple[str, int, str]], folder: str) -> Iterator[str]:
    return _capped(f"{os.path.relpath(file, folder)}:{at}: {text}" for file, at, text in rows)


def _capped(lines: Iterable[str]) -> Iterator[str]:
    every = [*lines]
    yield from (f"#   {line}" for line in every[:MOST])
    if every[MOST:]:
        yield f"#   and {len(every) - MOST} more"


def _left(it: Proposal, folder: str) -> Iterator[tuple[str, str]]:
    """Yield what was refused, what cannot be read, and the files of the robots' packages that no robot
    has, each with the reason."""
    for path, why in {**it.refused, **it.broken}.items():
        yield _shown(path, folder), why
    taken = {
        path for member in it.members for path in (*member.looked.files, *member.companions.paths)
    }
    packages = {*map(package_of, taken)}
    left = dict.fromkeys(it.others, "another description")
    for member in it.members:
        left |= member.companions.left
    for path in left.keys() - taken - it.broken.keys():
        if package_of(path) in packages:
            yield os.path.relpath(path, folder), left[path]


def _shown(path: str, folder: str) -> str:
    return path if path == VALUES else os.path.relpath(path, folder)


def _sentence(text: str) -> str:
    return text[:1].upper() + text[1:]


def _block(key: str, value: Any) -> Iterator[str]:
    if not isinstance(value, dict):
        yield f"{key}: {_flow(value)}"
        return
    yield f"{key}:"
    yield from (f"  {name}: {_flow(inner)}" for name, inner in value.items())


def _flow(value: Any) -> str:
    text = fleet_yaml(value, default_flow_style=True, width=inf)
    return text.removesuffix("\n").removesuffix("\n...")


def _common(it: Proposal, folder: str) -> dict[str, tuple[Any, tuple[str, ...]]]:
    """What all robots have, if they have one description, with the reasons."""
    if len(it.members) > 1:
        return {}
    return dict(_of_member(it.members[0], folder, it.launched.values))


def _of_member(
    member: Member, folder: str, launched: Mapping[str, Mapping[str, Any]] = {}
) -> Iterator[tuple[str, tuple[Any, tuple[str, ...]]]]:
    """The keys of a description and its files, each with the reasons; ``launched`` are values that
    launch files give to nodes."""

    def here(path: str) -> str:
        return os.path.relpath(path, folder)

    looked, beside = member.looked, member.companions
    yield "description", (here(looked.path), (f"The description has {looked.links} links",))
    if member.is_real:
        yield "simulator", (REAL, ())
    if looked.model:
        yield "simulated", (here(looked.model), ("The same robot as the simulator gets it",))
    if looked.arguments:
        why = "Arguments of the xacro: {robot} stands for the robot's name"
        yield "arguments", (dict(looked.arguments), (why, *_needed(looked)))
    if beside.srdf:
        yield "srdf", (here(beside.srdf), ("The planning groups of MoveIt",))
    if beside.stacks:
        whys = tuple(f"{stack}: {reason}" for stack, reason in beside.stacks.items())
        yield "stack", (list(beside.stacks), whys)
    files: dict[str, Any] = {
        kind: here(its[0]) if kind == "rviz" else [here(path) for path in its]
        for kind, its in beside.files.items()
    }
    whys = ("Files for one robot; the build writes one of each for every robot",)
    if launched:
        files["params"] = [*files.get("params", ()), dict(launched)]
        whys = (*whys, "{NODE: {PARAMETER: value}} is what launch files give a node")
    if files:
        yield "companions", (files, whys)


def _needed(it: Looked) -> Iterator[str]:
    """What nobody gave and the xacro cannot do without, and what makes it simulated or real."""
    arguments = dict(it.arguments)
    if it.switch:
        yield f"{it.switch} is the switch between the simulated and the real robot"
    found = [name for name in it.needed if name in arguments]
    if found:
        yield f"It needs {', '.join(found)}; init chose a value: is it right?"


def _robots(it: Proposal, folder: str) -> Iterator[dict[str, Any]]:
    for member in it.members:
        own = _of_member(member, folder) if len(it.members) > 1 else ()
        keys = {key: value for key, (value, _) in own}
        for name in member.names:
            pose = {"pose": dict(it.poses[name])} if name in it.poses else {}
            yield {"name": name, **keys, **pose}
