# SPDX-License-Identifier: Apache-2.0
"""``multibot check PLAN``: compare the running system with its plan."""

from __future__ import annotations

import argparse
import os
from collections.abc import Mapping, Sequence

from multibot_rewrite.base.bounded import MAX_FLEET_BYTES
from multibot_rewrite.base.file_kinds import SNAPSHOT, recognised
from multibot_rewrite.base.findings.finding import ERROR, INCONCLUSIVE, NOTE, Finding
from multibot_rewrite.base.findings.selection import fails
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.base.wording import plural
from multibot_rewrite.cli import live, pictures
from multibot_rewrite.cli.output import note, print_lines, say
from multibot_rewrite.cli.process import PROGRAM, STOPPED
from multibot_rewrite.cli.report import About, check_report, chosen, report_first
from multibot_rewrite.cli.walk import check_target
from multibot_rewrite.cli.watch import follow
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.live.watching import Outcome, Verdict, final, final_words, verdict_words
from multibot_rewrite.planning.plan import is_fleet, read_plan, robot_words
from multibot_rewrite.producers.bags.recording import as_snapshot, counted
from multibot_rewrite.rules.check import check, check_domains
from multibot_rewrite.rules.system.unsent import nothing_known_sends
from multibot_rewrite.rules.with_plan import subject_of
from multibot_rewrite.system.coverage import Coverage, coverage
from multibot_rewrite.system.domains import by_domain, side_by_side
from multibot_rewrite.system.index import index
from multibot_rewrite.system.ownership import whose_by_plan
from multibot_rewrite.system.records import System, answering, doubts


def run(options: argparse.Namespace) -> int:
    """Compare, report, sum up; returns the exit code."""
    options, several = live.by_domain(options)
    if options.plan is None:
        from multibot_rewrite.cli import unplanned  # a check with a plan needs none of it

        return unplanned.run(options, several)
    _check_use(options)
    plan, before = plan_of(options), _earlier_snapshot(options)
    parts = _plan_by_domain(options, plan, several)
    if options.watch:
        if len(parts) == 1:
            ((domain, plan),) = parts.items()
            options, parts = live.at(options, domain), {}
        plan = _with_files(options, plan) if options.state else plan
        return _watch(options, plan, [*parts], before)
    if parts and not options.bag:
        return _check_domains(options, plan, parts)
    if options.bag:
        from multibot_rewrite.producers.bags.read import read_bag

        recording = read_bag(options.bag)
        graph = as_snapshot(recording, plan)
        return conclude(options, plan, graph, check(plan, graph, counted(recording)))
    graph = live.graph(options, judge=lambda it: check(plan, it, before=before))
    if options.state or answering(graph):
        plan = _with_files(options, plan)
    graph = live.with_states(options, graph, _asked_parameters(plan))
    return conclude(options, plan, graph, check(plan, graph, before=before))


def _earlier_snapshot(options: argparse.Namespace) -> System | None:
    """Return the earlier snapshot that PLAN is; None for a plan or a fleet file."""
    if recognised(read_file(options.plan, MAX_FLEET_BYTES)) != SNAPSHOT:
        return None
    from multibot_rewrite.producers.snapshot_file import read_snapshot

    return read_snapshot(options.plan)


def _plan_by_domain(
    options: argparse.Namespace, plan: System, several: Sequence[int]
) -> Mapping[int, System]:
    """Return the plan for each domain that is checked; empty for one plan for all."""
    # A plan of one domain holds for each that is named: for robots that are alike and have no
    # names.
    parts = by_domain(plan)
    if not parts:
        return dict.fromkeys(several, plan)
    asked = several or [it for it in (options.domain,) if it is not None]
    for it in asked:
        if it not in parts:
            known = ", ".join(map(str, parts))
            raise UsageError(f"--domain {it}: the plan has no node there; it has {known}")
    return {it: parts[it] for it in asked} or parts


def _check_domains(options: argparse.Namespace, plan: System, parts: Mapping[int, System]) -> int:
    """Check all domains of a plan with robots in several domains; returns the exit code."""
    seen = live.graphs(options, parts)
    if options.state or any(map(answering, seen.values())):
        plan = _with_files(options, plan)
    asked = _asked_parameters(plan)
    seen = {it: live.with_states(live.at(options, it), seen[it], asked) for it in seen}
    return conclude(options, plan, side_by_side(seen), check_domains(plan, seen))


def _with_files(options: argparse.Namespace, plan: System) -> System:
    """Return the plan with the parameters in the files of its folder."""
    from multibot_rewrite.fleet.outputs.built_states import with_built

    return with_built(plan, os.path.dirname(options.plan))


def _asked_parameters(plan: System) -> dict[str, list[str]]:
    """Return the parameters of the plan to ask for, by node."""
    return lists_by_key((it.node, it.name) for it in plan.parameters)


def _check_use(options: argparse.Namespace) -> None:
    live.check_source(options)
    if options.suggest:
        raise UsageError("--suggest begins a plan: leave out PLAN")
    check_report(options, printed=False)
    pictures.check(options)
    if options.output:
        check_target(options.output, [options.plan, *options.snapshot])


def plan_of(options: argparse.Namespace) -> System:
    """Return the plan in a file or of a fleet file; of a snapshot, a plan of all that it saw."""
    path: str = options.plan
    data = read_file(path, MAX_FLEET_BYTES)
    if recognised(data) == SNAPSHOT:
        from multibot_rewrite.live.diagnose import diagnose
        from multibot_rewrite.live.seen_plan import seen_plan
        from multibot_rewrite.producers.snapshot_file import read_snapshot

        seen = read_snapshot(path)
        if not seen.nodes:
            hint = "take one while the robots run, and check the graph against that"
            raise InputError(f"{path}: no node ran when this snapshot was taken; {hint}")
        return seen_plan(diagnose(seen))
    if not is_fleet(data):
        return _checked_release(options, read_plan(data, path))
    from multibot_rewrite.checks.closed_plan import closed_plan
    from multibot_rewrite.checks.judged_plan import plan_fleet
    from multibot_rewrite.cli.fleet import check_unread, note_interfaces  # a plan needs none of it
    from multibot_rewrite.fleet.file.fleet_file import input_files, read_fleet
    from multibot_rewrite.fleet.fleet import expected

    file = read_fleet(path, options.distro or "", os.environ)
    if options.output:
        check_target(options.output, input_files(file))
    made = closed_plan(plan_fleet(file, trust=options.trust))
    note_interfaces(options, made.facts)
    check_unread(options, made)
    return expected(made)


def _checked_release(options: argparse.Namespace, plan: System) -> System:
    """Return the plan; raises UsageError if it is for another release than ``--distro``."""
    asked: str = options.distro or ""
    if asked and plan.release not in ("", asked):
        hint = f"make one with multibot plan --distro {asked}, or leave out --distro"
        raise UsageError(f"{options.plan} is for ROS 2 {plan.release}; {hint}")
    return plan._replace(release=plan.release or asked)


def conclude(
    options: argparse.Namespace,
    plan: System,
    graph: System,
    compared: Sequence[Finding],
    before: Sequence[Finding] = (),
) -> int:
    """Report the findings, draw what is asked for; return the exit code.

    ``compared`` are those about the graph and its plan, ``before`` those from before there was a
    graph."""
    found = chosen(options, compared)
    gaps, whose = _shown_gaps(options, plan), index(plan, whose_by_plan(plan))
    of_graph = [it for it in (*before, *found) if it not in gaps]
    known = {(subject_of(whose, it), it.level) for it in of_graph}
    gaps = [it for it in gaps if (subject_of(whose, it), it.level) not in known]
    findings = [*of_graph, *gaps]
    held = coverage(plan, graph)
    given = vars(options)
    about = About([given.get("plan") or given["input"]], robot_words(plan), plan.release, held)
    failed = report_first(options, findings, about)
    caveats = doubts(graph)
    for caveat in caveats:
        say(f"incomplete: {caveat.message}", PROGRAM)
    unsure = caveats or any(it.level == INCONCLUSIVE for it in of_graph)
    verdict = Verdict.INCONCLUSIVE if unsure else Verdict.PLANNED
    verdict = Verdict.WRONG if fails(of_graph, options.fail_on) else verdict
    words = verdict_words(verdict, of_graph, held, gaps=gaps)
    outcome = Outcome(verdict, words, f"{options.program} {options.command}")
    pictures.conclude(options, plan, graph, findings, outcome, about)
    return STOPPED if failed else live.CODES[verdict]


def _shown_gaps(options: argparse.Namespace, plan: System) -> list[Finding]:
    """Return the open findings of the plan; many notes are only counted."""
    # That is topics that an unnamed driver may publish, unless notes are asked for.
    found = chosen(options, plan.gaps)
    unsent = [it for it in found if it.code == nothing_known_sends.code and it.level == NOTE]
    if not unsent or options.fail_on == NOTE or options.verbose:
        return found
    what = f"{plural(len(unsent), 'note')} about topics that no known node sends"
    note(options, f"note: {what}; --verbose shows them")
    return [it for it in found if it not in unsent]


def _watch(
    options: argparse.Namespace,
    plan: System,
    domains: Sequence[int] = (),
    before: System | None = None,
) -> int:
    """Compare with the plan at each change; return the exit code."""
    gaps = _shown_gaps(options, plan)
    print_lines(map(str, gaps))

    def look(views: Mapping[int, System]) -> tuple[System, Coverage, Sequence[Finding]]:
        """Return the joined graph, how much of the robots it has, and the findings."""
        graph = side_by_side(views)
        found = check_domains(plan, views) if domains else check(plan, graph, before=before)
        return graph, coverage(plan, graph), found

    last = follow(look, live.watched(options, _asked_parameters(plan), domains))
    if last is None:
        note(options, "ended before anything was seen")
        return live.INCONCLUSIVE
    live.note_answers(options, last.graph)
    findings = [*last.findings, *gaps]
    about = About([options.plan], robot_words(plan), plan.release, last.coverage)
    if options.output:
        report_first(options, findings, about)
    verdict = final(last)
    words = final_words(last, planned=True, gaps=gaps)
    outcome = Outcome(verdict, words, f"{options.program} {options.command}")
    pictures.conclude(options, plan, last.graph, findings, outcome, about)
    return STOPPED if any(it.level == ERROR for it in gaps) else live.CODES[verdict]
