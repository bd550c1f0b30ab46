"""``multibot check``: is the running system what was planned?"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from math import inf

from multibot_rewrite.cli import live, pictures
from multibot_rewrite.cli.output import print_lines, say
from multibot_rewrite.cli.process import DONE, PROGRAM, STOPPED
from multibot_rewrite.cli.watch import WORDS, follow
from multibot_rewrite.graph.check import check, doubts
from multibot_rewrite.graph.expectation import Expectation
from multibot_rewrite.graph.live.child import RosUnusable, observe, watch
from multibot_rewrite.graph.live.request import Request
from multibot_rewrite.graph.plan_file import from_yaml
from multibot_rewrite.graph.rules.comparison import GraphFinding
from multibot_rewrite.graph.snapshot import Snapshot, from_json
from multibot_rewrite.graph.watching import Verdict, final, judge
from multibot_rewrite.sources.read import read_file

MORE = """\
examples:
  multibot check plan.yaml                         the graph that runs now
  multibot check plan.yaml --watch                 show every change until Ctrl-C
  multibot check plan.yaml --snapshot graph.json   one that was written before; needs no ROS
exit codes: 0 as planned; 1 something is wrong; 2 wrong use or unreadable input; 3 inconclusive: the
view may be incomplete; 4 rclpy or its RMW is missing or does not start. With --watch it is the
worst that was seen; what was not there yet before everything was does not count
"""
CODES = {Verdict.PLANNED: DONE, Verdict.WRONG: STOPPED, Verdict.INCONCLUSIVE: live.INCONCLUSIVE}


def options(parser: argparse.ArgumentParser) -> None:
    """Add the options of the command."""
    parser.epilog = MORE
    parser.add_argument("plan", metavar="PLAN", help="what multibot plan wrote, or a fleet file")
    seen = parser.add_mutually_exclusive_group()
    seen.add_argument("--snapshot", metavar="FILE", help="what multibot snapshot wrote")
    seen.add_argument(
        "--watch", action="store_true", help="show every change until Ctrl-C or --timeout"
    )
    live.options(parser)
    pictures.options(parser)


def run(options: argparse.Namespace) -> int:
    """Compare, print a line for each finding, sum up; returns the exit code."""
    pictures.check(options)
    plan = _plan(options.plan)
    try:
        return _watch(options, plan) if options.watch else _check(options, plan)
    except RosUnusable as error:
        say(str(error), PROGRAM)
        return live.NO_ROS


def _plan(path: str) -> Expectation:
    """The plan that a file holds, or that follows from a fleet file."""
    from multibot_rewrite.fleets.fleet_file import is_fleet, read_fleet

    data = read_file(path)
    if not is_fleet(data):
        return from_yaml(data, path)
    from multibot_rewrite.fleets.fleet import expected
    from multibot_rewrite.fleets.fleet_plan import plan_fleet
    from multibot_rewrite.fleets.with_start_pose_nodes import with_start_pose_nodes

    return expected(with_start_pose_nodes(plan_fleet(read_fleet(path))))


def _check(options: argparse.Namespace, plan: Expectation) -> int:
    return conclude(options, plan, _graph(options))


def conclude(options: argparse.Namespace, plan: Expectation, graph: Snapshot) -> int:
    """Compare, print a line for each finding, draw what is asked for; the exit code."""
    found = check(plan, graph)
    print_lines(found)
    for caveat in doubts(graph):
        say(f"incomplete: {caveat.message}", PROGRAM)
    pictures.deliver(options, plan, graph, found)
    return _sum_up(plan, found, judge(found, graph))


def _sum_up(plan: Expectation, found: Sequence[GraphFinding], verdict: Verdict) -> int:
    robots, findings = len(plan.robots), len(found)
    counted = f"{robots} robot{'s' * (robots != 1)}, {findings} finding{'s' * (findings != 1)}"
    say(f"{counted}: {WORDS[verdict]}", PROGRAM)
    return CODES[verdict]


def _graph(options: argparse.Namespace) -> Snapshot:
    if options.snapshot:
        return from_json(read_file(options.snapshot), options.snapshot)
    # Not only until the planned nodes are there: a twin or a leak may come after them.
    return observe(Request(options.timeout or live.LOOK_SECONDS), live.environ(options.domain))


def _watch(options: argparse.Namespace, plan: Expectation) -> int:
    last = follow(plan, watch(Request(options.timeout or inf), live.environ(options.domain)))
    if last is None:
        say("ended before anything was seen", PROGRAM)
        return live.INCONCLUSIVE
    pictures.deliver(options, plan, last.graph, last.findings)
    return _sum_up(plan, last.findings, final(last))
