"""``multibot plan``: what the graph of a fleet should look like, as a file for ``multibot check``."""

from __future__ import annotations

import argparse

from multibot_rewrite.cli import fleet
from multibot_rewrite.cli.output import deliver, goes_to_file, write_files
from multibot_rewrite.cli.process import DONE, STOPPED
from multibot_rewrite.cli.walk import check_folder, check_target
from multibot_rewrite.fleets.fleet import expected, possible
from multibot_rewrite.graph.enclaves import to_policy
from multibot_rewrite.graph.plan_file import to_json, to_yaml


def run(options: argparse.Namespace) -> int:
    """Make the plan and write it; returns the exit code."""
    fleet.check_use(options, printed=not goes_to_file(options))
    if options.sros2:
        check_target(options.sros2, list(filter(None, [options.input, options.output])), "--sros2")
        check_folder(options.sros2)
    made = fleet.build(options)
    failed = fleet.report_table(options, made)
    write = to_json if (options.output or "").endswith(".json") else to_yaml
    plan = expected(made)
    deliver(options, write(plan).encode())
    if options.sros2:
        write_files(options, [(options.sros2, to_policy(plan, possible(made)).encode())])
    return STOPPED if failed else DONE
