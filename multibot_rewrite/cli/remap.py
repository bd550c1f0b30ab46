"""``multibot remap``: what every node of every robot must be remapped to."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from typing import Any

from multibot_rewrite.cli.files import write_all
from multibot_rewrite.cli.output import print_bytes, say
from multibot_rewrite.cli.process import DONE, PROGRAM, STOPPED
from multibot_rewrite.cli.tables import Grid, print_report
from multibot_rewrite.cli.walk import check_target
from multibot_rewrite.config import configured_vocabulary
from multibot_rewrite.library import builtin_tree, rewrite_all
from multibot_rewrite.model import ERROR
from multibot_rewrite.naming import LAYOUTS, SHARED_TOPICS, Naming, make_naming
from multibot_rewrite.remap.bridge import as_yaml, bridge
from multibot_rewrite.remap.forms import EVERY_ROBOT, FORMS
from multibot_rewrite.remap.plugins import plugin_nodes
from multibot_rewrite.remap.records import Table
from multibot_rewrite.remap.stacks import load_stack
from multibot_rewrite.remap.table import build_table
from multibot_rewrite.rewriting.collect import Inventory, collect
from multibot_rewrite.rewriting.document import read_document

BRIDGE = "bridge"
ABOUT = "what every node of every robot must be remapped to"
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
    parser.add_argument("input", metavar="INPUT", help="the robot's description, not rewritten")
    parser.add_argument("robots", nargs="+", metavar="ROBOT", help="names of the robots")
    parser.add_argument(
        "--stack", action="append", default=[], metavar="NAME", help="nodes that every robot runs"
    )
    names = ", ".join(f"{layout.name} ({layout.short})" for layout in LAYOUTS)
    parser.add_argument("--layout", default="postfix", metavar="NAME", help=f"one of {names}")
    parser.add_argument("--affix", default="postfix", metavar="SIDE", help="postfix or prefix")
    parser.add_argument("--topics", metavar="HOW", help="postfix, prefix or namespace")
    parser.add_argument(
        "--shared-topics",
        default=",".join(SHARED_TOPICS),
        metavar="A,B",
        help="default: %(default)s",
    )
    parser.add_argument(
        "--format", metavar="FORM", choices=("table", *FORMS, BRIDGE), default="table",
        help=f"table (default), {', '.join(FORMS)}, or {BRIDGE} (ros_gz_bridge)",
    )  # fmt: skip
    parser.add_argument("-o", "--output", metavar="FILE", help="write it there")


def run(options: argparse.Namespace) -> int:
    """Build the table, say what is wrong with it, print it."""
    if options.output:
        check_target(options.output, [options.input], "--output")
    nodes = [node for stack in options.stack for node in load_stack(stack)]
    naming = make_naming(**_policy(options), shared_topics=options.shared_topics.split(","))
    inventories = _rewritten(options)
    plugins = {robot: list(plugin_nodes(found, robot)) for robot, found in inventories.items()}
    table = build_table(options.robots, list(dict.fromkeys(nodes)), naming, plugins)
    for problem in table.problems:
        where = f"{problem.robot}: {problem.node}" if problem.robot else problem.node
        hint = f" ({problem.hint})" if problem.hint else ""
        say(f"{where}: {problem.level}: {problem.code} {problem.message}{hint}", PROGRAM)
    if options.format == "table":
        print_report(_parts(table))
    elif options.format == BRIDGE:
        _write(options, _bridge(inventories, naming))
    else:
        _write(options, FORMS[options.format](table))
    return STOPPED if any(problem.level == ERROR for problem in table.problems) else DONE


def _policy(options: argparse.Namespace) -> dict[str, Any]:
    return {"layout": options.layout, "affix": options.affix, "topics": options.topics}


def _rewritten(options: argparse.Namespace) -> dict[str, Inventory]:
    """What each robot's rewritten description holds."""
    vocabulary = configured_vocabulary(options.input)
    shared = options.shared_topics.split(",")
    more = {"shared_topics": shared, "vocabulary": vocabulary, **_policy(options)}
    tree = builtin_tree(vocabulary)
    return {
        one.robot: collect(read_document(one.data, options.input), tree)
        for one in rewrite_all(options.input, options.robots, **more)
    }


def _bridge(inventories: dict[str, Inventory], naming: Naming) -> str:
    carried, left = bridge(inventories, naming)
    for item in left:
        message = f"line {item.line}: {item.what} has no topic, its default hangs on the world"
        say(f"{item.robot}: warning: {message} (write the element)", PROGRAM)
    return as_yaml(carried)


def _write(options: argparse.Namespace, text: str) -> None:
    if not options.output:
        print_bytes(text.encode())
        return
    write_all([(options.output, text.encode())])


def _parts(table: Table) -> Iterator[str | Grid]:
    yield f"layout {table.layout}"
    rows = [
        (node.robot or EVERY_ROBOT, node.node, f"{node.namespace.rstrip('/')}/{node.name}", text)
        for node in table.nodes
        for text in ([f"{rule.source} -> {rule.target}" for rule in node.rules] or ["no rule"])
    ]
    yield Grid(("robot", "node", "runs as", "rule"), rows)
