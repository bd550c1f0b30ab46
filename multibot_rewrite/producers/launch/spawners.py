# SPDX-License-Identifier: Apache-2.0
"""The words of programs as rcl reads them; those of spawners -> controllers and parameters.

Source: ros2_control jazzy and humble, controller_manager/spawner.py (``--controller NAME ...`` has
options of its own; the name of a manager is relative to the spawner's namespace, which it gets by
``--namespace`` or as a node).

Source: rcl arguments.c (what is between ``--ros-args`` and ``--`` is ROS's own)."""

import argparse
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple, NoReturn

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding, declare
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.rosnames import expand
from multibot_rewrite.planning.start import AS_USUAL, Process
from multibot_rewrite.producers.launch.records import LaunchedNode, LaunchNote, ParameterText
from multibot_rewrite.system.records import Place

_RULE, _VALUE, _FILE = ("-r", "--remap"), ("-p", "--param"), "--params-file"


class RosArguments(NamedTuple):
    """Name, namespace, remap rules, parameter values and files, and the words that are not ROS's."""

    name: str
    namespace: str
    rules: tuple[tuple[str, str], ...]
    values: tuple[tuple[str, str], ...]
    files: tuple[str, ...]
    own: tuple[str, ...]


def ros_arguments(words: Sequence[str]) -> RosArguments:
    """Return the names, rules and parameters that rcl reads in a program's arguments."""
    own: list[str] = []
    given: list[str] = []
    inside = False
    for word in words:
        if word in ("--ros-args", "--"):
            inside = word == "--ros-args"
        else:
            (given if inside else own).append(word)
    flags = list(pairwise(given))
    rules = [_split_rule(text) for flag, text in flags if flag in _RULE and ":=" in text]
    named = dict(rules)
    return RosArguments(
        named.get("__node", named.get("__name", "")),
        named.get("__ns", ""),
        tuple(it for it in rules if not it[0].startswith("__")),
        tuple(_split_rule(text) for flag, text in flags if flag in _VALUE and ":=" in text),
        tuple(text for flag, text in flags if flag == _FILE),
        tuple(own),
    )


def ros2_run(words: Sequence[str]) -> tuple[str, str, tuple[str, ...]] | None:
    """Return package, executable and further words of a ``ros2 run`` line; None for another line."""
    if [it.rpartition("/")[2] for it in words[:2]] != ["ros2", "run"]:
        return None
    after = list(words[2:])
    while after and after[0].startswith("-"):
        # --prefix is the one option with a value.
        after = after[2:] if after[0] == "--prefix" else after[1:]
    return (after[0], after[1], tuple(after[2:])) if len(after) > 1 else None


def _split_rule(text: str) -> tuple[str, str]:
    old, _, new = text.partition(":=")
    return old, new


def params_text(values: Iterable[tuple[str, str]]) -> str:
    """Return a parameter file for any node with these values, each as YAML has it."""
    lines = "".join(f"    {name}: {value}\n" for name, value in values)
    return f"/**:\n  ros__parameters:\n{lines}" if lines else ""


NO_MANAGER = declare("MG723", "no-controller-manager", ERROR, formats=("fleet",))
SPAWNER = "controller_manager/spawner"
_ONE = "--controller"
_TIMES = ("--controller-manager-timeout", "--switch-timeout", "--service-call-timeout")


class Spawned(NamedTuple):
    """A controller that a spawner loads into ``manager`` (a full name).

    Its ``type`` is as the spawner says it. ``later`` says what starts the spawner if not the launch
    itself, ``place`` where the launch file has it, ``number`` and ``process`` which it is and how
    it runs, ``words`` are its further words."""

    name: str
    manager: str
    type: str
    parameters: tuple[ParameterText, ...]
    rules: tuple[tuple[str, str], ...]
    later: str
    place: Place
    inactive: bool = False
    number: int = -1
    process: Process = AS_USUAL
    words: tuple[str, ...] = ()

    @property
    def full_name(self) -> str:
        """The controller's full name, in the namespace of its manager."""
        return f"{self.manager.rpartition('/')[0]}/{self.name}"


class _Parser(argparse.ArgumentParser):
    """One that raises ValueError where argparse would end the program."""

    def error(self, message: str) -> NoReturn:
        """Raise ValueError."""
        raise ValueError(message)


def is_spawner(node: LaunchedNode) -> bool:
    """Return whether a node loads controllers and ends."""
    return _is_spawner_program(f"{node.package}/{node.executable}")


def _is_spawner_program(program: str) -> bool:
    return program.removesuffix(".py") == SPAWNER


def spawned_in(nodes: Iterable[LaunchedNode]) -> tuple[tuple[Spawned, ...], tuple[LaunchNote, ...]]:
    """Return the controllers that these spawners load, and notes on wrong arguments of spawners."""
    found: list[Spawned] = []
    notes: list[LaunchNote] = []
    for number, node in enumerate(nodes):
        try:
            own = _controllers_of(node) if is_spawner(node) else ()
            found += (it._replace(number=number, process=node.process) for it in own)
        except ValueError as error:
            notes.append(LaunchNote(node.place, f"the arguments of a spawner are wrong: {error}"))
    return tuple(found), tuple(notes)


def active(spawned: Mapping[str, Spawned]) -> set[str]:
    """Return the controllers that are active as soon as all is started, whatever happens."""
    return {name for name, it in spawned.items() if not (it.inactive or it.later)}


def controller_files(program: str, words: Sequence[str]) -> tuple[str, ...]:
    """Return controllers' parameter files in a program's arguments; empty if it is no spawner."""
    if not _is_spawner_program(program):
        return ()
    try:
        every = [it.param_file for it in _options_of_each(words)]
    except ValueError:
        return ()
    return tuple(dict.fromkeys(file for files in every for file in files))


def texts_of(
    spawned: Iterable[Spawned], given: Mapping[str, Sequence[ParameterText]]
) -> Iterator[tuple[str, list[ParameterText]]]:
    """Yield each manager by its full name, with all parameters that decide its controllers.

    They are what it gets itself (``given``), the spawners' files, and the types that they give."""
    by_manager = lists_by_key((it.manager, it) for it in spawned)
    for manager, controllers in by_manager.items():
        named = (text for it in controllers for text in it.parameters)
        # Each as a parameter file would have it: a section of its own, its type if said.
        said = []
        for it in controllers:
            typed = f"{manager}:\n  ros__parameters: {{{it.name}.type: {it.type}}}\n"
            section = f"{it.full_name}:\n  ros__parameters: {{}}\n"
            said.append(ParameterText("", f"{typed}{section}" if it.type else section))
        yield manager, list(dict.fromkeys((*said, *given.get(manager, ()), *named)))


def _controllers_of(node: LaunchedNode) -> Iterator[Spawned]:
    for given in _options_of_each(node.arguments):
        words = [word for text in given.controller_ros_args for word in text.split()]
        above = given.namespace or node.namespace
        manager = expand(given.controller_manager, above, SPAWNER.rpartition("/")[2])
        rules = ros_arguments(["--ros-args", *words]).rules
        own = (node.parameters, rules, node.later, node.place)
        inactive = given.inactive or given.stopped or given.load_only
        for name in given.controller_names:
            made = Spawned(name, manager, given.controller_type, *own, inactive)
            yield made._replace(words=tuple(_further(given)))


def _options_of_each(words: Sequence[str]) -> Iterator[argparse.Namespace]:
    """Yield the options of each controller; raises ValueError for words that the spawner refuses."""
    if _ONE not in words:
        yield _parser(names="+").parse_args(list(words))
        return
    starts = [at for at, word in enumerate(words) if word == _ONE]
    top = _parser(names="*").parse_args(list(words[: starts[0]]))
    for at, end in zip(starts, (*starts[1:], len(words)), strict=True):
        one = _parser(names="+").parse_args(list(words[at + 1 : end]))
        one.controller_manager, one.namespace = top.controller_manager, top.namespace
        yield one


def _further(given: argparse.Namespace) -> Iterator[str]:
    """Yield the options by which a controller is loaded, without ``--inactive``."""
    for flag in _TIMES:
        if value := getattr(given, flag[2:].replace("-", "_"), None):
            yield from (flag, value)
    for flag in ("--load-only", "--activate-as-group", "--unload-on-kill", "--switch-asap"):
        if getattr(given, flag[2:].replace("-", "_"), False):
            yield flag


def _parser(names: str) -> _Parser:
    parser = _Parser(add_help=False, allow_abbrev=True)
    parser.add_argument("controller_names", nargs=names)
    parser.add_argument("-c", "--controller-manager", default="controller_manager")
    parser.add_argument("-p", "--param-file", action="append", default=[])
    parser.add_argument("-n", "--namespace", default="")
    parser.add_argument("-t", "--controller-type", default="")
    parser.add_argument("--controller-ros-args", action="append", default=[])
    for flag in ("--load-only", "--inactive", "--stopped", "--activate-as-group"):
        parser.add_argument(flag, action="store_true")
    parser.add_argument("-u", "--unload-on-kill", action="store_true")
    parser.add_argument("--switch-asap", action=argparse.BooleanOptionalAction)
    for value in _TIMES:
        parser.add_argument(value)
    return parser


def under_managers(
    spawned: Iterable[Spawned], started: Collection[str]
) -> tuple[list[Spawned], list[Finding]]:
    """Return the controllers under the one manager that is started, and findings about others."""
    meant = next(iter(started)) if len(started) == 1 else ""
    every = tuple(spawned)
    lost = [it for it in every if meant and it.manager not in started]
    found = [it._replace(manager=meant) if it in lost else it for it in every]
    # One finding a spawner.
    spawners = lists_by_key(((it.place.file, it.place.line, it.manager), it.name) for it in lost)
    findings = []
    for (file, line, manager), names in spawners.items():
        message = f"the spawner of {', '.join(names)} asks for {manager}, which nothing starts"
        hint = f"{meant} is started; give the namespace once; the plan has them there"
        where = {"file": file, "line": line, "column": 1}
        findings.append(NO_MANAGER.finding(message, hint, level=WARNING, **where))
    return found, findings
