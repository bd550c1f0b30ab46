# SPDX-License-Identifier: Apache-2.0
"""The launch files of a package with a new argument of its xacros, and the proof that they hand it on.

A launch file is a program, and runs where whoever calls this trusts it. It is read in a copy of the
package, with the changed files in it: with the argument every link of the description that it gives its
nodes has the prefix.
"""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator, Mapping
from tempfile import TemporaryDirectory

import yaml

from multibot_rewrite.base.bounded import load_yaml
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.checks.links_and_joints import WORLD
from multibot_rewrite.description.readback.xml import read_xml
from multibot_rewrite.description.sources.packages import package_of
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.producers.launch.child import launch_graph
from multibot_rewrite.producers.launch.records import LaunchGraph, LaunchOrder
from multibot_rewrite.refactor.launch_argument import with_argument
from multibot_rewrite.refactor.placing import Left

_DESCRIPTION = "robot_description"


class Launches(NamedTuple):
    """Launch files with the argument by path, those of them that are proved, and what is left."""

    after: Mapping[str, bytes]
    proved: tuple[str, ...]
    left: tuple[Left, ...]


class _Verdict(NamedTuple):
    """What is wrong with a launch file, or why it cannot be read; both empty where it is proved."""

    fault: str
    unread: str


def with_launches(
    folder: str,
    launches: Collection[str],
    argument: str,
    after: Mapping[str, bytes],
    prefix: str,
    trust: bool,
) -> Launches:
    """The launch files that expand a description of ``after``, files by their paths. One that does not
    hand the argument on, tried with ``prefix``, is left as it was."""
    names = {os.path.basename(it) for it in after}
    made: dict[str, bytes] = {}
    left: list[Left] = []
    for path in launches:
        found = with_argument(path, read_file(path), argument, names)
        left += found.left
        if found.data is not None:
            made[path] = found.data
    if not trust:
        why = f"it gets {argument}, which is proved with --trust alone: a launch file is a program"
        return Launches(made, (), (*left, *(Left(it, why) for it in made)))
    read = dict(_read(folder, {**after, **made}, made, argument, prefix)) if made else {}
    for path, it in read.items():
        if it.fault:
            left.append(Left(path, f"it does not hand {argument} on: {it.fault}"))
        elif it.unread:
            left.append(Left(path, f"it gets {argument}, which is not proved: {it.unread}"))
    kept = {path: data for path, data in made.items() if not read[path].fault}
    proved = tuple(path for path in kept if not read[path].unread)
    return Launches(kept, proved, tuple(left))


def _read(
    folder: str, files: Mapping[str, bytes], launches: Collection[str], argument: str, prefix: str
) -> Iterator[tuple[str, _Verdict]]:
    """Each launch file in a copy of the package."""
    home = (package_of(os.path.join(folder, "x")) or ("", os.path.abspath(folder)))[1]
    with TemporaryDirectory(prefix="multibot_") as above:
        root = os.path.join(above, os.path.basename(home))
        _copy(home, root, {os.path.realpath(path): data for path, data in files.items()})
        for path in launches:
            copy = os.path.join(
                root, os.path.relpath(os.path.realpath(path), os.path.realpath(home))
            )
            found = _verdict(LaunchOrder(copy, (), (above,), True), argument, prefix)
            yield path, _Verdict(*(it.replace(f"{root}/", "") for it in found))


def _copy(home: str, root: str, files: Mapping[str, bytes]) -> None:
    """A folder with links to all its files, but for those that are changed."""
    for at, folders, names in os.walk(home):
        folders[:] = [it for it in folders if it != ".git"]
        target = os.path.join(root, os.path.relpath(at, home))
        os.makedirs(target, exist_ok=True)
        for name in names:
            os.symlink(os.path.realpath(os.path.join(at, name)), os.path.join(target, name))
    for path, data in files.items():
        target = os.path.join(root, os.path.relpath(path, os.path.realpath(home)))
        if os.path.lexists(target):
            os.unlink(target)
        with open(target, "wb") as out:
            out.write(data)


def _verdict(order: LaunchOrder, argument: str, prefix: str) -> _Verdict:
    try:
        plain = _links(launch_graph(order))
    except InputError as error:
        return _Verdict("", str(error))
    if not plain:
        return _Verdict("", "no node of it gets a robot_description that is known")
    try:
        given = _links(launch_graph(order._replace(arguments=((argument, prefix),))))
    except InputError as error:
        return _Verdict(str(error), "")
    if given == [it if it == WORLD else f"{prefix}{it}" for it in plain]:
        return _Verdict("", "")
    return _Verdict(f"with {argument}:={prefix} its links are {', '.join(given[:3])}", "")


def _links(graph: LaunchGraph) -> list[str]:
    """The links of all descriptions that nodes get, each once."""
    found: dict[str, None] = {}
    for node in graph.nodes:
        for it in node.parameters:
            for text in _descriptions(it.text):
                root = read_xml(text.encode(), it.file or "robot_description")
                found |= dict.fromkeys(one.get("name", "") for one in root.iterchildren("link"))
    return list(found)


def _descriptions(text: str) -> Iterator[str]:
    """The values of ``robot_description`` in a parameter file."""
    try:
        todo = [load_yaml(text)] if _DESCRIPTION in text else []
    except (yaml.YAMLError, ValueError):
        return
    for it in todo:  # grows
        for key, value in it.items() if isinstance(it, dict) else ():
            if key == _DESCRIPTION and isinstance(value, str):
                yield value
            todo.append(value)
