# SPDX-License-Identifier: Apache-2.0
"""``multibot rehearse``: the plan of a fleet tried on a real graph, without robot or simulator."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial

from multibot_rewrite.base.wording import SEVERAL, plural, shorten
from multibot_rewrite.cli import fleet, live, pictures
from multibot_rewrite.cli.check import conclude
from multibot_rewrite.cli.output import note, shown, write_files
from multibot_rewrite.cli.report import chosen
from multibot_rewrite.cli.walk import check_folder, check_target
from multibot_rewrite.fleet.fleet import expected
from multibot_rewrite.live.rehearsal import (
    Stub,
    bridge_stub,
    domain_bridge_stubs,
    graph_of_stubs,
    isolated_environments,
    stub_nodes,
    with_own_types,
    with_substitutes,
    without_doubles,
)
from multibot_rewrite.planning.transforms import with_odometry
from multibot_rewrite.rules.check import check, check_domains
from multibot_rewrite.system.domains import by_domain, domain_of, side_by_side
from multibot_rewrite.system.json import to_json
from multibot_rewrite.system.records import WAYS, System

# Where a plan is of one domain, its number is none of a system.
ONE = -1


def run(options: argparse.Namespace) -> int:
    """Start the stubs, look, compare, sum up; returns the exit code."""
    fleet.check_use(options, "rehearse", printed=False)
    pictures.check(options)
    if options.save_snapshot:
        check_target(options.save_snapshot, [options.input], "--save-snapshot")
        check_folder(options.save_snapshot)
    made = fleet.build(options)
    # Nodes that stand in for others have none of their parameters.
    plan, table = expected(made)._replace(parameters=()), chosen(options, made.table.problems)
    edges, added = made.edges, []
    for robot in made.inventories:
        # What no node of the node sets sends: the odometry of a driver.
        edges, own = with_odometry(edges, robot, made.naming)
        added += [f"{own} of {made.name(robot)}"] if own else []
    ways = WAYS if "all" in options.without_rules else list(options.without_rules)
    nodes = [
        (run._replace(robot=made.name(run.robot)), sent)
        for run, sent in without_doubles(stub_nodes(made.table, edges, ways), plan)
    ]
    seen, replaced = _play(options, plan, nodes)
    for it in added:
        note(options, f"note: {it} comes from a driver or simulator; the rehearsal sends it")
    seen = {it: with_own_types(graph, plan, replaced) for it, graph in seen.items()}
    plan = with_own_types(with_substitutes(plan, replaced), plan, replaced)
    if any(it.bridge for it in plan.topics):
        note(options, "note: no simulator runs: the rehearsal has what its bridge brings")
    graph = side_by_side(seen) if plan.domains else seen[ONE]
    if options.save_snapshot:
        write_files(options, [(options.save_snapshot, to_json(graph))])
    _note_substitutes(options, replaced)
    found = check_domains(plan, seen) if plan.domains else check(plan, graph)
    return conclude(options, plan, graph, found, table)


def _play(
    options: argparse.Namespace, plan: System, nodes: Sequence[Stub]
) -> tuple[dict[int, System], dict[str, str]]:
    """Play the stubs; return the graph by domain of the plan, and by missing type its substitute."""
    # The domains they are played in are free ones of this machine.
    parts, numbers = by_domain(plan) or {ONE: plan}, domain_of(plan)
    environs = isolated_environments(options.domain, len(parts))
    casts = {
        it: [
            *(stub for stub in nodes if numbers.get(stub[0].robot, ONE) == it),
            *bridge_stub(part.topics),
            *domain_bridge_stubs(part),
        ]
        for it, part in parts.items()
    }
    where = ", ".join(it["ROS_DOMAIN_ID"] for it in environs)
    count = plural(sum(map(len, casts.values())), "node")
    started = f"{count} in domain{'s' * (len(environs) > 1)} {where}"
    play = partial(graph_of_stubs, seconds=options.timeout or live.LOOK_SECONDS)
    with shown(f"{started} are looked for"), ThreadPoolExecutor(len(parts)) as pool:
        played = dict(zip(parts, pool.map(play, casts.values(), environs), strict=True))
    note(options, started)
    replaced = {old: new for _, own in played.values() for old, new in own.items()}
    return {it: _without_places(seen) for it, (seen, _) in played.items()}, replaced


def _without_places(graph: System) -> System:
    """Return the graph without places and QoS: stubs send which frame is below which, and one QoS."""
    ends = tuple(it._replace(qos=None) for it in graph.ends)
    return graph._replace(ends=ends, edges=tuple(it._replace(transform=()) for it in graph.edges))


def _note_substitutes(options: argparse.Namespace, replaced: dict[str, str]) -> None:
    if replaced:
        what = "type is" if len(replaced) == 1 else "types are"
        types = shorten(sorted(replaced), SEVERAL)
        text = f"{len(replaced)} {what} not installed here and replaced by others: {types}"
        note(options, f"note: {text}; this does not change the names")
