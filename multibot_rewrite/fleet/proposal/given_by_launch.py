# SPDX-License-Identifier: Apache-2.0
"""What launch files themselves give to nodes that a fleet starts: parameters in their text, files of
parameters, and remap rules. ``init`` carries what is plain, and names the rest.
"""

from __future__ import annotations

import ast
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.fleet.proposal.launch_text import (
    UNKNOWN,
    Reading,
    argument,
    launch_text,
    word_of,
)
from multibot_rewrite.fleet.proposal.searching import text_of
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.knowledge.stacks import load_stack
from multibot_rewrite.producers.launch.programs import programs
from multibot_rewrite.system.tool_nodes import is_viewer

# What a build gives each node anyway, or what is of one machine.
_USUAL = frozenset(("use_sim_time", "autostart", "node_names", "frame_prefix"))
# The node and its parameter that an included file gives the value of its argument of this name.
_MAP = {"map": ("map_server", "yaml_filename")}
_DESCRIPTION = "robot_description"
# A fleet has them, whatever its stacks.
_IN_EVERY_FLEET = frozenset(
    (
        "robot_state_publisher",
        "joint_state_publisher",
        "joint_state_publisher_gui",
        "controller_manager",
        "rclcpp_components",
        "nav2_lifecycle_manager",
    )
)
# Letters of a value that is shown.
_LONGEST = 80
# What the values of launch files are called where they are refused.
VALUES = "values of launch files"
_USUAL_TOPICS = frozenset(("tf", "tf_static", "robot_description"))


class Launched(NamedTuple):
    """What launch files give: values of parameters by node, which are the same in all of them, and what
    else there is, by file and line; ``started`` are the nodes that the fleet does not start."""

    values: Mapping[str, Mapping[str, Any]] = {}
    rest: tuple[tuple[str, int, str], ...] = ()
    started: tuple[tuple[str, int, str], ...] = ()


class _Given(NamedTuple):
    """What one launch file gives one node: ``node`` is its name in the fleet, empty for one of another
    name."""

    file: str
    line: int
    who: str
    node: str
    values: Mapping[str, Any]
    rules: tuple[str, ...]


def readings(launch: Iterable[str], description: str, every: Sequence[str]) -> list[Reading]:
    """The launch files, but for those of other descriptions, each with the arguments that others
    include it with."""
    others = {os.path.basename(it) for it in every} - {os.path.basename(description)}
    own = (
        it
        for it in launch
        if os.path.basename(description) in text_of(it)
        or not any(other in text_of(it) for other in others)
    )
    texts = [launch_text(it) for it in own]
    given: dict[str, dict[str, Any]] = {}
    for text in texts:
        for _, target, arguments in _included(Reading(text, {})):
            known = given.setdefault(os.path.normpath(target), {})
            for name, value in arguments.items():
                known[name] = value if known.get(name, value) == value else UNKNOWN
    return [Reading(it, given.get(os.path.normpath(it.file), {})) for it in texts]


def files_given(read: Iterable[Reading]) -> dict[str, set[str]]:
    """The files that nodes or included launch files get as parameters, each with the packages of these
    nodes, of which an included file tells none."""
    found: dict[str, set[str]] = {}
    for path, package in (one for it in read for one in _files(it)):
        found.setdefault(os.path.normpath(path), set()).add(package)
    return found


def _files(it: Reading) -> Iterator[tuple[str, str]]:
    for _, _, arguments in _included(it):
        texts = (value for value in arguments.values() if isinstance(value, str))
        yield from ((value, "") for value in texts if value)
    for call in it.text.nodes:
        paths = map(it.path, _elements(argument(call, "parameters")))
        yield from ((path, word_of(argument(call, "package"))) for path in paths if path)


def _included(it: Reading) -> Iterator[tuple[int, str, dict[str, Any]]]:
    """The line and path of each file that is included, and its arguments."""
    for call in it.text.includes:
        target = it.path(argument(call, "launch_description_source", 0))
        pairs = _pairs(argument(call, "launch_arguments", 1))
        values = ((word_of(key), it.path(value) or it.value(value)) for key, value in pairs)
        yield call.lineno, target, {name: value for name, value in values if name}


def _pairs(it: ast.expr | None) -> Iterator[tuple[ast.expr | None, ast.expr]]:
    """The arguments of an include: ``{...}.items()``, or pairs."""
    if isinstance(it, ast.Call) and isinstance(it.func, ast.Attribute) and it.func.attr == "items":
        it = it.func.value
    if isinstance(it, ast.Dict):
        yield from zip(it.keys, it.values, strict=True)
    for each in _elements(it):
        if isinstance(each, ast.Tuple) and len(each.elts) == 2:
            yield each.elts[0], each.elts[1]


def _elements(it: ast.expr | None) -> Sequence[ast.expr]:
    return it.elts if isinstance(it, ast.List | ast.Tuple) else ()


def given_by_launch(
    read: Sequence[Reading], stacks: Iterable[str], release: str, carried: bool = True
) -> Launched:
    """What launch files give to the nodes of these stacks; nothing is ``carried`` where that does not
    build."""
    nodes = [node for stack in stacks for node in load_stack(stack, release)]
    every = [given for it in read for given in _given(it, nodes)]
    said: dict[tuple[str, str], list[Any]] = {}
    for given in every:
        for name, value in given.values.items():
            said.setdefault((given.node, name), []).append(_data(value))
    values: dict[str, dict[str, Any]] = {}
    for (node, name), its in said.items():
        if carried and node and its[0] is not UNKNOWN and all(it == its[0] for it in its):
            values.setdefault(node, {})[name] = its[0]
    return Launched(values, tuple(_rest(every, values)))


def _fact(nodes: Iterable[NodeFacts], who: str, program: str) -> NodeFacts | None:
    return next((one for one in nodes if {who, program} & _called(one)), None)


def _rest(
    every: Iterable[_Given], values: Mapping[str, Mapping[str, Any]]
) -> Iterator[tuple[str, int, str]]:
    for it in every:
        own = values.get(it.node, {})
        left = [_shown(name, value) for name, value in it.values.items() if name not in own]
        if left or it.rules:
            yield it.file, it.line, f"{it.who}: {', '.join((*left, *it.rules))}"


def _shown(name: str, value: Any) -> str:
    plain = isinstance(value, bool | int | float | str) and len(f"{value}") <= _LONGEST
    return f"{name}: {value}" if plain else name


def _given(it: Reading, nodes: Sequence[NodeFacts]) -> Iterator[_Given]:
    known = {os.path.basename(one.name) for one in nodes}
    for line, _, arguments in _included(it):
        for name, (server, parameter) in _MAP.items():
            if server in known and arguments.get(name):
                values = {parameter: arguments[name]}
                yield _Given(it.text.file, line, server, "", values, ())
    for call in it.text.nodes:
        program = word_of(argument(call, "executable"))
        who = word_of(argument(call, "name")) or program
        node = _fact(nodes, who, program)
        if node is None:
            continue
        values = dict(_parameters(it, call))
        own = os.path.basename(node.name)
        named = argument(call, "name") is None or who == own
        rules = tuple(_rules(argument(call, "remappings")))
        yield _Given(it.text.file, call.lineno, who, own if named else "", values, rules)


def started_elsewhere(
    read: Iterable[Reading], stacks: Iterable[str], release: str
) -> tuple[tuple[str, int, str], ...]:
    """Return the nodes that launch files start and a fleet of these stacks does not, each once at its
    first place, with its rules; without programs that are in every fleet, or are none of a robot."""
    known = {
        name for stack in stacks for node in load_stack(stack, release) for name in _called(node)
    }
    found: dict[str, tuple[str, int, str]] = {}
    for file, call in ((it.text.file, call) for it in read for call in it.text.nodes):
        package, program = (word_of(argument(call, key)) for key in ("package", "executable"))
        program = program or word_of(argument(call, "plugin"))
        name = word_of(argument(call, "name"))
        if program and not known & {name, program} and not _is_usual(package, program):
            who = f"{name} ({package} {program})" if name else f"{program} ({package})"
            rules = ", ".join(_rules(argument(call, "remappings")))
            text = f"{who}: {rules}" if rules else who
            found.setdefault(text, (file, call.lineno, text))
    return tuple(found.values())


def _is_usual(package: str, program: str) -> bool:
    """Is it in every fleet, does it only look, or is it of a simulator or a tool of ros2_control?"""
    ways = programs()
    passes = f"{package}/{program}" in ways.passing or package in ways.simulators
    return passes or package in _IN_EVERY_FLEET or is_viewer(program)


def _called(node: NodeFacts) -> frozenset[str]:
    return frozenset((os.path.basename(node.name), *map(os.path.basename, node.programs)))


def _parameters(it: Reading, call: ast.Call) -> Iterator[tuple[str, Any]]:
    for each in _elements(argument(call, "parameters")):
        assigned = it.text.assigned.get(each.id) if isinstance(each, ast.Name) else each
        if isinstance(assigned, ast.Dict):
            for key, value in zip(assigned.keys, assigned.values, strict=True):
                name = word_of(key)
                if name and name not in _USUAL and not name.startswith(_DESCRIPTION):
                    yield name, it.value(value)


def _data(value: Any) -> Any:
    """A value as a parameter can have it; a path is another's where this file is read."""
    if isinstance(value, list):
        return UNKNOWN if UNKNOWN in map(_data, value) else value
    is_path = isinstance(value, str) and os.path.exists(value) and os.sep in value
    return value if isinstance(value, bool | int | float | str) and not is_path else UNKNOWN


def _rules(it: ast.expr | None) -> Iterator[str]:
    for each in _elements(it):
        words = [word_of(one) for one in each.elts] if isinstance(each, ast.Tuple) else []
        yield from (f"{a}:={b}" for a, b in pairwise(words) if a and b and _is_moved(a))


def _is_moved(topic: str) -> bool:
    return topic.rpartition("/")[2] not in _USUAL_TOPICS
