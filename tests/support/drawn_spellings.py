# SPDX-License-Identifier: Apache-2.0
"""A fleet file says one thing in many ways: keys at the top or at the robots, in an included file, a
pattern of robots, short names of layouts, a word in place of a list.

Each way is one that docs/fleet-file.md has. All must mean the fleet that was drawn.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from itertools import takewhile
from typing import Any

from hypothesis import strategies as st

Data = dict[str, Any]
FILE, SITE = "fleet.yaml", "site/common.yaml"
SHORT = {
    "tf-per-robot": "L1",
    "frames-per-robot": "L2",
    "both": "L3",
    "postfix": "L4",
    "frame-prefix": "L5",
}
OF_ALL = ("description", "join", "srdf", "arguments", "node_sets", "simulator")
PATHS = (
    *(
        "description",
        "srdf",
        "simulated",
        "simulator_world",
        "nodes",
        "definitions",
        "launch_roots",
    ),
)
FILES = ("params", "rviz", "moveit", "bridge", "behavior_trees", "lua")


def spelled(draw: st.DrawFn, data: Data) -> dict[str, Data]:
    """Return the fleet files, by path, in which somebody may have written what ``data`` says."""
    written = {**data, "robots": [_copy(row) for row in data["robots"]]}
    for way in (_layout, _numbered, _at_the_top, _words):
        if draw(st.booleans()):
            way(written)
    return _in_two_files(draw, written) if draw(st.integers(0, 3)) == 3 else {FILE: written}


def _copy(row: Mapping[str, Any]) -> Data:
    return {key: {**it} if isinstance(it, dict) else it for key, it in row.items()}


def _layout(data: Data) -> None:
    """Write the layout's short name, no side if it is the usual one, and topics as the layout's."""
    layout = data["layout"]
    usual = "prefix" if layout == "frame-prefix" else "postfix"
    if data["affix"] == usual:
        del data["affix"]
    elif layout != "postfix":
        data["topics"] = "namespace"
    data["layout"] = SHORT[layout]


def _numbered(data: Data) -> None:
    """Robots that are numbered from 1, and differ in nothing but their places, as a pattern."""
    rows, left = data["robots"], []
    while rows:
        run = list(takewhile(_of_pattern(rows), enumerate(rows)))
        made = _pattern([row for _, row in run]) if len(run) > 1 else None
        left.append(made or rows[0])
        rows = rows[len(run) if made else 1 :]
    data["robots"] = left


def _of_pattern(rows: list[Data]) -> Callable[[tuple[int, Data]], bool]:
    """Return a function that says whether a row goes on with the pattern that the first row begins."""
    stem, wanted = rows[0]["name"][:-1], _kept(rows[0])
    own = {"namespace", "prefix", "postfix", "model"} & rows[0].keys()

    def goes_on(row: tuple[int, Data]) -> bool:
        at, it = row
        return bool(stem) and not own and it["name"] == f"{stem}{at + 1}" and _kept(it) == wanted

    return goes_on


def _kept(row: Data) -> Data:
    return {key: it for key, it in row.items() if key not in ("name", "pose")}


def _pattern(rows: list[Data]) -> Data | None:
    """One row for all of these; None if their places are in no row."""
    first, second = (row.get("pose", {}) for row in rows[:2])
    step = {key: second.get(key, 0) - first.get(key, 0) for key in {**first, **second}}
    for at, row in enumerate(rows):
        place = {key: first.get(key, 0) + at * step[key] for key in step}
        if row.get("pose", {}) != place:
            return None
    made = {**rows[0], "name": rows[0]["name"][:-1], "count": len(rows)}
    return made | (
        {"step": {key: it for key, it in step.items() if it}} if any(step.values()) else {}
    )


def _at_the_top(data: Data) -> None:
    """Move what most robots have to the top, for all of them: another one has its own."""
    rows = data["robots"]
    # Of one for all and another one at a robot that of the robot counts: both at one robot are a fault.
    has_both = any({"description", "join"} <= row.keys() for row in rows)
    for key in (it for it in OF_ALL if not (has_both and it in ("description", "join"))):
        _raise(data, rows, key, nothing=[] if key == "node_sets" else None)
    top: Data = {}
    for kind in FILES:
        own = [row.get("related_files", {}) for row in rows]
        _raise(top, own, kind, nothing=None if kind == "rviz" else [])
        for row, it in zip(rows, own, strict=True):
            row.pop("related_files", None)
            row.update({"related_files": it} if it else {})
    data |= {"related_files": top} if top else {}


def _raise(top: Data, rows: Sequence[Data], key: str, nothing: object) -> None:
    """Put the first value of a key to the top, if each row has one, or ``nothing`` can be written."""
    given = [row[key] for row in rows if key in row]
    if not given or key in top or (len(given) < len(rows) and nothing is None):
        return
    top[key] = given[0]
    for row in rows:
        if key in row and row[key] == given[0] and type(row[key]) is type(given[0]):
            del row[key]
        else:
            row.setdefault(key, nothing)


def _words(data: Data) -> None:
    """Write a list of one word as a word."""
    for row in (data, *data["robots"]):
        for own in (row, row.get("related_files", {})):
            for key in ("node_sets", *FILES):
                value = own.get(key)
                if isinstance(value, list) and len(value) == 1 and isinstance(value[0], str):
                    own[key] = value[0]


def _in_two_files(draw: st.DrawFn, data: Data) -> dict[str, Data]:
    """Return some keys in a file of another folder, which the fleet file includes and overrides."""
    keys = [it for it in data if it != "robots"]
    moved = draw(st.lists(st.sampled_from(keys), min_size=1, max_size=4, unique=True))
    site = {key: _from(os.path.dirname(SITE), key, data[key]) for key in moved}
    own = {key: it for key, it in data.items() if key not in moved}
    # Of both files the one that includes counts, also for the list of robots.
    below = {"distro": "humble"} if "distro" in own else {}
    below |= {"robots": [{"name": "nobody"}]} if draw(st.booleans()) else {}
    return {FILE: {"include": SITE, **own}, SITE: {**site, **below}}


def _from(folder: str, key: str, value: Any) -> Any:
    """Return a value with its paths as they are from a folder."""
    if key in PATHS and isinstance(value, str):
        return os.path.relpath(value, folder)
    if key in PATHS:
        return [os.path.relpath(it, folder) for it in value]
    if key == "join":
        return [{**it, "description": os.path.relpath(it["description"], folder)} for it in value]
    if key != "related_files":
        return value
    return {
        kind: [os.path.relpath(it, folder) if isinstance(it, str) else it for it in own]
        if isinstance(own, list)
        else os.path.relpath(own, folder)
        for kind, own in value.items()
    }
