"""``multibot plan``: what the graph of a fleet is to look like, as a file for ``multibot check``."""

from __future__ import annotations

import argparse

from multibot_rewrite.cli import fleet
from multibot_rewrite.fleets.fleet import expected
from multibot_rewrite.graph.plan_file import to_yaml

MORE = """\
examples:
  multibot plan rover.urdf robot1 robot2 --stack nav2 --layout frames-per-robot -o plan.yaml
exit codes: 0 done; 1 two robots would share a name; 2 wrong use or unreadable input
"""


def options(parser: argparse.ArgumentParser) -> None:
    """Add the options of the command."""
    parser.epilog = MORE
    fleet.options(parser)


def run(options: argparse.Namespace) -> int:
    """Make the plan and write it."""
    made = fleet.build(options)
    fleet.deliver(options, to_yaml(expected(made)))
    return fleet.verdict(made)
