# SPDX-License-Identifier: Apache-2.0
"""Compares what a fleet is to start with what ``fleet.launch.py`` and ``commands.md`` do.

The launch file is executed with other launch arguments each time, the lines are read as a shell
and rcl read them. Every value of every action is compared with the records that it was printed
from: it is printed by other code than this. A controller that the launch file leaves out has its
line all the same, and so have programs that only a person starts. Sources: launch and launch_ros
jazzy; lifecycle_msgs msg/Transition.msg."""

import os
import re
import shlex
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from itertools import count, zip_longest
from pathlib import Path
from typing import Any, NamedTuple

from multibot_rewrite.fleet.launch.launch_file import LAUNCH
from multibot_rewrite.fleet.launch.starts import (
    CLASSIC,
    GZ,
    SIMULATOR,
    FleetStarts,
    RobotStarts,
    launch_arguments,
)
from multibot_rewrite.fleet.outputs.relays import BRIDGE
from multibot_rewrite.planning.start import (
    File,
    Led,
    Start,
    Text,
    holds,
    in_order,
    keywords,
    name_in,
    path_of,
    with_folders,
    with_rest,
)
from multibot_rewrite.producers.launch.performed import (
    END,
    Action,
    Launching,
    performed,
    prefix,
    share,
)
from multibot_rewrite.producers.launch.spawners import ros2_run, ros_arguments
from multibot_rewrite.system.records import SIM_TIME, Place

# The transitions of a life cycle, by number, and the states before and after the first.
_CONFIGURE, _ACTIVATE = 1, 3
_CONFIGURED = {"start_state": "configuring", "goal_state": "inactive"}
_INCLUDE = "IncludeLaunchDescription"
# Handlers are registered in this order.
_EVENTS = (("OnProcessStart", "on_start"), ("OnProcessExit", "on_exit"))
_INCLUDED = {GZ: "ros_gz_sim/gz_sim", CLASSIC: "gazebo_ros/gazebo"}
# What is in a variable before.
_REST = "rest"
# More of a value is not shown.
_SHOWN = 100
_NOTHING = object()
# The programs of which each process has its line, unless it is a node of a node set.
_TOLD = (
    ("tf2_ros", "static_transform_publisher"),
    ("controller_manager", "spawner"),
    ("ros_gz_sim", "create"),
    ("gazebo_ros", "spawn_entity.py"),
    ("topic_tools", "relay"),
    ("tf_namespace_bridge", "tf_namespace_bridge"),
)
_RVIZ = ("rviz2", "rviz2")
_SECTION = re.compile(r"(?m)^## .*$")


class Difference(NamedTuple):
    """A value that is not as planned, in words, and where the launch file has it."""

    message: str
    place: Place


def not_as_printed(starts: FleetStarts, launch_file: bytes, folder: str) -> list[Difference]:
    """Return the differences between what a launch file does and what is planned, each once.

    It is written to an empty ``folder``. Each file whose text it reads has a text of its own there: it
    is compared which file is read, and not what it says.
    """
    texts = {it: _placeholder_text(it).encode() for it in starts.texts}
    for name, data in {LAUNCH: launch_file, **texts}.items():
        os.makedirs(os.path.dirname(os.path.join(folder, name)), exist_ok=True)
        Path(folder, name).write_bytes(data)
    path, launches = os.path.join(folder, LAUNCH), _launches(starts)
    found: list[Difference] = []
    for it, done in zip(launches, performed(path, launches), strict=True):
        if done.error:
            found.append(Difference(done.error, Place(path, 1)))
        else:
            planned = _Planned(starts, it, os.path.realpath(folder), count())
            usual = {name: planned.value(one) for name, one, _ in launch_arguments(starts)}
            planned = planned._replace(arguments={**usual, **it.arguments})
            found += _differences([*planned.actions()], done.actions)
    return [*dict.fromkeys(found)]


def _placeholder_text(path: str) -> str:
    """Return a text that only its file has."""
    return f"the text of {path}"


def _launches(starts: FleetStarts) -> list[Launching]:
    """Return launches with two values of each launch argument and every way to choose robots."""
    usual = {name: default for name, default, _ in launch_arguments(starts)}
    clock = str(not starts.use_sim_time).lower()
    off = {"use_sim_time": clock, "rviz": "false", "simulator": "false"}
    names = [it.name for it in starts.robots]
    values = starts.values
    others = {
        name: [one for one in values.get(name, ()) if one != it] or [str(it.lower() != "true")]
        for name, it in starts.switches.items()
    }
    off |= {name: its[0] for name, its in others.items()}
    more = range(1, max(map(len, others.values()), default=0))
    other = {"headless": "true", "world": "other.sdf"}
    told = {name: it for name, it in other.items() if name in usual}
    launches = (
        Launching({}, frozenset({BRIDGE})),
        Launching({name: it for name, it in off.items() if name in usual}),
        *(Launching({name: its[at % len(its)] for name, its in others.items()}) for at in more),
        *(Launching({"robots": ",".join(it), **told}) for it in (names[:2], names[2:][-2:]) if it),
        Launching({"robots": "1", "use_sim_time": "1"}),
    )
    every = (starts.environment, *(it.environment for it in starts.every))
    pairs = (pair for it in every for pair in it.items())
    there = {name: _REST for name, it in pairs if ":" in (it[:1], it[-1:])}
    # The last one has none of it.
    return [*(it._replace(environment=there) for it in launches[:-1]), launches[-1]]


class _Planned(NamedTuple):
    """What a fleet is to start in one launch; ``home`` is the folder of the build.

    ``arguments`` are the values of the launch arguments, ``numbers`` those of its nodes with a
    life cycle."""

    starts: FleetStarts
    launch: Launching
    home: str
    numbers: Iterator[int]
    arguments: Mapping[str, Any] = {}

    def actions(self) -> Iterator[Action]:
        """Yield all actions in the order of the launch."""
        for name, default, about in launch_arguments(self.starts):
            given = {"name": name, "default_value": self.value(default), "description": about}
            yield Action("DeclareLaunchArgument", given)
        yield from map(self.simulator, self.starts.simulators if self.is_on(SIMULATOR) else ())
        yield from self.processes(self.starts.shared)
        for it in self.chosen():
            yield from self.processes(it.starts, it.name, it.clock, it.not_bridged)
        yield from self.processes(self.starts.windows)

    def is_on(self, condition: str) -> bool:
        """Return whether all parts of a condition hold."""
        return all(holds(it, self.arguments.get(name_in(it), "")) for it in condition.split())

    def chosen(self) -> list[RobotStarts]:
        """Return the robots that are launched."""
        word = self.arguments["robots"]
        if word.isdigit():
            return list(self.starts.robots[: int(word)])
        wanted = word.split(",")
        return [it for it in self.starts.robots if not word or it.name in wanted]

    def processes(
        self,
        starts: Sequence[Start],
        robot: str = "",
        clock: bool | None = None,
        otherwise: str = "",
    ) -> Iterator[Action]:
        """Yield what is started for a robot, or for all (empty)."""
        missing = [it for it in starts if it.needs not in ("", *self.launch.installed)]
        time = self.is_on(SIM_TIME) if clock is None else clock
        for it in in_order(starts):
            if it.start in missing[:1]:
                yield Action("LogInfo", {"msg": otherwise})
            elif it.start in missing:
                continue
            elif it.start.condition and not self.is_on(it.start.condition):
                for one in it.always:
                    if self.is_on(one.start.condition):
                        yield from self.led(one, robot, time)
            else:
                yield from self.led(it, robot, time)

    def led(self, it: Led, robot: str, clock: bool) -> Iterator[Action]:
        """Yield a process after its delay, and before it what starts at its events."""
        if it.start.process.delay:
            yield Action("TimerAction", {"period": it.start.process.delay})
        first, *more = self.process(it.start, robot, clock)
        for kind, word in _EVENTS:
            if several := it.at(word):
                yield Action(kind, {"target_action": first.values})
                for one in several:
                    if self.is_on(one.start.condition):
                        yield from self.led(one, robot, clock)
                yield Action(END, {})
        yield from (first, *more)
        if it.start.process.delay:
            yield Action(END, {})

    def simulator(self, name: str) -> Action:
        """Return the include that starts a simulator."""
        package, file = _INCLUDED[name].split("/")
        world, headless = self.arguments["world"], self.is_on("headless")
        given = [["gz_args", f'-r {self.starts.options}{"-s " if headless else ""}"{world}"']]
        if name == CLASSIC:
            given = [["gui", "false" if headless else "true"], ["world", world]]
        source = f"{share(package)}/launch/{file}.launch.py"
        values = {"launch_description_source": source, "launch_arguments": given}
        return Action(_INCLUDE, {**values, "environment": self.environment("")})

    def process(self, it: Start, robot: str, clock: bool) -> Iterator[Action]:
        """Yield a process; one that is brought up is configured, then activated."""
        if it.process.is_include or not it.package:
            yield self.other(it, robot, clock)
            return
        time = {SIM_TIME: clock}
        own, *inner = (one._replace(parameters=(*one.parameters, time)) for one in it.every)
        environment = self.environment(robot)
        values = self.value(_keywords(own._replace(components=tuple(inner)), environment))
        kind = "ComposableNodeContainer" if inner else "LifecycleNode" if it.brought_up else "Node"
        yield Action(kind, {**values, "output": "screen", "environment": environment})
        if it.brought_up:
            number = next(self.numbers)
            entities = [{"event": _transition_keywords(number, _ACTIVATE)}]
            target = {"target_lifecycle_node": number, "entities": entities}
            yield Action("RegisterEventHandler", {**target, **_CONFIGURED})
            yield Action("EmitEvent", {"event": _transition_keywords(number, _CONFIGURE)})

    def environment(self, robot: str) -> dict[str, str]:
        """Return the environment of what is started for a robot."""
        domains = self.starts.domains
        domain = {"ROS_DOMAIN_ID": f"{domains[robot]}"} if domains else {}
        there = self.launch.environment
        every = self.starts.environment.items()
        own = {
            name: "".join(with_rest(it, _REST)) if there else it.strip(":") for name, it in every
        }
        own = {name: _with_folders(it) for name, it in own.items()}
        return {**there, **own, **domain}

    def other(self, it: Start, robot: str, clock: bool) -> Action:
        """Return a command, the launch file of a package, or what loads components."""
        environment = self.environment(robot)
        if it.components:
            time = {SIM_TIME: clock}
            inner = (one._replace(parameters=(*one.parameters, time)) for one in it.components)
            return Action(
                "LoadComposableNodes", self.value(keywords(it._replace(components=(*inner,))))
            )
        if not it.process.is_include:
            own = self.value(_keywords(it, environment))
            return Action("ExecuteProcess", {**own, "output": "screen", "environment": environment})
        source = f"{share(it.package)}/{it.executable}"
        words = self.value(it.arguments)
        given = [[*pair] for pair in zip(words[::2], words[1::2], strict=True)]
        values = {"launch_description_source": source, "launch_arguments": given}
        scope = {"namespace": it.namespace.rstrip("/"), "remappings": self.value(it.remappings)}
        more = {name: one for name, one in scope.items() if one}
        inside = {**environment, **self.value(it.environment)}
        return Action(_INCLUDE, {**values, **more, "environment": inside})

    def value(self, it: Any) -> Any:
        """Return a value as the launch has it."""
        if isinstance(it, File):
            path = os.path.join(self.home, it.path)
            return {"param_file": path, "allow_substs": True} if it.substituted else path
        if isinstance(it, Text):
            return _placeholder_text(it.path)
        if isinstance(it, Mapping):
            return {key: self.value(one) for key, one in it.items()}
        if isinstance(it, str):
            return _with_folders(it)
        return [self.value(one) for one in it] if isinstance(it, list | tuple) else it


def _with_folders(text: str) -> str:
    """Return a text with the folders of packages."""
    return "".join(with_folders(text, share, prefix))


def _keywords(it: Start, there: Mapping[str, str]) -> dict[str, Any]:
    """Return the keywords of a process in an environment."""
    own = {name: with_rest(text, there.get(name, "")) for name, text in it.environment.items()}
    return {name: own if name == "additional_env" else one for name, one in keywords(it).items()}


def _transition_keywords(number: int, transition: int) -> dict[str, Any]:
    return {"lifecycle_node_matcher": [number], "transition_id": transition}


def not_as_commanded(starts: FleetStarts, text: str) -> list[str]:
    """Return messages about planned processes and lines of ``commands.md`` that differ."""
    above, *sections = ([*_commands(section)] for section in _SECTION.split(text))
    both = zip(starts.robots, sections, strict=False)
    opened = [it for section in (above, *sections) for it in section if it[:2] == _RVIZ]
    found: list[str] = []
    for robot, section in both:
        planned = [it for it in robot.starts if it.full_name not in robot.nodes]
        left = {name for name, _ in robot.left}
        for program in _TOLD:
            wanted = [it for it in planned if it[:2] == program]
            given = [it for it in section if it[:2] == program and not left & {*it.arguments}]
            # Lines stand in the order of nodes, processes in that of the launch.
            for several in (wanted, given):
                several.sort(key=lambda it: [*map(path_of, it.arguments)])
            found += (f"{robot.name}: {it}" for it in _start_differences(wanted, given))
    return [*found, *_start_differences(starts.shown, opened)]


def _start_differences(planned: Iterable[Start], printed: Iterable[Start]) -> Iterator[str]:
    wanted = [Action("Node", keywords(_as_commanded(it))) for it in planned]
    given = [Action("Node", keywords(it)) for it in printed]
    yield from (it.message for it in _differences(wanted, given))


def _as_commanded(it: Start) -> Start:
    """Return a planned process as its line has it, without arguments that are no texts."""
    rows = [row for row in it.parameters if isinstance(row, Mapping)]
    values = {name: one for row in rows for name, one in row.items() if isinstance(one, str)}
    names = {"__node": it.name, **dict(it.remappings)}
    return it._replace(
        namespace="" if it.namespace == "/" else it.namespace,
        name=names["__node"],
        parameters=(*(File(one.path) for one in it.parameters if isinstance(one, File)), values),
        remappings=tuple(pair for pair in it.remappings if not pair[0].startswith("__")),
        arguments=tuple(map(path_of, it.arguments)),
    )


def _commands(text: str) -> Iterator[Start]:
    """Yield the processes of the lines, except those under a condition."""
    for line in text.splitlines():
        words: list[str] = []
        with suppress(ValueError):
            words = [] if line.startswith("#") or "  # " in line else shlex.split(line)
        while words and "=" in words[0]:
            del words[0]
        run = (*_RVIZ, tuple(words[1:])) if words[:1] == ["rviz2"] else ros2_run(words)
        if run:
            package, executable, given = *run[:2], ros_arguments(run[2])
            values = {name: one for name, one in given.values if name != SIM_TIME}
            names, files = (given.namespace, given.name), map(File, given.files)
            yield Start(package, executable, *names, (*files, values), given.rules, given.own)


def _differences(planned: list[Action], printed: Iterable[Action]) -> Iterator[Difference]:
    """Yield the first difference of each action, or actions that are missing or too many."""
    found = list(printed)
    if len(planned) != len(found):
        wanted, given = (Counter(map(_title, it)) for it in (planned, found))
        for it in wanted - given:
            yield Difference(f"{it} is planned and is not started", Place("", 1))
        for it in given - wanted:
            place = next(one.place for one in found if _title(one) == it)
            yield Difference(f"{it} is started and is not planned", place)
        return
    for one, other in zip(planned, found, strict=True):
        if one.kind != other.kind:
            message = f"{_title(one)} is planned, and {_title(other)} is started in its place"
            yield Difference(message, other.place)
        elif at := _first_difference(one.values, other.values):
            where, wanted, given = at
            message = f"{_title(one)}: {where} is {_shown(given)}, planned is {_shown(wanted)}"
            yield Difference(message, other.place)


def _title(it: Action) -> str:
    """Return what an action is called in a message."""
    values = it.values
    program = "/".join(filter(None, (values.get(key, "") for key in ("package", "executable"))))
    if not program:
        return f"{it.kind} {values.get('name', '')}".rstrip()
    name = "/".join((values.get("namespace", "").rstrip("/"), values.get("name", "")))
    return f"{program} {name}" if name != "/" else program


def _first_difference(planned: Any, printed: Any, where: str = "") -> tuple[str, Any, Any] | None:
    """Return the first value that differs: where it is, as planned, as printed; None for none."""
    # It differs for values of other types, which are equal.
    if repr(planned) == repr(printed):
        return None
    if type(planned) is not type(printed) or not isinstance(planned, dict | list):
        return where, planned, printed
    if isinstance(planned, dict):
        keys = dict.fromkeys((*planned, *printed))
        pairs = [(f"{where}.{key}".lstrip("."), key) for key in keys]
        every = ((at, planned.get(key, _NOTHING), printed.get(key, _NOTHING)) for at, key in pairs)
    else:
        both = enumerate(zip_longest(planned, printed, fillvalue=_NOTHING))
        every = ((f"{where}[{at}]", one, other) for at, (one, other) in both)
    return next(filter(None, (_first_difference(one, other, at) for at, one, other in every)), None)


def _shown(it: Any) -> str:
    """Return a value for a message."""
    text = "missing" if it is _NOTHING else repr(it)
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]}..."
