"""What the commands about a fleet have in common: its options, its table, its problems."""

from __future__ import annotations

import argparse
from collections.abc import Iterable
from typing import Any, NamedTuple

from multibot_rewrite.cli.files import write_all
from multibot_rewrite.cli.output import print_bytes, say
from multibot_rewrite.cli.process import DONE, PROGRAM, STOPPED
from multibot_rewrite.cli.walk import check_target
from multibot_rewrite.config import configured_vocabulary
from multibot_rewrite.graph.expectation import Expectation, expect, named_frames
from multibot_rewrite.graph.transforms import Edge, Edges, edges_of, frames_of
from multibot_rewrite.library import builtin_tree, rewrite_all
from multibot_rewrite.model import ERROR
from multibot_rewrite.naming import LAYOUTS, SHARED_TOPICS, Naming, make_naming
from multibot_rewrite.remap.known import stack_of
from multibot_rewrite.remap.plugins import plugin_nodes, plugin_places
from multibot_rewrite.remap.records import NodeFacts, Problem, Table
from multibot_rewrite.remap.stacks import built_in, user_stack
from multibot_rewrite.remap.table import build_table
from multibot_rewrite.rewriting.collect import Inventory, collect
from multibot_rewrite.rewriting.document import read_document


class Fleet(NamedTuple):
    """A fleet's table, what each robot's rewritten description holds, and the transforms that each
    robot's nodes send. ``facts`` are of the stacks' nodes, ``sources`` where in its description
    (``file:line``) a plugin's node comes from."""

    table: Table
    inventories: dict[str, Inventory]
    naming: Naming
    edges: Edges
    facts: tuple[NodeFacts, ...]
    sources: dict[str, str]


def options(parser: argparse.ArgumentParser) -> None:
    """Add the options that say which robots, nodes and layout."""
    names = ", ".join(f"{layout.name} ({layout.short})" for layout in LAYOUTS)
    shared = ",".join(SHARED_TOPICS)
    parser.add_argument("input", metavar="INPUT", help="the robot's description, not rewritten")
    parser.add_argument("robots", nargs="+", metavar="ROBOT", help="names of the robots")
    parser.add_argument(
        "--stack", action="append", default=[], metavar="NAME", help="nodes that every robot runs"
    )
    parser.add_argument("--nodes", metavar="FILE", help="nodes and stacks of your own, as YAML")
    parser.add_argument("--layout", default="postfix", metavar="NAME", help=f"one of {names}")
    parser.add_argument("--affix", default="postfix", metavar="SIDE", help="postfix or prefix")
    parser.add_argument("--topics", metavar="HOW", help="postfix, prefix or namespace")
    parser.add_argument("-o", "--output", metavar="FILE", help="write it there")
    parser.add_argument(
        "--shared-topics", default=shared, metavar="A,B", help="default: %(default)s"
    )


def build(options: argparse.Namespace, also: str = "") -> Fleet:
    """Rewrite the description for each robot, make the fleet's table and say what is wrong with it.

    ``also`` is a node that every robot runs, too.
    """
    if options.output:
        check_target(options.output, [options.input], "--output")
    policy: dict[str, Any] = {
        "layout": options.layout,
        "affix": options.affix,
        "topics": options.topics,
        "shared_topics": options.shared_topics.split(","),
    }
    library = user_stack(options.nodes) if options.nodes else built_in()
    stacks = [*options.stack, *filter(None, [also])]
    nodes = tuple(dict.fromkeys(node for stack in stacks for node in stack_of(library, stack)))
    naming = make_naming(**policy)
    vocabulary = configured_vocabulary(options.input)
    tree = builtin_tree(vocabulary)
    rewritten = list(rewrite_all(options.input, options.robots, vocabulary=vocabulary, **policy))
    inventories = {
        one.robot: collect(read_document(one.data, options.input), tree) for one in rewritten
    }
    plugins = {robot: list(plugin_nodes(found, robot)) for robot, found in inventories.items()}
    table = build_table(options.robots, nodes, naming, plugins)
    _tell(table.problems)
    edges: dict[tuple[str, str], list[Edge]] = {}
    for robot, found in inventories.items():
        own = [facts for facts, _ in plugins[robot]]
        edges |= edges_of(robot, found, nodes, own, naming)
    places = plugin_places(rewritten[0].template.inventory)
    sources = {
        f"{node.namespace.rstrip('/')}/{node.name}": place
        for found in plugins.values()
        for (_, node), place in zip(found, places, strict=True)
    }
    return Fleet(table, inventories, naming, edges, nodes, sources)


def expected(made: Fleet) -> Expectation:
    """What the graph of the fleet is to look like."""
    frames = {
        robot: frames_of(found, _sent(made, robot), made.naming)
        for robot, found in made.inventories.items()
    }
    named = {robot: named_frames(found) for robot, found in made.inventories.items()}
    return expect(made.table, made.naming, frames, made.facts, named, made.sources)


def _sent(made: Fleet, robot: str) -> list[Edge]:
    return [edge for (owner, _), edges in made.edges.items() if owner == robot for edge in edges]


def deliver(options: argparse.Namespace, text: str) -> None:
    """Write what was made where the options say."""
    if options.output:
        write_all([(options.output, text.encode())])
    else:
        print_bytes(text.encode())


def verdict(made: Fleet) -> int:
    """The exit code: did the table have an error?"""
    return STOPPED if any(problem.level == ERROR for problem in made.table.problems) else DONE


def _tell(problems: Iterable[Problem]) -> None:
    for problem in problems:
        where = f"{problem.robot}: {problem.node}" if problem.robot else problem.node
        hint = f" ({problem.hint})" if problem.hint else ""
        say(f"{where}: {problem.level}: {problem.code} {problem.message}{hint}", PROGRAM)
