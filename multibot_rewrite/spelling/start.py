# SPDX-License-Identifier: Apache-2.0
"""What is started, in one record: launch files, actions, lines for a shell and their checks are made of
it."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple, TypeAlias

from multibot_rewrite.knowledge.programs import Program
from multibot_rewrite.spelling.records import Rules
from multibot_rewrite.spelling.ways import (
    COMPONENT,
    SPAWN,
    Started,
    ros_arguments,
    spawner_arguments,
)

# These need no ``ros2 run``.
_COMMANDS = {("rviz2", "rviz2"): ("rviz2",)}


class File(NamedTuple):
    """The path of a file of the build."""

    path: str


class Text(NamedTuple):
    """What a file of the build holds."""

    path: str


# A file of parameters, or their values.
Parameters: TypeAlias = File | Mapping[str, Any]
NOTHING: Mapping[str, str] = {}


class Start(NamedTuple):
    """A process: its program, its node's name and namespace (empty for those of its code), and what it
    is given.

    ``components`` are loaded into it: each has its class as ``plugin`` and no ``executable``.
    ``brought_up`` is true if its node has a life cycle that nobody else configures and activates.
    It starts if the launch argument ``condition`` is true and the package ``needs`` is installed,
    where these are not empty. ``environment`` is what is set for it.
    """

    package: str
    executable: str
    namespace: str = ""
    name: str = ""
    parameters: tuple[Parameters, ...] = ()
    remappings: Rules = ()
    arguments: tuple[str | File, ...] = ()
    components: tuple[Start, ...] = ()
    brought_up: bool = False
    plugin: str = ""
    condition: str = ""
    needs: str = ""
    environment: Mapping[str, str] = NOTHING

    @property
    def full_name(self) -> str:
        """The full name of its node; without a name the namespace."""
        return f"{self.namespace.rstrip('/')}/{self.name}"

    @property
    def every(self) -> Iterator[Start]:
        """The process and the components in it."""
        yield from (self, *self.components)

    @property
    def words(self) -> list[str]:
        """What follows its program on a command line; values of parameters are texts there."""
        rules = ros_arguments(self.namespace or "/", self.name, self.remappings)
        told = [word for it in self.parameters for word in _parameter_words(it)]
        lead = ["--ros-args"] if told and not rules else []
        return [*(path_of(it) for it in self.arguments), *rules, *lead, *told]


def start_of(it: Started, program: Program, parameters: tuple[Parameters, ...] = ()) -> Start:
    """Return what runs a node: a process of its program, or its class in the process of another."""
    is_component = it.way == COMPONENT
    return Start(
        program.package,
        "" if is_component else program.executable,
        it.node.namespace,
        it.node.name,
        parameters,
        it.rules,
        () if is_component else program.words,
        plugin=program.plugin if is_component else "",
    )


def spawner_of(it: Started, *words: str | File) -> Start:
    """Return the spawner of a controller, with further ``words``."""
    return Start(*SPAWN, it.node.namespace, arguments=(*spawner_arguments(it), *words))


def shell_line(it: Start) -> str:
    """Return the line that starts a process without components."""
    program = _COMMANDS.get((it.package, it.executable))
    environment = (f"{name}={value}" for name, value in it.environment.items())
    run = program or ("ros2", "run", it.package, it.executable)
    return shlex.join([*environment, *run, *it.words])


def keywords(it: Start) -> dict[str, Any]:
    """Return the keywords of launch_ros's Node, of ComposableNode for a component."""
    given = {
        "package": it.package,
        "executable": it.executable,
        "plugin": it.plugin,
        "namespace": it.namespace,
        "name": it.name,
        "parameters": list(it.parameters),
        "remappings": list(it.remappings),
        "arguments": list(it.arguments),
        "composable_node_descriptions": [keywords(one) for one in it.components],
        "additional_env": it.environment,
    }
    return {name: one for name, one in given.items() if one}


def path_of(it: str | File) -> str:
    """Return a word of a program, for a file its path."""
    return it.path if isinstance(it, File) else it


def _parameter_words(it: Parameters) -> Iterator[str]:
    if isinstance(it, File):
        yield from ("--params-file", it.path)
        return
    for pair in it.items():
        yield from ("-p", ":=".join(pair))
