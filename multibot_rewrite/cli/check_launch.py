# SPDX-License-Identifier: Apache-2.0
"""``multibot check-launch``: what would be wrong with the robots that a launch file starts?"""

from __future__ import annotations

import argparse
import shlex
from collections.abc import Sequence
from functools import partial

from multibot_rewrite.base.releases import release_told
from multibot_rewrite.cli import check, pictures, unplanned
from multibot_rewrite.cli.fleet import own_nodes
from multibot_rewrite.cli.output import note
from multibot_rewrite.cli.report import check_report, chosen
from multibot_rewrite.cli.walk import check_target
from multibot_rewrite.fleet.checks.manager_remedy import with_remedies
from multibot_rewrite.fleet.file.system_sources import launched_by
from multibot_rewrite.lint.launched import named_findings
from multibot_rewrite.live.diagnose import diagnose
from multibot_rewrite.producers.launch.findings import not_read
from multibot_rewrite.producers.launch.records import LaunchOrder, orders_in_words
from multibot_rewrite.rules.check import side_by_side
from multibot_rewrite.rules.domains import check_view
from multibot_rewrite.rules.launch.judge import as_one_of_several, as_sure, judge_launch, placed


def run(options: argparse.Namespace) -> int:
    """Read the launch file, make the graph that it would start, report; returns the exit code."""
    orders = orders_of(options, options.words)
    _check_use(options, orders)
    plan, own = check.plan_of(options) if options.plan else None, own_nodes(options)
    told = release_told(options.distro) or (plan.release if plan else "")
    read = partial(launched_by, told=told, nodes=own[0], nodl=own[1])
    made = read(orders)
    for it in made.system.environment.caveats:
        if not it.incomplete:
            note(options, it.message)
    found = [*with_remedies(judge_launch(made), orders, read), *named_findings(made)]
    if options.format != "text":
        found += not_read(made.graph)
    if plan is not None:
        whose = side_by_side(plan, made.system)[1]
        sure = (as_sure(it, made, whose) for it in check_view(plan, made.with_bridged))
        judged = [*as_one_of_several(sure, plan, made.system)]
        return check.conclude(options, plan, made.system, judged, chosen(options, found))
    # What a check is told besides: there is no snapshot, and nothing to begin.
    whole = argparse.Namespace(**vars(options), snapshot=[], suggest=None)
    seen = diagnose(made.system)
    every = (*found, *placed((as_sure(it, made, seen.whose) for it in seen.findings), made))
    return unplanned.report_on(whole, seen._replace(findings=every))


def orders_of(options: argparse.Namespace, words: Sequence[str]) -> list[LaunchOrder]:
    """The launch files that words name, with the arguments; raises UsageError for other words."""
    orders = orders_in_words(words, shlex.join(words), options.roots)
    return [it._replace(trusted=options.trust) for it in orders]


def _check_use(options: argparse.Namespace, orders: Sequence[LaunchOrder]) -> None:
    check_report(options, printed=False)
    pictures.check(options)
    if options.output:
        check_target(options.output, [*filter(None, [options.plan]), *(it.file for it in orders)])
