# SPDX-License-Identifier: Apache-2.0
"""A launch file with one thing changed, everywhere in turn: a text or number, a keyword, an item."""

from __future__ import annotations

import ast
from collections.abc import Iterator

_DOCUMENTED = (ast.Module, ast.FunctionDef)


def mutants(text: str) -> Iterator[tuple[str, str]]:
    """Yield what was changed, and the text of the changed file."""
    tree = ast.parse(text)
    for node in list(_values(tree)):
        value, node.value = node.value, _other(node.value)  # type: ignore[assignment]
        yield f"line {node.lineno}: {value!r} is {node.value!r}", ast.unparse(tree)
        node.value = value
    for field in ("keywords", "elts", "keys"):
        for owner in list(_having(tree, field)):
            lists = [getattr(owner, it) for it in (field, "values")[: 1 + (field == "keys")]]
            for at in range(len(lists[0])):
                left_out = [it.pop(at) for it in lists]
                yield f"line {owner.lineno}: without {ast.unparse(left_out[0])}", ast.unparse(tree)  # type: ignore[attr-defined]
                for its, one in zip(lists, left_out, strict=True):
                    its.insert(at, one)


def _values(tree: ast.AST) -> Iterator[ast.Constant]:
    """Yield the texts and numbers; those of f-strings, too, and no docstring."""
    about = {
        id(it.body[0].value)
        for it in ast.walk(tree)
        if isinstance(it, _DOCUMENTED) and isinstance(it.body[0], ast.Expr)
    }
    for it in ast.walk(tree):
        if isinstance(it, ast.Constant) and id(it) not in about and it.value is not None:
            yield it


def _other(value: object) -> object:
    if isinstance(value, bool):
        return not value
    if isinstance(value, int | float):
        return value + 1
    return f"{value}X"


def _having(tree: ast.AST, field: str) -> Iterator[ast.AST]:
    yield from (it for it in ast.walk(tree) if getattr(it, field, None))
