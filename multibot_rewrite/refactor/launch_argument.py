# SPDX-License-Identifier: Apache-2.0
"""A launch file passes a new xacro argument on: declared, with an empty default, and given to
``xacro``.

Edited is what people write: ``Command(["xacro ", path])`` in a launch file in Python with a literal
list of its actions, and ``$(command 'xacro ...')`` in XML. What else runs xacro is left for its author.
Sources: ros2/launch launch/substitutions/command.py, launch_xml; ros2/xacro README."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Collection, Iterator

from multibot_rewrite.base.findings.finding import locate
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.refactor.placing import Left
from multibot_rewrite.refactor.source_edits import SourceEdit, edited

_COMMAND = re.compile(rb"\$\(command\s+(['\"])(?=[^'\"]*xacro\s)[^'\"]*()\1")
_ROOT = re.compile(rb"<launch\b[^>]*>")
_XACRO = re.compile(r"\bxacro\b")
_IMPORTS = {
    "DeclareLaunchArgument": "launch.actions",
    "LaunchConfiguration": "launch.substitutions",
}


class LaunchEdit(NamedTuple):
    """A launch file with the argument; ``data`` is None where it is not changed, ``left`` says why."""

    data: bytes | None
    left: tuple[Left, ...]


def with_argument(
    path: str, source: bytes, argument: str, descriptions: Collection[str]
) -> LaunchEdit:
    """The launch file with an argument for the descriptions (names of files) that it expands."""
    if not any(name.encode() in source for name in descriptions):
        return LaunchEdit(None, ())
    if path.endswith(".xml"):
        return _of_xml(path, source, argument)
    try:
        tree = ast.parse(source)
    except (SyntaxError, ValueError):
        return LaunchEdit(None, (Left(path, "it is no Python"),))
    return _of_python(path, source, tree, argument)


def _of_xml(path: str, source: bytes, argument: str) -> LaunchEdit:
    commands = list(_COMMAND.finditer(source))
    root = _ROOT.search(source)
    if not commands or not root or b'<arg name="%s"' % argument.encode() in source:
        return LaunchEdit(None, (_left(path, source, b"xacro"),))
    given = f" {argument}:=$(var {argument})".encode()
    edits = [SourceEdit(path, it.start(2), it.start(2), given) for it in commands]
    declared = f'\n  <arg name="{argument}" default=""/>'.encode()
    edits.append(SourceEdit(path, root.end(), root.end(), declared))
    return LaunchEdit(edited({path: source}, edits)[path], ())


def _of_python(path: str, source: bytes, tree: ast.Module, argument: str) -> LaunchEdit:
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
    edits += _imports(path, tree, at)
    return LaunchEdit(edited({path: source}, edits)[path], ())


def _imports(
    path: str, tree: ast.Module, at: Callable[[int | None, int | None], int]
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
    missing = [(home, name) for name, home in _IMPORTS.items() if name not in known]
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
