# SPDX-License-Identifier: Apache-2.0
"""A launch file as it is written: its actions, and values that are read without running it.

A value is plain where names that are assigned once, paths in packages that are there, and defaults of
launch arguments lead to it. All else is unknown: a launch file is a program. One in XML or YAML is read
as the same one in Python (launch_xml/entity.py, launch_yaml/entity.py, launch_ros/actions/node.py).
"""

from __future__ import annotations

import ast
import os
import re
from collections import defaultdict
from collections.abc import Callable, Container, Iterator, Mapping, Sequence
from functools import lru_cache
from typing import Any

from multibot_rewrite.base.bounded import load_yaml
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.sources.packages import package_folder
from multibot_rewrite.fleet.proposal.searching import text_of
from multibot_rewrite.producers.launch.entities import Entity, root_of

# What is not plain.
UNKNOWN = object()
_NODES = ("Node", "LifecycleNode", "ComposableNode")
_INCLUDE, _DECLARE = "IncludeLaunchDescription", "DeclareLaunchArgument"
# Calls that have the value of their first argument, and the name of that argument.
_SAME = {
    "ParameterFile": "param_file", "RewrittenYaml": "source_file", "ParameterValue": "value",
    "TextSubstitution": "text", "PythonLaunchDescriptionSource": "", "str": "", "Path": "",
    "AnyLaunchDescriptionSource": "", "ReplaceString": "source_file", "PathSubstitution": "path",
}  # fmt: skip
_PACKAGES = ("get_package_share_directory", "FindPackageShare", "get_package_share_path")
_JOINS = ("join", "PathJoinSubstitution")
# Names that lead to a value by way of others.
_DEEPEST = 12
_SUBSTITUTION = re.compile(r"(\$\((?:[^()]|\([^()]*\))*\))")
_UNREAD = "unknown()"


class LaunchText(NamedTuple):
    """A launch file: its calls that start nodes or include files, what it assigns to names once, the
    arguments that it declares, with their defaults, and the texts in it."""

    file: str
    nodes: tuple[ast.Call, ...]
    includes: tuple[ast.Call, ...]
    assigned: Mapping[str, ast.expr]
    declared: Mapping[str, ast.expr]
    texts: tuple[str, ...]


@lru_cache(maxsize=512)
def launch_text(path: str) -> LaunchText:
    """Read a launch file; one that cannot be parsed has nothing."""
    try:
        text = text_of(path) if path.endswith(".py") else _in_python(path)
        every = _used(ast.parse(text))
    except (SyntaxError, ValueError, TypeError, RuntimeError, InputError):
        every = []
    calls = [it for it in every if isinstance(it, ast.Call)]
    declared = ((word_of(argument(it, "name", 0)), it) for it in _called(calls, _DECLARE))
    return LaunchText(
        path,
        tuple(_called(calls, *_NODES)),
        tuple(_called(calls, _INCLUDE)),
        _assigned(every),
        {name: it for name, call in declared if (it := argument(call, "default_value", 1))},
        tuple(filter(None, (word_of(it) for it in every if isinstance(it, ast.Constant)))),
    )


def _used(tree: ast.AST) -> list[ast.AST]:
    """All of a file but what it assigns to names that it never reads: such a node is not started."""
    names = (it for it in ast.walk(tree) if isinstance(it, ast.Name))
    read = {it.id for it in names if isinstance(it.ctx, ast.Load)}
    every: list[ast.AST] = [tree]
    for it in every:
        below = ast.iter_child_nodes(it)
        every += (one for one in below if not isinstance(one, ast.Assign) or _is_read(one, read))
    return every


def _is_read(it: ast.Assign, names: Container[str]) -> bool:
    return any(not isinstance(one, ast.Name) or one.id in names for one in it.targets)


def argument(call: ast.Call, name: str, at: int = -1) -> ast.expr | None:
    """An argument of a call by its name, or its place."""
    named = next((it.value for it in call.keywords if it.arg == name), None)
    return named or (call.args[at] if 0 <= at < len(call.args) else None)


def word_of(it: ast.expr | None) -> str:
    """The text of a constant; empty for anything else."""
    return it.value if isinstance(it, ast.Constant) and isinstance(it.value, str) else ""


def _name(call: ast.Call) -> str:
    return getattr(call.func, "id", "") or getattr(call.func, "attr", "")


def _called(calls: Sequence[ast.Call], *names: str) -> Iterator[ast.Call]:
    return (it for it in calls if _name(it) in names)


def _assigned(every: Sequence[ast.AST]) -> dict[str, ast.expr]:
    """Names that have one value in the whole file."""
    found: dict[str, ast.expr | None] = {}
    for it in (one for one in every if isinstance(one, ast.Assign)):
        for target in (one for one in it.targets if isinstance(one, ast.Name)):
            found[target.id] = None if target.id in found else it.value
    return {name: it for name, it in found.items() if it is not None}


class Reading(NamedTuple):
    """A launch file with the values of its arguments."""

    text: LaunchText
    given: Mapping[str, Any]

    def value(self, it: ast.expr | None, depth: int = 0) -> Any:
        """The plain value of an expression, or UNKNOWN; raises nothing."""
        read = _READERS.get(type(it))
        return UNKNOWN if read is None or depth > _DEEPEST else read(self, it, depth + 1)

    def path(self, it: ast.expr | None) -> str:
        """The plain text of an expression, of its pieces one after the other; empty for none."""
        found = _joined(self.value(it))
        return "" if found is UNKNOWN else str(found)


def _constant(_: Reading, it: Any, __: int) -> Any:
    return it.value


def _number(reading: Reading, it: Any, depth: int) -> Any:
    found = reading.value(it.operand, depth)
    negative = isinstance(it.op, ast.USub) and type(found) in (int, float)
    return -found if negative else UNKNOWN


def _of_name(reading: Reading, it: Any, depth: int) -> Any:
    return reading.value(reading.text.assigned.get(it.id), depth)


def _list(reading: Reading, it: Any, depth: int) -> Any:
    found = [reading.value(one, depth) for one in it.elts]
    return UNKNOWN if UNKNOWN in found else found


def _sum(reading: Reading, it: Any, depth: int) -> Any:
    both = [reading.value(one, depth) for one in (it.left, it.right)]
    if isinstance(it.op, ast.Div):
        return _path(both)
    texts = isinstance(it.op, ast.Add) and all(isinstance(one, str) for one in both)
    return "".join(both) if texts else UNKNOWN


def _path(parts: Sequence[Any]) -> Any:
    """The path of these parts; UNKNOWN for none, and where one of them is unknown."""
    found = [_joined(it) for it in parts]
    return os.path.join(*found) if found and UNKNOWN not in found else UNKNOWN


def _joined(found: Any) -> Any:
    """A text, or the pieces of one; UNKNOWN for all else."""
    pieces = found if isinstance(found, list) and found else [found]
    return "".join(pieces) if all(isinstance(one, str) for one in pieces) else UNKNOWN


def _call(reading: Reading, it: Any, depth: int) -> Any:
    name = _name(it)
    if name == "LaunchConfiguration":
        return _configured(reading, word_of(argument(it, "variable_name", 0)), depth)
    if name in _PACKAGES:
        return _folder(reading, reading.value(argument(it, "package", 0), depth))
    if name in _JOINS:
        pieces = (
            it.args if name == "join" else getattr(argument(it, "substitutions", 0), "elts", [])
        )
        return _path([reading.value(one, depth) for one in pieces])
    return reading.value(argument(it, _SAME[name], 0), depth) if name in _SAME else UNKNOWN


def _configured(reading: Reading, name: str, depth: int) -> Any:
    """An argument as it was given, or its default; launch makes numbers and truth of the text."""
    default = reading.text.declared.get(name)
    found = reading.given[name] if name in reading.given else reading.value(default, depth)
    try:
        return load_yaml(found, "") if isinstance(found, str) and found else found
    except InputError:
        return found


def _folder(reading: Reading, package: Any) -> Any:
    found = package_folder(package, reading.text.file, ()) if isinstance(package, str) else ""
    return os.path.relpath(found) if found else UNKNOWN


_READERS: Mapping[type, Callable[[Reading, Any, int], Any]] = {
    ast.Constant: _constant, ast.UnaryOp: _number, ast.Name: _of_name, ast.List: _list,
    ast.Tuple: _list, ast.BinOp: _sum, ast.Call: _call,
}  # fmt: skip


def _in_python(path: str) -> str:
    """The actions of a file in XML or YAML as Python, each in its line; raises as ``root_of``."""
    lines: dict[int, list[str]] = defaultdict(list)
    for it in root_of(text_of(path).encode()).every():
        made = _MADE.get(it.tag)
        if made:
            lines[it.line].append(made(it).replace(_HERE, repr(os.path.dirname(path) or os.curdir)))
    return "\n".join("; ".join(lines[at]) for at in range(1, max(lines, default=0) + 1))


def _made_node(it: Entity) -> str:
    own = {"executable": it.values.get("exec"), "name": it.values.get("name")}
    words = [f"{key}={_made_text(value)}" for key, value in own.items() if value is not None]
    files = [_made_text(one.values["from"]) for one in _inside(it, "param", "from")]
    values = ", ".join(f"{name!r}: {value}" for name, value in _made_values(it, ""))
    rules = (
        f"({_made_text(one.values['from'])}, {_made_text(one.values.get('to', ''))})"
        for one in _inside(it, "remap", "from")
    )
    given = ", ".join([*files, f"{{{values}}}"])
    return f"Node({', '.join(words)}, parameters=[{given}], remappings=[{', '.join(rules)}])"


def _inside(it: Entity, tag: str, key: str) -> Iterator[Entity]:
    return (one for one in it.below if one.tag == tag and key in one.values)


def _made_values(it: Entity, above: str) -> Iterator[tuple[str, str]]:
    """The parameters in an element, those below one with its name in front."""
    for one in _inside(it, "param", "name"):
        name = f"{above}{one.values['name']}"
        yield from _made_values(one, f"{name}.")
        if "value" in one.values:
            made = _made_text if one.values.get("type") == "str" else _made_value
            yield name, made(one.values["value"])


def _made_value(it: Any) -> str:
    """A value as launch has it: of what a text says in YAML."""
    if isinstance(it, list):
        return f"[{', '.join(map(_made_value, it))}]"
    if not isinstance(it, str):
        return repr(it)
    try:
        return _made_text(it) if "$" in it else repr(load_yaml(it, ""))
    except InputError:
        return repr(it)


def _made_text(it: Any) -> str:
    if not isinstance(it, str):
        return _UNREAD
    return " + ".join(_made_piece(one) for one in _SUBSTITUTION.split(it) if one) or "''"


def _made_piece(it: str) -> str:
    if not it.startswith("$("):
        return repr(it)
    name, _, rest = it[2:-1].partition(" ")
    made = {"var": "LaunchConfiguration", "find-pkg-share": "FindPackageShare"}.get(name)
    if name == "dirname":
        return _HERE
    return f"{made}({_made_text(rest.strip())})" if made else _UNREAD


def _made_include(it: Entity) -> str:
    values = (
        f"({one.values['name']!r}, {_made_text(one.values.get('value', ''))})"
        for one in _inside(it, "arg", "name")
    )
    file = _made_text(it.values.get("file", ""))
    return f"{_INCLUDE}({file}, launch_arguments=[{', '.join(values)}])"


def _made_argument(it: Entity) -> str:
    """An ``arg``, or a ``let``, of which one with a condition may not count."""
    value = it.values.get("default", it.values.get("value"))
    if {"if", "unless"} & it.values.keys():
        value = None
    return f"{_DECLARE}({it.values.get('name', '')!r}, default_value={_made_text(value)})"


# What stands for the folder of the file.
_HERE = "__folder__"
_MADE: Mapping[str, Callable[[Entity], str]] = {
    "node": _made_node, "lifecycle_node": _made_node, "composable_node": _made_node,
    "include": _made_include, "arg": _made_argument, "let": _made_argument,
}  # fmt: skip
