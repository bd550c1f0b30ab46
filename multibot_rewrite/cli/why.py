# SPDX-License-Identifier: Apache-2.0
"""``urdf-postfix --why FILE:LINE``: which rewriter claims a value, and why."""

from __future__ import annotations

import argparse
from collections.abc import Iterator

from multibot_rewrite.base.config import configured_definitions
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.cli.process import DONE
from multibot_rewrite.cli.tables import deliver_report
from multibot_rewrite.cli.usage import rewriting, robots
from multibot_rewrite.description.library import explain
from multibot_rewrite.description.reports.explain import Explanation
from multibot_rewrite.related_files.named_file import is_related_file


def run(options: argparse.Namespace) -> int:
    """Print an explanation of every value on the line."""
    path, line = _file_and_line(options.why)
    if is_related_file(path):
        raise UsageError(f"--why is for descriptions, {path} is none; --diff shows what changes")
    # The file is in the option: what stands first is a robot or a xacro argument.
    options.words[:0] = [options.input] if options.input else []
    robot = next(iter(robots(options)), "robot1")
    options.definitions = [*configured_definitions(path), *options.definitions]
    found = explain(path, line, robot, **rewriting(options))
    if not found:
        raise UsageError(f"{options.why}: no value starts on this line; name another")
    deliver_report(options, (line for it in found for line in _explanation_lines(it, path, robot)))
    return DONE


def _file_and_line(text: str) -> tuple[str, int]:
    """Return path and line of ``FILE:LINE``; raises UsageError for another text."""
    path, colon, line = text.rpartition(":")
    if not colon or not line.isdigit() or not path:
        raise UsageError(f"--why {text}: write FILE:LINE, for example rover.urdf:34")
    return path, int(line)


def _explanation_lines(item: Explanation, path: str, robot: str) -> Iterator[str]:
    within = f", of {item.within}" if item.within else ""
    yield f"{path}:{item.line}:{item.column}: {item.path}{within}"
    yield from _fact_lines(item, robot)
    if item.made_of:
        yield f"  made of: {' + '.join(item.made_of)}"
    if item.source:
        yield f"  source: {item.source}"


def _fact_lines(item: Explanation, robot: str) -> Iterator[str]:
    """Yield the facts about one value, indented below its place."""
    if item.inserted:
        yield f"  [{item.value}] gets for {robot}: {item.reason}"
        yield from (f"    {element}" for element in item.inserted)
        return
    site = item.site
    yield f"  value: {item.value!r}"
    if site is None:
        yield f"  claimed by no rewriter: {item.reason}"
        return
    by = f"[{site.section}] {site.file}:{site.line}"
    if site.role == "keep":
        yield f"  kept by {by}: {item.reason}"
        return
    form = "" if site.form == "whole" else f" ({site.form})"
    note = f"; {site.note}" if site.note else ""
    yield f"  claimed by {by}: {site.path} {site.role} {' '.join(site.kinds)}{form}{note}"
    yield f"  is: {item.reason}"
    yield f"  for {robot}: {item.new!r}" if item.new != item.value else "  stays as it is"
