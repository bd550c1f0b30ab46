# SPDX-License-Identifier: Apache-2.0
"""``multibot rehearse``: the plan of a fleet tried on a real graph, without robot or simulator."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

from multibot_rewrite.base.wording import SEVERAL, plural, shorten
from multibot_rewrite.cli import fleet, live, pictures
from multibot_rewrite.cli.check import conclude
from multibot_rewrite.cli.declared.fleet import EVERY_WAY
from multibot_rewrite.cli.output import note, shown, write_files
from multibot_rewrite.cli.walk import check_folder, check_target
from multibot_rewrite.fleet.fleet import Fleet, expected
from multibot_rewrite.live.rehearsal import bridge_stub, stub_nodes, with_substitutes
from multibot_rewrite.live.staged import stage, staged
from multibot_rewrite.spelling.transforms import Edges, with_odometry
from multibot_rewrite.spelling.ways import WAYS
from multibot_rewrite.system.json import to_json
from multibot_rewrite.system.records import System


def run(options: argparse.Namespace) -> int:
    """Start the stubs, look, compare, sum up; returns the exit code."""
    _check_use(options)
    made = fleet.build(options)
    # Nodes that stand in for others have none of their parameters.
    plan, table = expected(made)._replace(parameters=()), fleet.findings(options, made)
    edges, added = _edges(made)
    nodes = [*stub_nodes(made.table, edges, _left_out(options)), *bridge_stub(plan.topics)]
    environ = stage(options.domain)
    note(options, f"{plural(len(nodes), 'node')} in domain {environ['ROS_DOMAIN_ID']}")
    with shown("they start, and are looked for"):
        seen, replaced = staged(nodes, environ, options.timeout or live.LOOK_SECONDS)
    for it in added:
        note(options, f"note: {it} comes from a driver or simulator; the rehearsal sends it")
    graph, plan = _without_places(seen), with_substitutes(plan, replaced)
    if options.save_snapshot:
        write_files(options, [(options.save_snapshot, to_json(graph))])
    _note_substitutes(options, replaced)
    return conclude(options, plan, graph, table)


def _left_out(options: argparse.Namespace) -> Sequence[str]:
    """The ways of which no rules are given."""
    return WAYS if EVERY_WAY in options.without_rules else list(options.without_rules)


def _check_use(options: argparse.Namespace) -> None:
    fleet.check_use(options, printed=False)
    pictures.check(options)
    if options.save_snapshot:
        check_target(options.save_snapshot, [options.input], "--save-snapshot")
        check_folder(options.save_snapshot)


def _without_places(graph: System) -> System:
    """Stubs send which frame hangs on which, not where, and all with one quality of service."""
    ends = tuple(it._replace(qos=None) for it in graph.ends)
    return graph._replace(ends=ends, edges=tuple(it._replace(transform=()) for it in graph.edges))


def _edges(made: Fleet) -> tuple[Edges, list[str]]:
    """What is sent, and which of it no node of the stacks sends: the odometry of a driver."""
    edges, names = made.edges, []
    for robot in made.inventories:
        edges, added = with_odometry(edges, robot, made.naming)
        if added:
            names.append(f"{added} of {robot}")
    return edges, names


def _note_substitutes(options: argparse.Namespace, replaced: dict[str, str]) -> None:
    if replaced:
        what = "type is" if len(replaced) == 1 else "types are"
        types = shorten(sorted(replaced), SEVERAL)
        text = f"{len(replaced)} {what} not installed here and replaced by others: {types}"
        note(options, f"note: {text}; this does not change the names")
