# SPDX-License-Identifier: Apache-2.0
"""Nodes and groups of nodes as Python: the actions of ``fleet.launch.py``."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from multibot_rewrite.base.markup import STRING
from multibot_rewrite.fleet.launch.starts import Component, File, Start, Text

_Files = tuple[File, ...]
# What stays in one line.
_SHORT = 64
_FLAG = re.compile(r"-{1,2}[A-Za-z][\w-]*")
_TEXTS = re.compile(STRING)
# A key with its value, which may be a list or a call.
_ENTRY = re.compile(
    rf"{STRING}: (?:\[(?:[^\[\]\"]|{STRING})*\]|\{{(?:[^{{}}\"]|{STRING})*\}}"
    rf"|\w+\((?:[^()\"]|{STRING})*\)|[^,\[{{]+)"
)


def group(starts: Sequence[Start], argument: str, indent: int) -> Iterator[str]:
    """What is started where a launch argument is true."""
    if not starts:
        return
    space = " " * indent
    yield f"{space}GroupAction("
    yield f"{space}    ["
    for start in starts:
        yield from process(start, indent + 8)
    yield f"{space}    ],"
    yield f'{space}    condition=IfCondition(LaunchConfiguration("{argument}")),'
    yield f"{space}),"


def process(it: Start, indent: int, own: _Files = (), action: str = "Node") -> Iterator[str]:
    """A node; ``own`` are the files that the robot's function calls ``params``."""
    space = " " * indent
    if it.brought_up:
        yield f"{space}*brought_up("
        yield from process(it._replace(brought_up=False), indent + 4, own, "LifecycleNode")
        yield f"{space}),"
        return
    yield f"{space}{'ComposableNodeContainer' if it.components else action}("
    yield from (f"{space}    {line}" for line in _keywords(it, own))
    if it.components:
        yield f"{space}    composable_node_descriptions=["
        for one in it.components:
            yield from _component(one, indent + 8, own)
        yield f"{space}    ],"
    yield f"{space}),"


def _keywords(it: Start, own: _Files) -> Iterator[str]:
    yield f'package="{it.package}",'
    yield f'executable="{it.executable}",'
    yield from _names(it.namespace, it.name)
    if it.arguments:
        yield from _list("arguments", [*_pairs(it.arguments)])
    yield from _given(it.parameters, it.remappings, own)
    yield 'output="screen",'


def _names(namespace: str, name: str) -> Iterator[str]:
    if namespace:
        yield f'namespace="{namespace}",'
    if name:
        yield f'name="{name}",'


def _given(
    parameters: Sequence[File | Mapping[str, Any]],
    remappings: Iterable[tuple[str, str]],
    own: _Files,
) -> Iterator[str]:
    common = bool(own) and tuple(parameters[: len(own)]) == own
    words = ["*params"] if common else []
    words += [value(it) for it in parameters[len(own) * common :]]
    yield from _list("parameters", [*words, "CLOCK"])
    pairs = list(remappings)
    if pairs:
        yield "remappings=["
        yield from (f"    ({value(old)}, {value(new)})," for old, new in pairs)
        yield "],"


def _list(key: str, items: Sequence[str]) -> Iterator[str]:
    """A keyword with a list."""
    yield from list_between(f"{key}=[", items, "],")


def list_between(start: str, items: Sequence[str], end: str) -> Iterator[str]:
    """A list in one line where that is short, whatever the names of robots are."""
    line = f"{start}{', '.join(items)}{end}"
    if _is_short(line):
        yield line
        return
    yield start
    yield from (f"    {line}" for it in items for line in _item(it))
    yield end


def _is_short(text: str) -> bool:
    """Does it stay in one line? Robots that only a number tells apart look the same."""
    return len(re.sub(r"\d", "", text)) <= _SHORT


def _item(it: str) -> Iterator[str]:
    """An item of a list; a long dictionary or list of words in several lines."""
    if _is_short(it) or not it.startswith("{"):
        yield f"{it},"
        return
    yield "{"
    for text in _ENTRY.findall(it[1:-1]):
        yield from (f"    {line}" for line in _entry(text))
    yield "},"


def _entry(text: str) -> Iterator[str]:
    key, _, words = text.partition(": ")
    if _is_short(text) or not words.startswith("["):
        yield f"{text},"
        return
    yield f"{key}: ["
    yield from (f"    {it}," for it in _TEXTS.findall(words))
    yield "],"


def _pairs(words: Iterable[str | File]) -> Iterator[str]:
    """The arguments of a program: a flag and its value stand together."""
    flag = ""
    for it in words:
        is_flag = isinstance(it, str) and _FLAG.fullmatch(it) is not None
        if flag and is_flag:
            yield flag
            flag = ""
        if is_flag:
            flag = value(it)
        else:
            yield f"{flag}, {value(it)}" if flag else value(it)
            flag = ""
    if flag:
        yield flag


def _component(it: Component, indent: int, own: _Files) -> Iterator[str]:
    space = " " * indent
    yield f"{space}ComposableNode("
    yield f'{space}    package="{it.package}",'
    yield f'{space}    plugin="{it.plugin}",'
    lines = (*_names(it.namespace, it.name), *_given(it.parameters, it.remappings, own))
    yield from (f"{space}    {line}" for line in lines)
    yield f"{space}),"


def value(it: Any) -> str:
    """A value of a parameter or argument."""
    if isinstance(it, File):
        return f"file({quoted(it.path)})"
    if isinstance(it, Text):
        return f"text({quoted(it.path)})"
    if isinstance(it, str):
        return quoted(it)
    if isinstance(it, Mapping):
        return "{" + ", ".join(f"{quoted(key)}: {value(one)}" for key, one in it.items()) + "}"
    if isinstance(it, list):
        return f"[{', '.join(map(value, it))}]"
    return repr(it)


def quoted(text: str) -> str:
    """A text in double quotes."""
    import json

    return json.dumps(text)
