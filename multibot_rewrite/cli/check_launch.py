"""``multibot check-launch``: what would be wrong with the robots that a launch file starts?"""

from __future__ import annotations

import argparse
import shlex
from collections.abc import Sequence

from multibot_rewrite.base.releases import release_here
from multibot_rewrite.cli import check, pictures, unplanned
from multibot_rewrite.cli.fleet import own_nodes
from multibot_rewrite.cli.output import note
from multibot_rewrite.cli.report import check_report
from multibot_rewrite.cli.walk import check_target
from multibot_rewrite.fleet.fleet import known_nodes
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.live.diagnose import diagnose
from multibot_rewrite.producers.launch.child import launch_graph
from multibot_rewrite.producers.launch.records import LaunchOrder, order_in_words
from multibot_rewrite.producers.launch.running import Knowledge
from multibot_rewrite.producers.launch.snapshot import would_run
from multibot_rewrite.system.records import System


def run(options: argparse.Namespace) -> int:
    """Read the launch file, make the graph that it would start, report; returns the exit code."""
    order = order_of(options, options.words)
    _check_use(options, order)
    plan = check.plan_of(options) if options.plan else None
    made = graph_of(options, order)
    for it in made.environment.caveats:
        if not it.incomplete:
            note(options, it.message)
    if plan is not None:
        return check.conclude(options, plan, made)
    # What a check is told besides: there is no snapshot, and nothing to begin.
    whole = argparse.Namespace(**vars(options), snapshot=[], suggest=None)
    return unplanned.report_on(whole, diagnose(made))


def order_of(options: argparse.Namespace, words: Sequence[str]) -> LaunchOrder:
    """The launch file that words name, with its arguments; raises UsageError for other words."""
    order = order_in_words(words, shlex.join(words), options.roots)
    return order._replace(trusted=True)


def graph_of(options: argparse.Namespace, order: LaunchOrder) -> System:
    """What the launch file would start; raises InputError for one that cannot be read."""
    release = release_here(options.distro)
    nodes, nodl = own_nodes(options)
    library = known_nodes(nodes, release, nodl).library
    known = Knowledge(library.nodes, load_known_nodes(nodes or "", release), release)
    return would_run(launch_graph(order), known)


def _check_use(options: argparse.Namespace, order: LaunchOrder) -> None:
    check_report(options, printed=False)
    pictures.check(options)
    if options.output:
        check_target(options.output, [*filter(None, [options.plan]), order.file])
