# SPDX-License-Identifier: Apache-2.0
"""Where a plan and what is seen beside it differ: the look-ups that several rules need."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Mapping, Sequence, Set

from multibot_rewrite.base.nearest import MISTYPED, nearest
from multibot_rewrite.system.index import EndKey, Index, once
from multibot_rewrite.system.ownership import NameOwnership
from multibot_rewrite.system.records import End

# With more names than these, some name is always similar.
MOST_CANDIDATES = 50


@once
def missing(plan: Index, seen: Index) -> Mapping[EndKey, End]:
    """The planned ends that are not there, without those that only may be."""
    there = seen.by_key
    return {key: end for key, end in plan.sure.by_key.items() if key not in there}


@once
def unplanned_ends(plan: Index, seen: Index) -> Mapping[str, Sequence[End]]:
    """By node: the ends that are not planned, each once, without hidden ones."""
    found: dict[str, list[End]] = defaultdict(list)
    known = set(plan.by_key)
    for end in seen.sure.system.ends:
        key = (end.node, end.kind, end.role, end.name)
        # A node may subscribe to a topic more than once.
        if key not in known and "/_" not in end.name:
            known.add(key)
            found[end.node].append(end)
    return found


@once
def unplanned_nodes(plan: Index, seen: Index) -> Sequence[str]:
    """The nodes that are not planned, without those that come and go."""
    return [node for node in _others(plan, seen) if not seen.is_tool(node)]


@once
def _others(plan: Index, seen: Index) -> Set[str]:
    known = plan.robot_of.keys() | set(plan.own[""])
    return dict.fromkeys(node for node in seen.nodes if node not in known).keys()


@once
def matches(plan: Index, seen: Index) -> Mapping[str, str]:
    """The running node that each missing node probably is."""
    gone = {node: robot for node, robot in plan.robot_of.items() if node not in seen.nodes}
    return probable_matches(gone, _others(plan, seen), unplanned_nodes(plan, seen), plan.of_names)


def probable_matches(
    missing: Mapping[str, str],
    others: Collection[str],
    unplanned: Iterable[str],
    ownership: NameOwnership,
) -> dict[str, str]:
    """The running node that each missing node (node -> robot) probably is, where there is one.

    ``others`` are all running nodes that are not in the plan, ``unplanned`` those of them that are
    no tools: only these are compared by similar name.
    """
    by_robot: dict[str, list[str]] = defaultdict(list)
    for node in unplanned if missing else ():
        by_robot[ownership.robot(node)].append(node)
    spaces = {_letters(node.split("/")[1]): node.split("/")[1] for node in by_robot.get("", ())}
    found: dict[str, str] = {}
    for node, robot in missing.items():
        plain = ownership.without_robot(node, robot)
        space = spaces.get(_letters(robot), robot)
        likely = (plain, f"/{plain.rpartition('/')[2]}", f"/{space}{plain}")
        own = {ownership.without_robot(it, robot): it for it in by_robot.get(robot, ())}
        there = next((it for it in likely if it in others), "")
        if match := there or own.get(similar(plain, own), ""):
            found[node] = match
    return found


def _letters(name: str) -> str:
    """Its letters and digits in lower case."""
    return "".join(filter(str.isalnum, name)).lower()


def similar(name: str, known: Collection[str]) -> str:
    """The known name that extends ``name``, is its beginning or is nearly the same; or ""."""
    if len(known) > MOST_CANDIDATES:
        return ""
    extended = [other for other in known if other.startswith(name) or name.startswith(other)]
    if extended:
        return min(extended, key=lambda other: abs(len(other) - len(name)))
    return nearest(name, known, MISTYPED)
