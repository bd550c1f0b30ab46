"""``multibot plan --form``: what every node of every robot must be remapped to."""

from __future__ import annotations

import argparse
from collections.abc import Iterator

from multibot_rewrite.base.releases import facts_of_release
from multibot_rewrite.cli.output import deliver, note
from multibot_rewrite.cli.tables import Grid, deliver_report
from multibot_rewrite.fleet.fleet import NO_STATE_PUBLISHER, Fleet
from multibot_rewrite.spelling.bridged_topics import as_yaml, bridged_topics
from multibot_rewrite.spelling.records import Table
from multibot_rewrite.spelling.table_formats import FORMS, given_to, standing_by_robot

TABLE, BRIDGE = "table", "bridge"


def deliver_rules(options: argparse.Namespace, made: Fleet) -> None:
    """Write the rules in the form that is asked for."""
    _note_without_nodes(options, made)
    if options.form == TABLE:
        deliver_report(options, _parts(made.table))
    elif options.form == BRIDGE:
        deliver(options, _bridge(options, made).encode())
    else:
        deliver(options, FORMS[options.form](made.table).encode())


def _note_without_nodes(options: argparse.Namespace, made: Fleet) -> None:
    known = {node.robot for node in made.table.nodes}
    nothing = [robot for robot in made.inventories if robot not in known]
    if nothing:
        hint = f"name a stack of its nodes, or leave out {NO_STATE_PUBLISHER}"
        note(options, f"no node of {', '.join(nothing)} is known, so no rule is for it; {hint}")


def _bridge(options: argparse.Namespace, made: Fleet) -> str:
    carried, left = bridged_topics(made.inventories, made.naming)
    for item in left:
        message = f"line {item.line}: {item.what} has no topic, its default depends on the world"
        note(options, f"{item.robot}: warning: {message} (write the element)")
    return as_yaml(carried)


def _parts(table: Table) -> Iterator[str | Grid]:
    yield f"layout {table.layout}{facts_of_release(table.release)}"
    rows = [
        (robot, it.node.node, it.node.full_name, text, given_to(it))
        for robot, given in standing_by_robot(table)
        for it in given
        for text in ([f"{source} -> {target}" for source, target in it.rules] or ["no rule"])
    ]
    yield Grid(("robot", "node", "runs as", "rule", "given to"), rows)
