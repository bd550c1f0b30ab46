"""``multibot plan``: what the graph of a fleet should look like, as a file for ``multibot check``."""

from __future__ import annotations

import argparse

from multibot_rewrite.cli import fleet
from multibot_rewrite.cli.output import deliver, goes_to_file
from multibot_rewrite.cli.process import DONE, STOPPED
from multibot_rewrite.fleets.fleet import expected
from multibot_rewrite.graph.plan_file import to_json, to_yaml


def run(options: argparse.Namespace) -> int:
    """Make the plan and write it; returns the exit code."""
    fleet.check_use(options, printed=not goes_to_file(options))
    made = fleet.build(options)
    failed = fleet.report_table(options, made)
    write = to_json if (options.output or "").endswith(".json") else to_yaml
    deliver(options, write(expected(made)).encode())
    return STOPPED if failed else DONE
