# SPDX-License-Identifier: Apache-2.0
"""The file that the plan of a fleet is: how it is read and written, and what is wrong with it."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping

from multibot_rewrite.base.file_kinds import PLAN, ROBOTS, recognised, refuse_others
from multibot_rewrite.base.grouping import sets_by_key
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.nearest import unknown
from multibot_rewrite.system import json
from multibot_rewrite.system.environment import MAX_DOMAIN
from multibot_rewrite.system.records import RUNS, System


def robot_words(plan: System) -> dict[str, str]:
    """Return the words that stand for robots in texts, each with the name of its robot."""
    return words_of({it.name: (it.tag, it.namespace) for it in plan.robots})


def words_of(others: Mapping[str, Iterable[str]]) -> dict[str, str]:
    """Return the names of robots, and words that stand for one robot alone, with its name."""
    robots = sets_by_key((word, name) for name, words in others.items() for word in words if word)
    only = {word: min(names) for word, names in robots.items() if len(names) == 1}
    return {name: name for name in others} | {k: it for k, it in only.items() if k not in others}


def vacuous(plan: System) -> str:
    """Return why a graph without nodes would be as planned; empty for a plan that expects something."""
    if not plan.robots:
        return "no robot is planned"
    needed = {it.robot for it in plan.nodes if it.sure.word == RUNS.word or it.sure.instead}
    idle = [it.name for it in plan.robots if it.name not in needed]
    verb = "has" if len(idle) == 1 else "have"
    return f"{', '.join(idle)} {verb} no node that must run" if idle else ""


HEAD = """\
# What the graph of this fleet is to look like: each robot with its nodes, and each node with its ends:
# [role, kind, name, type, name in the code]; one that only may be there has its condition besides.
# `multibot check` compares exactly this: take out what is not started, add what is. A node with
# `sure: may` may be missing. The page "The plan" of the documentation has all keys.
"""
# lifecycle_msgs/msg/State, the primary ones.
LIFECYCLE = ("unconfigured", "inactive", "active", "finalized")
# What follows ``robots:``, empty lines and comments aside.
_ROBOTS = lazy_compile(ROBOTS + rb"([^\s#])", re.MULTILINE)
_INCLUDE = lazy_compile(rb"^include:", re.MULTILINE)


def to_yaml(plan: System) -> str:
    """Return a plan as the text of a YAML file."""
    return HEAD + json.to_yaml(plan)


def read_plan(data: bytes, file: str) -> System:
    """Return the plan that a file holds; raises InputError with file, place and what to write there."""
    refuse_others(data, file, PLAN)
    plan = json.read_system(data, file)
    for wrong in _contradictions(plan):
        raise InputError(f"{file}: {wrong}")
    return plan


def _contradictions(plan: System) -> Iterator[str]:
    """Yield what is wrong in a plan or fits no graph or any graph, and what to do."""
    if not plan.layout:
        yield f"layout: missing; it is needed; {json.REMEDY}"
    if nothing := vacuous(plan):
        yield f"{nothing}, so every graph would be as planned; {json.REMEDY}"
    robots = Counter(it.name for it in plan.robots)
    for name in (it for it in robots if robots[it] > 1):
        yield f"robots: {name} is there twice; join the two"
    for domain in plan.domains:
        if domain.robot and domain.robot not in robots:
            yield f"domains: {unknown('robot', domain.robot, robots)}"
        if not 0 <= domain.number <= MAX_DOMAIN:
            yield f"domains: {domain.number}: write a ROS_DOMAIN_ID, 0 to {MAX_DOMAIN}"
    groups: dict[str, tuple[str, ...]] = {}
    for node in plan.nodes:
        if node.lifecycle and node.lifecycle not in LIFECYCLE:
            yield f"{node.name}: lifecycle: {unknown('state', node.lifecycle, LIFECYCLE)}"
        groups |= dict.fromkeys(node.sure.instead, node.sure.instead)
    for node in plan.nodes:
        group = groups.get(node.name, ())
        if group != node.sure.instead:
            written = f"write instead: [{', '.join(group)}] at each of them"
            yield f"{node.name}: sure: of these nodes one runs, or another group; {written}"


def is_fleet(data: bytes) -> bool:
    """Return whether a text is a fleet file. Its robots are a list, or in files that it includes."""
    if recognised(data) == PLAN:
        return False
    found = _ROBOTS.search(data)
    return found[1] in (b"-", b"[") if found else bool(_INCLUDE.search(data))
