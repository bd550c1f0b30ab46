# SPDX-License-Identifier: Apache-2.0
"""What is started, as a record: launch files, actions, lines for a shell and checks are made of it."""

import re
import shlex
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple, TypeAlias

from multibot_rewrite.knowledge.programs import Program
from multibot_rewrite.planning.records import Rules
from multibot_rewrite.planning.ways import SPAWN, Started, ros_arguments, spawner_arguments
from multibot_rewrite.system.records import COMPONENT

# A folder of a package, as launch files in XML have it.
_FOLDER = re.compile(r"\$\(find-pkg-(share|prefix) ([\w-]+)\)")
# These need no ``ros2 run``.
_COMMANDS = {("rviz2", "rviz2"): ("rviz2",)}


class File(NamedTuple):
    """The path of a file of the build; ``substituted``: the launch replaces the substitutions in it."""

    path: str
    substituted: bool = False


class Text(NamedTuple):
    """What a file of the build holds."""

    path: str


# A file of parameters, or their values.
Parameters: TypeAlias = File | Mapping[str, Any]
NOTHING: Mapping[str, str] = {}


class Switch(NamedTuple):
    """A launch argument that decides whether a process starts, with its ``default``.

    The ``word`` of a condition says with which values it starts: ``name`` (true), ``!name``
    (false), ``name=a|b`` (one of these), ``name!=a|b`` (none of these)."""

    name: str
    default: str
    word: str


def name_in(word: str) -> str:
    """Return the launch argument that a term of a condition is about."""
    return word.strip("!").partition("=")[0].rstrip("!")


def values_in(word: str) -> list[str]:
    """Return the values that a term of a condition names; none for a term of true or false."""
    return word.partition("=")[2].split("|") if "=" in word else []


def holds(word: str, value: str) -> bool:
    """Return whether a term of a condition holds with a value of its launch argument."""
    if values := values_in(word):
        return (value in values) != (f"{name_in(word)}!=" in word)
    return (value.lower() in ("true", "1")) == (word[0] != "!")


class Process(NamedTuple):
    """How a process runs, besides what its node is given.

    ``prefix`` is before its command, ``cwd`` is its folder, with ``shell`` a shell reads the line.
    With ``respawn`` it is started again when it ends, after ``respawn_delay`` seconds. It starts
    ``delay`` seconds after the launch, or after the ``event`` (one of ``EVENTS``) of the process that
    is number ``after`` in its launch, -1 for none. ``is_include`` is true for a launch file of a
    package, with launch arguments as words; ``is_extra`` for what spawns something else than the robot
    in its simulator. ``switches`` are the launch arguments that turn it off or on.
    """

    prefix: str = ""
    respawn: bool = False
    respawn_delay: float = 0.0
    cwd: str = ""
    shell: bool = False
    delay: float = 0.0
    event: str = ""
    after: int = -1
    is_include: bool = False
    is_extra: bool = False
    switches: tuple[Switch, ...] = ()

    @property
    def off(self) -> str:
        """The launch argument without whose other value it does not start; empty for none."""
        return next((it.name for it in self.switches if not holds(it.word, it.default)), "")


AS_USUAL = Process()
# How a process runs, by the keywords of launch.
HOW = ("prefix", "respawn", "respawn_delay", "cwd", "shell")
# What a process may wait for, and the keyword of that.
EVENTS: Mapping[str, str] = {
    **{"OnProcessStart": "on_start", "OnProcessExit": "on_exit"},
    "OnExecutionComplete": "on_exit",
}


class Start(NamedTuple):
    """A process: program, name and namespace of its node (empty: as in its code), what it is given.

    ``components`` are loaded into it: each has its class as ``plugin`` and no ``executable``.
    ``brought_up`` is true if its node has a life cycle that nobody else configures and activates.
    It starts if each word of ``condition`` holds (see ``Switch``), and the package ``needs`` is
    installed, where these are not empty. ``environment`` is what is set for it.
    ``number`` is its place in the launch that it is from, -1 for none.

    Without a package the ``executable`` is a command; with ``components`` and without both it loads
    these into the container called ``name``. A launch file of a package has its path in the
    share folder for one, and names and values of launch arguments as words."""

    package: str
    executable: str
    namespace: str = ""
    name: str = ""
    parameters: tuple[Parameters, ...] = ()
    remappings: Rules = ()
    arguments: tuple[str | File, ...] = ()
    components: "tuple[Start, ...]" = ()
    brought_up: bool = False
    plugin: str = ""
    condition: str = ""
    needs: str = ""
    environment: Mapping[str, str] = NOTHING
    process: Process = AS_USUAL
    number: int = -1

    @property
    def full_name(self) -> str:
        """The full name of its node; without a name the namespace."""
        return f"{self.namespace.rstrip('/')}/{self.name}"

    @property
    def every(self) -> "Iterator[Start]":
        """The process and the components in it."""
        yield from (self, *self.components)

    @property
    def terms(self) -> list[str]:
        """The terms of its condition."""
        return self.condition.split()

    @property
    def words(self) -> list[str]:
        """What follows its program on a command line; values of parameters are texts there."""
        rules = ros_arguments(self.namespace or "/", self.name, self.remappings)
        told: list[str] = []
        for it in self.parameters:
            if isinstance(it, File):
                told += ("--params-file", it.path)
            else:
                told += (word for pair in it.items() for word in ("-p", ":=".join(pair)))
        lead = ["--ros-args"] if told and not rules else []
        return [*(path_of(it) for it in self.arguments), *rules, *lead, *told]


class Led(NamedTuple):
    """A process, and those that start at events of it."""

    start: Start
    followers: tuple[Any, ...] = ()

    @property
    def always(self) -> "list[Led]":
        """Return the processes after it that start even if its condition does not hold."""
        return [it for it in self.followers if not {*self.start.terms} <= {*it.start.terms}]

    def at(self, event: str) -> "list[Led]":
        """Return the processes that start at an event of this one."""
        return [it for it in self.followers if EVENTS[it.start.process.event] == event]


def in_order(starts: Sequence[Start]) -> Iterator[Led]:
    """Yield the processes with those that wait for them.

    One that waits for a missing one, or needs another package than it, waits for nothing."""
    leaders = {
        it.number: at
        for at, it in enumerate(starts)
        if it.number >= 0 and not (it.brought_up or it.process.is_include)
    }
    below: dict[int, list[int]] = {}
    for at, it in enumerate(starts):
        leader = leaders.get(it.process.after, -1) if it.process.event in EVENTS else -1
        alike = leader >= 0 and it.needs in (starts[leader].needs, "")
        below.setdefault(leader if alike and leader != at else -1, []).append(at)

    def with_followers(at: int) -> Led:
        return Led(starts[at], tuple(map(with_followers, below.get(at, ()))))

    yield from map(with_followers, below.get(-1, ()))


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
    """Return the process that spawns a controller, with further arguments."""
    return Start(*SPAWN, it.node.namespace, arguments=(*spawner_arguments(it), *words))


def shell_line(it: Start) -> str:
    """Return the line that starts a process without components."""
    program = _COMMANDS.get((it.package, it.executable))
    environment = (f"{name}={value}" for name, value in it.environment.items())
    run = program or ("ros2", "run", it.package, it.executable)
    return shlex.join([*environment, *run, *it.words])


def keywords(it: Start) -> dict[str, Any]:
    """Return launch_ros's keywords of a Node, a ComposableNode, or (commands) an ExecuteProcess."""
    how = {name: getattr(it.process, name) for name in HOW}
    inner = [keywords(one) for one in it.components]
    if inner and not it.package:
        return {"composable_node_descriptions": inner, "target_container": it.name}
    if not it.package:
        cmd = [it.executable, *it.arguments]
        given = {"cmd": cmd, "additional_env": it.environment, **how}
        return {name: one for name, one in given.items() if one}
    given = {
        "package": it.package,
        "executable": it.executable,
        "plugin": it.plugin,
        "namespace": it.namespace,
        "name": it.name,
        "parameters": list(it.parameters),
        "remappings": list(it.remappings),
        "arguments": list(it.arguments),
        "composable_node_descriptions": inner,
        "additional_env": it.environment,
        **how,
    }
    return {name: one for name, one in given.items() if one}


def with_rest(text: str, rest: Any) -> Any:
    """Return a value of the environment with ``rest`` in a list, on the side of its ``:``."""
    if text[:1] == ":":
        return [rest, text]
    return [text, rest] if text[-1:] == ":" else text


def with_folders(
    text: str, shares: Callable[[str], str], prefixes: Callable[[str], str]
) -> list[str]:
    """Return a text cut at the folders of packages; each second part is what a function makes."""
    cut = _FOLDER.split(text)
    made = zip(cut[1::3], cut[2::3], cut[3::3], strict=True)
    named = (((shares if kind == "share" else prefixes)(it), rest) for kind, it, rest in made)
    return [cut[0], *(part for pair in named for part in pair)]


def path_of(it: str | File) -> str:
    """Return a word of a command line: a text as it is, a file by its path."""
    return it.path if isinstance(it, File) else it
