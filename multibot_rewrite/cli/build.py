"""``multibot build``: a fleet file in, everything its robots need out."""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterable, Mapping, Sequence

from multibot_rewrite.cli.folders import change_folder, check_inside, clear_leftovers, locked
from multibot_rewrite.cli.output import print_findings, print_lines, say
from multibot_rewrite.cli.process import DONE, PROGRAM, STOPPED
from multibot_rewrite.fleets.build import make_outputs
from multibot_rewrite.fleets.fleet_file import read_fleet
from multibot_rewrite.fleets.fleet_plan import FleetPlan, plan_fleet
from multibot_rewrite.fleets.manifest import (
    MANIFEST,
    NOTE,
    OutputChanges,
    hash_of,
    manifest,
    output_changes,
    read_manifest,
)
from multibot_rewrite.fleets.output_file import OutputFile
from multibot_rewrite.model import ERROR, UsageError
from multibot_rewrite.sources.read import read_file

MORE = """\
examples:
  multibot build fleet.yaml -o out/             everything, one folder a robot
  multibot build fleet.yaml -o out/ --check     in CI: what is stale? writes nothing
exit codes: 0 done; 1 findings that stop the job (any, with --strict), or with --check something is
stale; 2 wrong use or unreadable input
"""


def options(parser: argparse.ArgumentParser) -> None:
    """Add the options of the command."""
    parser.epilog = MORE
    parser.add_argument("fleet", metavar="FLEET", help="the fleet file, YAML")
    parser.add_argument("-o", "--output", metavar="FOLDER", required=True, help="where it all goes")
    parser.add_argument("--check", action="store_true", help="say what is stale, write nothing")
    parser.add_argument("--force", action="store_true", help="overwrite what no build made")
    parser.add_argument("--strict", action="store_true", help="warnings stop the job")
    parser.add_argument("--quiet", action="store_true", help="no report, only findings")


def run(options: argparse.Namespace) -> int:
    """Build or check; returns the exit code."""
    _check_folder(options.output)
    plan = plan_fleet(read_fleet(options.fleet))
    made = make_outputs(plan)
    findings = [*made.findings, *plan.fleet.table.problems]
    print_findings(sorted(set(findings), key=lambda it: (it.file, it.line, it.column, it.code)))
    if any(it.level == ERROR or options.strict for it in findings):
        say("nothing was written", PROGRAM)
        return STOPPED
    files = [*made.files, manifest(made.files, _read(plan, made.files), options.output)]
    with locked(options.output):
        known = _known(options.output)
        there = _there(options.output, {*known, *(it.path for it in files)})
        found = output_changes(files, known, there)
        return _told(options, found) if options.check else _written(options, files, found)


def _read(plan: FleetPlan, files: Iterable[OutputFile]) -> dict[str, bytes]:
    """The files that a build was made from."""
    paths = {path for it in files for path in it.sources} | set(plan.file.files)
    return {path: read_file(path) for path in paths}


def _check_folder(folder: str) -> None:
    if not folder:
        raise UsageError("--output is empty, give the name of a folder")
    if os.path.exists(folder) and not os.path.isdir(folder):
        raise UsageError(f"{folder}: it is a file; name a folder")


def _known(folder: str) -> dict[str, str]:
    """What is a build's: what the last one made, and what one that was killed has made of it."""
    found = _of_manifest(folder, MANIFEST)
    begun = _of_manifest(folder, NOTE)
    there = _there(folder, begun)
    return {**found, **{path: it for path, it in begun.items() if there.get(path) == it}}


def _of_manifest(folder: str, name: str) -> dict[str, str]:
    path = os.path.join(folder, name)
    if not os.path.exists(path):
        return {}
    data = read_file(path)
    return {**read_manifest(data, path), name: hash_of(data)}


def _there(folder: str, paths: Iterable[str]) -> Mapping[str, str]:
    full = {path: os.path.join(folder, path) for path in paths}
    return {path: hash_of(read_file(it)) for path, it in full.items() if os.path.isfile(it)}


def _told(options: argparse.Namespace, found: OutputChanges) -> int:
    stale = [f"{path}: stale" for path in found.write]
    print_lines([*stale, *(f"{path}: left over" for path in found.remove)])
    count = len(found.write) + len(found.remove)
    if count:
        say(f"{count} files of {options.output} are not what {options.fleet} makes", PROGRAM)
        return STOPPED
    if not options.quiet:
        say(f"{options.output} is up to date", PROGRAM)
    return DONE


def _written(options: argparse.Namespace, files: Sequence[OutputFile], found: OutputChanges) -> int:
    if not options.force:
        _refuse(options.output, found.foreign, "no build made it")
        _refuse(options.output, found.edited, "it was edited since it was built")
    check_inside(options.output, (*found.write, *found.remove))
    clear_leftovers(options.output)
    data = {it.path: it.data for it in files}
    if found.write or found.remove:
        note = NOTE, data[MANIFEST]
        change_folder(options.output, {it: data[it] for it in found.write}, found.remove, note)
    if not options.quiet:
        robots = len({it.path.partition("/")[0] for it in files if "/" in it.path})
        say(f"{robots} robots, {len(files)} files, {len(found.write)} written", PROGRAM)
    return DONE


def _refuse(folder: str, paths: Sequence[str], why: str) -> None:
    if paths:
        more = f" (and {len(paths) - 1} more)" if len(paths) > 1 else ""
        where = os.path.join(folder, paths[0])
        raise UsageError(f"{where}: {why}{more}; move it away, or --force overwrites it")
