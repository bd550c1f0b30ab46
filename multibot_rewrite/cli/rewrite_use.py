# SPDX-License-Identifier: Apache-2.0
"""Which options of ``urdf-postfix`` do not go together, and which files it may write."""

from __future__ import annotations

import argparse
import os
import re
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from typing import Any

from multibot_rewrite.base.conventions import SHARED_TOPICS, WORLD_FRAMES
from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.findings.selection import fails
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.nearest import did_you_mean
from multibot_rewrite.base.wording import SEVERAL, shorten
from multibot_rewrite.cli.output import (
    diff,
    note,
    print_bytes,
    prints_colour,
    say,
    watched,
    write_files,
)
from multibot_rewrite.cli.report import (
    About,
    by_themselves,
    check_report,
    chosen,
    report_findings_too,
)
from multibot_rewrite.cli.usage import check_order, policy, xacro_args
from multibot_rewrite.cli.walk import check_link, check_target
from multibot_rewrite.description.sources.included_by import data_of_file
from multibot_rewrite.description.sources.read import is_xacro

PLACEHOLDER = "{robot}"
CHANGES = "changes"


def check_use(options: argparse.Namespace, names: list[str]) -> None:
    """Raise UsageError for missing arguments and for options that exclude each other."""
    if options.input == "":
        raise UsageError("the name of the input is empty; write its path")
    if options.input is None:
        raise UsageError("no INPUT and no ROBOT given; see urdf-postfix --help")
    if not names:
        undo = " --undo" * options.undo
        example = f"urdf-postfix {options.input} robot1{undo}"
        raise UsageError(f"no robot name given; for example: {example}")
    check_order("urdf-postfix", options.input, names)
    _check_together(options)
    inputs = (options.input, options.urdf or "", options.xacro or "")
    if xacro_args(options) and not any(is_xacro(path) for path in inputs):
        raise UsageError(f"{input_name(options)} is no xacro: leave out NAME:=VALUE")
    if len(names) > 1 and (options.undo or options.in_place):
        raise UsageError("--undo and --in-place take one robot at a time")
    check_report(options, printed=not (options.output or options.in_place))
    is_one = options.output_kind == CHANGES
    known = "" if is_one else PLACEHOLDER
    unknown = [it for it in re.findall(r"\{[^{}]*\}", options.output or "") if it != known]
    if unknown:
        hint = f"only {known} is filled in" if known else "one file serves all robots"
        raise UsageError(f"--output {options.output}: unknown placeholder {unknown[0]}, {hint}")
    if len(names) > 1 and not (is_one or options.diff or PLACEHOLDER in (options.output or "")):
        ending = os.path.splitext(options.input)[1] or ".urdf"
        hint = f"-o out/, or -o 'out/{{robot}}{ending}'"
        also = "; multibot build writes one for all robots" * (ending == ".rviz")
        raise UsageError(f"several robots need one file each: {hint}{also}")
    _check_targets(
        options, [target_path(options.output, robot) for robot in names if options.output]
    )


def _check_together(options: argparse.Namespace) -> None:
    """Raise UsageError for options of which one would silently have no effect with the other."""
    if options.output is not None and options.in_place:
        raise UsageError("give --output or --in-place, not both")
    if options.diff and (options.output is not None or options.in_place):
        raise UsageError("--diff prints to standard output: leave out --output and --in-place")
    if options.xacro and not options.undo:
        raise UsageError("--xacro goes with --undo; to rewrite a xacro, name it as the INPUT")
    others = (it for it in ("undo", "in_place", "diff") if getattr(options, it))
    if options.output_kind == CHANGES and (other := next(others, "")):
        raise UsageError(
            f"--output-kind changes lists what a rewrite changes: leave out --{other.replace('_', '-')}"
        )
    if options.in_place and (options.input == "-" or is_xacro(options.input)):
        raise UsageError("--in-place needs a URDF file, not standard input or xacro")


def _check_targets(options: argparse.Namespace, targets: list[str]) -> None:
    """Raise UsageError for a result that would overwrite the input, or a file that is read for it."""
    for path in targets:
        if os.path.isfile(path) and _same_file(path, options.input):
            raise UsageError(f"{path} is the input file; choose another name, or --in-place")
        for option in ("urdf", "xacro", "definitions"):
            given = getattr(options, option) or ()
            for it in [given] if isinstance(given, str) else given:
                if os.path.isfile(path) and _same_file(path, it):
                    raise UsageError(f"{path} is the file of --{option}; choose another name")


def check_unread(options: argparse.Namespace, names: Iterable[str], read: Iterable[str]) -> None:
    """Raise UsageError where a result would be written over a file that was ``read`` for it."""
    files = list(read)
    for robot in names if options.output else ():
        check_target(target_path(options.output, robot), files)


def _same_file(path: str, other: str) -> bool:
    return os.path.isfile(other) and os.path.samefile(path, other)


def below(output: str | None, source: str) -> str | None:
    """Return the output; for a folder, the pattern of each robot's file below it, as in a build."""
    if not output or not (output.endswith("/") or os.path.isdir(output)):
        return output
    name = "robot.urdf" if source == "-" else os.path.basename(source).removesuffix(".xacro")
    return os.path.join(output, PLACEHOLDER, name)


def target_path(output: str, robot: str) -> str:
    """Return the output file of one robot."""
    return output.replace(PLACEHOLDER, robot)


def input_name(options: argparse.Namespace) -> str:
    """Return the input as messages call it."""
    if options.input == "-":
        return "<stdin>"
    expanded = " (expanded)" if is_xacro(options.input) else ""
    return f"{options.input}{expanded}"


def is_stopped(
    options: argparse.Namespace, found: Iterable[Finding], robots: Sequence[str], release: str
) -> bool:
    """Report what was found, to a program only errors; return whether they stop the rewrite."""
    findings: Sequence[Finding] = chosen(options, dict.fromkeys(found))
    if options.silent and not fails(findings, options.fail_on):
        findings = ()
    about = About([input_name(options)], by_themselves(robots), release)
    stops = report_findings_too(options, findings, about)
    if stops:
        say(f"--fail-on {options.fail_on}: nothing was written", options.program)
    return stops


def tell(options: argparse.Namespace, text: str) -> None:
    """Print a line in addition to the result, unless a program reads it."""
    if not options.silent:
        note(options, text)


def deliver(
    options: argparse.Namespace,
    results: Iterable[tuple[str, bytes, bytes]],
    total: int,
) -> None:
    """Print or write the results (robot, before, after) as they are made."""
    target = options.input if options.in_place else options.output
    if target:
        files = ((target_path(target, robot), data) for robot, _, data in results)
        every = files if options.in_place else map(_unless_link, files)
        write_files(options, watched(every, total, "writing"))
        return
    colour = prints_colour(options)
    for robot, before, data in results:
        name = input_name(options)
        text = diff(before, data, name, f"{name} for {robot}", colour) if options.diff else data
        print_bytes(text)


def _unless_link(item: tuple[str, bytes]) -> tuple[str, bytes]:
    check_link(item[0])
    return item


TOPICS, FRAMES = "shared_topics", "shared_frames"
USUAL: Mapping[str, tuple[str, ...]] = {TOPICS: SHARED_TOPICS, FRAMES: WORLD_FRAMES}
# Makes the result with another naming policy; equal results are equal in texts and findings.
Make = Callable[[Mapping[str, Any]], object]


def check_shared(
    options: argparse.Namespace,
    result: object,
    make: Make,
    names: Mapping[str, Collection[str]],
    files: Sequence[str] = (),
) -> None:
    """Raise UsageError for a name of ``--shared`` without which the input gives the same result.

    ``names`` are the frames and topics of the input by ``FRAMES`` and ``TOPICS``, as far as they are
    known; where they are not, a name that is in the text of one of the ``files`` may be one. What is
    shared by default may be named again.
    """
    given: dict[str, Any] = {**policy(options)}
    for word in dict.fromkeys(options.shared):
        kind = TOPICS if word.startswith("/") else FRAMES
        if word in USUAL[kind] or word.strip("/") in names.get(kind, ()):
            continue
        without = [
            it for it in options.shared if it.startswith("/") == (kind == TOPICS) and it != word
        ]
        if make({**given, kind: without}) == result:
            hint = _hint(word, given, make, result, names)
            if not hint and any(word.strip("/").encode() in data_of_file(it) for it in files):
                continue
            what, there = "topic" if kind == TOPICS else "frame", sorted(names.get(kind, ()))
            hint = hint or f"; its {what}s are {shorten(there, SEVERAL)}" * bool(there)
            raise UsageError(f"--shared {word}: the input has no {what} {word!r}{hint}")


def _hint(
    word: str,
    given: Mapping[str, Any],
    make: Make,
    result: object,
    names: Mapping[str, Collection[str]],
) -> str:
    """Return what was probably meant: the name as a frame or topic, or a similar one."""
    kind, other = (TOPICS, FRAMES) if word.startswith("/") else (FRAMES, TOPICS)
    bare = word.strip("/")
    spelled = bare if other == FRAMES else f"/{bare}"
    as_other = {**given, other: [*given.get(other, USUAL[other]), spelled]}
    if bare in names.get(other, ()) or make(as_other) != result:
        slash = "topics are written with a slash" if other == TOPICS else "frames have no slash"
        return f"; {slash}: --shared {spelled}"
    slashed = "/" if kind == TOPICS else ""
    near = did_you_mean(word, sorted(f"{slashed}{it}" for it in names.get(kind, ())))
    return f"; {near}" if near else ""
