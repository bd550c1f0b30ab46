# SPDX-License-Identifier: Apache-2.0
"""What launch files themselves give to nodes that a fleet starts: parameters in their text, files of
parameters, and remap rules. ``init`` carries what is plain, and names the rest.

All launch files are read once, behind fences, each with all that it starts with any arguments.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

from multibot_rewrite.base.bounded import load_yaml
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.wording import plural
from multibot_rewrite.fleet.proposal.searching import text_of
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.knowledge.stacks import load_stack
from multibot_rewrite.producers.launch.child import read_launch_files
from multibot_rewrite.producers.launch.programs import programs
from multibot_rewrite.producers.launch.records import LaunchedNode, LaunchGraph, LaunchOrder
from multibot_rewrite.producers.launch.source_packages import NOT_INSTALLED
from multibot_rewrite.system.tool_nodes import is_viewer

# What is not plain.
UNKNOWN = object()
_OF_ALL = "/**"
# For each launch file.
_SECONDS = 10.0
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
    else there is, by file and line; ``started`` are the nodes that the fleet does not start, ``unread``
    is what could not be read."""

    values: Mapping[str, Mapping[str, Any]] = {}
    rest: tuple[tuple[str, int, str], ...] = ()
    started: tuple[tuple[str, int, str], ...] = ()
    unread: tuple[tuple[str, int, str], ...] = ()


class _Given(NamedTuple):
    """What one launch file gives one node: ``node`` is its name in the fleet, empty for one of another
    name."""

    file: str
    line: int
    who: str
    node: str
    values: Mapping[str, Any]
    rules: tuple[str, ...]


class Reading(NamedTuple):
    """A launch file with what it starts and includes, or why it cannot be read."""

    file: str
    graph: LaunchGraph
    why: str = ""


def readings(launch: Sequence[str], description: str, every: Sequence[str]) -> list[Reading]:
    """What the launch files of a description start, as far as it stands in one of them. What stands in
    a file that another one includes is in that one."""
    own = {os.path.realpath(it): it for it in launches_for(launch, description, every)}
    read = [it for it in _read_all(tuple(launch), _times(launch)) if it.file in own.values()]
    within = {
        os.path.realpath(node.place.file)
        for it in read
        for node in it.graph.nodes
        if os.path.realpath(node.place.file) != os.path.realpath(it.file)
    }
    return [
        it._replace(graph=_of_files(it.graph, own))
        for it in read
        if os.path.realpath(it.file) not in within
    ]


def launches_for(launch: Iterable[str], description: str, every: Sequence[str]) -> list[str]:
    """The launch files, but for those of other descriptions."""
    others = {os.path.basename(it) for it in every} - {os.path.basename(description)}
    return [
        it
        for it in launch
        if os.path.basename(description) in text_of(it)
        or not any(other in text_of(it) for other in others)
    ]


@lru_cache(maxsize=4)
def _read_all(launch: tuple[str, ...], times: tuple[object, ...]) -> list[Reading]:
    """Read launch files in one process; ``times`` tell their changes."""
    if not launch:
        return []
    # What others name is read with them.
    named = {one for one in launch if any(_names(it, one) for it in launch)}
    launch = tuple(sorted(launch, key=lambda it: it in named))
    read = read_launch_files([LaunchOrder(it, every=True) for it in launch], _SECONDS)
    return [
        Reading(file, LaunchGraph(), _without(f"{it}", file))
        if isinstance(it, InputError)
        else Reading(file, it)
        for file, it in zip(launch, read, strict=True)
    ]


def _names(launch: str, other: str) -> bool:
    return launch != other and os.path.basename(other) in text_of(launch)


def _without(message: str, file: str) -> str:
    return message.removeprefix(f"{file}: the launch file cannot be read: ")


def _times(launch: Sequence[str]) -> tuple[object, ...]:
    return tuple(_time(it) for it in launch)


def _time(file: str) -> tuple[int, int]:
    try:
        found = os.stat(file)
    except OSError:  # whoever reads it says so
        return 0, 0
    return found.st_mtime_ns, found.st_size


def _of_files(graph: LaunchGraph, own: Mapping[str, str]) -> LaunchGraph:
    """What stands in these files, by their real paths, each at its path there."""

    def kept(rows: Iterable[Any]) -> tuple[Any, ...]:
        files = ((it, own.get(os.path.realpath(it.place.file))) for it in rows)
        return tuple(it._replace(place=it.place._replace(file=file)) for it, file in files if file)

    return graph._replace(
        nodes=kept(graph.nodes), notes=kept(graph.notes), includes=kept(graph.includes)
    )


def files_given(read: Iterable[Reading], paths: Iterable[str]) -> dict[str, set[str]]:
    """Those of some files that nodes or included launch files get as parameters, each with the packages
    of these nodes, of which an included file tells none."""
    found: dict[str, set[str]] = {}
    for path, package in (one for it in read for one in _files(it.graph)):
        found.setdefault(path, set()).add(package)
    real = {it: os.path.realpath(it) for it in paths}
    return {it: found[path] for it, path in real.items() if path in found}


def _files(it: LaunchGraph) -> Iterator[tuple[str, str]]:
    yield from ((value, "") for one in it.includes for _, value in one.arguments if value)
    for node in it.nodes:
        yield from ((given.source, node.package) for given in node.parameters if given.source)


def given_by_launch(
    read: Sequence[Reading], stacks: Iterable[str], release: str, carried: bool = True
) -> Launched:
    """What launch files give to the nodes of these stacks; nothing is ``carried`` where that does not
    build."""
    nodes = [node for stack in stacks for node in load_stack(stack, release)]
    every = [given for it in read for given in _given(it.graph, nodes)]
    said: dict[tuple[str, str], list[Any]] = {}
    for given in every:
        for name, value in given.values.items():
            said.setdefault((given.node, name), []).append(_data(value))
    values: dict[str, dict[str, Any]] = {}
    for (node, name), its in said.items():
        if carried and node and its[0] is not UNKNOWN and all(it == its[0] for it in its):
            values.setdefault(node, {})[name] = its[0]
    return Launched(values, tuple(dict.fromkeys(_rest(every, values))))


def not_read(read: Iterable[Reading]) -> Iterator[tuple[str, int, str]]:
    """Yield what of each launch file could not be read: the first of it."""
    for it in read:
        notes = [one for one in it.graph.notes if not (one.parameters or one.missing)]
        if it.why:
            yield it.file, 1, it.why
        elif notes:
            more = f" (and {len(notes) - 1} more)" if notes[1:] else ""
            yield notes[0].place.file, notes[0].place.line, f"{notes[0].message}{more}"


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
    if isinstance(value, str) and os.path.isabs(value) and os.path.exists(value):
        value = os.path.relpath(value)
    plain = isinstance(value, bool | int | float | str) and 0 < len(f"{value}") <= _LONGEST
    return f"{name}: {value}" if plain else name


def _given(it: LaunchGraph, nodes: Sequence[NodeFacts]) -> Iterator[_Given]:
    known = {os.path.basename(one.name) for one in nodes}
    for include in it.includes:
        arguments = dict(include.arguments)
        for name, (server, parameter) in _MAP.items():
            if server in known and arguments.get(name):
                values = {parameter: arguments[name]}
                yield _Given(*include.place[:2], server, "", values, ())
    for one in it.nodes:
        who = one.name or one.executable
        node = _fact(nodes, who, one.executable)
        if node is None:
            continue
        own = os.path.basename(node.name)
        named = own if who in (own, one.executable) else ""
        text, every = text_of(one.place.file), dict(_parameters(one))
        values = {name: every[name] for name in every if all(it in text for it in name.split("."))}
        left = len(every) - len(values)
        more = (f"{plural(left, 'value')} of files that it reads",) if left else ()
        yield _Given(*one.place[:2], who, named, values, (*_rules(one), *more))


def started_elsewhere(
    read: Iterable[Reading], stacks: Iterable[str], release: str
) -> tuple[tuple[str, int, str], ...]:
    """Return the nodes that launch files start and a fleet of these stacks does not, each once at its
    first place, with its rules; without programs that are in every fleet, or are none of a robot."""
    known = {
        name for stack in stacks for node in load_stack(stack, release) for name in _called(node)
    }
    found: dict[str, tuple[str, int, str]] = {}
    for it in (node for one in read for node in one.graph.nodes):
        package, program, name = it[:3]
        if program and not known & {name, program} and not _is_usual(package, program):
            who = f"{name} ({package} {program})" if name else f"{program} ({package})"
            rules = ", ".join(_rules(it))
            text = f"{who}: {rules}" if rules else who
            found.setdefault(text, (*it.place[:2], text))
    return tuple(found.values())


def _is_usual(package: str, program: str) -> bool:
    """Is it in every fleet, does it only look, or is it of a simulator or a tool of ros2_control?"""
    ways = programs()
    passes = f"{package}/{program}" in ways.passing or package in ways.simulators
    return passes or package in _IN_EVERY_FLEET or is_viewer(program)


def _called(node: NodeFacts) -> frozenset[str]:
    return frozenset((os.path.basename(node.name), *map(os.path.basename, node.programs)))


def _parameters(it: LaunchedNode) -> Iterator[tuple[str, Any]]:
    """The values that the launch file itself gives, UNKNOWN for those that only a run tells."""
    for given in (one for one in it.parameters if not (one.file or one.source)):
        sections = load_yaml(given.text, it.place.file)
        # A file that the launch makes may have any.
        own = sections.get(_OF_ALL) if isinstance(sections, dict) else None
        for name, value in ((own or {}).get("ros__parameters") or {}).items():
            if name not in _USUAL and not name.startswith(_DESCRIPTION):
                yield name, value
        if given.untold:
            yield given.untold, UNKNOWN


def _data(value: Any) -> Any:
    """A value as a parameter can have it; a path is another's where this file is read, an empty text
    may be the output of a program that is not started."""
    if value == "":
        return UNKNOWN
    if isinstance(value, list):
        return UNKNOWN if UNKNOWN in map(_data, value) else value
    is_path = isinstance(value, str) and os.sep in value and _is_of_machine(value)
    return value if isinstance(value, bool | int | float | str) and not is_path else UNKNOWN


def _is_of_machine(path: str) -> bool:
    home = os.path.join(os.path.expanduser("~"), "")
    return os.path.exists(path) or NOT_INSTALLED in path or path.startswith(home)


def _rules(it: LaunchedNode) -> tuple[str, ...]:
    moved = ((a, b) for a, b in it.remappings if a and b and not _is_name(a))
    return tuple(f"{a}:={b}" for a, b in moved if _is_moved(a))


def _is_name(rule: str) -> bool:
    """Does a rule name the node (``__node``)?"""
    return rule.rpartition(":")[2].startswith("__")


def _is_moved(topic: str) -> bool:
    return topic.rpartition("/")[2] not in _USUAL_TOPICS
