"""``multibot remap``: what every node of every robot must be remapped to."""

from __future__ import annotations

import argparse
from collections.abc import Iterator

from multibot_rewrite.cli import fleet
from multibot_rewrite.cli.output import say
from multibot_rewrite.cli.process import PROGRAM
from multibot_rewrite.cli.tables import Grid, print_report
from multibot_rewrite.fleets.fleet import Fleet
from multibot_rewrite.remap.bridged_topics import as_yaml, bridged_topics
from multibot_rewrite.remap.records import Table
from multibot_rewrite.remap.table_formats import EVERY_ROBOT, FORMS

BRIDGE = "bridge"
MORE = """\
examples:
  multibot remap rover.urdf robot1 robot2 --stack nav2 --layout frames-per-robot
  multibot remap rover.urdf robot1 --stack nav2 --stack slam_toolbox --format ros-args
  multibot remap rover.urdf robot1 robot2 --stack teleop --format launch -o remaps.py
exit codes: 0 done; 1 a rule is wrong, or two robots would share a name; 2 wrong use or unreadable input
"""


def options(parser: argparse.ArgumentParser) -> None:
    """Add the options of the command."""
    parser.epilog = MORE
    fleet.options(parser)
    parser.add_argument(
        "--format", metavar="FORM", choices=("table", *FORMS, BRIDGE), default="table",
        help=f"table (default), {', '.join(FORMS)}, or {BRIDGE} (ros_gz_bridge)",
    )  # fmt: skip


def run(options: argparse.Namespace) -> int:
    """Build the table, say what is wrong with it, print it."""
    made = fleet.build(options)
    if options.format == "table":
        print_report(_parts(made.table))
    elif options.format == BRIDGE:
        fleet.deliver(options, _bridge(made))
    else:
        fleet.deliver(options, FORMS[options.format](made.table))
    return fleet.verdict(made)


def _bridge(made: Fleet) -> str:
    carried, left = bridged_topics(made.inventories, made.naming)
    for item in left:
        message = f"line {item.line}: {item.what} has no topic, its default hangs on the world"
        say(f"{item.robot}: warning: {message} (write the element)", PROGRAM)
    return as_yaml(carried)


def _parts(table: Table) -> Iterator[str | Grid]:
    yield f"layout {table.layout}"
    rows = [
        (node.robot or EVERY_ROBOT, node.node, f"{node.namespace.rstrip('/')}/{node.name}", text)
        for node in table.nodes
        for text in ([f"{rule.source} -> {rule.target}" for rule in node.rules] or ["no rule"])
    ]
    yield Grid(("robot", "node", "runs as", "rule"), rows)
