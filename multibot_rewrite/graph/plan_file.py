"""The expectation as a YAML file that people read and edit."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cache
from typing import Any

from multibot_rewrite.graph.expectation import Expectation, Wanted, WantedRobot
from multibot_rewrite.model import InputError
from multibot_rewrite.remap.records import KINDS, ROLES

HEAD = """\
# What the graph of this fleet is to look like. Endpoints: [role, kind, name, type, name in the code].
# Take out what is not started, add what is: `multibot check` compares exactly this.
# optional: nodes that may be missing. other_frames: frames that may come besides. ignored_nodes:
# patterns of nodes that may come and go, beside the usual tools. sources: what starts a node.
# spelled: what stands for a robot in its frames, where that is not its name.
"""
KEYS = ("layout", "shared_nodes", "shared_topics", "shared_frames", "robots")
ROBOT_KEYS = ("tf", "frames", "nodes")
# May be left out.
MORE_KEYS = ("ignored_nodes", "sources")
MORE_ROBOT_KEYS = ("other_frames", "optional", "spelled")
FIELDS = 5
# Between the types an endpoint may have.
OR = " | "
Spell = Callable[[str], str]
# Reads back as the same text between brackets and elsewhere, and as no number, boolean or null.
_PLAIN = re.compile(r"[A-Za-z_/~](?:[A-Za-z0-9_./~-]|:(?=[A-Za-z0-9_/])| \| )*")
_WORDS = frozenset(["~", "null", "true", "false", "yes", "no", "on", "off", "y", "n"])


def to_yaml(plan: Expectation) -> str:
    """The file's text."""
    rows: dict[str, list[list[str]]] = defaultdict(list)
    for wanted in plan.endpoints:
        types = OR.join((wanted.type, *wanted.also))
        rows[wanted.node].append([wanted.role, wanted.kind, wanted.name, types, wanted.asked])
    spell = cache(_quoted)
    parts = [HEAD]
    for key in (*KEYS[:-1], "ignored_nodes"):
        value = getattr(plan, key)
        parts.append(f"{key}: {spell(value) if isinstance(value, str) else _flow(value, spell)}\n")
    parts.append("robots:\n" if plan.robots else "robots: {}\n")
    for robot in plan.robots:
        parts += _robot(robot, rows, spell)
    # One a line: that is how people look them up.
    parts += ["sources:\n"] * bool(plan.sources)
    parts += [f"  {spell(node)}: {spell(place)}\n" for node, place in plan.sources]
    return "".join(parts)


def _robot(robot: WantedRobot, rows: Mapping[str, list[list[str]]], spell: Spell) -> Iterator[str]:
    yield f"  {spell(robot.name)}:\n    tf: {spell(robot.tf)}\n"
    yield f"    frames: {_flow(robot.frames, spell)}\n"
    for key in MORE_ROBOT_KEYS:
        value = getattr(robot, key)
        if value:
            yield f"    {key}: {spell(value) if isinstance(value, str) else _flow(value, spell)}\n"
    yield "    nodes:\n" if robot.nodes else "    nodes: {}\n"
    for node in dict.fromkeys(robot.nodes):
        own = rows.get(node, ())
        yield f"      {spell(node)}:\n" if own else f"      {spell(node)}: []\n"
        yield from (f"      - {_flow(row, spell)}\n" for row in own)


def _flow(values: Iterable[str], spell: Spell) -> str:
    return f"[{', '.join(map(spell, values))}]"


def _quoted(value: str) -> str:
    if _PLAIN.fullmatch(value) and value.lower() not in _WORDS:
        return value
    import yaml

    return str(yaml.dump(value, default_style='"', width=10**9)).rstrip("\n")


def _fast(name: str) -> Any:
    """PyYAML's class of this name, the one in C where there is one: ten times as fast."""
    import yaml

    return getattr(yaml, f"C{name}", None) or getattr(yaml, name)


def from_yaml(data: bytes, file: str) -> Expectation:
    """Read what ``to_yaml`` wrote; raises InputError with file, place and what is allowed there."""
    import yaml

    try:
        value = yaml.load(data, Loader=_fast("SafeLoader"))
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        place = f"{file}:{mark.line + 1}:{mark.column + 1}" if mark else file
        reason = getattr(error, "problem", None) or " ".join(str(error).split())
        raise InputError(f"{place}: not YAML: {reason}; use what multibot plan wrote") from None
    except (UnicodeDecodeError, RecursionError) as error:
        raise InputError(f"{file}: not YAML: {error}; use what multibot plan wrote") from None
    top = _mapping(value, KEYS, file, "the plan", MORE_KEYS)
    nodes, topics, frames = (_texts(top[key], f"{file}: {key}") for key in KEYS[1:4])
    robots: list[WantedRobot] = []
    endpoints: list[Wanted] = []
    for name, given in _mapping(top["robots"], (), file, "robots").items():
        robot, ends = _read_robot(str(name), given, file)
        robots.append(robot)
        endpoints += ends
    return Expectation(
        str(top["layout"]),
        tuple(robots),
        nodes,
        topics,
        frames,
        tuple(endpoints),
        _texts(top.get("ignored_nodes", []), f"{file}: ignored_nodes"),
        tuple(_sources(top.get("sources", {}), file)),
    )


def _read_robot(name: str, given: object, file: str) -> tuple[WantedRobot, list[Wanted]]:
    place = f"robots.{name}"
    robot = _mapping(given, ROBOT_KEYS, file, place, MORE_ROBOT_KEYS)
    nodes = _mapping(robot["nodes"] or {}, (), file, f"{place}.nodes")
    keys = ("frames", *MORE_ROBOT_KEYS[:-1])
    frames, others, optional = (
        _texts(robot.get(key, []), f"{file}: {place}.{key}") for key in keys
    )
    endpoints = [
        _wanted(node, row, f"{file}: {place}.nodes.{node}[{at}]")
        for node, rows in nodes.items()
        for at, row in enumerate(_rows(rows, f"{file}: {place}.nodes.{node}"))
    ]
    tf = _full_name(robot["tf"], f"{file}: {place}.tf")
    names = tuple(_full_name(node, f"{file}: {place}.nodes") for node in nodes)
    spelled = robot.get("spelled", "")
    if not isinstance(spelled, str):
        raise InputError(f"{file}: {place}.spelled: write one word")
    return WantedRobot(name, names, frames, tf, others, optional, spelled), endpoints


def _full_name(value: object, place: str) -> str:
    if not isinstance(value, str) or not value.startswith("/"):
        raise InputError(f"{place}: {value!r} is no full name, it starts with /")
    return value


def _rows(value: object, place: str) -> Sequence[object]:
    if value is not None and not isinstance(value, list):
        raise InputError(f"{place} is no list; write [] for a node without endpoints of note")
    return value or []


def _sources(value: object, file: str) -> Iterator[tuple[str, str]]:
    for node, place in _mapping(value or {}, (), file, "sources").items():
        if not isinstance(place, str):
            raise InputError(f"{file}: sources.{node}: write file:line")
        yield str(node), place


def _mapping(
    value: object, keys: tuple[str, ...], file: str, what: str, more: tuple[str, ...] = ()
) -> Mapping[str, Any]:
    """``value`` with all of ``keys``, and of ``more`` what it likes; with any, if there are none."""
    if not isinstance(value, dict):
        raise InputError(f"{file}: {what} is no mapping; write it as multibot plan does")
    wrong = [key for key in keys if key not in value]
    wrong += [key for key in value if keys and key not in (*keys, *more)]
    if wrong:
        known = ", ".join((*keys, *more))
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
    type_, *also = type_.split(OR)
    return Wanted(node, kind, role, _full_name(name, place), type_, asked, tuple(also))
