"""``multibot check``: is the running system what was planned?"""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence
from math import inf

from multibot_rewrite.bounded import MAX_FLEET_BYTES
from multibot_rewrite.cli import live, pictures
from multibot_rewrite.cli.output import note, say
from multibot_rewrite.cli.process import DONE, PROGRAM, STOPPED
from multibot_rewrite.cli.report import TEXT, About, check_report, chosen, report_first
from multibot_rewrite.cli.walk import check_target
from multibot_rewrite.cli.watch import WORDS, follow
from multibot_rewrite.findings.finding import Finding
from multibot_rewrite.fleets.fleet_or_plan import is_fleet
from multibot_rewrite.graph.check import check, doubts
from multibot_rewrite.graph.expectation import Expectation, robot_words
from multibot_rewrite.graph.live.child import RosUnusable, observe, watch
from multibot_rewrite.graph.live.request import Request
from multibot_rewrite.graph.plan_file import is_json, read_plan
from multibot_rewrite.graph.snapshot import Snapshot
from multibot_rewrite.graph.snapshot_file import read_snapshot
from multibot_rewrite.graph.watching import Verdict, final
from multibot_rewrite.model import UsageError
from multibot_rewrite.plural import plural
from multibot_rewrite.releases import facts_of_release
from multibot_rewrite.sources.read import read_file

CODES = {Verdict.PLANNED: DONE, Verdict.WRONG: STOPPED, Verdict.INCONCLUSIVE: live.INCONCLUSIVE}


def run(options: argparse.Namespace) -> int:
    """Compare, report, sum up; returns the exit code."""
    _check_use(options)
    plan = _plan(options)
    try:
        return _watch(options, plan) if options.watch else conclude(options, plan, _graph(options))
    except RosUnusable as error:
        say(str(error), PROGRAM)
        return live.NO_ROS


def _check_use(options: argparse.Namespace) -> None:
    if options.watch and options.snapshot:
        raise UsageError("--watch is for the live graph, leave out --snapshot")
    if options.watch and (options.select or options.ignore or options.format != TEXT):
        raise UsageError("--watch shows every finding: leave out --select, --ignore and --format")
    check_report(options, printed=False)
    pictures.check(options)
    if options.output:
        check_target(options.output, list(filter(None, [options.plan, options.snapshot])))


def _plan(options: argparse.Namespace) -> Expectation:
    """The plan that a file holds, or that follows from a fleet file."""
    path: str = options.plan
    data = read_file(path, MAX_FLEET_BYTES)
    if is_json(data) or not is_fleet(data):
        return _of_release(options, read_plan(data, path))
    from multibot_rewrite.cli.fleet import check_unread, note_interfaces  # a plan needs none of it
    from multibot_rewrite.fleets.fleet import expected
    from multibot_rewrite.fleets.fleet_file import input_files, read_fleet
    from multibot_rewrite.fleets.fleet_plan import plan_fleet
    from multibot_rewrite.fleets.with_start_pose_nodes import with_start_pose_nodes

    file = read_fleet(path, options.distro or "", os.environ)
    if options.output:
        check_target(options.output, input_files(file))
    made = with_start_pose_nodes(plan_fleet(file, trust=options.trust))
    note_interfaces(options, made.facts)
    check_unread(options, made)
    return expected(made)


def _of_release(options: argparse.Namespace, plan: Expectation) -> Expectation:
    """The plan, which is of the release that ``--distro`` names, if it says so."""
    asked: str = options.distro or ""
    if asked and plan.release not in ("", asked):
        hint = f"make one with multibot plan --distro {asked}, or leave out --distro"
        raise UsageError(f"{options.plan} has the facts of {plan.release}; {hint}")
    return plan._replace(release=plan.release or asked)


def conclude(
    options: argparse.Namespace,
    plan: Expectation,
    graph: Snapshot,
    before: Sequence[Finding] = (),
) -> int:
    """Compare, report the findings, draw what is asked for; the exit code.

    ``before`` are findings from before there was a graph.
    """
    found = check(plan, graph)
    findings = [*before, *chosen(options, found)]
    about = About([plan_name(options)], robot_words(plan), plan.release)
    failed = report_first(options, findings, about)
    caveats = doubts(graph)
    for caveat in caveats:
        say(f"incomplete: {caveat.message}", PROGRAM)
    codes = {it.code for it in findings}
    pictures.deliver(options, plan, graph, [it for it in found if it.code in codes])
    inconclusive = Verdict.INCONCLUSIVE if caveats else Verdict.PLANNED
    return _sum_up(options, plan, len(findings), Verdict.WRONG if failed else inconclusive)


def plan_name(options: argparse.Namespace) -> str:
    """The file that the plan comes from."""
    given = vars(options)
    return str(given.get("plan") or given["input"])


def _sum_up(options: argparse.Namespace, plan: Expectation, findings: int, verdict: Verdict) -> int:
    counted = f"{plural(len(plan.robots), 'robot')}, {plural(findings, 'finding')}"
    note(options, f"{counted}: {WORDS[verdict]}{facts_of_release(plan.release)}")
    return CODES[verdict]


def _graph(options: argparse.Namespace) -> Snapshot:
    if options.snapshot:
        return read_snapshot(options.snapshot)
    # Not only until the planned nodes are there: a twin or a leak may come after them.
    return observe(Request(options.timeout or live.LOOK_SECONDS), live.environ(options.domain))


def _watch(options: argparse.Namespace, plan: Expectation) -> int:
    last = follow(plan, watch(Request(options.timeout or inf), live.environ(options.domain)))
    if last is None:
        note(options, "ended before anything was seen")
        return live.INCONCLUSIVE
    if options.output:
        findings = list(last.findings)
        report_first(options, findings, About([options.plan], robot_words(plan), plan.release))
    pictures.deliver(options, plan, last.graph, last.findings)
    return _sum_up(options, plan, len(last.findings), final(last))
