# SPDX-License-Identifier: Apache-2.0
"""Launch files with a new argument of their xacros, verified to hand it on.

A launch file is read in a copy of the package, with the changed files in it: with the argument every
link of the description that it gives its nodes has the prefix. A parameter file that it fills in gets
``$(var prefix)`` before the names of the robot.

Source: launch_ros parameter_descriptions.py (``ParameterFile``: with ``allow_substs`` the text of the
file is a substitution). What else reads the file, as a plugin of Gazebo, would take it as it is, so one
launch file alone may name it.
"""

import os
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from itertools import zip_longest
from tempfile import TemporaryDirectory
from typing import NamedTuple

from multibot_rewrite.base.bounded import load_yaml
from multibot_rewrite.base.model import InputError, MultibotError
from multibot_rewrite.description.checks.links_and_joints import WORLD
from multibot_rewrite.description.joining.part import PREFIXED
from multibot_rewrite.description.readback.xml import read_xml
from multibot_rewrite.description.sources.packages import package_of
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.library.one_file import names_in_file
from multibot_rewrite.producers.launch.child import launch_graph
from multibot_rewrite.producers.launch.records import LaunchGraph, LaunchOrder
from multibot_rewrite.refactor.launch_argument import OF_ROBOT, LaunchEdit, Space, with_argument
from multibot_rewrite.refactor.namespaces import TRIED_SPACE
from multibot_rewrite.refactor.placing import Left
from multibot_rewrite.related_files.named_file import NamedFile
from multibot_rewrite.related_files.names.rename_map import KINDS

_DESCRIPTION = "robot_description"


class Launches(NamedTuple):
    """Launch files with the argument by path, those of them that are verified, and what is left."""

    after: Mapping[str, bytes]
    verified: tuple[str, ...]
    left: tuple[Left, ...]


class Trial(NamedTuple):
    """How a launch file is tried: argument and value, trust, parameter files, namespace."""

    argument: str
    prefix: str
    trust: bool
    parameters: "Mapping[str, Filled]"
    space: Space | None


class _Verdict(NamedTuple):
    """What is wrong with a launch file, or why it cannot be read; both empty where it is verified."""

    fault: str
    unread: str


def with_launches(
    folder: str, launches: Collection[str], after: Mapping[str, bytes], how: Trial
) -> Launches:
    """Return the launch files that expand a description of ``after``, with the argument."""
    # One that does not hand the argument on is unchanged. Parameter files are filled in if no other
    # file names them and they are verified with their launch file; so is a namespace.
    texts = {path: read_file(path) for path in launches}
    alone = {
        name: it
        for name, it in how.parameters.items()
        if sum(name.encode() in text for text in (*texts.values(), *after.values())) == 1
    }
    how = how._replace(parameters=alone)
    made = [_tried_launch(folder, path, text, after, how) for path, text in texts.items()]
    return Launches(
        {path: data for it in made for path, data in it.after.items()},
        tuple(path for it in made for path in it.verified),
        tuple(one for it in made for one in it.left),
    )


def _tried_launch(
    folder: str, path: str, text: bytes, after: Mapping[str, bytes], how: Trial
) -> Launches:
    """Return a launch file with all that is asked for, or with less of it, as far as verified."""
    names = {os.path.basename(it) for it in after}
    plain = how._replace(parameters={})
    one = Launches({}, (), ())
    for it in (how, plain, plain._replace(space=None)):
        made = with_argument(path, text, it.argument, names, it.parameters, it.space)
        one = _verified(folder, path, made, after, it if made.spaced else it._replace(space=None))
        if path in one.after or not (made.filled or made.spaced):
            break
    return one


def _verified(
    folder: str, path: str, made: LaunchEdit, after: Mapping[str, bytes], how: Trial
) -> Launches:
    """Return one launch file with what it fills in, as far as it is verified."""
    argument = how.argument
    if made.data is None:
        return Launches({}, (), made.left)
    filled = [how.parameters[it] for it in made.filled]
    changed = {path: made.data, **{it.path: it.after for it in filled}}
    files = {os.path.realpath(it): data for it, data in {**after, **changed}.items()}
    home = (package_of(os.path.join(folder, "x")) or ("", os.path.abspath(folder)))[1]
    # It is read in a copy of the package.
    with TemporaryDirectory(prefix="multibot_") as above:
        root = os.path.join(above, os.path.basename(home))
        _link_copy(home, root, files)
        copy = os.path.join(root, os.path.relpath(os.path.realpath(path), os.path.realpath(home)))
        found = _verdict(LaunchOrder(copy, (), (above, home), how.trust), how, filled)
        it = _Verdict(*(words.replace(f"{root}/", "") for words in found))
    if it.fault:
        why = f"it does not hand {argument} on: {it.fault}"
        return Launches({}, (), (*made.left, Left(path, why)))
    if it.unread and filled:
        return Launches({}, (), ())
    if it.unread:
        why = f"it gets {argument}, which is not verified: {it.unread}"
        return Launches(changed, (), (*made.left, Left(path, why)))
    return Launches(changed, (path,), made.left)


def _link_copy(home: str, root: str, files: Mapping[str, bytes]) -> None:
    """Make a folder with links to all its files, except those that are changed."""
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


def _verdict(order: LaunchOrder, how: Trial, filled: "Sequence[Filled]") -> _Verdict:
    """Return what is wrong with a launch file that was tried with the argument."""
    argument, prefix = how.argument, how.prefix
    try:
        graph = launch_graph(order)
        plain = _links(graph)
    except InputError as error:
        return _Verdict("", str(error))
    if not plain:
        return _Verdict("", "no node of it gets a robot_description that is known")
    try:
        other = launch_graph(order._replace(arguments=((argument, prefix),)))
        given = _links(other)
        spaced = _space_fault(order, graph, how.space)
    except InputError as error:
        return _Verdict(str(error), "")
    for it in filled:
        if not (_gets_file(graph, it.path, it.before) and _gets_file(other, it.path, it.tried)):
            return _Verdict(f"{os.path.basename(it.path)} is changed, or lacks it", "")
    if given == [it if it == WORLD else f"{prefix}{it}" for it in plain]:
        return _Verdict(spaced, "")
    return _Verdict(f"with {argument}:={prefix} its links are {', '.join(given[:3])}", "")


def _space_fault(order: LaunchOrder, graph: LaunchGraph, space: Space | None) -> str:
    """Return what is wrong with the description's nodes, or with the description, in a namespace."""
    if space is None:
        return ""
    other = launch_graph(order._replace(arguments=((space.name, TRIED_SPACE),)))
    every = zip_longest(graph.nodes, other.nodes)
    pairs = [(one, two) for one, two in every if one and two and one.package in OF_ROBOT]
    wrong = next((two for one, two in pairs if two.namespace != f"/{TRIED_SPACE}"), None)
    if wrong is not None or len(graph.nodes) != len(other.nodes):
        name = wrong.executable if wrong else "another number of nodes"
        return f"with {space.name}:={TRIED_SPACE} it has {name} in another namespace"
    is_given = any(TRIED_SPACE in it.text for node in other.nodes for it in node.parameters)
    return "" if is_given or not space.of_xacro else f"its description lacks {TRIED_SPACE}"


def _gets_file(graph: LaunchGraph, path: str, wanted: bytes) -> bool:
    """Return whether nodes get a parameter file as ``wanted``, and no node another version."""
    name = os.path.basename(path)
    given = [it for node in graph.nodes for it in node.parameters]
    texts = [it.text for it in given if name == os.path.basename(it.source or it.file)]
    return bool(texts) and all(
        load_yaml(it, path) == load_yaml(wanted.decode(), path) for it in texts
    )


def _links(graph: LaunchGraph) -> list[str]:
    """Return the links of all descriptions that nodes get, each once."""
    found: dict[str, None] = {}
    for node in graph.nodes:
        for it in node.parameters:
            for text in _descriptions(it.text):
                root = read_xml(text.encode(), it.file or "robot_description")
                found |= dict.fromkeys(one.get("name", "") for one in root.iterchildren("link"))
    return list(found)


def _descriptions(text: str) -> Iterator[str]:
    """Yield the values of ``robot_description`` in a parameter file."""
    try:
        todo = [load_yaml(text, "")] if _DESCRIPTION in text else []
    except InputError:
        return
    for it in todo:  # grows
        for key, value in it.items() if isinstance(it, dict) else ():
            if key == _DESCRIPTION and isinstance(value, str):
                yield value
            todo.append(value)


class Filled(NamedTuple):
    """A parameter file as it is, as it becomes, and what it is with the prefix that is tried."""

    path: str
    before: bytes
    after: bytes
    tried: bytes


def fillable(
    paths: Sequence[str], urdfs: Sequence[bytes], names: Collection[str], argument: str, tried: str
) -> Mapping[str, Filled]:
    """Return the parameter files with names of the descriptions ``urdfs``, by their own names."""
    # Files of one name are left out.
    own = [os.path.basename(it) for it in paths]
    found: dict[str, Filled] = {}
    for path in paths:
        data, name = read_file(path), os.path.basename(path)
        # A file with substitutions is filled in already.
        if own.count(name) > 1 or b"$(" in data or not urdfs:
            continue
        with suppress(MultibotError):
            file = names_in_file(data, path, urdfs[0])
            if starts := set(starts_of(file, names, PREFIXED)):
                words = (f"$(var {argument})", tried)
                texts = (respelled(file, data, starts, 0, it) for it in words)
                found[name] = Filled(path, data, *texts)
    return found


def starts_of(file: NamedFile, names: Collection[str], kinds: Collection[str]) -> Iterator[int]:
    """Yield the offsets in a file's text at which names of these kinds begin."""
    for site in file.names:
        if site.text in names and not {site.kind, *KINDS.get(site.kind, ())}.isdisjoint(kinds):
            start = file.text.find(site.text, site.slot.start + site.at, site.slot.end)
            if start >= 0:
                yield start


def respelled(file: NamedFile, data: bytes, starts: Collection[int], size: int, word: str) -> bytes:
    """Return the bytes of a file with a word in place of ``size`` characters from each start."""
    text = file.text
    # A byte order mark is none of the text.
    mark = data[: len(data) - len(text.encode())]
    for at in sorted(starts, reverse=True):
        text = text[:at] + word + text[at + size :]
    return mark + text.encode()
