"""What the commands about a fleet have in common: its options, its table, its problems."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Sequence

from multibot_rewrite.cli.files import write_all
from multibot_rewrite.cli.output import print_bytes, say
from multibot_rewrite.cli.process import DONE, PROGRAM, STOPPED
from multibot_rewrite.cli.walk import check_target
from multibot_rewrite.config import configured_vocabulary
from multibot_rewrite.fleets.fleet import Fleet, make_fleet
from multibot_rewrite.model import ERROR, Finding, UsageError
from multibot_rewrite.naming import DEFAULT_LAYOUT, LAYOUTS, SHARED_TOPICS, Policy

FLEET_FILES = (".yaml", ".yml")
USUAL = {"layout": DEFAULT_LAYOUT, "affix": "postfix", "shared_topics": ",".join(SHARED_TOPICS)}


def options(parser: argparse.ArgumentParser) -> None:
    """Add the options that say which robots, nodes and layout."""
    names = ", ".join(f"{layout.name} ({layout.short})" for layout in LAYOUTS)
    shared = ",".join(SHARED_TOPICS)
    help_ = "the robot's description, not rewritten; or a fleet file (*.yaml), which says the rest"
    parser.add_argument("input", metavar="INPUT", help=help_)
    parser.add_argument(
        "robots", nargs="*", metavar="ROBOT", help="names of the robots; NAME:=VALUE is for xacro"
    )
    parser.add_argument(
        "--stack", action="append", default=[], metavar="NAME", help="nodes that every robot runs"
    )
    parser.add_argument("--nodes", metavar="FILE", help="nodes and stacks of your own, as YAML")
    parser.add_argument("--layout", default=DEFAULT_LAYOUT, metavar="NAME", help=f"one of {names}")
    parser.add_argument("--affix", default="postfix", metavar="SIDE", help="postfix or prefix")
    parser.add_argument("--topics", metavar="HOW", help="postfix, prefix or namespace")
    parser.add_argument("-o", "--output", metavar="FILE", help="write it there")
    parser.add_argument(
        "--shared-topics", default=shared, metavar="A,B", help="default: %(default)s"
    )


def build(options: argparse.Namespace, also: Sequence[str] = ()) -> Fleet:
    """Make the fleet that the options describe and say what is wrong with its table.

    ``also`` are nodes that every robot runs, too.
    """
    if options.output:
        check_target(options.output, [options.input], "--output")
    if options.input.endswith(FLEET_FILES):
        made = _from_file(options, also)
    else:
        made = _from_words(options, also)
    _tell(made.table.problems)
    return made


def _from_file(options: argparse.Namespace, also: Sequence[str]) -> Fleet:
    from multibot_rewrite.fleets.fleet_file import read_fleet  # one description needs none of it
    from multibot_rewrite.fleets.fleet_plan import plan_fleet
    from multibot_rewrite.fleets.with_start_pose_nodes import with_start_pose_nodes

    given = [name for name in ("robots", "stack", "nodes", "topics") if getattr(options, name)]
    given += [name for name, usual in USUAL.items() if getattr(options, name) != usual]
    if given:
        raise UsageError(f"{options.input} says which {given[0]} there are: leave that out")
    return with_start_pose_nodes(plan_fleet(read_fleet(options.input), also))


def _from_words(options: argparse.Namespace, also: Sequence[str]) -> Fleet:
    robots = [word for word in options.robots if ":=" not in word]
    if not robots:
        raise UsageError("no ROBOT given, and the input is no fleet file (*.yaml)")
    arguments = [word for word in options.robots if ":=" in word]
    return make_fleet(
        options.input,
        robots,
        [*options.stack, *also],
        _policy(options),
        nodes=options.nodes,
        vocabulary=configured_vocabulary(options.input),
        xacro_args=dict(word.split(":=", 1) for word in arguments),
    )


def _policy(options: argparse.Namespace) -> Policy:
    return {
        "layout": options.layout,
        "affix": options.affix,
        "topics": options.topics,
        "shared_topics": options.shared_topics.split(","),
    }


def deliver(options: argparse.Namespace, text: str) -> None:
    """Write what was made where the options say."""
    if options.output:
        write_all([(options.output, text.encode())])
    else:
        print_bytes(text.encode())


def verdict(made: Fleet) -> int:
    """The exit code: did the table have an error?"""
    return STOPPED if any(problem.level == ERROR for problem in made.table.problems) else DONE


def _tell(problems: Iterable[Finding]) -> None:
    for problem in problems:
        say(str(problem), PROGRAM)
