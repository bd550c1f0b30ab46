# SPDX-License-Identifier: Apache-2.0
"""A launch file and its arguments -> the nodes that it would start."""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from multibot_rewrite.producers.launch.commands import (
    faults,
    read_commands,
    see_no_machine,
    start_nothing,
)
from multibot_rewrite.producers.launch.describe import SIMULATORS, Visit, changed_environment
from multibot_rewrite.producers.launch.door import of_launch, of_launch_ros
from multibot_rewrite.producers.launch.failures import (
    failure,
    is_of_file,
    is_without,
    lost_file,
    missing_module,
    missing_package,
    not_installed,
)
from multibot_rewrite.producers.launch.includes import unread_of
from multibot_rewrite.producers.launch.kept_paths import (
    GONE,
    keep_sources,
    real_paths,
    with_real_paths,
)
from multibot_rewrite.producers.launch.places import keep_places
from multibot_rewrite.producers.launch.read_files import descriptions_in, files_read, keep_reads
from multibot_rewrite.producers.launch.records import (
    LaunchArgument,
    LaunchGraph,
    LaunchNote,
    LaunchOrder,
)
from multibot_rewrite.producers.launch.source_packages import (
    NOT_INSTALLED,
    add_empty,
    add_file,
    add_sources,
)
from multibot_rewrite.producers.launch.stand_in import standing_in
from multibot_rewrite.producers.launch.stand_in.names import names
from multibot_rewrite.producers.launch.stand_in.packages import (
    FindPackage,
    FindPackagePrefix,
    FindPackageShare,
    PackageNotFoundError,
    get_package_prefix,
)
from multibot_rewrite.producers.launch.unknown_modules import add_unknown, imported
from multibot_rewrite.producers.launch.visit import ASKED, visit_all
from multibot_rewrite.system.records import Place


class UnreadableError(Exception):
    """A launch file cannot be read, and why; ``of_file``: nor can launch, wherever it is."""

    def __init__(self, message: str, *, of_file: bool = True) -> None:
        super().__init__(message)
        self.of_file = of_file


def read_graph(order: LaunchOrder, folder: str) -> LaunchGraph:
    """Visit the description of a launch file; ``folder`` is for temporary files.

    Raises ImportError without launch, UnreadableError for a file that cannot be read.
    """
    add_sources(order.file, order.roots, folder)
    # What the parsers of the launch files in XML and YAML need.
    of_launch_ros("actions")
    keep_places()
    keep_sources()
    lines, reads = read_commands(), keep_reads()
    unsure = [] if order.trusted else start_nothing(lines)
    if not order.trusted:
        see_no_machine(unsure)
    # A launch file may look at the command line itself.
    sys.argv = order.command_line
    missing: list[str] = []
    PackageNotFoundError.asked.clear()
    while (graph := _try_to_read(order, folder, missing)) is None:
        pass
    missing += [it for it in PackageNotFoundError.asked if it not in missing]
    files = (*graph.files, *descriptions_in(reads.paths))
    # What the launch files of these start is known without them.
    off = {it.package for it in graph.off} - graph.packages
    said = (*_lost_packages(graph.notes), *SIMULATORS, *off)
    unsaid = [it for it in missing if it not in said]
    place = Place(os.path.abspath(order.file), 1)
    more = (*map(not_installed, unsaid), *dict.fromkeys(unsure))
    own = (LaunchNote(place, it, parameters=it in unsure) for it in more)
    notes = (*graph.notes, *own)
    imports = tuple(it for it in imported() if it not in names().parameters.split())
    read = files_read(lines, reads)
    whole = graph._replace(notes=notes, files=files, read=read, imports=imports)
    return with_real_paths(whole)  # type: ignore[no-any-return]


def _try_to_read(order: LaunchOrder, folder: str, missing: list[str]) -> LaunchGraph | None:
    """Return the graph; None if a package or file was missing, for which a stand-in was made now."""
    try:
        graph = _visited_graph(order)
    except UnreadableError:
        raise
    except (Exception, SystemExit) as error:  # a launch file may raise anything
        if missing and is_without(error):
            said = f"the package {missing[-1]!r} computes what it starts, and is not read here"
            return LaunchGraph(notes=(LaunchNote(Place(os.path.abspath(order.file), 1), said),))
        _stand_in_for(error, folder, missing)
        return None
    # A function of a launch file goes on without them, as the file does.
    lost = [it for it in _lost_packages(graph.notes) if it not in missing]
    for name in lost:
        add_empty(name, folder)
        add_unknown(name)
    missing += lost
    return None if lost else graph


def _stand_in_for(error: BaseException, folder: str, missing: list[str]) -> None:
    """Add a stand-in for the missing package or file; raises UnreadableError for other errors."""
    package, module = missing_package(error), missing_module(error)
    name = package or module
    if name in missing and add_file(error, folder):
        return
    if not name or name in missing:
        text = f"{failure(error)}{lost_file(error)}"
        raise UnreadableError(text, of_file=is_of_file(error)) from error
    if package:
        add_empty(package, folder)
    else:
        add_unknown(module)
    missing.append(name)


def _lost_packages(notes: Iterable[LaunchNote]) -> list[str]:
    """Return the missing packages that notes name, each once."""
    return list(dict.fromkeys(it.missing for it in notes if it.missing))


def read_own(file: str, folder: str) -> LaunchGraph:
    """Return the graph of a launch file of ``build``, read in this process, as ``read_graph``."""
    before, order = tempfile.tempdir, LaunchOrder(file)
    find = FindPackagePrefix.find, FindPackageShare.find
    with standing_in():
        tempfile.tempdir = folder
        # Parameter files have substitutions as well.
        _find_packages_by(_prefix, _share)
        keep_places()
        try:
            return with_real_paths(_visited_graph(order))  # type: ignore[no-any-return]
        except (Exception, SystemExit) as error:  # as above
            raise UnreadableError(failure(error)) from error
        finally:
            tempfile.tempdir = before
            _find_packages_by(*find)


def _find_packages_by(prefix: Callable[..., str], share: Callable[..., str]) -> None:
    """Let the substitutions for folders of packages find them by these methods."""
    FindPackagePrefix.find, FindPackageShare.find = prefix, share  # type: ignore[method-assign]


def _prefix(_self: FindPackage, package_name: str) -> str:
    """Return what a package is installed in; an empty folder for one that is not here."""
    try:
        return get_package_prefix(package_name)
    except LookupError:
        return os.path.join(tempfile.gettempdir(), NOT_INSTALLED)


def _share(own: FindPackage, package_name: str) -> str:
    """Return the share folder of a package, which is empty for one that is not here."""
    return os.path.join(_prefix(own, package_name), "share", package_name)


def _visited_graph(order: LaunchOrder) -> LaunchGraph:
    """Return what loading and visiting a launch file finds; the environment stays as it was."""
    before = dict(os.environ)
    try:
        return _found_in(_described(order), order, before)
    finally:
        # The environment of launch is that of its process, and the file may be read again.
        for name in [it for it in os.environ if it not in before]:
            del os.environ[name]
        os.environ.update(before)


def _found_in(description: Any, order: LaunchOrder, before: Mapping[str, str]) -> LaunchGraph:
    """Return what visiting a description finds; raises UnreadableError."""
    # Without an argument that the file itself has to be given it is not read.
    for it, includes in getattr(description, ASKED)():
        usual = it.default_value is not None or getattr(it, "_conditionally_included", False)
        free = order.every or usual
        if not free and not includes and it.name not in dict(order.arguments):
            raise UnreadableError(f"it has to be given {it.name}; write {it.name}:=VALUE after it")
    context, path = of_launch().LaunchContext(noninteractive=True), os.path.abspath(order.file)
    folder = {"current_launch_file_directory": os.path.dirname(path)}
    context.extend_locals({"current_launch_file_path": path, **folder})
    context.launch_configurations.update(order.arguments)
    seen = Visit(context, [], [], {}, [], Place(path, 1), [], [], before, {}, [], [], order.every)
    unread_of(path, dict(order.arguments), seen)
    visit_all(description, seen)
    declared = _declared(description)
    for it in faults(context):
        seen.note(it, parameters=True)
    notes = tuple(dict.fromkeys(_with_unset(seen.notes, path)))
    files, ignored = tuple(seen.files.items()), tuple(dict.fromkeys(seen.unread))
    own = tuple(changed_environment(seen).items())
    notes = (*notes, *_lost_variables(seen, path))
    return LaunchGraph(
        *(tuple(seen.nodes), notes, files),
        unread=ignored,
        includes=tuple(seen.includes),
        environment=own,
        declared=declared,
        idle=tuple(dict.fromkeys(seen.idle)),
        off=tuple(seen.off),
    )


def _lost_variables(seen: Visit, path: str) -> tuple[LaunchNote, ...]:
    """Return notes on variables with folders that exist only while launch files are read."""
    before, now = seen.before, seen.context.environment.items()
    new = (name for name, it in now if before.get(name) != it and GONE in real_paths(it))
    said = (f"the environment variable {it} has a folder of installed packages" for it in new)
    place = Place(path, 1)
    return tuple(LaunchNote(place, f"{it}; that is left out", parameters=True) for it in said)


def _declared(description: Any) -> tuple[LaunchArgument, ...]:
    """Return the arguments of a launch file and its includes, once; computed defaults: unknown."""
    found: dict[str, LaunchArgument] = {}
    for it, _ in getattr(description, ASKED)():
        given = it.default_value
        parts = given if isinstance(given, list | tuple) else [given or ""]
        plain = [one if isinstance(one, str) else getattr(one, "text", None) for one in parts]
        default = "".join(map(str, plain)) if None not in plain else ""
        choices = tuple(map(str, it.choices or ()))
        found.setdefault(it.name, LaunchArgument(it.name, default, choices))
    return tuple(found.values())


def _with_unset(notes: Iterable[LaunchNote], path: str) -> Iterator[LaunchNote]:
    """Yield the notes; a later include fails if it needs a configuration that is surely not set."""
    known = True
    for it in notes:
        unset = it.unset and it.place.file != path
        fails = it.fails or (known and unset)
        known = known and (fails or it.parameters)
        yield it._replace(fails=fails)


def _described(order: LaunchOrder) -> Any:
    """Return the launch description that the file makes."""
    sources = of_launch("launch_description_sources")
    source = sources.AnyLaunchDescriptionSource(os.path.abspath(order.file))
    made = source.get_launch_description(of_launch().LaunchContext(noninteractive=True))
    if not hasattr(made, ASKED):
        what = "nothing" if made is None else f"a value of type {type(made).__name__}"
        text = f"its generate_launch_description() returns {what}; return a LaunchDescription"
        raise UnreadableError(text)
    return made
