"""``multibot plan``: what the graph of a fleet should look like, as a file for ``multibot check``."""

from __future__ import annotations

import argparse

from multibot_rewrite.cli import check_launch, fleet
from multibot_rewrite.cli.output import deliver, goes_to_file, say, write_files
from multibot_rewrite.cli.process import DONE, PROGRAM, STOPPED
from multibot_rewrite.cli.usage import given_options
from multibot_rewrite.cli.walk import check_folder, check_target
from multibot_rewrite.fleets.fleet import expected, possible
from multibot_rewrite.graph.enclaves import to_policy
from multibot_rewrite.graph.plan_file import to_json, to_yaml
from multibot_rewrite.live.diagnose import diagnose
from multibot_rewrite.live.seen_plan import seen_plan
from multibot_rewrite.model import UsageError
from multibot_rewrite.releases import release_here
from multibot_rewrite.rules.check import doubts

# What a plan of a description has, and that of a launch file has not.
NOT_OF_LAUNCH = {
    **{it: f"--{it}" for it in ("robots", "stack", "launch", "layout", "affix", "topics", "sros2")},
    "shared_frames": "--shared-frames",
    "shared_topics": "--shared-topics",
}


def run(options: argparse.Namespace) -> int:
    """Make the plan and write it; returns the exit code."""
    if options.from_launch:
        return _from_launch(options)
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


def _from_launch(options: argparse.Namespace) -> int:
    """The plan of what a launch file starts; what is not known of it is said."""
    given = given_options(options, NOT_OF_LAUNCH)
    if given:
        raise UsageError(f"--from-launch: the launch file says what runs, leave out {given[0]}")
    order = check_launch.order_of(options, [options.input, *options.words])
    if options.output:
        check_target(options.output, [order.file])
        check_folder(options.output)
    made = check_launch.graph_of(options, order)
    seen = diagnose(made)
    if not seen.robots:
        raise UsageError(
            f"{order.file}: no name of a robot is in what it starts, so there is no plan"
        )
    for caveat in doubts(made):
        say(f"incomplete: {caveat.message}", PROGRAM)
    write = to_json if (options.output or "").endswith(".json") else to_yaml
    deliver(options, write(seen_plan(seen)._replace(release=release_here(options.distro))).encode())
    return DONE
