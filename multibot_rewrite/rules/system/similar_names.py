# SPDX-License-Identifier: Apache-2.0
"""What was probably meant: similar names, and running nodes that are probably a missing one."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Mapping, Sequence

from multibot_rewrite.base.nearest import MISTYPED, nearest
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.system.ownership import NameOwnership

# With more names than these, some name is always similar.
MOST_CANDIDATES = 50


def similar(name: str, known: Collection[str]) -> str:
    """The known name that extends ``name``, is its beginning or is nearly the same; or ""."""
    if len(known) > MOST_CANDIDATES:
        return ""
    extended = [other for other in known if other.startswith(name) or name.startswith(other)]
    if extended:
        return min(extended, key=lambda other: abs(len(other) - len(name)))
    return nearest(name, known, MISTYPED)


class _Candidates(NamedTuple):
    """Running nodes that are not in the plan.

    ``all`` has tools too, ``by_robot`` has none. ``namespaces`` are the first namespaces of nodes
    that belong to no robot, by their letters and digits in lower case.
    """

    all: frozenset[str]
    by_robot: Mapping[str, Sequence[str]]
    namespaces: Mapping[str, str]


def probable_matches(
    missing: Mapping[str, str],
    others: Iterable[str],
    unplanned: Iterable[str],
    ownership: NameOwnership,
) -> dict[str, str]:
    """The running node that each missing node (node -> robot) probably is, where there is one.

    ``others`` are all running nodes that are not in the plan, ``unplanned`` those of them that are
    no tools: only these are compared by similar name.
    """
    if not missing:
        return {}
    by_robot: dict[str, list[str]] = defaultdict(list)
    for node in unplanned:
        by_robot[ownership.robot(node)].append(node)
    namespaces = {_normalized(node.split("/")[1]): node.split("/")[1] for node in by_robot[""]}
    candidates = _Candidates(frozenset(others), by_robot, namespaces)
    found = {node: _match(node, robot, candidates, ownership) for node, robot in missing.items()}
    return {node: other for node, other in found.items() if other}


def _normalized(name: str) -> str:
    return "".join(filter(str.isalnum, name)).lower()


def _match(node: str, robot: str, candidates: _Candidates, ownership: NameOwnership) -> str:
    plain = ownership.without_robot(node, robot)
    namespace = candidates.namespaces.get(_normalized(robot), robot)
    for likely in (plain, f"/{plain.rpartition('/')[2]}", f"/{namespace}{plain}"):
        if likely in candidates.all:
            return likely
    running = candidates.by_robot.get(robot, ())
    own = {ownership.without_robot(other, robot): other for other in running}
    return own.get(similar(plain, own), "")
