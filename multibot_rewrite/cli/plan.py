"""``multibot plan``: what the graph of a fleet should look like, and the rules that make it so."""

from __future__ import annotations

import argparse
import re

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.releases import release_here
from multibot_rewrite.cli import check_launch, fleet
from multibot_rewrite.cli.output import deliver, goes_to_file, say
from multibot_rewrite.cli.process import DONE, PROGRAM, STOPPED
from multibot_rewrite.cli.remap import deliver_rules
from multibot_rewrite.cli.usage import given_options
from multibot_rewrite.cli.walk import check_folder, check_target
from multibot_rewrite.fleet.fleet import expected, possible
from multibot_rewrite.live.diagnose import diagnose
from multibot_rewrite.live.seen_plan import seen_plan
from multibot_rewrite.rules.check import doubts
from multibot_rewrite.spelling.enclaves import to_policy
from multibot_rewrite.spelling.plan_file import to_json, to_yaml
from multibot_rewrite.system.records import System

PLAN, POLICY = "plan", "sros2"
# What a plan of a description has, and that of a launch file has not.
NOT_OF_LAUNCH = {
    **{it: f"--{it}" for it in ("robots", "stack", "launch", "layout", "affix", "topics")},
    "shared_frames": "--shared-frames",
    "shared_topics": "--shared-topics",
}
# A launch file is told by its name: no description or fleet file is called so.
_LAUNCH = re.compile(r".*(\.py|[._]launch(\.\w+)?|system_model\.yaml)")


def run(options: argparse.Namespace) -> int:
    """Make the plan and write what is asked for of it; returns the exit code."""
    if any(map(_LAUNCH.fullmatch, [options.input, *options.words[:1]])):
        return _of_launch(options)
    fleet.check_use(options, printed=not goes_to_file(options))
    made = fleet.build(options)
    failed = fleet.report_table(options, made)
    if options.form == PLAN:
        _write(options, expected(made))
    elif options.form == POLICY:
        deliver(options, to_policy(expected(made), possible(made)).encode())
    else:
        deliver_rules(options, made)
    return STOPPED if failed else DONE


def _write(options: argparse.Namespace, plan: System) -> None:
    write = to_json if (options.output or "").endswith(".json") else to_yaml
    deliver(options, write(plan).encode())


def _of_launch(options: argparse.Namespace) -> int:
    """The plan of what a launch file starts; what is not known of it is said."""
    given = given_options(options, NOT_OF_LAUNCH)
    if given or options.form != PLAN:
        what = given[0] if given else "--form"
        raise UsageError(f"{options.input}: a launch file says what runs, leave out {what}")
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
    _write(options, seen_plan(seen)._replace(release=release_here(options.distro)))
    return DONE
