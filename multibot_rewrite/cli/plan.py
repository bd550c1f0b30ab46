"""``multibot plan``: what the graph of a fleet is to look like, as a file for ``multibot check``."""

from __future__ import annotations

import argparse

from multibot_rewrite.cli import fleet
from multibot_rewrite.cli.files import write_all
from multibot_rewrite.cli.output import print_bytes
from multibot_rewrite.cli.process import DONE, STOPPED
from multibot_rewrite.cli.walk import check_target
from multibot_rewrite.graph.expectation import expect
from multibot_rewrite.graph.plan_file import to_yaml
from multibot_rewrite.model import ERROR

ABOUT = "what the graph of a fleet is to look like"
MORE = """\
examples:
  multibot plan rover.urdf robot1 robot2 --stack nav2 --layout frames-per-robot -o plan.yaml
exit codes: 0 done; 1 two robots would share a name; 2 wrong use or unreadable input
"""


def options(parser: argparse.ArgumentParser) -> None:
    """Add the options of the command."""
    parser.epilog = MORE
    fleet.options(parser)
    parser.add_argument("-o", "--output", metavar="FILE", help="write it there")


def run(options: argparse.Namespace) -> int:
    """Make the plan and write it."""
    if options.output:
        check_target(options.output, [options.input], "--output")
    made = fleet.build(options)
    fleet.tell(made.table.problems)
    frames = {
        robot: [*found.declared["link"], *found.declared["frame"]]
        for robot, found in made.inventories.items()
    }
    data = to_yaml(expect(made.table, made.naming, frames)).encode()
    if options.output:
        write_all([(options.output, data)])
    else:
        print_bytes(data)
    return STOPPED if any(p.level == ERROR for p in made.table.problems) else DONE
