# SPDX-License-Identifier: Apache-2.0
"""What a launch file itself gives a process, as parameter files have it; a build gives it the same."""

import os
import re
import shlex
from collections.abc import Callable, Collection, Mapping
from functools import lru_cache
from typing import Any, NamedTuple

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.rosnames import expand
from multibot_rewrite.planning.start import AS_USUAL, Process
from multibot_rewrite.producers.evidence.parameter_files import values_for
from multibot_rewrite.producers.launch.records import LaunchedNode, ParameterText
from multibot_rewrite.related_files.names.placeholders import filled
from multibot_rewrite.related_files.params.sections import raw_sections
from multibot_rewrite.related_files.yaml_text import YamlText, read_yaml
from multibot_rewrite.system.records import NOWHERE, Place

# The name of a file for what a launch file gives itself.
OWN = "parameters of a launch file"


@lru_cache(maxsize=64)
def has_sections(it: ParameterText) -> bool:
    """Return whether a text is a parameter file with sections of nodes."""
    try:
        return any(True for _ in raw_sections(document_of(it.file, it.text)))
    except InputError:
        return False


@lru_cache(maxsize=64)
def document_of(file: str, text: str) -> YamlText:
    """Return a parameter file, or without ``file`` what a launch file sets; raises InputError."""
    return read_yaml(text.encode(), file or OWN)


# Whoever starts the node decides it.
_CLOCK = "use_sim_time"
DESCRIPTION, SEMANTIC = "robot_description", "robot_description_semantic"
# What stands for the robot, as in parameter files of vendors.
_ROBOT = "<robot>"
_FOLDER = re.compile(r"\$\(find-pkg-\w+ ([\w-]+)\)")
# They run the program that follows.
_RUNNERS = frozenset(("sudo", "env", "nice", "bash", "sh", "python3", "python", "xterm", "exec"))


class HandedOn(NamedTuple):
    """What a launch file gives a node: parameters of no file, arguments, environment, rules.

    ``texts`` are the descriptions among its parameters. ``is_unnamed`` is true if only its code has
    its name. ``files`` are its parameter files, ``clock`` is its ``use_sim_time``, if it is said.
    ``number`` is its place in the launch, ``program`` are its package and program or class,
    ``kind`` is what it is known as. ``description`` is that of something else than the robot, which
    it publishes."""

    values: Mapping[str, Any]
    arguments: tuple[str, ...] = ()
    environment: Mapping[str, str] = {}
    process: Process = AS_USUAL
    texts: tuple[str, ...] = ()
    is_unnamed: bool = False
    rules: tuple[tuple[str, str], ...] = ()
    number: int = -1
    place: Place = NOWHERE
    program: tuple[str, str] = ("", "")
    kind: str = ""
    files: tuple[str, ...] = ()
    clock: bool | None = None
    description: str = ""

    @property
    def names(self) -> list[str]:
        """The names of parameters, arguments and variables, for a message."""
        return [*self.values, *self.texts, *self.arguments, *self.environment]


class Passing(NamedTuple):
    """A process that is no node of a robot: what it is called, and if it runs once for all robots."""

    node: LaunchedNode
    name: str
    once: bool


def handed_on(
    node: LaunchedNode, name: str, of_all: Collection[tuple[str, str]] = (), number: int = -1
) -> HandedOn:
    """Return what a launch file gives a node of this name, without the files that outlast it.

    These are rewritten, and what they set later counts. ``of_all`` is the environment of all
    processes."""
    full = expand(name.rpartition("/")[2], node.namespace, "")
    values: dict[str, Any] = {}
    for it in node.parameters:
        told = values_for(full, [document_of(it.file, it.text)]) if has_sections(it) else {}
        values |= {key: one.value for key, one in told.items()}
        values = {key: one for key, one in values.items() if not (it.source and key in told)}
    clock = values.pop(_CLOCK, None)
    described = {key: values.pop(key, None) for key in (DESCRIPTION, SEMANTIC)}
    texts = tuple(key for key, text in described.items() if text is not None)
    own = dict(it for it in node.environment if it not in of_all)
    program = node.package, node.executable
    more = not node.name, node.remappings, number, node.place, program
    found = HandedOn(values, node.arguments, own, node.process, texts, *more)
    files = tuple(dict.fromkeys(it.source for it in node.parameters if it.source))
    found = found._replace(files=files, description=str(described[DESCRIPTION] or ""))
    return found._replace(clock=clock if isinstance(clock, bool) else None)


def for_any(it: Any, robot: str) -> Any:
    """Return values with a placeholder for the name of a robot."""
    word = re.compile(rf"(?<![A-Za-z0-9]){re.escape(robot)}(?![A-Za-z0-9])")
    return _each(it, lambda text: word.sub(_ROBOT, text))


def for_robot(it: Any, robot: str) -> Any:
    """Return values with a robot's name in place of the placeholder."""
    return _each(it, lambda text: filled(text, robot))


def process_name(it: LaunchedNode) -> str:
    """Return what a process is called that is no node: by its launch file, program or script."""
    try:
        words = [it.executable, *it.arguments] if it.package else shlex.split(it.executable)
    except ValueError:
        words = it.executable.split()
    more = "" if it.package else _FOLDER.sub(r"\1", " ".join(it.arguments))
    words = [*words, *more.split()]
    own = (os.path.basename(word) for word in words if word[:1] != "-")
    return next((name for name in own if name not in _RUNNERS), os.path.basename(it.executable))


def _each(it: Any, change: Callable[[str], str]) -> Any:
    """Return a value with each text in it changed, but for places."""
    if isinstance(it, Mapping):
        return {key: _each(one, change) for key, one in it.items()}
    if isinstance(it, Place):
        return it
    if hasattr(it, "_fields"):
        return type(it)(*(_each(one, change) for one in it))
    if isinstance(it, list | tuple):
        return type(it)(_each(one, change) for one in it)
    return change(it) if isinstance(it, str) else it
