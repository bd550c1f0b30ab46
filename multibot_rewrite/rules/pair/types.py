# SPDX-License-Identifier: Apache-2.0
"""By a plan: which side of a name has the wrong type."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Set

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.rules.declaration import found_by_plan
from multibot_rewrite.rules.pair.causes import caused, plugin_of
from multibot_rewrite.rules.system.matching import STAMPED, types_differ
from multibot_rewrite.system.index import Index, once
from multibot_rewrite.system.records import SUBSCRIBES, End


@found_by_plan(types_differ, nodes=False)
def type_not_planned(plan: Index, seen: Index) -> Iterator[Finding]:
    """Each end of a planned name whose type is none that the plan has; a tool reads what is there."""
    said, planned = set(), plan.by_key
    for end in seen.system.ends:
        known = planned.get((end.node, end.kind, end.role, end.name))
        if not end.type or (known and known.type == end.type):
            continue
        by_name = _types(plan).get((end.kind, end.name), frozenset())
        wanted = {known.type, *known.also} if known and known.type else by_name
        looks = end.role == SUBSCRIBES and seen.is_tool(end.node)
        differs = wanted and end.type not in wanted and not looks
        if differs and (end.node, end.name, end.type) not in said:
            said.add((end.node, end.name, end.type))
            yield _not_as_planned(plan, seen, end, wanted)


@once
def _types(plan: Index) -> Mapping[tuple[str, str], Set[str]]:
    """Those of each planned name, where they are known."""
    found: dict[tuple[str, str], set[str]] = defaultdict(set)
    for end in plan.by_key.values():
        found[end.kind, end.name] |= {end.type, *end.also} - {""}
    return found


def _not_as_planned(plan: Index, seen: Index, end: End, wanted: Set[str]) -> Finding:
    listed = " or ".join(sorted(wanted))
    plugin, place = plugin_of(plan, end.node)
    which = f"another version or setting of {plugin or 'the node'}"
    see = f", see {place}" if place else ""
    stamped = {f"{it}{STAMPED}" for it in wanted} | {it.removesuffix(STAMPED) for it in wanted}
    if end.type in stamped:
        which = "enable_stamped_cmd_vel, use_stamped_vel or stamped is set on one side"
    cause = caused(f"{which}{see}? If this type is right, correct the plan", place)
    robot = plan.robot_of.get(end.node) or seen.robot(end.name)
    return types_differ.finding(
        f"uses {end.name} as {end.type}, but the plan has it as {listed}",
        **cause._asdict(),
        robot=robot,
        node=end.node if end.node in seen.nodes else "",
        names=(end.name,),
    )
