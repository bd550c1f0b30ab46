# SPDX-License-Identifier: Apache-2.0
"""Nodes that launch files start: package, executable, name, namespace and remap rules.

Files in Python are read as text and never run, so a value that only a run would tell is ``<...>``.
Sources: launch_ros/actions/node.py, launch_ros/descriptions/composable_node.py (parse methods, too).
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

import yaml
from lxml import etree

from multibot_rewrite.base.bounded import compose_yaml
from multibot_rewrite.base.model import InputError

NODE, LIFECYCLE, CONTAINER, COMPONENT = "node", "lifecycle_node", "container", "component"
# Actions of Python files, and elements of XML and YAML files.
_ACTIONS = {
    "Node": NODE,
    "add_debuggable_node": NODE,
    "LifecycleNode": LIFECYCLE,
    "ComposableNodeContainer": CONTAINER,
    "ComposableLifecycleNode": COMPONENT,
    "ComposableNode": COMPONENT,
}
_ELEMENTS = {"node": NODE, "node_container": CONTAINER, "composable_node": COMPONENT}
_ALTERNATIVES = 8


class LaunchedNode(NamedTuple):
    """A node of a launch file; ``executable`` is the plugin of a component, ``name`` is empty where
    the node has its own, ``remaps`` are rules ``from:=to`` with blanks between."""

    kind: str
    package: str
    executable: str
    name: str
    namespace: str
    remaps: str
    line: int


def launched_nodes(file: str, text: str) -> tuple[LaunchedNode, ...]:
    """Return the nodes of a launch file by its name's end; none for one that cannot be read."""
    try:
        if file.endswith(".py"):
            return tuple(_of_python(ast.parse(text)))
        if file.endswith((".xml", ".launch")):
            return tuple(_of_xml(text))
        return tuple(_of_yaml(compose_yaml(text, file)))
    except (SyntaxError, ValueError, etree.XMLSyntaxError, InputError):
        return ()


def _of_python(module: ast.Module) -> Iterator[LaunchedNode]:
    names = _assigned(module)
    for node in ast.walk(module):
        if isinstance(node, ast.Call) and _last_name(node.func) in _ACTIONS:
            given = {it.arg: it.value for it in node.keywords if it.arg}
            if "package" in given:
                yield _called(node, given, names)


def _called(
    call: ast.Call, given: Mapping[str, ast.expr], names: Mapping[str, ast.expr]
) -> LaunchedNode:
    def text(*keys: str) -> str:
        found = next((given[key] for key in keys if key in given), None)
        return _text(found, names) if found is not None else ""

    kind = _ACTIONS[_last_name(call.func)]
    rules = _rules(given["remappings"], names) if "remappings" in given else ()
    executable = text("plugin", "executable", "node_executable")
    name = text("name", "node_name")
    return LaunchedNode(
        kind, text("package"), executable, name, text("namespace"), " ".join(rules), call.lineno
    )


def _last_name(node: ast.expr) -> str:
    if isinstance(node, ast.Attribute):
        return node.attr
    return node.id if isinstance(node, ast.Name) else ""


def _assigned(module: ast.Module) -> dict[str, ast.expr]:
    """Names with one value in the whole file."""
    found: dict[str, list[ast.expr]] = {}
    for node in ast.walk(module):
        if isinstance(node, ast.Assign):
            for target in node.targets:
                if isinstance(target, ast.Name):
                    found.setdefault(target.id, []).append(node.value)
    return {name: values[0] for name, values in found.items() if len(values) == 1}


def _text(node: ast.expr, names: Mapping[str, ast.expr], depth: int = 0) -> str:
    """Return a text; ``$(var x)`` for an argument, ``<...>`` for what only a run tells."""
    if isinstance(node, ast.Constant):
        return "" if node.value is None else str(node.value)
    if isinstance(node, ast.Name) and node.id in names and depth < _ALTERNATIVES:
        return _text(names[node.id], names, depth + 1)
    if isinstance(node, ast.List | ast.Tuple):
        return "".join(_text(it, names, depth + 1) for it in node.elts)
    if isinstance(node, ast.Call) and _last_name(node.func) == "LaunchConfiguration" and node.args:
        return f"$(var {_text(node.args[0], names, depth + 1)})"
    return "<...>"


def _rules(node: ast.expr, names: Mapping[str, ast.expr], depth: int = 0) -> tuple[str, ...]:
    """Return the rules of a list, of lists that are added, or of a name for one."""
    if isinstance(node, ast.Name) and node.id in names and depth < _ALTERNATIVES:
        return _rules(names[node.id], names, depth + 1)
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
        return _rules(node.left, names, depth + 1) + _rules(node.right, names, depth + 1)
    if isinstance(node, ast.Starred):
        return _rules(node.value, names, depth + 1)
    if isinstance(node, ast.List | ast.Tuple):
        if len(node.elts) == 2 and not any(isinstance(it, ast.Tuple) for it in node.elts):
            return (":=".join(_text(it, names) for it in node.elts),)
        return tuple(rule for it in node.elts for rule in _rules(it, names, depth + 1))
    return ("<...>",)


def _of_xml(text: str) -> Iterator[LaunchedNode]:
    parser = etree.XMLParser(resolve_entities=False)
    for element in etree.fromstring(text.encode(), parser).iter(*_ELEMENTS):
        given = {str(key): str(value) for key, value in element.attrib.items()}
        if "pkg" in given:
            rules = [(it.get("from", ""), it.get("to", "")) for it in element.iterfind("remap")]
            yield _described(str(element.tag), given, rules, int(str(element.sourceline or 0)))


def _of_yaml(node: yaml.Node | None) -> Iterator[LaunchedNode]:
    if isinstance(node, yaml.SequenceNode):
        for below in node.value:
            yield from _of_yaml(below)
    if not isinstance(node, yaml.MappingNode):
        return
    for key, below in node.value:
        word = getattr(key, "value", "")
        for entry in below.value if isinstance(below, yaml.SequenceNode) else [below]:
            given = _scalars(entry)
            if word in _ELEMENTS and "pkg" in given:
                line = entry.start_mark.line + 1
                yield _described(word, given, _yaml_rules(entry), line)
        yield from _of_yaml(below)


def _scalars(node: yaml.Node) -> dict[str, str]:
    if not isinstance(node, yaml.MappingNode):
        return {}
    return {key.value: it.value for key, it in node.value if isinstance(it, yaml.ScalarNode)}


def _yaml_rules(node: yaml.Node) -> Iterator[tuple[str, str]]:
    for key, value in node.value if isinstance(node, yaml.MappingNode) else ():
        if key.value == "remap" and isinstance(value, yaml.SequenceNode):
            rules = map(_scalars, value.value)
            yield from ((it.get("from", ""), it.get("to", "")) for it in rules)


def _described(
    tag: str, given: Mapping[str, str], rules: Iterable[tuple[str, str]], line: int
) -> LaunchedNode:
    remaps = " ".join(f"{old}:={new}" for old, new in rules)
    executable = given.get("plugin") or given.get("exec", "")
    name, namespace = given.get("name", ""), given.get("namespace", "")
    return LaunchedNode(_ELEMENTS[tag], given["pkg"], executable, name, namespace, remaps, line)
