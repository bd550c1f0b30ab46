# SPDX-License-Identifier: Apache-2.0
"""A launch file passes a new xacro argument on: declared, with an empty default, and given to
``xacro``.

Edited is what people write: ``Command(["xacro ", path])`` in a launch file in Python with a literal
list of its actions, and ``$(command 'xacro ...')`` in XML. What else runs xacro is left for its author.
Sources: ros2/launch launch/substitutions/command.py, launch_xml; ros2/xacro README."""

from __future__ import annotations

import ast
import os
import re
from collections.abc import Callable, Collection, Iterator
from itertools import chain

from multibot_rewrite.base.findings.finding import locate
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.refactor.placing import Left
from multibot_rewrite.refactor.source_edits import SourceEdit, edited

_COMMAND = re.compile(rb"\$\(command\s+(['\"])(?=[^'\"]*xacro\s)[^'\"]*()\1")
_ROOT = re.compile(rb"<launch\b[^>]*>")
_XACRO = re.compile(r"\bxacro\b")
_FROM = rb"<param\s+from=\"[^\"]*%s\""
_IMPORTS = {
    "DeclareLaunchArgument": "launch.actions",
    "LaunchConfiguration": "launch.substitutions",
}


class LaunchEdit(NamedTuple):
    """A launch file with the argument; ``data`` is None where it is not changed, ``left`` says why.
    ``filled`` are the parameter files that it fills in now."""

    data: bytes | None
    left: tuple[Left, ...]
    filled: tuple[str, ...] = ()


def with_argument(
    path: str,
    source: bytes,
    argument: str,
    descriptions: Collection[str],
    parameters: Collection[str] = (),
) -> LaunchEdit:
    """The launch file with an argument for the descriptions (names of files) that it expands; it fills
    in those of ``parameters`` (names of files) that it only gives to nodes."""
    if not any(name.encode() in source for name in descriptions):
        return LaunchEdit(None, ())
    if path.endswith(".xml"):
        return _of_xml(path, source, argument, parameters)
    try:
        tree = ast.parse(source)
    except (SyntaxError, ValueError):
        return LaunchEdit(None, (Left(path, "it is no Python"),))
    return _of_python(path, source, tree, argument, parameters)


def _of_xml(path: str, source: bytes, argument: str, parameters: Collection[str]) -> LaunchEdit:
    commands = list(_COMMAND.finditer(source))
    root = _ROOT.search(source)
    if not commands or not root or b'<arg name="%s"' % argument.encode() in source:
        return LaunchEdit(None, (_left(path, source, b"xacro"),))
    given = f" {argument}:=$(var {argument})".encode()
    edits = [SourceEdit(path, it.start(2), it.start(2), given) for it in commands]
    declared = f'\n  <arg name="{argument}" default=""/>'.encode()
    edits.append(SourceEdit(path, root.end(), root.end(), declared))
    filled = []
    for name in parameters:
        ends = [it.end() for it in re.finditer(_FROM % re.escape(name.encode()), source)]
        if ends and len(ends) == source.count(name.encode()):
            edits += (SourceEdit(path, end, end, b' allow_substs="true"') for end in ends)
            filled.append(name)
    return LaunchEdit(edited({path: source}, edits)[path], (), tuple(filled))


def _of_python(
    path: str, source: bytes, tree: ast.Module, argument: str, parameters: Collection[str]
) -> LaunchEdit:
    lines = [0]
    for line in source.splitlines(keepends=True):
        lines.append(lines[-1] + len(line))

    def at(line: int | None, column: int | None) -> int:
        return lines[(line or 1) - 1] + (column or 0)

    commands = list(_lists_of(tree, "Command", _runs_xacro))
    actions = next(_lists_of(tree, "LaunchDescription", lambda _: True), None)
    if not commands or actions is None or not actions.elts:
        return LaunchEdit(None, (_left(path, source, b"xacro"),))
    given = f', " {argument}:=", LaunchConfiguration("{argument}")'.encode()
    ends = [at(it.elts[-1].end_lineno, it.elts[-1].end_col_offset) for it in commands]
    edits = [SourceEdit(path, end, end, given) for end in ends]
    first = at(actions.elts[0].lineno, actions.elts[0].col_offset)
    gap = source[at(actions.lineno, actions.col_offset) + 1 : first]
    declared = f'DeclareLaunchArgument("{argument}", default_value=""),'.encode() + (gap or b" ")
    edits.append(SourceEdit(path, first, first, declared))
    given_files = {it: found for it in parameters if (found := list(_given(tree, it)))}
    for it in chain.from_iterable(given_files.values()):
        begin, end = at(it.lineno, it.col_offset), at(it.end_lineno, it.end_col_offset)
        edits.append(SourceEdit(path, begin, begin, b"ParameterFile("))
        edits.append(SourceEdit(path, end, end, b", allow_substs=True)"))
    used = [*_IMPORTS, *(["ParameterFile"] if given_files else [])]
    edits += _imports(path, tree, at, used)
    return LaunchEdit(edited({path: source}, edits)[path], (), tuple(given_files))


def _given(tree: ast.Module, file: str) -> Iterator[ast.expr]:
    """The items of ``parameters=[...]`` that name a file; none where it is named elsewhere, too."""
    values = [it for it in ast.walk(tree) if isinstance(it, ast.Assign) and len(it.targets) == 1]
    named = {
        it.targets[0].id: it.value
        for it in values
        if isinstance(it.targets[0], ast.Name) and _says(it.value, file)
    }
    lists = [
        it.value
        for it in ast.walk(tree)
        if isinstance(it, ast.keyword) and it.arg == "parameters" and isinstance(it.value, ast.List)
    ]
    items = [item for it in lists for item in it.elts if not isinstance(item, ast.Dict)]
    found = [it for it in items if _says(it, file)]
    found += [it for it in items if isinstance(it, ast.Name) and it.id in named]
    direct = sum(_says(it, file) for it in (*items, *named.values()))
    uses = [it for it in ast.walk(tree) if isinstance(it, ast.Name) and it.id in named]
    loads = sum(isinstance(it.ctx, ast.Load) for it in uses)
    by_name = sum(isinstance(it, ast.Name) for it in found)
    every = sum(_is_said(it, file) for it in ast.walk(tree))
    if direct == every and loads == by_name:
        yield from found


def _says(expression: ast.expr, file: str) -> bool:
    return any(_is_said(it, file) for it in ast.walk(expression))


def _is_said(node: ast.AST, file: str) -> bool:
    if not isinstance(node, ast.Constant) or not isinstance(node.value, str):
        return False
    return os.path.basename(node.value) == file


def _imports(
    path: str,
    tree: ast.Module,
    at: Callable[[int | None, int | None], int],
    used: Collection[str],
) -> Iterator[SourceEdit]:
    """Imports of what the argument needs, after those that are there."""
    known = {
        it.asname or it.name
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom)
        for it in node.names
    }
    last = [it for it in tree.body if isinstance(it, (ast.Import, ast.ImportFrom))][-1]
    end = at(last.end_lineno, last.end_col_offset)
    homes = {**_IMPORTS, "ParameterFile": "launch_ros.parameter_descriptions"}
    missing = [(homes[name], name) for name in used if name not in known]
    text = "".join(f"\nfrom {home} import {name}" for home, name in missing)
    if text:
        yield SourceEdit(path, end, end, text.encode())


def _lists_of(
    tree: ast.Module, called: str, is_meant: Callable[[ast.List], bool]
) -> Iterator[ast.List]:
    """The literal lists that are the first argument of calls of a name."""
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call) or not node.args:
            continue
        name = (
            node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
        )
        first = node.args[0]
        if name == called and isinstance(first, ast.List) and is_meant(first):
            yield first


def _runs_xacro(words: ast.List) -> bool:
    """``["xacro ", ...]`` or ``[FindExecutable(name="xacro"), " ", ...]``."""
    return bool(words.elts) and bool(_XACRO.search(ast.unparse(words.elts[0])))


def _left(path: str, source: bytes, word: bytes) -> Left:
    line = locate(source, max(source.find(word), 0))[0]
    return Left(f"{path}:{line}", "give its xacro the argument by hand")
