# SPDX-License-Identifier: Apache-2.0
"""Nodes and groups of nodes as Python: the actions of ``fleet.launch.py``."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.fleet.launch.each_robot import FLAG, Code
from multibot_rewrite.fleet.launch.starts import Component, File, Start, Text

# What stays in one line.
_SHORT = 66


class OfRobot(NamedTuple):
    """What the nodes of a robot have in common: the files that its function calls ``params``, and the
    parameter of their clock."""

    files: tuple[File, ...] = ()
    clock: Any = Code("CLOCK")


OF_ALL = OfRobot()


def group(
    starts: Sequence[Start], argument: str, indent: int, own: OfRobot = OF_ALL
) -> Iterator[str]:
    """Yield what is started where a launch argument is true."""
    if not starts:
        return
    space = " " * indent
    yield f"{space}GroupAction("
    yield f"{space}    ["
    for start in starts:
        yield from process(start, indent + 8, own)
    yield f"{space}    ],"
    yield f"{space}    condition=IfCondition(LaunchConfiguration({value(argument)})),"
    yield f"{space}),"


def process(it: Start, indent: int, own: OfRobot = OF_ALL, action: str = "Node") -> Iterator[str]:
    """Yield a node."""
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


def _keywords(it: Start, own: OfRobot) -> Iterator[str]:
    yield f"package={value(it.package)},"
    yield f"executable={value(it.executable)},"
    yield from _names(it.namespace, it.name)
    if it.arguments:
        yield from lines("arguments=", [*_pairs(it.arguments)], ",")
    yield from _given(it.parameters, it.remappings, own)
    yield "output='screen',"


def _names(namespace: str, name: str) -> Iterator[str]:
    if namespace:
        yield f"namespace={value(namespace)},"
    if name:
        yield f"name={value(name)},"


def _given(
    parameters: Sequence[File | Mapping[str, Any]],
    remappings: Iterable[tuple[str, str]],
    own: OfRobot,
) -> Iterator[str]:
    common = bool(own.files) and tuple(parameters[: len(own.files)]) == own.files
    first = [Code("*params")] if common else []
    rest = parameters[len(own.files) * common :]
    yield from lines("parameters=", [*first, *rest, own.clock], ",")
    pairs = list(remappings)
    if pairs:
        yield "remappings=["
        yield from (f"    ({value(old)}, {value(new)})," for old, new in pairs)
        yield "],"


def lines(before: str, it: Any, after: str = "") -> list[str]:
    """Return the lines of a value: one if that is short, else those of its items."""
    line = f"{before}{value(it)}{after}"
    if _is_short(line) or not isinstance(it, Mapping | list):
        return [line]
    first, last = "{}" if isinstance(it, Mapping) else "[]"
    pairs = it.items() if isinstance(it, Mapping) else ((None, one) for one in it)
    inner = [lines("" if key is None else f"{value(key)}: ", one) for key, one in pairs]
    below = (f"    {line}" for one in inner for line in (*one[:-1], f"{one[-1]},"))
    return [f"{before}{first}", *below, f"{last}{after}"]


def _is_short(text: str) -> bool:
    """Does it stay in one line? Robots that only a number tells apart look the same."""
    return len(re.sub(r"\d", "", text)) <= _SHORT


def _pairs(words: Iterable[str | File]) -> Iterator[Code]:
    """Yield the arguments of a program: a flag and its value stand together."""
    flag = ""
    for it in words:
        is_flag = isinstance(it, str) and not isinstance(it, Code) and bool(FLAG.fullmatch(it))
        if flag and is_flag:
            yield Code(flag)
            flag = ""
        if is_flag:
            flag = value(it)
        else:
            yield Code(f"{flag}, {value(it)}" if flag else value(it))
            flag = ""
    if flag:
        yield Code(flag)


def _component(it: Component, indent: int, own: OfRobot) -> Iterator[str]:
    space = " " * indent
    yield f"{space}ComposableNode("
    yield f"{space}    package={value(it.package)},"
    yield f"{space}    plugin={value(it.plugin)},"
    own_lines = (*_names(it.namespace, it.name), *_given(it.parameters, it.remappings, own))
    yield from (f"{space}    {line}" for line in own_lines)
    yield f"{space}),"


def value(it: Any) -> str:
    """Return the Python of a value of a parameter or argument."""
    if isinstance(it, Code):
        return str(it)
    if isinstance(it, File):
        return f"file({value(it.path)})"
    if isinstance(it, Text):
        return f"text({value(it.path)})"
    if isinstance(it, Mapping):
        return "{" + ", ".join(f"{value(key)}: {value(one)}" for key, one in it.items()) + "}"
    if isinstance(it, list):
        return f"[{', '.join(map(value, it))}]"
    return repr(it)


def comment(text: str) -> str:
    """Return a text for people that ends no comment and no docstring."""
    return " ".join(text.split()).replace("\\", "/").replace('"', "'")
