# SPDX-License-Identifier: Apache-2.0
"""A launch file with one thing changed, everywhere in turn: a text or number, a keyword, an item."""

from __future__ import annotations

import ast
import copy
from collections.abc import Iterator

_DOCUMENTED = (ast.Module, ast.FunctionDef)


def mutants(text: str) -> Iterator[tuple[str, str]]:
    """What was changed, and the text of the changed file."""
    tree = ast.parse(text)
    for number, node in enumerate(_values(tree)):
        changed = copy.deepcopy(tree)
        own = list(_values(changed))[number]
        own.value = _other(own.value)
        yield f"line {node.lineno}: {node.value!r} is {own.value!r}", ast.unparse(changed)
    for field in ("keywords", "elts", "keys"):
        for number, node in enumerate(_having(tree, field)):
            for at, it in enumerate(getattr(node, field)):
                changed = copy.deepcopy(tree)
                own_node = list(_having(changed, field))[number]
                del getattr(own_node, field)[at]
                if field == "keys":
                    del own_node.values[at]
                yield f"line {node.lineno}: without {ast.unparse(it)}", ast.unparse(changed)


def _values(tree: ast.AST) -> Iterator[ast.Constant]:
    """The texts and numbers; those of f-strings, too, and no docstring."""
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
