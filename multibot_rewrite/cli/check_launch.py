# SPDX-License-Identifier: Apache-2.0
"""``multibot check-launch``: what would be wrong with the robots that a launch file starts?"""

from __future__ import annotations

import argparse
import shlex
from collections.abc import Sequence

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.releases import release_told
from multibot_rewrite.cli import check, pictures, unplanned
from multibot_rewrite.cli.fleet import own_nodes
from multibot_rewrite.cli.output import note
from multibot_rewrite.cli.report import check_report, chosen
from multibot_rewrite.cli.walk import check_target
from multibot_rewrite.fleet.file.system_sources import launched_by
from multibot_rewrite.lint.launched import named_findings
from multibot_rewrite.live.diagnose import diagnose
from multibot_rewrite.producers.launch.findings import not_read
from multibot_rewrite.producers.launch.launched import Launched
from multibot_rewrite.producers.launch.records import LaunchOrder, orders_in_words
from multibot_rewrite.rules.launch.judge import judge_launch, placed
from multibot_rewrite.rules.system.interfaces import (
    interface_claimed_twice,
    interface_not_exported,
)
from multibot_rewrite.rules.system.tf_pieces import tf_tree_in_pieces


def run(options: argparse.Namespace) -> int:
    """Read the launch file, make the graph that it would start, report; returns the exit code."""
    orders = orders_of(options, options.words)
    _check_use(options, orders)
    plan = check.plan_of(options) if options.plan else None
    told = release_told(options.distro) or (plan.release if plan else "")
    made = launched_by(orders, told, *own_nodes(options))
    for it in made.system.environment.caveats:
        if not it.incomplete:
            note(options, it.message)
    found = [*judge_launch(made), *named_findings(made)]
    if options.format != "text":
        found += not_read(made.graph)
    if plan is not None:
        return check.conclude(options, plan, made.system, chosen(options, found))
    # What a check is told besides: there is no snapshot, and nothing to begin.
    whole = argparse.Namespace(**vars(options), snapshot=[], suggest=None)
    seen = diagnose(made.system)
    every = (*found, *(placed(_certain(it, made), made) for it in seen.findings))
    return unplanned.report_on(whole, seen._replace(findings=every))


def orders_of(options: argparse.Namespace, words: Sequence[str]) -> list[LaunchOrder]:
    """The launch files that words name, with the arguments; raises UsageError for other words."""
    orders = orders_in_words(words, shlex.join(words), options.roots)
    return [it._replace(trusted=True) for it in orders]


def _certain(it: Finding, made: Launched) -> Finding:
    """A claim that no hardware meets is an error where all that is started is known. The odometry of a
    robot that is in no simulator may come from a driver that is started apart."""
    claims = it.code in (interface_not_exported.code, interface_claimed_twice.code)
    if claims and it.level == WARNING:
        return it._replace(level=ERROR)
    doubted = it.code == tf_tree_in_pieces.code and it.level == ERROR
    apart = doubted and not any(one.spawned for one in made.models.found)
    if apart and it.names and not any(edge.parent == it.names[0] for edge in made.system.edges):
        return it._replace(level=WARNING)
    return it


def _check_use(options: argparse.Namespace, orders: Sequence[LaunchOrder]) -> None:
    check_report(options, printed=False)
    pictures.check(options)
    if options.output:
        check_target(options.output, [*filter(None, [options.plan]), *(it.file for it in orders)])
