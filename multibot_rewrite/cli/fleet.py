# SPDX-License-Identifier: Apache-2.0
"""What the commands about a fleet have in common: the robots, their table, its findings."""

from __future__ import annotations

import argparse
import os
import shlex
from collections.abc import Iterable, Sequence

from multibot_rewrite.base.config import configured_definitions
from multibot_rewrite.base.file_kinds import DESCRIPTIONS, refuse_others
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.releases import release_doubt
from multibot_rewrite.checks.judged_plan import make_fleet
from multibot_rewrite.cli.output import note
from multibot_rewrite.cli.report import About, check_report, chosen, report_findings_too
from multibot_rewrite.cli.usage import (
    asked_number,
    check_order,
    check_xacro,
    given_options,
    policy,
    robots,
    xacro_args,
)
from multibot_rewrite.cli.walk import check_folder, check_target
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.fleet.fleet import Fleet
from multibot_rewrite.knowledge.nodl.lookup import NO_DOCUMENTS, SUFFIXES
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.producers.launch.records import LaunchOrder, launch_order, orders_in_words

# Options that name files to write.
WRITTEN = ("output", "save_snapshot", "report")
FLEET_FILES = (".yaml", ".yml")
# What a fleet file says itself, and how the option is written.
_OF_FLEET_FILE = (
    *("robots", "node_set", "nodes", "layout", "affix", "topics", "separator", "shared"),
    *("definitions", "launch", "roots"),
)
OF_FLEET_FILE = {"words": "ROBOT", **{it: f"--{it.replace('_', '-')}" for it in _OF_FLEET_FILE}}


def check_use(options: argparse.Namespace, command: str, printed: bool) -> None:
    """Raise UsageError for a target that cannot be written; ``printed``: the result is printed."""
    check_order(f"multibot {command}", options.input, options.words)
    check_report(options, printed)
    if options.output:
        check_target(options.output, [options.input])
        check_folder(options.output)


def build(options: argparse.Namespace) -> Fleet:
    """Return the fleet that the options describe, a fleet file or a description."""
    made = (_fleet_of_file if options.input.endswith(FLEET_FILES) else _fleet_of_words)(options)
    note_interfaces(options, made.facts)
    check_unread(options, made)
    return made


def check_unread(options: argparse.Namespace, made: Fleet) -> None:
    """Raise UsageError where a result would be written over a file that a description was made from."""
    for name in WRITTEN:
        if getattr(options, name, None):
            check_target(getattr(options, name), made.read, f"--{name.replace('_', '-')}")


def note_interfaces(options: argparse.Namespace, facts: Iterable[NodeFacts]) -> None:
    """Print which nodes are described by a NoDL file."""
    for name, file in dict.fromkeys((it.name, it.interface) for it in facts if it.interface):
        note(options, f"note: {name} as in {file} (NoDL)")


def _fleet_of_file(options: argparse.Namespace) -> Fleet:
    from multibot_rewrite.checks.closed_plan import closed_plan
    from multibot_rewrite.checks.judged_plan import plan_fleet
    from multibot_rewrite.fleet.file.fleet_file import (  # one description needs none of it
        input_files,
        read_fleet,
    )
    from multibot_rewrite.fleet.file.robot_choice import Choice

    choice = Choice(number=asked_number(options))
    file = read_fleet(options.input, options.distro or "", os.environ, choice)
    check_own(options)
    if options.output:
        check_target(options.output, input_files(file))
    return closed_plan(plan_fleet(file, trust=options.trust))


def check_own(options: argparse.Namespace) -> None:
    """Raise UsageError for an option that the fleet file sets."""
    known = {name: written for name, written in OF_FLEET_FILE.items() if name in vars(options)}
    if given := given_options(options, known):
        raise UsageError(f"{options.input}: a fleet file has its own, leave out {given[0]}")


def _fleet_of_words(options: argparse.Namespace) -> Fleet:
    names = robots(options)
    if not names:
        refuse_others(read_file(options.input), options.input, *DESCRIPTIONS)
        raise UsageError(
            "no ROBOT given; write robots' names after the input, or give a fleet file (*.yaml)"
        )
    check_xacro(options, [options.input])
    if doubt := release_doubt(options.distro):
        note(options, f"warning: {doubt}")
    nodes, nodl = own_nodes(options)
    return make_fleet(
        options.input,
        names,
        options.node_set,
        policy(options),
        nodes=nodes,
        nodl=nodl,
        definitions=[*configured_definitions(options.input), *options.definitions],
        xacro_args=xacro_args(options),
        trust=options.trust,
        launch=[
            launch_order(it, options.roots)._replace(trusted=options.trust) for it in options.launch
        ],
        release=options.distro or "",
    )


def own_nodes(options: argparse.Namespace) -> tuple[str | None, list[str]]:
    """Return the values of ``--nodes``: the user's file of nodes, and NoDL files or folders."""
    nodl = [it for it in options.nodes if _is_nodl(it)]
    files = [it for it in options.nodes if it not in nodl]
    if len(files) > 1:
        raise UsageError(f"--nodes: {files[0]} and {files[1]} are two files of nodes; give one")
    return next(iter(files), None), nodl


def _is_nodl(path: str) -> bool:
    return path == NO_DOCUMENTS or path.endswith(SUFFIXES) or os.path.isdir(path)


def report_table(options: argparse.Namespace, made: Fleet) -> bool:
    """Report what is wrong with the table and open in the robots; return whether that is a failure."""
    found = chosen(options, (*made.table.problems, *made.gaps))
    about = About([options.input], made.words, made.table.release)
    return report_findings_too(options, found, about)


def orders_of(options: argparse.Namespace, words: Sequence[str]) -> list[LaunchOrder]:
    """Return launch files with their arguments; raises UsageError for anything else."""
    orders = orders_in_words(words, shlex.join(words), options.roots)
    return [it._replace(trusted=options.trust) for it in orders]
