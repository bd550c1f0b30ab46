# SPDX-License-Identifier: Apache-2.0
"""The ``system_model.yaml`` that play_launch writes -> the nodes in it; ROS is not needed.

Source: NEWSLabNTU/play_launch, docs/design/system-model.md, scripts/compare_models.py: below
``structure.nodes`` each node by its full name with ``pkg``, ``exec`` or ``plugin``, ``node_name``,
``container``, ``remaps``, ``params`` and the texts of ``params_files``.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from typing import Any

import yaml

from multibot_rewrite.base.bounded import load_yaml
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError
from multibot_rewrite.companions.yaml_text import line_of, pairs, read_yaml
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.producers.launch.records import (
    LaunchedNode,
    LaunchGraph,
    LaunchNote,
    ParameterText,
)
from multibot_rewrite.producers.launch.spawners import controller_files
from multibot_rewrite.system.records import Place

_ENDS = (".yaml", ".yml")
_HEAD = lazy_compile(rb"^structure:", re.MULTILINE)
_KEPT_TEXT = ("pkg", "exec", "plugin", "node_name", "container")


def is_system_model(path: str) -> bool:
    """Is it a system model? A launch file in YAML has ``launch:`` instead."""
    return path.endswith(_ENDS) and _HEAD.search(read_file(path)) is not None


def read_system_model(path: str) -> LaunchGraph:
    """The nodes of a system model; raises InputError for one that has none."""
    document = read_yaml(read_file(path), path)
    lines = _lines(document.root)
    data = load_yaml(document.text, path)
    structure = data.get("structure") if isinstance(data, dict) else None
    nodes = structure.get("nodes") if isinstance(structure, dict) else None
    if not isinstance(nodes, dict) or not nodes:
        raise InputError(f"{path}: structure has no nodes; write the file with play_launch dump")
    found = []
    notes = []
    for name, it in nodes.items():
        place = Place(path, lines.get(str(name), 1))
        if not isinstance(it, dict) or not str(name).startswith("/"):
            raise InputError(f"{place}: {name} is no node of a system model; write it anew")
        if it.get("pkg"):
            found.append(_node(str(name), it, place))
        else:
            notes.append(LaunchNote(place, f"what {name} runs is not known: it has no package"))
    return LaunchGraph(tuple(found), tuple(notes))


def _lines(root: yaml.Node | None) -> dict[str, int]:
    """The line of each node."""
    for part in ("structure", "nodes"):
        root = next((value for key, value in pairs(root) if key.value == part), None)
        if root is None:
            return {}
    return {str(key.value): line_of(key) for key, _ in pairs(root)}


def _node(full: str, it: Mapping[str, Any], place: Place) -> LaunchedNode:
    above, _, last = full.rpartition("/")
    words = {key: str(it.get(key) or "") for key in _KEPT_TEXT}
    # Without a name in the launch file the last word is the executable's.
    name = last if words["plugin"] else words["node_name"]
    remaps = tuple((str(rule["from"]), str(rule["to"])) for rule in it.get("remaps") or ())
    container = words["container"]
    return LaunchedNode(
        words["pkg"],
        words["plugin"] or words["exec"],
        name,
        above or "/",
        remaps,
        tuple(_parameters(it, place)),
        f"/{container.lstrip('/')}" if container else "",
        tuple(str(word) for word in it.get("args") or ()),
        "",
        place,
    )


def _parameters(it: Mapping[str, Any], place: Place) -> Iterator[ParameterText]:
    for text in it.get("params_files") or ():
        yield ParameterText("", str(text))
    program = f"{it.get('pkg')}/{it.get('exec')}"
    for path in controller_files(program, [str(word) for word in it.get("args") or ()]):
        file = os.path.realpath(os.path.join(os.path.dirname(place.file), path))
        if os.path.isfile(file):
            yield ParameterText(file, read_file(file).decode(errors="replace"), file)
    values = it.get("params") or {}
    if values:
        body = {"/**": {"ros__parameters": dict(values)}}
        yield ParameterText("", yaml.safe_dump(body, sort_keys=False))
