# SPDX-License-Identifier: Apache-2.0
"""``multibot build``: a fleet file in, everything its robots need out."""

from __future__ import annotations

import argparse
import os
from collections.abc import Collection, Iterable, Mapping, Sequence
from contextlib import suppress

from multibot_rewrite.base.findings.finding import ERROR
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.releases import facts_of_release
from multibot_rewrite.base.wording import plural
from multibot_rewrite.checks.build import make_outputs
from multibot_rewrite.checks.judged_plan import plan_fleet
from multibot_rewrite.checks.read_back import read_back
from multibot_rewrite.cli.fleet import note_interfaces
from multibot_rewrite.cli.folders import change_folder, check_inside, clear_leftovers, locked
from multibot_rewrite.cli.output import detail, note, print_lines, say
from multibot_rewrite.cli.process import DONE, PROGRAM, STOPPED
from multibot_rewrite.cli.report import (
    About,
    check_report,
    chosen,
    report_findings_too,
    with_coverage,
)
from multibot_rewrite.cli.usage import asked_number
from multibot_rewrite.cli.walk import check_link, is_same_file
from multibot_rewrite.description.checks.meeting import not_verified
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.description.sources.release_said import MANIFEST
from multibot_rewrite.fleet.file.fleet_file import input_files, read_fleet
from multibot_rewrite.fleet.file.robot_choice import Choice
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.launch.launch_file import LAUNCH
from multibot_rewrite.fleet.outputs.manifest import (
    NOTE,
    OutputChanges,
    hash_of,
    manifest,
    output_changes,
    read_manifest,
)
from multibot_rewrite.fleet.outputs.output_file import OutputFile
from multibot_rewrite.system.coverage import Coverage, coverage


def run(options: argparse.Namespace) -> int:
    """Build or check; returns the exit code."""
    _check_folder(options.output)
    if options.undo:
        return _remove_build(options)
    check_report(options, printed=False)
    choice = Choice(number=asked_number(options))
    fleet = read_fleet(options.fleet, options.distro or "", os.environ, choice)
    plan = plan_fleet(fleet, trust=options.trust)
    note_interfaces(options, plan.fleet.facts)
    made = make_outputs(plan, os.path.abspath(options.output))
    back = read_back(plan, made, os.path.abspath(options.output))
    # What is told in both is said once, at the level of the folder.
    again = {(it.code, it.names or it) for it in back}
    new = (
        it for it in made.findings if (it.code, it.names or it._replace(level=ERROR)) not in again
    )
    held = coverage(made.planned)
    every = [*new, *back, *plan.fleet.table.problems]
    # Keys of the fleet file in place of the options of urdf-postfix.
    for key in ("layout", "affix", "topics"):
        every = [it._replace(hint=it.hint.replace(f"--{key} ", f"{key}: ")) for it in every]
    both = dict.fromkeys(every)
    ordered = sorted(both, key=lambda it: (it.file, it.line, it.column, it.code, it.place))
    about = About([options.fleet], plan.words, plan.file.distro, held)
    if report_findings_too(options, chosen(options, ordered), about):
        say("nothing was written", PROGRAM)
        return STOPPED
    read = _input_files(plan, made.files)
    files = [*made.files, manifest(made.files, read, options.output, plan)]
    _check_inputs(options.output, files, {*read, *input_files(plan.file), *plan.fleet.read})
    with locked(options.output):
        known = _known_hashes(options.output)
        there = _existing_hashes(options.output, {*known, *(it.path for it in files)})
        found = output_changes(files, known, there)
        if options.check:
            return _report_stale(options, found)
        why = not_verified({*made.findings, *plan.fleet.table.problems})
        end = f"; not verified: {', '.join(why)}" if why else ""
        end = f"{end}{facts_of_release(plan.file.distro, plan.file.why)}"
        return _write_changes(options, files, found, held, end)


def _input_files(plan: FleetPlan, files: Iterable[OutputFile]) -> dict[str, bytes]:
    """Return the files that a build was made from, by path."""
    paths = {path for it in files for path in it.sources} | set(plan.file.files)
    paths |= {it.interface for it in plan.fleet.facts if it.interface}
    for it in plan.file.robots:
        paths -= {path for path, _ in it.filled} - {*it.files}
        paths |= {*it.files} if it.parts else set()
    return {path: read_file(path) for path in paths}


def _check_inputs(folder: str, files: Iterable[OutputFile], read: Collection[str]) -> None:
    """Raise UsageError where a build would write over what it is made from, which no option allows."""
    for path in (os.path.join(folder, it.path) for it in files):
        if os.path.exists(path) and any(is_same_file(path, it) for it in read):
            raise UsageError(f"{path} is a file that is read; choose another folder for --output")


def _check_folder(folder: str) -> None:
    check_link(folder)
    if os.path.exists(folder) and not os.path.isdir(folder):
        raise UsageError(f"{folder}: it is a file; name a folder")


def _known_hashes(folder: str) -> dict[str, str]:
    """Return hashes of the files that the last build made, and that a killed build has made so far."""
    found = _manifest_hashes(folder, MANIFEST)
    begun = _manifest_hashes(folder, NOTE)
    there = _existing_hashes(folder, begun)
    return {**found, **{path: it for path, it in begun.items() if there.get(path) == it}}


def _manifest_hashes(folder: str, name: str) -> dict[str, str]:
    """Return the hash of each file that a manifest lists, and its own; empty without a manifest."""
    path = os.path.join(folder, name)
    if not os.path.exists(path):
        return {}
    data = read_file(path)
    return {**read_manifest(data, path), name: hash_of(data)}


def _existing_hashes(folder: str, paths: Iterable[str]) -> Mapping[str, str]:
    full = {path: os.path.join(folder, path) for path in paths}
    return {path: hash_of(read_file(it)) for path, it in full.items() if os.path.isfile(it)}


def _report_stale(options: argparse.Namespace, found: OutputChanges) -> int:
    lines = [
        *(f"{path}: stale" for path in found.write),
        *(f"{it}: left over" for it in found.remove),
    ]
    print_lines(lines)
    if lines:
        differ = f"{plural(len(lines), 'file')} of {options.output} differ from what"
        say(f"{differ} {options.fleet} makes", PROGRAM)
        return STOPPED
    note(options, f"{options.output} is up to date")
    return DONE


def _write_changes(
    options: argparse.Namespace,
    files: Sequence[OutputFile],
    found: OutputChanges,
    held: Coverage,
    end: str,
) -> int:
    """Write what changed, and sum up; ``end`` is the end of that line."""
    if not options.force:
        _refuse_overwriting(options.output, found.foreign, "no build made it")
        _refuse_overwriting(options.output, found.edited, "it was edited since it was built")
    check_inside(options.output, (*found.write, *found.remove))
    clear_leftovers(options.output)
    data = {it.path: it.data for it in files}
    if found.write or found.remove:
        change_folder(
            options.output,
            {it: data[it] for it in found.write},
            found.remove,
            (NOTE, data[MANIFEST]),
        )
    for path in found.write:
        detail(options, f"wrote {os.path.join(options.output, path)}")
    written = f"{plural(len(files), 'file')}, {len(found.write)} written{end}"
    note(options, with_coverage(held, written))
    note(options, f"next: ros2 launch {os.path.join(options.output, LAUNCH)}")
    return DONE


def _remove_build(options: argparse.Namespace) -> int:
    """Remove what a build wrote; files that it did not write stay."""
    folder = options.output
    with locked(folder):
        known = _known_hashes(folder)
        if not known:
            raise UsageError(f"{folder}: no build wrote into it, so there is nothing to undo")
        found = output_changes((), known, _existing_hashes(folder, known))
        if not options.force:
            _refuse_overwriting(folder, found.edited, "it was edited since it was built")
        check_inside(folder, found.remove)
        change_folder(folder, {}, found.remove, (NOTE, b""))
        with suppress(OSError):
            os.rmdir(folder)
    note(options, f"{folder}: {plural(len(found.remove), 'file')} removed")
    return DONE


def _refuse_overwriting(folder: str, paths: Sequence[str], why: str) -> None:
    if paths:
        more = f" (and {len(paths) - 1} more)" if len(paths) > 1 else ""
        where = os.path.join(folder, paths[0])
        raise UsageError(f"{where}: {why}{more}; move it away, or --force overwrites it")
