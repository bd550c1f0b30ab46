"""The expectation as a YAML file that people read and edit."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from multibot_rewrite.graph.expectation import Expectation, Wanted, WantedRobot
from multibot_rewrite.model import InputError
from multibot_rewrite.remap.records import KINDS, ROLES

HEAD = """\
# What the graph of this fleet is to look like. Endpoints: [role, kind, name, type, name in the code].
# Take out what is not started, add what is: `multibot check` compares exactly this.
"""
KEYS = ("layout", "shared_nodes", "shared_topics", "shared_frames", "robots")
ROBOT_KEYS = ("tf", "frames", "nodes")
FIELDS = 5


def to_yaml(plan: Expectation) -> str:
    """The file's text."""
    import yaml

    data = {key: _plain(getattr(plan, key)) for key in KEYS[:-1]}
    data["robots"] = {robot.name: _robot(plan, robot) for robot in plan.robots}
    text = yaml.safe_dump(data, sort_keys=False, width=120, default_flow_style=None)
    return HEAD + str(text)


def _plain(value: object) -> object:
    return list(value) if isinstance(value, tuple) else value


def _robot(plan: Expectation, robot: WantedRobot) -> dict[str, object]:
    nodes: dict[str, list[list[str]]] = {node: [] for node in robot.nodes}
    for wanted in plan.endpoints:
        if wanted.node in nodes:
            node, kind, role, *rest = wanted
            nodes[node].append([role, kind, *rest])
    return {"tf": robot.tf, "frames": list(robot.frames), "nodes": nodes}


def from_yaml(data: bytes, file: str) -> Expectation:
    """Read what ``to_yaml`` wrote; raises InputError with file, place and what is allowed there."""
    import yaml

    try:
        value = yaml.safe_load(data)
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        reason = " ".join(str(error).split())
        raise InputError(f"{file}: not YAML: {reason}") from None
    top = _mapping(value, KEYS, file, "the plan")
    lists = {key: _texts(top[key], f"{file}: {key}") for key in KEYS[1:4]}
    robots, endpoints = [], []
    for name, given in _mapping(top["robots"], (), file, "robots").items():
        place = f"robots.{name}"
        robot = _mapping(given, ROBOT_KEYS, file, place)
        nodes = _mapping(robot["nodes"] or {}, (), file, f"{place}.nodes")
        frames = _texts(robot["frames"], f"{file}: {place}.frames")
        robots.append(WantedRobot(str(name), tuple(nodes), frames, str(robot["tf"])))
        for node, rows in nodes.items():
            where = f"{file}: {place}.nodes.{node}"
            endpoints += [_wanted(node, row, f"{where}[{at}]") for at, row in enumerate(rows or ())]
    return Expectation(
        str(top["layout"]),
        tuple(robots),
        lists["shared_nodes"],
        lists["shared_topics"],
        lists["shared_frames"],
        tuple(endpoints),
    )


def _mapping(value: object, keys: tuple[str, ...], file: str, what: str) -> Mapping[str, Any]:
    if not isinstance(value, dict):
        raise InputError(f"{file}: {what} is no mapping; write it as multibot plan does")
    wrong = [key for key in keys if key not in value] + [k for k in value if keys and k not in keys]
    if wrong:
        known = ", ".join(keys)
        raise InputError(f"{file}: {what}: key {wrong[0]!r} is missing or unknown; it has {known}")
    return value


def _texts(value: object, place: str) -> tuple[str, ...]:
    if not isinstance(value, list) or not all(isinstance(item, str) for item in value):
        raise InputError(f"{place} is no list of names")
    return tuple(value)


def _wanted(node: str, row: object, place: str) -> Wanted:
    if not isinstance(row, list) or len(row) != FIELDS or not all(isinstance(x, str) for x in row):
        raise InputError(f"{place}: write [role, kind, name, type, name in the node's code]")
    role, kind, name, type_, asked = row
    if role not in ROLES or kind not in KINDS:
        allowed = f"{', '.join(ROLES)} and {', '.join(KINDS)}"
        raise InputError(f"{place}: {role!r} {kind!r}: role and kind are of {allowed}")
    if not name.startswith("/"):
        raise InputError(f"{place}: {name!r} is no full name, it starts with /")
    return Wanted(node, kind, role, name, type_, asked)
