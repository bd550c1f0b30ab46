# SPDX-License-Identifier: Apache-2.0
"""Small bugs in a Python file, as people make them: an operator, constant, condition or statement."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

_COMPARED: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Eq: ast.NotEq, ast.NotEq: ast.Eq, ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE,
    ast.GtE: ast.Gt, ast.In: ast.NotIn, ast.NotIn: ast.In, ast.Is: ast.IsNot, ast.IsNot: ast.Is,
}  # fmt: skip
_CALLED = {"any": "all", "all": "any", "min": "max", "max": "min", "sorted": "list"}
_METHODS = {
    "startswith": "endswith", "endswith": "startswith", "partition": "rpartition",
    "rpartition": "partition", "removeprefix": "removesuffix", "removesuffix": "removeprefix",
    "lstrip": "rstrip", "rstrip": "lstrip", "find": "rfind", "index": "rindex",
}  # fmt: skip
_CHANGING = {"append", "add", "update", "extend", "sort", "discard", "insert"}
# Their words are for people, or name a type.
_WORDS = {"declare", "print", "add_argument", "TypeVar", "ParamSpec"}


class Bug(NamedTuple):
    """In ``file``, ``old`` at bytes ``start:end`` became ``new``.

    ``text`` is the line it is in, ``function`` the first line of the function around it or 0.
    """

    file: str
    line: int
    start: int
    end: int
    old: str
    new: str
    text: str = ""
    function: int = 0

    def __str__(self) -> str:
        return f"{self.file}:{self.line}: {self.old} -> {self.new}"


def bugs_in(home: Path, file: str) -> list[Bug]:
    """Every bug that can be planted in a file below ``home``."""
    source = (home / file).read_bytes()
    lines = source.splitlines(keepends=True)
    starts = [0]
    for line in lines:
        starts.append(starts[-1] + len(line))
    found = []
    for node, new, function in _changes(ast.parse(source), 0):
        start = starts[node.lineno - 1] + node.col_offset
        end = starts[(node.end_lineno or 0) - 1] + (node.end_col_offset or 0)
        old = " ".join(source[start:end].decode().split())
        if old != new:
            text = lines[node.lineno - 1].decode().strip()
            found.append(Bug(file, node.lineno, start, end, old, new, text, function))
    return sorted(set(found))


def planted(source: bytes, bug: Bug) -> bytes:
    """Return the text with the bug in it."""
    return source[: bug.start] + bug.new.encode() + source[bug.end :]


def _changes(node: ast.AST, function: int) -> Iterator[tuple[ast.expr | ast.stmt, str, int]]:
    """Each node that can be changed, what to write in its place, and the function around it."""
    if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
        function = min([node.lineno, *(it.lineno for it in node.decorator_list)])
    if isinstance(node, ast.expr):
        yield from ((node, new, function) for new in _expression(node))
    if isinstance(node, ast.stmt):
        yield from ((node, new, function) for new in _statement(node))
    for test in _conditions(node):
        yield test, f"(not ({ast.unparse(test)}))", function
    for child in _inner(node):
        yield from _changes(child, function)


def _inner(node: ast.AST) -> Iterator[ast.AST]:
    """Yield the parts of a node that run: no annotation, docstring, message or example."""
    if isinstance(node, (ast.JoinedStr, ast.Raise, ast.Assert, ast.Import, ast.ImportFrom)):
        return
    if isinstance(node, ast.Call) and _name(node.func) in _WORDS:
        return
    if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
        return
    # Names that a module gives on: for checkers of types alone.
    if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
        return
    for field, value in ast.iter_fields(node):
        if field in ("annotation", "returns", "decorator_list", "type_comment"):
            continue
        if isinstance(node, ast.keyword) and node.arg == "strict":  # of zip: as an assertion
            continue
        for item in value if isinstance(value, list) else [value]:
            if isinstance(item, ast.AST) and not _is_text(item):
                yield item


def _is_text(node: ast.AST) -> bool:
    """Return a docstring."""
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)


def _conditions(node: ast.AST) -> list[ast.expr]:
    if isinstance(node, (ast.If, ast.While, ast.IfExp)):
        return [] if ast.unparse(node.test) == "TYPE_CHECKING" else [node.test]
    return node.ifs if isinstance(node, ast.comprehension) else []


def _expression(node: ast.expr) -> Iterator[str]:
    if isinstance(node, ast.Compare) and len(node.ops) == 1:
        yield _with(node, ops=[_COMPARED[type(node.ops[0])]()])
    elif isinstance(node, ast.BoolOp):
        yield _with(node, op=ast.Or() if isinstance(node.op, ast.And) else ast.And())
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
        yield f"({ast.unparse(node.operand)})"
    elif isinstance(node, ast.BinOp) and isinstance(node.op, (ast.Add, ast.Sub)):
        if any(
            isinstance(it, ast.Constant) and type(it.value) is int for it in (node.left, node.right)
        ):
            yield _with(node, op=ast.Sub() if isinstance(node.op, ast.Add) else ast.Add())
    elif isinstance(node, ast.Constant):
        yield from _constant(node.value)
    elif isinstance(node, ast.Call):
        yield from _call(node)


def _constant(value: object) -> Iterator[str]:
    if isinstance(value, bool):
        yield str(not value)
    elif isinstance(value, int):
        yield str(value + 1)
    elif isinstance(value, str) and 0 < len(value) < 16 and " " not in value:
        yield repr(value + "x")


def _call(node: ast.Call) -> Iterator[str]:
    if isinstance(node.func, ast.Name) and node.func.id in _CALLED and not node.keywords:
        yield _with(node, func=ast.Name(_CALLED[node.func.id]))
    if isinstance(node.func, ast.Attribute):
        if node.func.attr in _METHODS:
            method = ast.Attribute(node.func.value, _METHODS[node.func.attr])
            yield _with(node, func=method)
        elif node.func.attr in ("strip", "lower", "copy") and not node.args:
            yield f"({ast.unparse(node.func.value)})"


def _statement(node: ast.stmt) -> Iterator[str]:
    if isinstance(node, (ast.AugAssign, ast.Continue, ast.Break)):
        yield "pass"
    elif isinstance(node, ast.Expr) and isinstance(node.value, (ast.Yield, ast.YieldFrom)):
        yield "yield from ()"
    elif isinstance(node, ast.Expr) and _changes_its_owner(node.value):
        yield "pass"


def _changes_its_owner(node: ast.expr) -> bool:
    return isinstance(node, ast.Call) and _name(node.func) in _CHANGING


def _with(node: ast.expr, **fields: object) -> str:
    """Return the node with other fields, as text that fits in its place."""
    return f"({ast.unparse(type(node)(**{**dict(ast.iter_fields(node)), **fields}))})"


def _name(function: ast.expr) -> str:
    if isinstance(function, ast.Attribute):
        return function.attr
    return function.id if isinstance(function, ast.Name) else ""
