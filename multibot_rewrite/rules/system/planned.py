# SPDX-License-Identifier: Apache-2.0
"""Where a plan and what is seen beside it differ: the look-ups that several rules need."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence, Set

from multibot_rewrite.rules.system.similar_names import probable_matches
from multibot_rewrite.system.index import EndKey, Index, once
from multibot_rewrite.system.records import End


@once
def missing(plan: Index, seen: Index) -> Mapping[EndKey, End]:
    """The planned ends that are not there."""
    there = seen.by_key
    return {key: end for key, end in plan.by_key.items() if key not in there}


@once
def unplanned_ends(plan: Index, seen: Index) -> Mapping[str, Sequence[End]]:
    """By node: the ends that are not planned, each once, without hidden ones."""
    found: dict[str, list[End]] = defaultdict(list)
    known = set(plan.by_key)
    for end in seen.system.ends:
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
