# SPDX-License-Identifier: Apache-2.0
"""What a rehearsal says of a fleet file, and what check says of the graph that came up.

The rehearsal starts a stand-in for every node, on real DDS; its graph is compared once more with the
plan that ``build`` has written. Needs rclpy.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import NOTE, Finding
from multibot_rewrite.live.rehearsal import substitute_type, with_substitutes
from multibot_rewrite.rules.check import check
from multibot_rewrite.system.json import from_json, from_yaml
from multibot_rewrite.system.records import TOPIC, System

PLAN = "plan.yaml"


class Said(NamedTuple):
    """A finding that is no note, with ``robot`` in place of the robot's name."""

    code: str
    message: str


class Looked(NamedTuple):
    """What a rehearsal says, and what check says."""

    rehearsed: tuple[Said, ...]
    checked: tuple[Said, ...]


class Told(NamedTuple):
    """How much a build, a rehearsal and a check say of a fleet, and how much of it is not true."""

    layout: str
    numbers: tuple[int, int, int]
    false: int


def told(layout: str, built: Sequence[Said], looked: Looked, true: Callable[[Said], bool]) -> Told:
    """Return what is said of a fleet in a layout."""
    every = (built, looked.rehearsed, looked.checked)
    false = sum(not true(it) for part in every for it in part)
    return Told(layout, (len(built), len(looked.rehearsed), len(looked.checked)), false)


def look(file: Path, built: Mapping[str, bytes], robots: Iterable[str]) -> Looked:
    """Rehearse a fleet file; ``built`` is what is built of it."""
    names, graph = tuple(robots), file.parent / "graph.json"
    words = ("rehearse", "--trust", str(file), "--format", "json", "--save-snapshot", str(graph))
    command = [sys.executable, "-m", "multibot_rewrite", *words]
    done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=200)
    if done.returncode not in (0, 1):
        raise SystemExit(f"{file}: {done.stderr}")
    rehearsed = [_finding(it) for it in json.loads(done.stdout)["findings"]]
    seen = from_json(graph.read_bytes(), str(graph))
    plan = _substituted(from_yaml(built[PLAN], PLAN)._replace(parameters=()), seen)
    found = check(plan, seen)
    return Looked(said(rehearsed, names), said(found, names))


def said(findings: Iterable[Finding], robots: Iterable[str]) -> tuple[Said, ...]:
    """Return what is said, once for all robots."""
    robot = re.compile(rf"\b({'|'.join(map(re.escape, robots))})(?=\b|_)")
    told = (it for it in findings if it.level != NOTE)
    return tuple(dict.fromkeys(Said(it.code, robot.sub("robot", it.message)) for it in told))


def _finding(row: Mapping[str, str]) -> Finding:
    return Finding(row["code"], row["level"], row["message"])


def _substituted(plan: System, graph: System) -> System:
    """Return the plan with the types that the rehearsal has in place of those that are not
    installed: no stand-in has these."""
    there = {it.type for it in graph.ends}
    return with_substitutes(plan, {t: new for t, new in _substitutes(plan) if t not in there})


def _substitutes(plan: System) -> Iterator[tuple[str, str]]:
    ends = [(it.kind, type_) for it in plan.ends for type_ in (it.type, *it.also)]
    ends += [(TOPIC, it.type) for it in plan.topics]
    yield from ((type_, substitute_type(kind, type_)) for kind, type_ in ends if type_)
