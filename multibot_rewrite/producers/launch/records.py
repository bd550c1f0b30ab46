# SPDX-License-Identifier: Apache-2.0
"""What launch files start, as records; how they pass from the process that reads them."""

import json
import os
import shlex
from collections.abc import Iterator, Sequence
from functools import cache
from itertools import takewhile
from typing import Any, NamedTuple, get_args, get_origin, get_type_hints

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.planning.start import AS_USUAL, Process
from multibot_rewrite.producers.launch.source_packages import file_of_package
from multibot_rewrite.system.records import Place

# What starts a node that another program has ended before.
AT_AN_END = ("at an event (OnProcessExit)", "at an event (on_exit)")


class LaunchOrder(NamedTuple):
    """A launch file or system_model.yaml to read, with launch arguments.

    ``roots`` are folders with the sources of packages that are not installed; ``trusted`` lifts the
    fences: a launch file is a program. ``package`` is that of the file where it was named by it.
    ``every`` asks also for what the file starts with other arguments, whatever its conditions say; a
    file that one of those before it includes starts nothing by itself then.
    """

    file: str
    arguments: tuple[tuple[str, str], ...] = ()
    roots: tuple[str, ...] = ()
    trusted: bool = False
    package: str = ""
    every: bool = False

    @property
    def command_line(self) -> list[str]:
        """The ``ros2 launch`` line: nav2_common's ParseMultiRobotPose reads it from sys.argv[4] on."""
        file = [self.package, os.path.basename(self.file)] if self.package else [self.file]
        return ["ros2", "launch", *file, *(f"{name}:={value}" for name, value in self.arguments)]


class ParameterText(NamedTuple):
    """A parameter file that a node gets, or values that a launch file gives it, in YAML.

    ``file`` is empty for values, and for a file that the launch makes. ``source`` is the file
    without the launch: ``file``, or what the launch makes another one of; empty for values.
    ``untold`` is the parameter whose value only a run tells: there is no text of it."""

    file: str
    text: str
    source: str = ""
    untold: str = ""


class LaunchedNode(NamedTuple):
    """A node that a launch file starts.

    ``executable`` is the plugin of a component, ``name`` is empty where the node has its own. What has
    no ``package`` is a command, ``process.is_include`` says that it is a launch file which is not here.
    ``number`` is its place in the launch, where that is asked.
    ``container`` is the full name of the node that a component is loaded into. ``later`` says what
    starts it if not the launch itself. ``place`` is where the launch file has it. ``environment`` is
    what is set for its process.
    """

    package: str
    executable: str
    name: str
    namespace: str
    remappings: tuple[tuple[str, str], ...]
    parameters: tuple[ParameterText, ...]
    container: str
    arguments: tuple[str, ...]
    later: str
    place: Place
    environment: tuple[tuple[str, str], ...] = ()
    process: Process = AS_USUAL
    number: int = -1


class LaunchNote(NamedTuple):
    """Something of a launch file whose nodes are not known, and why.

    With ``parameters`` the node is known, but not what a parameter ``file`` sets for it. ``fails``
    where the launch ends there on every machine. ``missing`` is the package that is not installed
    here, ``unset`` says that a launch configuration has no value."""

    place: Place
    message: str
    parameters: bool = False
    file: str = ""
    fails: bool = False
    missing: str = ""
    unset: bool = False


class UnreadArgument(NamedTuple):
    """An argument that an included ``file`` does not read; ``near`` is a declared one like it."""

    place: Place
    file: str
    name: str
    near: str


class LaunchInclude(NamedTuple):
    """An included launch file (its path from a missing package on), and its arguments."""

    place: Place
    file: str
    arguments: tuple[tuple[str, str], ...]


class IdleAction(NamedTuple):
    """What a condition keeps from starting, and its arguments; ``is_off``: it is kept."""

    place: Place
    what: str
    asked: tuple[tuple[str, str], ...]
    is_off: bool = False

    @property
    def why(self) -> str:
        """Return the values of the arguments that decide its condition."""
        return ", ".join(f"{name}:={value}" for name, value in self.asked) or "its condition"


class LaunchArgument(NamedTuple):
    """An argument that a launch file or an include declares; ``default`` is empty if unknown."""

    name: str
    default: str
    choices: tuple[str, ...]


class FileRead(NamedTuple):
    """A description, SRDF or YAML file that a launch file reads, with its xacro arguments."""

    file: str
    arguments: tuple[tuple[str, str], ...] = ()


class LaunchGraph(NamedTuple):
    """What launch files start.

    ``files`` are the parameter files that plugins in descriptions name, by the path that they have
    there, and descriptions that launch files read. ``stood_in`` is true where launch is not
    installed and its stand-in read them. ``unread`` are arguments without effect, ``environment``
    is what they set for all processes. ``declared`` are the arguments that there are, ``read`` is
    what the launch files themselves read, ``idle`` is what conditions keep out, ``off`` the nodes
    of it that one launch argument turns on. ``robots`` are the names of several that are started:
    the nodes are those of the first, without its name. ``imports`` are Python packages that the
    launch files import and that are not here."""

    nodes: tuple[LaunchedNode, ...] = ()
    notes: tuple[LaunchNote, ...] = ()
    files: tuple[tuple[str, ParameterText], ...] = ()
    stood_in: bool = False
    unread: tuple[UnreadArgument, ...] = ()
    includes: tuple[LaunchInclude, ...] = ()
    environment: tuple[tuple[str, str], ...] = ()
    declared: tuple[LaunchArgument, ...] = ()
    read: tuple[FileRead, ...] = ()
    idle: tuple[IdleAction, ...] = ()
    off: tuple[LaunchedNode, ...] = ()
    robots: tuple[str, ...] = ()
    imports: tuple[str, ...] = ()

    @property
    def whole(self) -> bool:
        """Return whether all nodes of the launch files are known."""
        return all(it.parameters for it in self.notes)

    @property
    def packages(self) -> set[str]:
        """The packages whose nodes are started."""
        return {it.package for it in self.nodes}

    @property
    def texts(self) -> Iterator[str]:
        """The texts that nodes get, and those of files that are read for them."""
        yield from (it.text for _, it in self.files)
        yield from (it.text for node in self.nodes for it in node.parameters)


def launch_order(text: str, roots: Sequence[str] = ()) -> LaunchOrder:
    """Return the order for arguments of ``ros2 launch``; raises UsageError for wrong ones."""
    try:
        words = shlex.split(text)
    except ValueError:
        words = []
    return order_in_words(words, text, roots)


def order_in_words(words: Sequence[str], text: str, roots: Sequence[str] = ()) -> LaunchOrder:
    """Return the order for words that a shell has split; ``text`` stands for them in an error."""
    named = list(takewhile(lambda it: "=" not in it, words))
    if not 0 < len(named) < 3:
        raise UsageError(f"launch {text!r}: write FILE NAME:=VALUE ..., or PACKAGE FILE ...")
    for it in words[len(named) :]:
        if not it.partition(":=")[0] or ":=" not in it:
            raise UsageError(f"launch {named[-1]}: {it!r} is no argument; write NAME:=VALUE")
    arguments = (it.partition(":=") for it in words[len(named) :])
    file, package = named[0], named[0] if len(named) > 1 else ""
    if package:
        file = file_of_package(package, named[1], tuple(roots))
    values = tuple((name, value) for name, _, value in arguments)
    return LaunchOrder(file, values, tuple(roots), package=package)


def orders_in_words(
    words: Sequence[str], text: str, roots: Sequence[str] = ()
) -> list[LaunchOrder]:
    """Return the orders for several launch files, which all get the arguments."""
    named = list(takewhile(lambda it: "=" not in it, words))
    if len(named) < 2 or not all(map(os.path.isfile, named)):
        return [order_in_words(words, text, roots)]
    rest = list(words[len(named) :])
    return [order_in_words([it, *rest], text, roots) for it in named]


def joined(graphs: Sequence[LaunchGraph]) -> LaunchGraph:
    """Return what several launch files start, as one."""
    listed = (name for name, it in LaunchGraph._field_defaults.items() if it == ())
    every = {name: tuple(one for it in graphs for one in getattr(it, name)) for name in listed}
    every["environment"] = tuple(dict.fromkeys(every["environment"]))
    every |= {it: tuple(_joined_nodes(graphs, it)) for it in ("nodes", "off")}
    return LaunchGraph(**every, stood_in=any(it.stood_in for it in graphs))


def _joined_nodes(graphs: Sequence[LaunchGraph], field: str) -> Iterator[LaunchedNode]:
    """Yield the nodes of all graphs, renumbered so that each waits for the right one."""
    first = 0
    for graph in graphs:
        for it in getattr(graph, field):
            after = it.process.after
            moved = it.process._replace(after=after + first) if after >= 0 else it.process
            yield it._replace(process=moved)
        first += len(graph.nodes)


def orders_of(text: str) -> tuple[float, list[LaunchOrder]]:
    """Return the seconds for each of some orders, and these, from JSON."""
    seconds, orders = json.loads(text)
    return seconds, [_read(LaunchOrder, it) for it in orders]


def graph_of(values: Any) -> LaunchGraph:
    """Return the graph from JSON; raises what an unexpected value does."""
    graph: LaunchGraph = _read(LaunchGraph, values)
    return graph


def _read(kind: Any, value: Any) -> Any:
    """Return a value of JSON as its type: records and pairs are lists there."""
    if hasattr(kind, "_fields"):
        types = _hints(kind).values()
        return kind(*(_read(*it) for it in zip(types, value, strict=True)))
    if get_origin(kind) is not tuple:
        return value
    inner = get_args(kind)
    each = inner if ... not in inner else inner[:1] * len(value)
    return tuple(_read(*it) for it in zip(each, value, strict=True))


# Asked for each record that is read.
_hints = cache(get_type_hints)
