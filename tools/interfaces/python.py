# SPDX-License-Identifier: Apache-2.0
"""Python -> what its classes call, by ``ast``."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator
from typing import Any

from tools.interfaces.records import (
    Call,
    Class,
    Constructor,
    Place,
    Source,
    Value,
    joined,
)

# Which argument is the type.
TYPE_AT = {
    **dict.fromkeys(("create_publisher", "create_subscription"), 0),
    **dict.fromkeys(("create_service", "create_client"), 0),
    **dict.fromkeys(("ActionServer", "ActionClient"), 1),
    "service_caller": 2,
}


def read_python(text: str, place: Place) -> Source:
    """What a Python file declares and calls; nothing of one that does not parse."""
    try:
        tree = ast.parse(text)
    except SyntaxError:
        return Source()
    types = dict(_imported(tree))
    parts = [_read(node, types, place) for node in tree.body]
    return joined(parts or [Source()])


def _imported(tree: ast.AST) -> Iterator[tuple[str, str]]:
    """Names of ROS types: ``from nav_msgs.msg import Odometry``."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module:
            for alias in node.names:
                yield alias.asname or alias.name, f"{node.module}.{alias.name}"


def _read(node: ast.stmt, types: dict[str, str], place: Place) -> Source:
    owner = node.name if isinstance(node, ast.ClassDef) else ""
    classes = (
        (Class(owner, tuple(map(_text, node.bases)), (), {}, place._replace(line=node.lineno)),)
        if isinstance(node, ast.ClassDef)
        else ()
    )
    takers: list[Constructor] = []
    calls: list[Call] = []
    values: list[Value] = []
    for inside, function in _functions(node):
        names = tuple(it.arg for it in inside.args.args[1:]) if inside else ()
        takers += [Constructor(owner, owner if function == "__init__" else function, names)]
    for function, found, condition in _walk(node, "", ""):
        if isinstance(found, ast.Call):
            calls.append(_call(found, owner, function, condition, types, place))
            values += _parameter(found, owner, function, place)
        elif isinstance(found, ast.Assign):
            values += [
                Value(owner, function, _text(it).strip("<>"), _text(found.value), place)
                for it in found.targets
            ]
    return Source(classes, tuple(calls), tuple(values), (), tuple(takers))


def _functions(node: ast.AST) -> Iterator[tuple[ast.FunctionDef, str]]:
    for found in ast.walk(node):
        if isinstance(found, ast.FunctionDef):
            yield found, found.name


def _walk(node: ast.AST, function: str, condition: str) -> Iterator[tuple[str, ast.AST, str]]:
    yield function, node, condition
    inside = node.name if isinstance(node, ast.FunctionDef) else function
    for child in ast.iter_child_nodes(node):
        below = condition
        if isinstance(node, ast.If) and child is not node.test:
            text = ast.unparse(node.test)
            below = f"not ({text})" if child in node.orelse else text
        yield from _walk(child, inside, below)


def _call(
    node: ast.Call, owner: str, function: str, condition: str, types: dict[str, str], place: Place
) -> Call:
    name = node.func.attr if isinstance(node.func, ast.Attribute) else _text(node.func).strip("<>")
    words = [it.value for it in node.keywords]
    args = [*node.args, *words] if name in TYPE_AT else list(node.args)
    given = [_text(it) for it in args]
    at = TYPE_AT.get(name, len(args))
    typed: tuple[str, ...] = ()
    if len(args) > at:
        written = ast.unparse(args[at])
        typed = (types.get(written, written),)
        del given[at]
    on = _text(node.func.value) if isinstance(node.func, ast.Attribute) else ""
    own = "" if on in ("<self>", "<node>") else on
    return Call(
        owner, function, name, typed, tuple(given), own, condition, place._replace(line=node.lineno)
    )


def _parameter(node: ast.Call, owner: str, function: str, place: Place) -> Iterator[Value]:
    """``declare_parameter('p', default)``."""
    if _name(node) == "declare_parameter" and len(node.args) > 1:
        yield Value(owner, function, f"@{_text(node.args[0])}", _text(node.args[1]), place)


def _name(node: ast.Call) -> str:
    return node.func.attr if isinstance(node.func, ast.Attribute) else ""


def _text(node: ast.AST) -> str:
    """An expression as a text; what is not known is in <>."""
    return TEXTS.get(type(node), lambda _: "<?>")(node)


def _constant(node: ast.Constant) -> str:
    return node.value if isinstance(node.value, str) else f"<{node.value!r}>"


def _attribute(node: ast.Attribute) -> str:
    return _text(node.value) if node.attr == "value" else f"<{node.attr}>"


def _called(node: ast.Call) -> str:
    if "param" in _name(node) and node.args:
        return f"<@{_text(node.args[0])}>"
    return _text(node.func.value) if isinstance(node.func, ast.Attribute) else "<?>"


TEXTS: dict[type, Callable[[Any], str]] = {
    ast.Constant: _constant,
    ast.BinOp: lambda node: _text(node.left) + _text(node.right),
    ast.JoinedStr: lambda node: "".join(map(_text, node.values)),
    ast.FormattedValue: lambda node: _text(node.value),
    ast.Attribute: _attribute,
    ast.Name: lambda node: "<this>" if node.id == "self" else f"<{node.id}>",
    ast.Call: _called,
}
