# SPDX-License-Identifier: Apache-2.0
"""Nodes and groups of nodes as Python: the actions of ``fleet.launch.py``."""

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import groupby
from typing import Any, NamedTuple

from multibot_rewrite.fleet.launch.each_robot import FLAG, Code
from multibot_rewrite.planning.start import (
    EVENTS,
    HOW,
    File,
    Led,
    Start,
    Text,
    in_order,
    name_in,
    values_in,
    with_folders,
    with_rest,
)

# What stays in one line.
_SHORT = 66


class OfRobot(NamedTuple):
    """What the nodes of a robot share: the files that its function calls ``params``, the clock."""

    files: tuple[File, ...] = ()
    clock: Any = Code("CLOCK")


OF_ALL = OfRobot()


def actions(
    starts: Iterable[Start], indent: int, own: OfRobot = OF_ALL, otherwise: str = ""
) -> Iterator[str]:
    """Yield what is started, in groups by launch argument and by needed package."""
    # ``otherwise`` is the message if a package is not installed.
    space, ordered = " " * indent, groupby(in_order([*starts]), lambda it: it.start.needs)
    for needs, several in ordered:
        if needs:
            given = (f"{space}    {value(it)}," for it in (needs, otherwise))
            inner = _conditional(several, (), indent + 8, own)
            yield from (f"{space}*if_installed(", *given, f"{space}    [", *inner)
            yield from (f"{space}    ],", f"{space}),")
        else:
            yield from _conditional(several, (), indent, own)


def _conditional(
    several: Iterable[Led], above: Collection[str], indent: int, own: OfRobot
) -> Iterator[str]:
    """Yield processes, in a group where they are under other conditions than ``above`` them."""
    apart = groupby(several, lambda it: tuple(one for one in it.start.terms if one not in above))
    for words, every in ((words, [*led]) for words, led in apart):
        yield from _grouped(words, _processes(every, indent + 8 * len(words), own), indent)
        if rest := [one for it in every for one in it.always]:
            inner = _conditional(rest, words, indent + 8, own)
            yield from _grouped([f"!{words[0]}"], inner, indent)


def _grouped(words: Sequence[str], inner: Iterable[str], indent: int) -> Iterator[str]:
    """Yield actions in nested groups, one for each launch argument."""
    if not words:
        yield from inner
        return
    space, name, values = " " * indent, name_in(words[0]), values_in(words[0])
    below = _grouped(words[1:], inner, indent + 8)
    yield from (f"{space}GroupAction(", f"{space}    [", *below, f"{space}    ],")
    of_values = f"one_of({value(name)}, {', '.join(map(value, values))})"
    asked = of_values if values else f"LaunchConfiguration({value(name)})"
    kind = "UnlessCondition" if "!" in words[0] else "IfCondition"
    yield from (f"{space}    condition={kind}({asked}),", f"{space}),")


def _processes(several: Iterable[Led], indent: int, own: OfRobot) -> Iterator[str]:
    """Yield processes, each after its delay."""
    space = " " * indent
    for it in several:
        if it.start.process.delay:
            yield from (f"{space}TimerAction(", f"{space}    period={it.start.process.delay!r},")
            inner = _lines_with_events(it, indent + 8, own)
            yield from (f"{space}    actions=[", *inner, f"{space}    ],", f"{space}),")
        else:
            yield from _lines_with_events(it, indent, own)


def _lines_with_events(it: Led, indent: int, own: OfRobot) -> Iterator[str]:
    """Yield a process, and what starts at its events."""
    space = " " * indent
    if not it.followers:
        yield from _process_lines(it.start, indent, own)
        return
    yield from (f"{space}*then(", *_process_lines(it.start, indent + 4, own))
    for event in dict.fromkeys(EVENTS.values()):
        if several := it.at(event):
            inner = _conditional(several, it.start.terms, indent + 8, own)
            yield from (f"{space}    {event}=[", *inner, f"{space}    ],")
    yield f"{space}),"


def _process_lines(it: Start, indent: int, own: OfRobot) -> Iterator[str]:
    space = " " * indent
    if it.process.is_include:
        yield from (f"{space}{line}" for line in _include_lines(it))
    elif it.brought_up:
        yield from (f"{space}*brought_up(", *_action_lines(it, indent + 4, own), f"{space}),")
    else:
        yield from _action_lines(it, indent, own)


def _include_lines(it: Start) -> Iterator[str]:
    """Yield a launch file of a package, in the namespace of its robot and under its rules."""
    yield from ("GroupAction(", "    [")
    for variable, setting in it.environment.items():
        yield f"        SetEnvironmentVariable({value(variable)}, {value(setting)}),"
    if it.namespace.strip("/"):
        yield f"        PushRosNamespace({value(it.namespace)}),"
    for old, new in it.remappings:
        yield f"        SetRemap({value(old)}, {value(new)}),"
    path = f"PathJoinSubstitution([FindPackageShare({value(it.package)}), {value(it.executable)}])"
    yield from ("        IncludeLaunchDescription(", f"            {path},")
    if it.arguments:
        yield "            launch_arguments=["
        for name, given in zip(it.arguments[::2], it.arguments[1::2], strict=True):
            yield f"                ({value(name)}, {value(given)}),"
        yield "            ],"
    yield from ("        ),", "    ],", "),")


def _action_lines(it: Start, indent: int, own: OfRobot) -> Iterator[str]:
    """Yield a process or a component."""
    space = " " * indent
    yield f"{space}{_action_class(it)}("
    yield from (f"{space}    {line}" for line in _keyword_lines(it, own))
    if it.components:
        yield f"{space}    composable_node_descriptions=["
        for one in it.components:
            yield from _action_lines(one, indent + 8, own)
        yield f"{space}    ],"
    yield f"{space}),"


def _action_class(it: Start) -> str:
    if it.plugin:
        return "ComposableNode"
    if not it.package:
        return "LoadComposableNodes" if it.components else "ExecuteProcess"
    if it.components:
        return "ComposableNodeContainer"
    return "LifecycleNode" if it.brought_up else "Node"


def _keyword_lines(it: Start, own: OfRobot) -> Iterator[str]:
    if it.components and not it.package:
        yield f"target_container={value(it.name)},"
        return
    if it.package:
        for name in ("package", "executable", "plugin", "namespace", "name"):
            if text := getattr(it, name):
                yield f"{name}={value(text)},"
        if it.arguments:
            yield from lines("arguments=", [*_argument_pairs(it.arguments)], ",")
        count = len(own.files)
        common = count > 0 and it.parameters[:count] == own.files
        first, rest = ([Code("*params")], it.parameters[count:]) if common else ([], it.parameters)
        yield from lines("parameters=", [*first, *rest, own.clock], ",")
        if it.remappings:
            yield "remappings=["
            yield from (f"    ({value(old)}, {value(new)})," for old, new in it.remappings)
            yield "],"
    else:
        yield from lines("cmd=", [*_argument_pairs((it.executable, *it.arguments))], ",")
    if it.environment:
        set_ = {name: _with_inherited(name, text) for name, text in it.environment.items()}
        yield from lines("additional_env=", set_, ",")
    for name in HOW:
        if given := getattr(it.process, name):
            yield f"{name}={value(given)},"
    if not it.plugin:
        yield "output='screen',"


def _with_inherited(name: Any, text: Any) -> Any:
    """Return Python for a variable of the environment, with the value that it has before in a list."""
    rest = Code(f"EnvironmentVariable({value(name)}, default_value='')")
    return text if isinstance(text, Code) else with_rest(text, rest)


def lines(before: str, it: Any, after: str = "") -> list[str]:
    """Return the lines of a value: one if that is short, else those of its items."""
    line = f"{before}{value(it)}{after}"
    if len(re.sub(r"\d", "", line)) <= _SHORT or not isinstance(it, Mapping | list):
        return [line]
    first, last = "{}" if isinstance(it, Mapping) else "[]"
    pairs = it.items() if isinstance(it, Mapping) else ((None, one) for one in it)
    inner = [lines("" if key is None else f"{value(key)}: ", one) for key, one in pairs]
    below = (f"    {line}" for one in inner for line in (*one[:-1], f"{one[-1]},"))
    return [f"{before}{first}", *below, f"{last}{after}"]


def _argument_pairs(words: Iterable[str | File]) -> Iterator[Code]:
    """Yield the arguments of a program: a flag and its value are on one line."""
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


def value(it: Any) -> str:
    """Return the Python of a value of a parameter or argument."""
    if isinstance(it, Code):
        return str(it)
    if isinstance(it, File):
        path = f"file({value(it.path)})"
        return f"ParameterFile({path}, allow_substs=True)" if it.substituted else path
    if isinstance(it, Text):
        return f"text({value(it.path)})"
    if isinstance(it, Mapping):
        return "{" + ", ".join(f"{value(key)}: {value(one)}" for key, one in it.items()) + "}"
    if isinstance(it, list):
        return f"[{', '.join(map(value, it))}]"
    return _quoted_text(it) if isinstance(it, str) else repr(it)


def _quoted_text(it: str) -> str:
    """Return the Python of a text; the folder of a package is asked for when it starts."""
    parts = with_folders(it, "FindPackageShare({!r})".format, "FindPackagePrefix({!r})".format)
    if len(parts) == 1:
        return repr(it)
    parts[::2] = map(repr, parts[::2])
    return f"[{', '.join(one for one in parts if one != repr(''))}]"


def comment(text: str) -> str:
    """Return a text for people that ends no comment and no docstring."""
    return " ".join(text.split()).replace("\\", "/").replace('"', "'")
