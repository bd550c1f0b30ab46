# SPDX-License-Identifier: Apache-2.0
"""Edits launch files to give new arguments to ``xacro`` and to start nodes in the namespace.

Edited is what people write: ``Command(["xacro ", path])`` in a launch file in Python with a
literal list of its actions, and ``$(command 'xacro ...')`` in XML. What else runs xacro is left
for its author. Sources: ros2/launch launch/substitutions/command.py, launch_xml; ros2/xacro
README."""

import ast
import os
import re
from collections.abc import Collection, Iterable, Iterator
from contextlib import suppress
from itertools import accumulate, chain
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import locate
from multibot_rewrite.description.steps.document import read_document, value_slot
from multibot_rewrite.refactor.placing import Left
from multibot_rewrite.refactor.source_edits import SourceEdit, edited

_COMMAND = re.compile(rb"\$\(command\s+(['\"])(?=[^'\"]*xacro\s)[^'\"]*()\1")
_ROOT = re.compile(rb"<launch\b[^<>]*>")
_XACRO = re.compile(r"\bxacro\b")
_FROM = rb"<param\s+from=\"[^\"]*%s\""
_IMPORTS = {
    "DeclareLaunchArgument": "launch.actions",
    "LaunchConfiguration": "launch.substitutions",
    "ParameterFile": "launch_ros.parameter_descriptions",
}


# These read or send robot_description and joint_states, or ask the controller_manager, by names that
# a namespace reaches (robot_state_publisher.cpp, joint_state_publisher.py, spawner.py).
OF_ROBOT = (
    *("robot_state_publisher", "joint_state_publisher", "joint_state_publisher_gui"),
    "controller_manager",
)
_NODE = rb"<node\b[^<>]*?\bpkg=\"(?:%s)\"" % "|".join(OF_ROBOT).encode()
_NODES = ("Node", "LifecycleNode", "ComposableNode")
_Placed = ast.expr | ast.stmt | ast.keyword
# Spawners of simulators read the topic that follows: in the namespace, if it is relative.
_TOPIC = "robot_description"
_OWN_SPACE = re.compile(rb"namespace", re.IGNORECASE)


class Space(NamedTuple):
    """The argument for a namespace, and whether xacros take it."""

    name: str
    of_xacro: bool


class LaunchEdit(NamedTuple):
    """A launch file with the argument; ``data`` is None if unchanged, ``left`` says why.

    ``filled`` are the parameter files that it fills in; ``spaced`` is true if it sets a
    namespace."""

    data: bytes | None
    left: tuple[Left, ...]
    filled: tuple[str, ...] = ()
    spaced: bool = False


def with_argument(
    path: str,
    source: bytes,
    argument: str,
    descriptions: Collection[str],
    parameters: Collection[str] = (),
    space: Space | None = None,
) -> LaunchEdit:
    """Return the launch file with an argument for the ``descriptions`` that it expands.

    It fills in those ``parameters`` that it only gives to nodes, and puts what belongs to the
    description into the namespace ``space``. All are names of files."""
    handed = re.search(rb"\b%s:=" % argument.encode(), source)
    if handed or not any(name.encode() in source for name in descriptions):
        return LaunchEdit(None, ())
    if space and not space.of_xacro and not any(it.encode() in source for it in OF_ROBOT):
        space = None
    own = _OWN_SPACE.search(source) if space else None
    if own:
        made = with_argument(path, source, argument, descriptions, parameters)
        place = f"{path}:{locate(source, own.start())[0]}"
        left = Left(place, "it has a namespace; give that to its xacro by hand")
        return made._replace(left=(*made.left, left)) if made.data else made
    change = _xml_edit if path.endswith(".xml") else _python_edit
    return change(path, source, argument, parameters, space)


def _declared_and_given(argument: str, space: Space | None) -> tuple[list[str], list[str]]:
    """Return the arguments to declare, and those that xacro gets."""
    every = [argument, space.name] if space else [argument]
    return every, every if space and space.of_xacro else [argument]


def _xml_edit(
    path: str, source: bytes, argument: str, parameters: Collection[str], space: Space | None
) -> LaunchEdit:
    every, of_xacro = _declared_and_given(argument, space)
    commands = list(_COMMAND.finditer(source))
    root = _ROOT.search(source)
    if not commands or not root or b'<arg name="%s"' % argument.encode() in source:
        return LaunchEdit(None, (_left_to_do_by_hand(path, source),))
    given = "".join(f" {it}:=$(var {it})" for it in of_xacro).encode()
    edits = [SourceEdit(path, it.start(2), it.start(2), given) for it in commands]
    declared = "".join(f'\n  <arg name="{it}" default=""/>' for it in every).encode()
    edits.append(SourceEdit(path, root.end(), root.end(), declared))
    for it in re.finditer(_NODE, source) if space else ():
        inside = f' namespace="$(var {space.name})"'.encode() if space else b""
        edits.append(SourceEdit(path, it.end(), it.end(), inside))
    filled = []
    for name in parameters:
        ends = [it.end() for it in re.finditer(_FROM % re.escape(name.encode()), source)]
        if ends and len(ends) == source.count(name.encode()):
            edits += (SourceEdit(path, end, end, b' allow_substs="true"') for end in ends)
            filled.append(name)
    return LaunchEdit(edited({path: source}, edits)[path], (), tuple(filled), space is not None)


class _Text(NamedTuple):
    """A launch file in Python, with the offsets at which its lines begin."""

    path: str
    source: bytes
    tree: ast.Module
    lines: list[int]

    def begin(self, node: _Placed) -> int:
        return self.lines[node.lineno - 1] + node.col_offset

    def end(self, node: _Placed) -> int:
        line, column = node.end_lineno, node.end_col_offset
        assert line and column
        return self.lines[line - 1] + column

    def insert(self, at: int, text: str) -> SourceEdit:
        return SourceEdit(self.path, at, at, text.encode())


def _python_edit(
    path: str, source: bytes, argument: str, parameters: Collection[str], space: Space | None
) -> LaunchEdit:
    it = _python_text(path, source)
    if not it.tree.body:
        return LaunchEdit(None, (Left(path, "it is no Python"),))
    tree = it.tree
    every, of_xacro = _declared_and_given(argument, space)
    # ``["xacro ", ...]`` or ``[FindExecutable(name="xacro"), " ", ...]``.
    called = (it for it in _lists_of(tree, "Command") if it.elts)
    commands = [it for it in called if _XACRO.search(ast.unparse(it.elts[0]))]
    actions = next(_lists_of(tree, "LaunchDescription"), None)
    if not commands or actions is None or not actions.elts:
        return LaunchEdit(None, (_left_to_do_by_hand(path, source),))
    given = "".join(f', " {name}:=", LaunchConfiguration("{name}")' for name in of_xacro)
    edits = [it.insert(it.end(words.elts[-1]), given) for words in commands]
    # Each argument is declared before the first action, as far from the next as that is.
    first = it.begin(actions.elts[0])
    gap = source[it.begin(actions) + 1 : first].decode() or " "
    new = (f'DeclareLaunchArgument("{name}", default_value=""),{gap}' for name in every)
    edits.append(it.insert(first, "".join(new)))
    edits += _namespace_edits(it, space.name) if space else ()
    files = {name: found for name in parameters if (found := list(_parameter_items(tree, name)))}
    for one in chain.from_iterable(files.values()):
        edits.append(it.insert(it.begin(one), "ParameterFile("))
        edits.append(it.insert(it.end(one), ", allow_substs=True)"))
    edits += _import_edits(it, [name for name in _IMPORTS if files or name != "ParameterFile"])
    data = edited({path: source}, edits)[path]
    return LaunchEdit(data, (), tuple(files), space is not None)


def literal_parameters(path: str, data: bytes, value: str) -> Iterator[tuple[int, str, str]]:
    """Yield where parameters with a literal value are in a launch file, with the node and the key."""
    if path.endswith(".xml"):
        document = read_document(data, path)
        for element, start in zip(document.elements, document.starts, strict=True):
            node, slot = element.getparent(), value_slot(data, start, "value", value)
            if slot and node is not None and (node.tag, element.tag) == ("node", "param"):
                yield slot[0], node.get("name", node.get("exec", "")), element.get("name", "")
        return
    it = _python_text(path, data)
    for call in ast.walk(it.tree):
        if not isinstance(call, ast.Call) or _called_name(call) not in _NODES:
            continue
        given = {one.arg: one.value for one in call.keywords}
        names = (given.get(word) for word in ("name", "executable", "plugin"))
        node_name = next((str(one.value) for one in names if isinstance(one, ast.Constant)), "")
        inside = ast.walk(given.get("parameters", ast.Tuple([])))
        tables = [one for one in inside if isinstance(one, ast.Dict)]
        pairs = (zip(one.keys, one.values, strict=True) for one in tables)
        for key, item in chain.from_iterable(pairs):
            start, end = it.begin(item) + 1, it.end(item) - 1
            is_literal = isinstance(item, ast.Constant) and item.value == value
            if isinstance(key, ast.Constant) and is_literal and data[start:end] == value.encode():
                yield start, node_name, str(key.value)


def _python_text(path: str, source: bytes) -> _Text:
    """Return a launch file in Python; its tree is empty if it is none."""
    tree = ast.Module([], [])
    with suppress(SyntaxError, ValueError):
        tree = ast.parse(source)
    lines = accumulate(map(len, source.splitlines(keepends=True)), initial=0)
    return _Text(path, source, tree, list(lines))


def _namespace_edits(it: _Text, space: str) -> Iterator[SourceEdit]:
    """Yield a namespace for each node that belongs to the description, after its package."""
    for node in ast.walk(it.tree):
        if not isinstance(node, ast.Call) or _called_name(node) != "Node":
            continue
        package = next((one for one in node.keywords if one.arg == "package"), None)
        if package is None or not isinstance(package.value, ast.Constant):
            continue
        words = [one.value for one in ast.walk(node) if isinstance(one, ast.Constant)]
        if package.value.value in OF_ROBOT or ("-topic" in words and _TOPIC in words):
            indent = it.source[it.lines[package.lineno - 1] : it.begin(package)].decode()
            gap = " " if indent.strip() else f"\n{indent}"
            yield it.insert(it.end(package), f',{gap}namespace=LaunchConfiguration("{space}")')


def _parameter_items(tree: ast.Module, file: str) -> Iterator[ast.expr]:
    """Yield the items of ``parameters=[...]`` that name a file; none if it is named elsewhere, too."""
    lists = [
        it.value
        for it in ast.walk(tree)
        if isinstance(it, ast.keyword) and it.arg == "parameters" and isinstance(it.value, ast.List)
    ]
    items = [item for it in lists for item in it.elts if not isinstance(item, ast.Dict)]
    inside = {one for it in items for one in ast.walk(it) if _names_file(one, file)}
    values = [it for it in ast.walk(tree) if isinstance(it, ast.Assign) and len(it.targets) == 1]
    # What has a node in it is no name of the file.
    named = {
        it.targets[0].id: it.value
        for it in values
        if isinstance(it.targets[0], ast.Name)
        and _has_file_name(it.value, file)
        and inside.isdisjoint(ast.walk(it.value))
    }
    found = [it for it in items if _has_file_name(it, file)]
    found += [it for it in items if isinstance(it, ast.Name) and it.id in named]
    direct = sum(_has_file_name(it, file) for it in (*items, *named.values()))
    uses = [it for it in ast.walk(tree) if isinstance(it, ast.Name) and it.id in named]
    loads = sum(isinstance(it.ctx, ast.Load) for it in uses)
    by_name = sum(isinstance(it, ast.Name) for it in found)
    every = sum(_names_file(it, file) for it in ast.walk(tree))
    if direct == every and loads == by_name:
        yield from found


def _has_file_name(expression: ast.expr, file: str) -> bool:
    return any(_names_file(it, file) for it in ast.walk(expression))


def _names_file(node: ast.AST, file: str) -> bool:
    if not isinstance(node, ast.Constant) or not isinstance(node.value, str):
        return False
    return os.path.basename(node.value) == file


def _import_edits(it: _Text, used: Iterable[str]) -> Iterator[SourceEdit]:
    """Yield imports of what the argument needs, after the existing ones."""
    froms = [one for one in ast.walk(it.tree) if isinstance(one, ast.ImportFrom)]
    known = {name.asname or name.name for one in froms for name in one.names}
    last = [one for one in it.tree.body if isinstance(one, (ast.Import, ast.ImportFrom))][-1]
    text = "".join(f"\nfrom {_IMPORTS[name]} import {name}" for name in used if name not in known)
    if text:
        yield it.insert(it.end(last), text)


def _lists_of(tree: ast.Module, called: str) -> Iterator[ast.List]:
    """Yield the literal lists that are the first argument of calls of a name."""
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call) or not node.args:
            continue
        first = node.args[0]
        if _called_name(node) == called and isinstance(first, ast.List):
            yield first


def _called_name(node: ast.Call) -> str:
    """Return the last name of what is called."""
    named = node.func.attr if isinstance(node.func, ast.Attribute) else node.func
    return named if isinstance(named, str) else getattr(named, "id", "")


def _left_to_do_by_hand(path: str, source: bytes) -> Left:
    line = locate(source, max(source.find(b"xacro"), 0))[0]
    return Left(f"{path}:{line}", "give its xacro the argument by hand")
