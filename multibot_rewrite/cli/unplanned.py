# SPDX-License-Identifier: Apache-2.0
"""``multibot check`` without a plan: report what is wrong with the robots that run now."""

from __future__ import annotations

import argparse
import os
from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import chain

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.releases import release_here
from multibot_rewrite.base.wording import plural
from multibot_rewrite.cli import live, pictures
from multibot_rewrite.cli.output import note, say, with_schema, write_files
from multibot_rewrite.cli.process import PROGRAM
from multibot_rewrite.cli.report import About, by_themselves, check_report, chosen, report_first
from multibot_rewrite.cli.walk import check_folder, check_target
from multibot_rewrite.cli.watch import Look, follow
from multibot_rewrite.live.diagnose import Diagnosis, diagnose, diagnose_domains, survey
from multibot_rewrite.live.seen_plan import seen_plan
from multibot_rewrite.live.watching import Outcome, Verdict, final, final_words, verdict_words
from multibot_rewrite.producers.bags.recording import as_snapshot, counted, is_recorded
from multibot_rewrite.rules.system.planned_nodes import missing_robot
from multibot_rewrite.system.coverage import Coverage
from multibot_rewrite.system.domains import unnamed
from multibot_rewrite.system.records import System, doubts
from multibot_rewrite.system.words import is_tool


def run(options: argparse.Namespace, domains: Sequence[int] = ()) -> int:
    """Look, report, sum up; returns the exit code. Several ``domains`` are checked side by side."""
    _check_use(options, domains)
    if options.watch:
        return _watch(options, domains)
    if options.bag:
        from multibot_rewrite.producers.bags.read import read_bag

        recording = read_bag(options.bag)
        return report_on(options, diagnose(as_snapshot(recording), counted(recording)))
    views: Mapping[int, System] = live.graphs(options, domains) if domains else {}
    if not domains and len(options.snapshot) > 1:
        from multibot_rewrite.producers.snapshot_file import read_by_domain

        views = read_by_domain(options.snapshot)
    if len(views) > 1:
        return _report_on_domains(options, views)
    saved = next(iter(views.values()), None)
    seen = saved or live.graph(options, judge=lambda it: diagnose(it).findings)
    return report_on(options, diagnose(live.with_states(options, seen)))


def _report_on_domains(options: argparse.Namespace, views: Mapping[int, System]) -> int:
    _check_folders(options, views)
    each = {it: diagnose(live.with_states(live.at(options, it), views[it])) for it in sorted(views)}
    for domain, one in each.items():
        note(options, f"domain {domain}: {survey(one)}")
    empty = [f"domain {at}: {it}" for at, one in each.items() for it in _nothing_seen(one)]
    return _report(options, diagnose_domains(each), empty, each)


def _check_use(options: argparse.Namespace, domains: Sequence[int] = ()) -> None:
    live.check_source(options)
    check_report(options, printed=False)
    pictures.check(options)
    if options.output:
        check_target(options.output, options.snapshot)
    _check_folders(options, domains)


def _check_folders(options: argparse.Namespace, domains: Collection[int]) -> None:
    """Raise UsageError where a suggestion would replace a file, or its folder cannot be made."""
    if not options.suggest:
        return
    from multibot_rewrite.live.suggestion import FILES  # reads descriptions: as long as a check

    folders = _folders(options, domains)
    for path in (os.path.join(folder, name) for folder in folders for name in FILES):
        check_folder(path)
        if os.path.lexists(path):
            raise UsageError(f"{path} is there already; name another folder with --suggest")


def _folders(options: argparse.Namespace, domains: Collection[int]) -> list[str]:
    """Return the folders for a suggestion's files: one for each of several domains."""
    apart = [os.path.join(options.suggest, f"domain{it}") for it in domains]
    return apart if len(apart) > 1 else [options.suggest]


def report_on(options: argparse.Namespace, seen: Diagnosis) -> int:
    """Say what is seen, report the findings, write what is asked for; the exit code."""
    if line := survey(seen):
        note(options, line)
    return _report(options, seen, [*_nothing_seen(seen)], {0: seen})


def _report(
    options: argparse.Namespace,
    seen: Diagnosis,
    empty: Sequence[str],
    each: Mapping[int, Diagnosis],
) -> int:
    """Report the findings and write what is asked for; ``empty`` are reasons why nothing was seen."""
    findings = chosen(options, seen.findings)
    about = _about(options, seen)
    failed = report_first(options, findings, about)
    unsure = [caveat.message for caveat in doubts(seen.graph)] or empty
    for reason in unsure:
        say(f"incomplete: {reason}", PROGRAM)
    inconclusive = Verdict.INCONCLUSIVE if unsure else Verdict.PLANNED
    verdict = Verdict.WRONG if failed else inconclusive
    words = verdict_words(verdict, findings, seen.coverage, planned=False)
    outcome = Outcome(verdict, words, "multibot check", planned=False, reasons=tuple(unsure))
    _write_suggestion(options, each)
    plan = seen_plan(seen) if options.report else seen.graph
    pictures.conclude(options, plan, seen.graph, findings, outcome, about)
    return live.CODES[verdict]


def _about(options: argparse.Namespace, seen: Diagnosis) -> About:
    """Return the ``About`` of a report: what the findings are about."""
    return About(options.snapshot, by_themselves(seen.whose.robots), coverage=seen.coverage)


def _nothing_seen(seen: Diagnosis) -> Iterator[str]:
    """Yield a reason if no robot's node runs; a recording never has nodes."""
    only_tools = all(is_tool(node.name) for node in seen.graph.nodes)
    if only_tools and not seen.findings and not is_recorded(seen.graph):
        yield "no node of a robot is in this graph, so there is nothing to judge"


def _write_suggestion(options: argparse.Namespace, each: Mapping[int, Diagnosis]) -> None:
    """Write a first fleet file and plan, for each domain by itself."""
    if not options.suggest:
        return
    from multibot_rewrite.knowledge.node_sets import built_in
    from multibot_rewrite.live.suggestion import SCHEMAS, suggestion

    library = built_in(release_here(options.distro))
    for folder, seen in zip(_folders(options, each), each.values(), strict=True):
        if doubts(seen.graph):
            say(f"nothing is written to {folder}: the view is incomplete, look again", PROGRAM)
            continue
        texts = {os.path.join(folder, it): one for it, one in suggestion(seen, library).items()}
        schemas = {os.path.join(folder, it): one for it, one in SCHEMAS.items()}
        files = (with_schema(it, one.encode(), schemas.get(it, "")) for it, one in texts.items())
        write_files(options, chain.from_iterable(files))
        note(options, f"wrote {', '.join(texts)}: see {next(iter(texts))}")


def _watch(options: argparse.Namespace, domains: Sequence[int] = ()) -> int:
    """Report at each change; return the exit code."""
    each: dict[int, Diagnosis] = {}
    last = follow(_judging(each), live.watched(options, domains=domains), planned=False)
    if last is None:
        note(options, "ended before anything was seen")
        return live.INCONCLUSIVE
    live.note_answers(options, last.graph)
    seen = diagnose(last.graph)
    about, words = _about(options, seen), final_words(last, planned=False)
    if options.output:
        report_first(options, last.findings, about)
    outcome = Outcome(final(last), words, "multibot check", planned=False)
    _write_suggestion(options, each)
    pictures.conclude(options, seen_plan(seen), last.graph, last.findings, outcome, about)
    return live.CODES[final(last)]


def _judging(each: dict[int, Diagnosis]) -> Look:
    """Return a function that judges one graph after another; ``each`` keeps the last."""
    # A robot that ran is reported when it is gone.
    known: dict[str, set[str]] = {}

    def look(views: Mapping[int, System]) -> tuple[System, Coverage, Sequence[Finding]]:
        """Return graph, coverage and findings of one view; robots of earlier ones may be missing."""
        each.update({at: diagnose(it) for at, it in views.items()})
        seen = diagnose_domains(each) if len(each) > 1 else next(iter(each.values()))
        there = {it.name for it in seen.graph.nodes if not is_tool(it.name)}
        for node in there:
            if robot := seen.whose.robot(node):
                known.setdefault(robot, set()).add(node)
        gone = [_missing_robot(*it) for it in known.items() if there.isdisjoint(it[1])]
        lost = map(unnamed, gone) if len(each) > 1 else gone
        return seen.graph, seen.coverage, (*seen.findings, *lost)

    return look


def _missing_robot(robot: str, nodes: Collection[str]) -> Finding:
    message = f"{robot} is gone: none of its {plural(len(nodes), 'node')} runs any more"
    return missing_robot.finding(message, "is it off, or out of the network?", robot=robot)
