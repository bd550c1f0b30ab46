"""Where ``urdf-postfix`` puts its results, and what it tells beside them."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Sequence
from itertools import chain

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.findings.selection import fails
from multibot_rewrite.cli.diffs import diff
from multibot_rewrite.cli.output import note, print_bytes, prints_colour, watched, write_files
from multibot_rewrite.cli.rewrite_use import input_name, target_path


def told(options: argparse.Namespace, findings: Sequence[Finding]) -> Sequence[Finding]:
    """What is reported: to a program only what stops the rewrite."""
    return () if options.silent and not fails(findings, options.fail_on) else findings


def tell(options: argparse.Namespace, text: str) -> None:
    """A line beside the result, unless a program reads it."""
    if not options.silent:
        note(options, text)


def deliver(
    options: argparse.Namespace,
    results: Iterable[tuple[str, bytes, bytes]],
    more: list[tuple[str, bytes]],
    total: int,
) -> None:
    """Print or write the results (robot, before, after) as they are made, and ``more`` files."""
    target = options.input if options.in_place else options.output
    if target:
        files = ((target_path(target, robot), data) for robot, _, data in results)
        write_files(options, watched(chain(more, files), total, "writing"))
        return
    write_files(options, more)
    colour = prints_colour(options)
    for robot, before, data in results:
        name = input_name(options)
        text = diff(before, data, name, f"{name} for {robot}", colour) if options.diff else data
        print_bytes(text)
