# SPDX-License-Identifier: Apache-2.0
"""A launch file and its arguments -> the nodes that it would start."""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Iterable, Iterator
from typing import Any

from multibot_rewrite.producers.launch.commands import faults, read_commands
from multibot_rewrite.producers.launch.describe import SIMULATORS, Visit
from multibot_rewrite.producers.launch.door import of_launch, of_launch_ros
from multibot_rewrite.producers.launch.failures import (
    NOT_THERE,
    failure,
    missing_module,
    missing_package,
    not_installed,
)
from multibot_rewrite.producers.launch.made_files import keep_sources
from multibot_rewrite.producers.launch.places import keep_places
from multibot_rewrite.producers.launch.read_files import descriptions_in, keep_reads
from multibot_rewrite.producers.launch.records import LaunchGraph, LaunchNote, LaunchOrder
from multibot_rewrite.producers.launch.source_packages import add_empty, add_file, add_sources
from multibot_rewrite.producers.launch.stand_in import standing_in
from multibot_rewrite.producers.launch.unknown_modules import add_unknown
from multibot_rewrite.producers.launch.visit import visit_all
from multibot_rewrite.system.records import Place


class UnreadableError(Exception):
    """The launch file itself cannot be read; the message says why."""


def read_graph(order: LaunchOrder, folder: str) -> LaunchGraph:
    """Visit the description of a launch file; ``folder`` is for temporary files.

    Raises ImportError without launch, UnreadableError for a file that cannot be read.
    """
    add_sources(order.file, order.roots, folder)
    # What the parsers of the launch files in XML and YAML need.
    of_launch_ros("actions")
    keep_places()
    keep_sources()
    read_commands()
    reads = keep_reads()
    # A launch file may look at the command line itself.
    sys.argv = order.command_line
    missing: list[str] = []
    while True:
        try:
            graph = _visited(_included(order), order)
            # A function of a launch file goes on without them, as the file does.
            lost = [it for it in _lost(graph.notes) if it not in missing]
            for name in lost:
                add_empty(name, folder)
                add_unknown(name)
            missing += lost
            if not lost:
                break
        except (Exception, SystemExit) as error:
            package, module = missing_package(error), missing_module(error)
            name = package or module
            if name in missing and add_file(error, folder):
                continue
            if not name or name in missing:
                raise UnreadableError(failure(error)) from error
            if package:
                add_empty(package, folder)
            else:
                add_unknown(module)
            missing.append(name)
    files = (*graph.files, *descriptions_in(reads))
    # What the launch files of these start is known without them.
    said = (*_lost(graph.notes), *SIMULATORS)
    unsaid = [it for it in missing if it not in said]
    return graph._replace(notes=(*graph.notes, *_not_there(order, unsaid)), files=files)


def _lost(notes: Iterable[LaunchNote]) -> list[str]:
    """The packages that are missing where something was started."""
    found = (NOT_THERE.search(it.message) for it in notes)
    return list(dict.fromkeys(it[1] for it in found if it))


def _not_there(order: LaunchOrder, missing: Iterable[str]) -> Iterator[LaunchNote]:
    for name in missing:
        yield LaunchNote(Place(os.path.abspath(order.file), 1), not_installed(name))


def read_own(file: str, folder: str) -> LaunchGraph:
    """The same of a launch file that ``build`` wrote, read by the stand-in in this process; ``folder``
    is for temporary files. Raises as ``read_graph``."""
    before, order = tempfile.tempdir, LaunchOrder(file)
    with standing_in():
        tempfile.tempdir = folder
        keep_places()
        try:
            description = _included(order)
            return _visited(description, order)
        except (Exception, SystemExit) as error:
            raise UnreadableError(failure(error)) from error
        finally:
            tempfile.tempdir = before


def _visited(description: Any, order: LaunchOrder) -> LaunchGraph:
    context = of_launch().LaunchContext(noninteractive=True)
    seen = Visit(context, [], [], {}, [], Place(os.path.abspath(order.file), 1), [])
    visit_all(description, seen)
    for it in faults(context):
        seen.note(it, parameters=True)
    notes = tuple(dict.fromkeys(seen.notes))
    files, ignored = tuple(seen.files.items()), tuple(dict.fromkeys(seen.unread))
    return LaunchGraph(tuple(seen.nodes), notes, files, unread=ignored)


def _included(order: LaunchOrder) -> Any:
    """The file as ``ros2 launch`` includes it; its description is read here to see its faults."""
    sources = of_launch("launch_description_sources")
    source = sources.AnyLaunchDescriptionSource(os.path.abspath(order.file))
    source.get_launch_description(of_launch().LaunchContext(noninteractive=True))
    include = of_launch("actions").IncludeLaunchDescription
    return include(source, launch_arguments=list(order.arguments))
