"""The plan of a fleet as a file: YAML, which people edit, or JSON, which is read faster.

Both have the same keys and values, and both are read with the same checks.
"""

from __future__ import annotations

import json
import re
from codecs import BOM_UTF8
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache
from sys import intern
from typing import Any

from multibot_rewrite.bounded import load_json, load_yaml
from multibot_rewrite.gc_pause import gc_paused
from multibot_rewrite.graph.expectation import (
    Expectation,
    PlannedEndpoint,
    PlannedRobot,
    vacuous,
)
from multibot_rewrite.graph.plan_gaps import gap_row, gap_value, read_gaps
from multibot_rewrite.model import InputError
from multibot_rewrite.releases import RELEASES
from multibot_rewrite.remap.records import KINDS, ROLES
from multibot_rewrite.remap.yaml_with_lines import unknown

HEAD = """\
# What the graph of this fleet is to look like. Endpoints: [role, kind, name, type, name in the code].
# Take out what is not started, add what is: `multibot check` compares exactly this.
# optional: nodes that may be missing. other_frames: frames that may come besides. ignored_nodes:
# patterns of nodes that may come and go, beside the usual tools. sources: the plugin that starts a
# node. from: the file or stack that names a node. distro: the ROS 2 release that the nodes are of.
# spelled: what stands for a robot in its frames, where that is not its name. open: what is read and
# not sent, claimed and not exported, by the robots' files; check reports it with the graph.
"""
KEYS = ("layout", "shared_nodes", "shared_topics", "shared_frames", "robots")
ROBOT_KEYS = ("tf", "frames", "nodes")
# Node -> text; key -> field of Expectation. "ways" is how a node gets rules, if not by --ros-args.
BY_NODE = {"sources": "sources", "from": "origins", "ways": "ways"}
OPEN = "open"
OPTIONAL_KEYS = ("distro", "ignored_nodes", *BY_NODE, OPEN)
# Key -> field of PlannedRobot.
OPTIONAL_ROBOT_KEYS = {
    "other_frames": "other_frames",
    "optional": "optional",
    "spelled": "frame_tag",
}
FIELDS = 5
# Between several types of an endpoint.
OR = " | "
Quote = Callable[[str], str]
_REMEDY = "use the file that multibot plan wrote"
# Text that YAML reads back unchanged without quotes, in brackets too.
_PLAIN = re.compile(r"[A-Za-z_/~](?:[A-Za-z0-9_./~-]|:(?=[A-Za-z0-9_/])| \| )*")
_WORDS = frozenset(["~", "null", "true", "false", "yes", "no", "on", "off", "y", "n"])


def to_yaml(plan: Expectation) -> str:
    """The text of a YAML file."""
    rows = _rows_by_node(plan)
    quote = cache(_quoted)
    parts = [HEAD, *[f"distro: {plan.release}\n"] * bool(plan.release)]
    for key in (*KEYS[:-1], "ignored_nodes"):
        value = getattr(plan, key)
        parts.append(f"{key}: {quote(value) if isinstance(value, str) else _flow(value, quote)}\n")
    parts.append("robots:\n" if plan.robots else "robots: {}\n")
    for robot in plan.robots:
        parts += _robot(robot, rows, quote)
    # One on each line, so that people find them.
    for key, field in BY_NODE.items():
        texts = getattr(plan, field)
        parts += [f"{key}:\n"] * bool(texts)
        parts += [f"  {quote(node)}: {quote(text)}\n" for node, text in texts]
    parts += [f"{OPEN}:\n"] * bool(plan.gaps)
    parts += (gap_row(it, quote) for it in plan.gaps)
    return "".join(parts)


def _rows_by_node(plan: Expectation) -> dict[str, list[list[str]]]:
    rows: dict[str, list[list[str]]] = defaultdict(list)
    for end in plan.endpoints:
        types = OR.join((end.type, *end.also))
        rows[end.node].append([end.role, end.kind, end.name, types, end.code_name])
    return rows


def to_json(plan: Expectation) -> str:
    """The text of a JSON file, a robot a line."""
    rows = _rows_by_node(plan)
    top: dict[str, object] = {key: getattr(plan, key) for key in (*KEYS[:-1], "ignored_nodes")}
    top |= {"distro": plan.release} if plan.release else {}
    by_node = {key: dict(getattr(plan, field)) for key, field in BY_NODE.items()}
    top |= {key: texts for key, texts in by_node.items() if texts}
    top |= {OPEN: [gap_value(it) for it in plan.gaps]} if plan.gaps else {}
    parts = [f"{_json(key)}: {_json(value)}" for key, value in top.items()]
    robots = ",\n".join(
        f"  {_json(it.name)}: {_json(_robot_value(it, rows))}" for it in plan.robots
    )
    return "{\n " + ",\n ".join([*parts, f'"robots": {{\n{robots}\n }}']) + "\n}\n"


def _robot_value(robot: PlannedRobot, rows: Mapping[str, list[list[str]]]) -> dict[str, object]:
    fields = {key: getattr(robot, field) for key, field in OPTIONAL_ROBOT_KEYS.items()}
    given = {key: value for key, value in fields.items() if value}
    nodes = {node: rows.get(node, []) for node in robot.nodes}
    return {"tf": robot.tf, "frames": robot.frames, **given, "nodes": nodes}


def _json(value: object) -> str:
    return json.dumps(value, ensure_ascii=False)


def _robot(robot: PlannedRobot, rows: Mapping[str, list[list[str]]], quote: Quote) -> Iterator[str]:
    yield f"  {quote(robot.name)}:\n    tf: {quote(robot.tf)}\n"
    yield f"    frames: {_flow(robot.frames, quote)}\n"
    for key, field in OPTIONAL_ROBOT_KEYS.items():
        value = getattr(robot, field)
        if value:
            yield f"    {key}: {quote(value) if isinstance(value, str) else _flow(value, quote)}\n"
    yield "    nodes:\n" if robot.nodes else "    nodes: {}\n"
    for node in dict.fromkeys(robot.nodes):
        own = rows.get(node, ())
        yield f"      {quote(node)}:\n" if own else f"      {quote(node)}: []\n"
        yield from (f"      - {_flow(row, quote)}\n" for row in own)


def _flow(values: Iterable[str], quote: Quote) -> str:
    return f"[{', '.join(map(quote, values))}]"


def _quoted(value: str) -> str:
    if _PLAIN.fullmatch(value) and value.lower() not in _WORDS:
        return value
    import yaml

    return str(yaml.dump(value, default_style='"', width=10**9)).rstrip("\n")


def read_plan(data: bytes, file: str) -> Expectation:
    """Read what ``to_yaml`` or ``to_json`` wrote; raises InputError with file, place and what to write
    there."""
    with gc_paused():
        return from_json(data, file) if is_json(data) else from_yaml(data, file)


def is_json(data: bytes) -> bool:
    """Whether a plan is JSON; a YAML file begins with a comment or a key."""
    return data.removeprefix(BOM_UTF8)[:1000].lstrip().startswith(b"{")


def from_json(data: bytes, file: str) -> Expectation:
    """Read what ``to_json`` wrote; raises InputError."""
    try:
        return from_value(load_json(data), file)
    except json.JSONDecodeError as error:
        place = f"{file}:{error.lineno}:{error.colno}"
        raise InputError(f"{place}: not valid JSON: {error.msg}; {_REMEDY}") from None
    except UnicodeDecodeError as error:
        raise InputError(f"{file}: not valid JSON: {error}; {_REMEDY}") from None


def from_yaml(data: bytes, file: str) -> Expectation:
    """Read what ``to_yaml`` wrote; raises InputError."""
    import yaml

    try:
        return from_value(load_yaml(data.decode("utf-8-sig")), file)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        place = f"{file}:{mark.line + 1}:{mark.column + 1}" if mark else file
        reason = getattr(error, "problem", None) or " ".join(str(error).split())
        raise InputError(f"{place}: not valid YAML: {reason}; {_REMEDY}") from None
    except UnicodeDecodeError as error:
        raise InputError(f"{file}: not valid YAML: {error}; {_REMEDY}") from None


def from_value(value: object, file: str) -> Expectation:
    """The plan that a value of YAML or JSON holds; raises InputError."""
    top = _mapping(value, KEYS, file, "the plan", OPTIONAL_KEYS)
    nodes, topics, frames = (_texts(top[key], f"{file}: {key}") for key in KEYS[1:4])
    robots: list[PlannedRobot] = []
    endpoints: list[PlannedEndpoint] = []
    for name, given in _mapping(top["robots"], (), file, "robots").items():
        robot, ends = _read_robot(str(name), given, file)
        robots.append(robot)
        endpoints += ends
    sources, origins, ways = (tuple(_by_node(top.get(key, {}), file, key)) for key in BY_NODE)
    plan = Expectation(
        str(top["layout"]),
        tuple(robots),
        nodes,
        topics,
        frames,
        tuple(endpoints),
        _texts(top.get("ignored_nodes", []), f"{file}: ignored_nodes"),
        sources,
        origins,
        _release(top.get("distro", ""), file),
        ways,
        tuple(read_gaps(top.get(OPEN), f"{file}: {OPEN}")),
    )
    nothing = vacuous(plan)
    if nothing:
        raise InputError(f"{file}: {nothing}, so every graph would be as planned; {_REMEDY}")
    return plan


def _release(value: object, file: str) -> str:
    """A plan of an earlier version has none."""
    if value and value not in RELEASES:
        raise InputError(f"{file}: distro: {unknown('release', str(value), RELEASES)}")
    return str(value)


def _read_robot(name: str, given: object, file: str) -> tuple[PlannedRobot, list[PlannedEndpoint]]:
    place = f"robots.{name}"
    robot = _mapping(given, ROBOT_KEYS, file, place, (*OPTIONAL_ROBOT_KEYS,))
    nodes = _mapping(robot["nodes"] or {}, (), file, f"{place}.nodes")
    keys = ("frames", "other_frames", "optional")
    frames, others, optional = (
        _texts(robot.get(key, []), f"{file}: {place}.{key}") for key in keys
    )
    endpoints: list[PlannedEndpoint] = []
    for node, given_rows in nodes.items():
        endpoints += _read_endpoints(node, given_rows, f"{file}: {place}.nodes.{node}")
    tf = _full_name(robot["tf"], f"{file}: {place}.tf")
    names = tuple(_full_name(node, f"{file}: {place}.nodes") for node in nodes)
    frame_tag = robot.get("spelled", "")
    if not isinstance(frame_tag, str):
        raise InputError(f"{file}: {place}.spelled: write one word")
    return PlannedRobot(name, names, frames, tf, others, optional, frame_tag), endpoints


def _full_name(value: object, place: str) -> str:
    if not isinstance(value, str) or not value.startswith("/"):
        raise InputError(f"{place}: {_not_full(value)}")
    return intern(value)


def _not_full(value: object) -> str:
    return f"{value!r} is not a full name; write it with a / in front"


def _by_node(value: object, file: str, key: str) -> Iterator[tuple[str, str]]:
    for node, place in _mapping(value or {}, (), file, key).items():
        if not isinstance(place, str):
            raise InputError(f"{file}: {key}.{node}: write file:line")
        yield str(node), place


def _mapping(
    value: object, keys: tuple[str, ...], file: str, what: str, more: tuple[str, ...] = ()
) -> Mapping[str, Any]:
    """``value``, checked to have all of ``keys`` and otherwise only ``more``; any without ``keys``."""
    if not isinstance(value, dict):
        raise InputError(f"{file}: {what} is not a mapping; write it as multibot plan does")
    missing = [key for key in keys if key not in value]
    unknown = [key for key in value if keys and key not in (*keys, *more)]
    if missing or unknown:
        wrong = f"key {missing[0]!r} is missing" if missing else f"unknown key {unknown[0]!r}"
        raise InputError(f"{file}: {what}: {wrong}; the keys are {', '.join((*keys, *more))}")
    return value


def _texts(value: object, place: str) -> tuple[str, ...]:
    if not isinstance(value, list) or not all(isinstance(item, str) for item in value):
        raise InputError(f"{place} is not a list of names")
    return tuple(value)


def _read_endpoints(node: str, rows: object, place: str) -> Iterator[PlannedEndpoint]:
    if rows is not None and not isinstance(rows, list):
        raise InputError(f"{place} is not a list; write [] for a node without planned endpoints")
    for at, row in enumerate(rows or ()):
        wrong = _wrong_row(row)
        if wrong:
            raise InputError(f"{place}[{at}]: {wrong}")
        # Many nodes have the same names, types and words.
        role, kind, name, types, code_name = map(intern, row)
        type_, *also = types.split(OR) if OR in types else (types,)
        yield PlannedEndpoint(node, kind, role, name, type_, code_name, tuple(also))


def _wrong_row(row: object) -> str:
    """What is wrong with a row of the plan; empty for an endpoint."""
    if not isinstance(row, list) or len(row) != FIELDS or {*map(type, row)} != {str}:
        return "write [role, kind, name, type, name in the node's code]"
    role, kind, name, _, _ = row
    if role not in ROLES or kind not in KINDS:
        allowed = f"a role ({', '.join(ROLES)}) and a kind ({', '.join(KINDS)})"
        return f"{role!r}, {kind!r}: write {allowed}"
    return "" if name.startswith("/") else _not_full(name)
