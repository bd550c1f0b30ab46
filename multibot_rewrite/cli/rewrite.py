# SPDX-License-Identifier: Apache-2.0
"""``urdf-postfix``: rewrite a robot description for one robot or many, or undo that."""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from itertools import chain
from typing import TYPE_CHECKING, Any

from multibot_rewrite.base.config import configured_definitions
from multibot_rewrite.base.findings.finding import RewriteRefused
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.naming import FRAME_KINDS, SEPARATORS, TOPIC_KINDS
from multibot_rewrite.base.releases import facts_of_release, release_doubt, why_here
from multibot_rewrite.base.wording import plural
from multibot_rewrite.cli import output
from multibot_rewrite.cli.output import STANDARD, serves_a_program
from multibot_rewrite.cli.process import DONE, STOPPED
from multibot_rewrite.cli.rewrite_use import (
    CHANGES,
    FRAMES,
    TOPICS,
    below,
    check_shared,
    check_unread,
    check_use,
    deliver,
    input_name,
    is_stopped,
    tell,
)
from multibot_rewrite.cli.usage import rewriting, robots, xacro_args
from multibot_rewrite.cli.walk import standard_input
from multibot_rewrite.description.checks.meeting import given, not_verified
from multibot_rewrite.description.library import Rewrite, explain, rewrite_all, strip
from multibot_rewrite.description.readback.meeting import NUMBERED
from multibot_rewrite.description.sources.job import read_whole
from multibot_rewrite.description.sources.own_names import filled, name_robot
from multibot_rewrite.description.sources.read import Source

if TYPE_CHECKING:
    from multibot_rewrite.description.reports.explain import Explanation

# What the summary calls a kind whose own word says little; the others are their own word.
WORDS = {"stem": "topic prefix"}


def run(options: argparse.Namespace) -> int:
    """Rewrite, undo or explain; returns the exit code."""
    if options.why is not None:
        return _explain(options)
    target = None if options.output == STANDARD else options.output
    options.output = (
        target if options.output_kind == CHANGES else below(target, options.input or "")
    )
    options.silent = serves_a_program(options)
    names = robots(options)
    check_use(options, names)
    options.definitions = [*configured_definitions(options.input), *options.definitions]
    source: Source = standard_input() if options.input == "-" else options.input
    if _is_related_file(source):
        from multibot_rewrite.cli import rewrite_file  # a description needs none of it

        return rewrite_file.run(options, source, names)
    return (_undo if options.undo else _rewrite)(options, source, names)


def _is_related_file(source: Source) -> bool:
    """Return whether a source is a related file, and not named as a description."""
    if isinstance(source, str) and source.endswith((".urdf", ".sdf", ".xacro")):
        return False
    from multibot_rewrite.related_files.named_file import is_related_file

    return is_related_file(source)


def _undo(options: argparse.Namespace, source: Source, names: list[str]) -> int:
    """Write the description without the robot's name; return the exit code."""
    from multibot_rewrite.cli.undo_options import (  # a rewrite needs none of it
        more_to_undo,
        with_missing_options,
    )

    (robot,) = names
    # Read once: it may be a pipe, and --diff shows it again.
    given = filled(xacro_args(options), robot)
    read = read_whole(source, {} if options.xacro else given, options.trust)
    beside = read_whole(options.xacro, given, options.trust).read if options.xacro else ()

    def undo(other: argparse.Namespace) -> bytes:
        return _strip(other, read.data, robot)

    try:
        stripped = undo(options)
    except RewriteRefused as error:
        raise with_missing_options(error, options, undo, robot, read.data) from None
    check_unread(options, [robot], (*read.read, *beside))
    deliver(options, [(robot, read.data, stripped)], 1)
    tell(options, f"{robot} taken out, verified by rewriting again")
    if words := more_to_undo(stripped, options, undo, robot):
        tell(options, f"warning: {robot} is in all links still; was the file made with {words}?")
    return DONE


def _rewrite(options: argparse.Namespace, source: Source, names: list[str]) -> int:
    """Write the description for each robot; return the exit code."""
    file = input_name(options)
    if doubt := release_doubt(options.distro):
        tell(options, f"warning: {doubt}")

    def rewrites_with(naming: Mapping[str, Any]) -> Iterator[Rewrite]:
        how = {**rewriting(options), **naming, "world_systems": options.world_systems}
        return rewrite_all(source, names, again=options.force, file=file, **how)

    rewrites = rewrites_with({})
    first = next(rewrites)
    if options.shared:
        _check_shared(options, first, rewrites_with)
    # Robots with descriptions or numbers of their own are all made before the first is here.
    is_numbered = any(it.code == NUMBERED for it in first.findings)
    others = list(rewrites) if first.prepared.job.naming.own or is_numbered else []
    jobs = dict.fromkeys(it.prepared for it in (first, *others))
    check_unread(options, names, (path for it in jobs for path in it.job.read.files))
    found = (finding for it in (first, *others) for finding in it.findings)
    if is_stopped(options, found, names, first.distro):
        return STOPPED
    if options.output_kind == CHANGES:
        own = {it.robot: it for it in others}
        every = [own.get(robot, first._replace(robot=robot)) for robot in names]
        # Every change for every robot, as ``--output-kind changes`` writes it.
        import json

        table = {
            "file": every[0].prepared.job.file,
            "distro": every[0].distro,
            "robots": {r.robot: [change._asdict() for change in r.changes] for r in every},
        }
        output.deliver(options, json.dumps(table, indent=1, ensure_ascii=False).encode() + b"\n")
        return DONE
    results = ((it.robot, it.prepared.job.data, it.data) for it in chain([first], others, rewrites))
    deliver(options, results, len(names))
    why = first.prepared.job.why or why_here(options.distro)
    arguments = (it for it in xacro_args(options).items() if name_robot(dict([it]), names[:1]))
    tell(options, summary(first, names, ", ".join(name for name, _ in arguments), why))
    return DONE


def _check_shared(
    options: argparse.Namespace,
    first: Rewrite,
    made: Callable[[Mapping[str, Any]], Iterator[Rewrite]],
) -> None:
    """Raise UsageError for a name of ``--shared`` that the description has not."""
    names: dict[str, set[str]] = {FRAMES: set(), TOPICS: set()}
    for name in chain.from_iterable(first.template.inventory.names):
        kinds = {name.kind, *name.kinds}
        if not kinds.isdisjoint(FRAME_KINDS):
            names[FRAMES].add(name.text.strip("/"))
        if not kinds.isdisjoint(TOPIC_KINDS):
            names[TOPICS].add(name.text.strip("/"))

    def result_with(given: Mapping[str, Any]) -> object:
        found = next(made(given))
        return found.data, found.findings

    check_shared(options, (first.data, first.findings), result_with, names)


def _strip(options: argparse.Namespace, source: bytes, robot: str) -> bytes:
    """Return the description without the robot's name."""
    given = rewriting(options)
    if not options.xacro:
        given["xacro_args"] = None
    return strip(source, robot, xacro=options.xacro, file=input_name(options), **given)


def summary(
    first: Rewrite, robots: list[str], own_arguments: str = "", of_release: str = ""
) -> str:
    """Return one line: renamed names of each kind, those by arguments, verification, release."""
    inventory, plan = first.template.inventory, first.template.plan
    names = {
        (kind, claim.value)
        for claim, spelling in zip(inventory.claims, plan.renames.values, strict=True)
        for kind, *_ in spelling
    }
    counts = Counter(kind for kind, _ in names)
    known = [plural(counts[it], WORDS.get(it, it)) for it in SEPARATORS if counts[it]]
    own = first.prepared.job.naming.own
    known += [f"{plural(len(own), 'name')} set by {own_arguments}"] if own else []
    renamed = f"renamed {', '.join(known)}" if known else "nothing to rename"
    added = f"; added {plural(len(plan.insertions), 'element')}" if plan.insertions else ""
    who = robots[0] if len(robots) == 1 else plural(len(robots), "robot")
    why = not_verified(first.findings)
    aside = dict(first.prepared.job.aside)
    verified = " ".join(filter(None, ["Verified", given(first.findings, aside)]))
    end = f"Not verified: {', '.join(why)}" if why else verified
    end += facts_of_release(first.distro, of_release, first.prepared.job.ros)
    return f"{who}: {renamed}{added}. {end}"


def _explain(options: argparse.Namespace) -> int:
    """Print an explanation of every value on the line that ``--why`` names."""
    from multibot_rewrite.cli.tables import deliver_report
    from multibot_rewrite.related_files.named_file import is_related_file

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
