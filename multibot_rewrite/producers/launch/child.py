# SPDX-License-Identifier: Apache-2.0
"""Launch files are programs: they are read in a process of their own, fenced, in limited time.

The ``system_model.yaml`` that play_launch writes has what one starts, and is read without ROS.

Source: NEWSLabNTU/play_launch, docs/design/system-model.md, scripts/compare_models.py: below
``structure.nodes`` each node by its full name with ``pkg``, ``exec`` or ``plugin``, ``node_name``,
``container``, ``remaps``, ``params`` and the texts of ``params_files``."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from typing import Any

import yaml

from multibot_rewrite.base.bounded import load_json, load_yaml
from multibot_rewrite.base.child import python, variables
from multibot_rewrite.base.file_kinds import LAUNCH, refuse_others
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.producers.launch.failures import started_by
from multibot_rewrite.producers.launch.kept_paths import FOLDER
from multibot_rewrite.producers.launch.records import (
    LaunchedNode,
    LaunchGraph,
    LaunchNote,
    LaunchOrder,
    ParameterText,
    graph_of,
)
from multibot_rewrite.producers.launch.spawners import controller_files
from multibot_rewrite.related_files.yaml_text import line_of, pairs, read_yaml
from multibot_rewrite.system.records import Place

_HEAD = lazy_compile(rb"^structure:", re.MULTILINE)
_KEPT_TEXT = ("pkg", "exec", "plugin", "node_name", "container")


def read_system_model(path: str) -> LaunchGraph:
    """Return the nodes of a system model; raises InputError for one that has none."""
    document = read_yaml(read_file(path), path)
    lines = _line_by_node(document.root)
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
            raise InputError(
                f"{place}: node {name} needs its full name and keys; use play_launch dump"
            )
        if it.get("pkg"):
            found.append(_node_of(str(name), it, place))
        else:
            notes.append(LaunchNote(place, f"what {name} runs is not known: it has no package"))
    return LaunchGraph(tuple(found), tuple(notes))


def _line_by_node(root: yaml.Node | None) -> dict[str, int]:
    """Return by name the line of each node in a system model."""
    for part in ("structure", "nodes"):
        root = next((value for key, value in pairs(root) if key.value == part), None)
        if root is None:
            return {}
    return {str(key.value): line_of(key) for key, _ in pairs(root)}


def _node_of(full: str, it: Mapping[str, Any], place: Place) -> LaunchedNode:
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
    """Yield the parameter files and values of a node in a system model."""
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


_MODULE = "multibot_rewrite.producers.launch"
# Of one launch file.
SECONDS, MOST = 60, 1000
# A launch file may load the fleet that names it.
_INSIDE = "MULTIBOT_READS_LAUNCH"


def launch_graph(order: LaunchOrder) -> LaunchGraph:
    """Return what a launch file or system_model.yaml starts. Raises InputError if it is unreadable."""
    refuse_others(read_file(order.file), order.file, LAUNCH)
    # A launch file in YAML has ``launch:`` in place of what a system model begins with.
    if order.file.endswith((".yaml", ".yml")) and _HEAD.search(read_file(order.file)) is not None:
        return read_system_model(order.file)
    if os.environ.get(_INSIDE):
        return LaunchGraph()
    (found,) = read_launch_files([order], SECONDS)
    if isinstance(found, InputError):
        raise found
    if not found.nodes and not found.notes:
        raise InputError(
            f"{order.file}: this launch file starts no node with these arguments; correct them"
        )
    return found


def read_launch_files(
    orders: Sequence[LaunchOrder], seconds: float
) -> list[LaunchGraph | InputError]:
    """Return what each launch file starts, or why it cannot be read; each has this many seconds."""
    with tempfile.TemporaryDirectory(prefix=FOLDER) as folder:
        said = _read_in_child(json.dumps([seconds, orders]), folder)
    try:
        answers = load_json(said)
        return [_checked_answer(*it) for it in zip(orders, answers, strict=True)]
    except ValueError:
        why = "its process gave no answer; a file that tampers with it is not read"
        return [InputError(f"{it.file}: the launch file cannot be read: {why}") for it in orders]


def _checked_answer(order: LaunchOrder, answer: Mapping[str, Any]) -> LaunchGraph | InputError:
    """Return the graph of an answer, or why there is none."""
    why = answer.get("error")
    try:
        if why is None:
            graph = graph_of(answer["graph"])
            if len(graph.nodes) <= MOST:
                return graph
            why = f"it starts {len(graph.nodes)} processes; of a robot {MOST} are read at most"
    except (ValueError, TypeError, LookupError, AttributeError):
        why = (
            "its process sent no valid answer; remove code that changes how Python reads or writes"
        )
    try:
        why = f"{why}{started_by(read_file(order.file).decode('utf-8', 'replace'))}"
    except InputError as error:  # a link to nothing, or a folder
        why = f"{error}".partition("cannot be read: ")[2]
    return InputError(f"{order.file}: the launch file cannot be read: {why}")


def _read_in_child(orders: str, folder: str) -> bytes:
    """Return the answer of the process that reads launch files; what they start ends with it."""
    environ = {**variables(), _INSIDE: "1", "TMPDIR": folder}
    process = subprocess.Popen(
        python(_MODULE),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=None,
        env=environ,
        start_new_session=True,
    )
    try:
        return process.communicate(orders.encode())[0]
    finally:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
