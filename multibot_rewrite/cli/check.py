"""``multibot check``: is the running system what was planned?"""

from __future__ import annotations

import argparse
import os

from multibot_rewrite.cli.output import say
from multibot_rewrite.cli.process import DONE, PROGRAM, STOPPED
from multibot_rewrite.cli.snapshot import INCONCLUSIVE, NO_ROS
from multibot_rewrite.graph import comparison
from multibot_rewrite.graph.check import check, doubts
from multibot_rewrite.graph.child import RosUnusable, observe
from multibot_rewrite.graph.environment import settings
from multibot_rewrite.graph.plan_file import from_yaml
from multibot_rewrite.graph.request import Request
from multibot_rewrite.graph.snapshot import Snapshot, from_json
from multibot_rewrite.model import ERROR
from multibot_rewrite.sources import read_file

ABOUT = "is the running system what was planned?"
MORE = """\
examples:
  multibot check plan.yaml                         the graph that runs now
  multibot check plan.yaml --snapshot graph.json   one that was written before; needs no ROS
exit codes: 0 as planned; 1 something is wrong; 2 wrong use or unreadable input; 3 inconclusive: the
view may be incomplete; 4 rclpy or its RMW is missing or does not start
"""


def options(parser: argparse.ArgumentParser) -> None:
    """Add the options of the command."""
    parser.epilog = MORE
    parser.add_argument("plan", metavar="PLAN", help="what multibot plan wrote")
    parser.add_argument("--snapshot", metavar="FILE", help="what multibot snapshot wrote")
    parser.add_argument(
        "--timeout", type=float, default=15.0, metavar="S", help="look S seconds (default: 15)"
    )


def run(options: argparse.Namespace) -> int:
    """Compare, print a line for each finding, sum up."""
    plan = from_yaml(read_file(options.plan), options.plan)
    try:
        graph = _graph(options)
    except RosUnusable as error:
        say(str(error), PROGRAM)
        return NO_ROS
    found = check(plan, graph)
    for finding in found:
        print(finding)
    for caveat in doubts(graph):
        say(f"incomplete: {caveat.message}", PROGRAM)
    code = _code(found, graph)
    say(f"{len(plan.robots)} robots, {len(found)} findings: {VERDICTS[code]}", PROGRAM)
    return code


VERDICTS = {
    DONE: "as planned",
    STOPPED: "not as planned",
    INCONCLUSIVE: "inconclusive, the view may be incomplete",
}


def _code(found: list[comparison.GraphFinding], graph: Snapshot) -> int:
    if any(finding.level == ERROR for finding in found):
        return STOPPED
    return INCONCLUSIVE if doubts(graph) else DONE


def _graph(options: argparse.Namespace) -> Snapshot:
    if options.snapshot:
        return from_json(read_file(options.snapshot), options.snapshot)
    environ = dict(os.environ)
    settings(environ)
    # Not only until the planned nodes are there: a twin or a leak may come after them.
    return observe(Request(options.timeout), environ)
