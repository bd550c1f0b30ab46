# SPDX-License-Identifier: Apache-2.0
"""The findings of a command: selected, grouped over robots, in the format asked for, where they go."""

import argparse
import sys
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

from multibot_rewrite.base.findings.finding import NOTE, WARNING, Finding, Rule
from multibot_rewrite.base.findings.formats import NO_COVERAGE, Report, rendered
from multibot_rewrite.base.findings.selection import Selection, fails, grouped, selected
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.wording import plural, shorten
from multibot_rewrite.cli.output import deliver, is_coloured, print_bytes, prints_colour

if TYPE_CHECKING:
    from multibot_rewrite.system.coverage import Coverage

TEXT = "text"
FEW_NOTES = 3
# Lines of a file that are named.
MOST_LINES = 8
NO_ROBOTS: Mapping[str, str] = MappingProxyType({})
NO_RULES: Mapping[str, Rule] = MappingProxyType({})


class About(NamedTuple):
    """What findings are about: files, words for robots, the release, and how much was judged."""

    files: Sequence[str]
    robots: Mapping[str, str] = NO_ROBOTS
    release: str = ""
    coverage: "Coverage | None" = None


def counted_findings(findings: Sequence[Finding]) -> str:
    """Return the number of findings with a noun; only notes are called notes."""
    only_notes = findings and all(it.level == NOTE for it in findings)
    return plural(len(findings), "note" if only_notes else "finding")


def with_coverage(held: "Coverage | None", text: str) -> str:
    """Return a verdict behind how much of the robots it is about."""
    return "; ".join(filter(None, (held.in_words if held else "", text)))


def by_themselves(robots: Iterable[str]) -> dict[str, str]:
    """Return robots, each as its own label."""
    return {it: it for it in robots}


def check_report(options: argparse.Namespace, printed: bool) -> None:
    """Put codes in place of rules' names in ``--select`` and ``--ignore``.

    Raise UsageError for a code that no rule has, or where findings and a result would both go to
    standard output; ``printed`` is whether the result does.
    """
    for option in ("select", "ignore"):
        if words := getattr(options, option):
            from multibot_rewrite.base.findings.codes import find_codes
            from multibot_rewrite.lint.catalogue import rules  # it imports every check

            setattr(options, option, [*find_codes(words, f"--{option}", rules())])
    if printed and options.format != TEXT:
        raise UsageError(
            f"--format {options.format} prints the findings; name a file for the result with -o"
        )


def chosen(options: argparse.Namespace, findings: Iterable[Finding]) -> list[Finding]:
    """Return the findings that ``--select`` and ``--ignore`` ask for."""
    codes = tuple(options.select) or Selection().select
    return selected(findings, Selection(codes, tuple(options.ignore)))


def report_first(
    options: argparse.Namespace,
    findings: Sequence[Finding],
    about: About,
    rules: Mapping[str, Rule] = NO_RULES,
) -> bool:
    """Write the findings, which are the result; return whether ``--fail-on`` matches any."""
    text = _report_text(options, findings, about, rules, colour=prints_colour(options))
    deliver(options, text.encode())
    return fails(findings, options.fail_on)


def report_findings_too(
    options: argparse.Namespace, findings: Sequence[Finding], about: About
) -> bool:
    """Write the findings in addition to the result: as text to standard error or standard output."""
    if options.format == TEXT and not findings:
        return False
    if options.format == TEXT:
        colour = is_coloured(options.color, sys.stderr)
        shown = findings if options.verbose else list(_few_of_a_kind(findings))
        sys.stderr.write(_report_text(options, shown, about, NO_RULES, colour=colour))
    else:
        print_bytes(_report_text(options, findings, about, NO_RULES, colour=False).encode())
    return fails(findings, options.fail_on)


def _few_of_a_kind(findings: Sequence[Finding]) -> Iterator[Finding]:
    """Yield the findings; many of one kind in a file as one with all lines."""
    lines = lists_by_key((_shared_kind(it), it.line) for it in findings)
    met: Counter[tuple[str, ...]] = Counter()
    for it in findings:
        kind = _shared_kind(it)
        met[kind] += 1
        shown = 1 if it.level == WARNING else FEW_NOTES
        rest = lines[kind][shown:]
        if not kind or len(lines[kind]) <= FEW_NOTES + 1 or met[kind] <= shown != 1:
            yield it
        elif it.level == WARNING and met[kind] == 1:
            listed = shorten(map(str, rest), MOST_LINES)
            more = f"{len(rest)} more of this kind in the file, at lines {listed}"
            yield it._replace(message=f"{it.message}; {more} (--verbose shows them)")
        elif it.level == NOTE and met[kind] == shown + 1:
            listed = ", ".join(map(str, rest))
            message = f"there are {len(rest)} more such notes in the file, at lines {listed}"
            yield it._replace(message=message, hint="see them with --verbose")


def _shared_kind(it: Finding) -> tuple[str, ...]:
    """Return what a finding shares with others that are shown with it; empty if shown alone."""
    # Warnings share their remedy, too; those of robots are shown once for all elsewhere.
    if it.line and it.level == NOTE:
        return it.level, it.code, it.file
    alone = not it.line or it.level != WARNING or it.robot or it.robots
    return () if alone else (it.level, it.code, it.file, it.hint)


def _report_text(
    options: argparse.Namespace,
    findings: Sequence[Finding],
    about: About,
    rules: Mapping[str, Rule],
    *,
    colour: bool,
) -> str:
    # A reader who wants quiet gets no notes, unless they are what the command fails on.
    notes = not options.quiet or options.format != TEXT or options.fail_on == NOTE
    told = findings if notes else [it for it in findings if it.level != NOTE]
    shown = told if options.verbose else grouped(told, about.robots)
    if options.format != TEXT and not rules:
        from multibot_rewrite.lint.catalogue import rules as all_rules  # it imports every check

        rules = all_rules()
    made_by = f"{options.program} {options.command}".removesuffix(f" {options.program}")
    held = about.coverage.as_value() if about.coverage else NO_COVERAGE
    report = Report(made_by, about.files, rules, about.release, held)
    return rendered(options.format, shown, report, colour=colour)
