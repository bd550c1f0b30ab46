# SPDX-License-Identifier: Apache-2.0
"""What a fleet is to start and what the printed ``fleet.launch.py`` does -> where they differ.

The launch file is executed with other launch arguments each time, and every value of every action is
compared with the records that it was printed from: it is printed by other code than this.
Sources: launch and launch_ros jazzy; lifecycle_msgs msg/Transition.msg.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from itertools import zip_longest
from pathlib import Path
from typing import Any

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.fleet.launch.launch_file import LAUNCH
from multibot_rewrite.fleet.launch.starts import (
    CLASSIC,
    GZ,
    Component,
    File,
    FleetStarts,
    RobotStarts,
    Start,
    Text,
    launch_arguments,
)
from multibot_rewrite.fleet.outputs.relays import BRIDGE
from multibot_rewrite.producers.launch.performed import Action, Launching, performed, share
from multibot_rewrite.system.records import Place

# The transitions of a life cycle, by number, and the states before and after the first.
_CONFIGURE, _ACTIVATE = 1, 3
_CONFIGURED = {"start_state": "configuring", "goal_state": "inactive"}
_BRIDGES = "ros_gz_bridge"
_INCLUDED = {GZ: "ros_gz_sim/gz_sim", CLASSIC: "gazebo_ros/gazebo"}
# More of a value is not shown.
_SHOWN = 100
_NOTHING = object()


class Difference(NamedTuple):
    """A value that is not as planned, in words, and where the launch file has it."""

    message: str
    place: Place


def not_as_printed(starts: FleetStarts, launch_file: bytes, folder: str) -> list[Difference]:
    """Return the differences between what a launch file does and what is planned, each once.

    It is written to an empty ``folder``. Each file whose text it reads has a text of its own there: it
    is compared which file is read, and not what it says.
    """
    texts = {it: _text_of(it).encode() for it in starts.texts}
    for name, data in {LAUNCH: launch_file, **texts}.items():
        os.makedirs(os.path.dirname(os.path.join(folder, name)), exist_ok=True)
        Path(folder, name).write_bytes(data)
    path, launches = os.path.join(folder, LAUNCH), _launches(starts)
    found: list[Difference] = []
    for it, done in zip(launches, performed(path, launches), strict=True):
        if done.error:
            found.append(Difference(done.error, Place(path, 1)))
        else:
            planned = _planned(starts, it, os.path.realpath(folder))
            found += _differences([*planned.actions()], done.actions)
    return [*dict.fromkeys(found)]


def _text_of(path: str) -> str:
    """Return a text that only its file has."""
    return f"the text of {path}"


def _launches(starts: FleetStarts) -> list[Launching]:
    """Return launches in which every launch argument has two values, and every way to choose robots
    is taken."""
    usual = {name: default for name, default, _ in launch_arguments(starts)}
    clock = str(not starts.use_sim_time).lower()
    off = {"use_sim_time": clock, "rviz": "false", "simulator": "false"}
    names = [it.name for it in starts.robots]
    other = {"headless": "true", "world": "other.sdf"}
    told = {name: it for name, it in other.items() if name in usual}
    return [
        Launching({}, frozenset({BRIDGE})),
        Launching({name: it for name, it in off.items() if name in usual}),
        *(Launching({"robots": ",".join(it), **told}) for it in (names[:2], names[2:]) if it),
        Launching({"robots": "1", "use_sim_time": "1"}),
    ]


class _Around(NamedTuple):
    """What the processes of a robot have in common: their environment and their clock."""

    environment: Mapping[str, str]
    clock: bool


class _Planned(NamedTuple):
    """What a fleet is to start in one launch; ``home`` is the folder of the build, ``arguments`` are
    the values of the launch arguments."""

    starts: FleetStarts
    launch: Launching
    home: str
    arguments: Mapping[str, Any] = {}

    def actions(self) -> Iterator[Action]:
        """Yield all actions in the order of the launch."""
        for name, default, about in launch_arguments(self.starts):
            given = {"name": name, "default_value": self.value(default), "description": about}
            yield Action("DeclareLaunchArgument", given)
        simulated = self.is_on("simulator")
        yield from map(self.simulator, self.starts.simulators if simulated else ())
        of_simulator = [it for it in self.starts.shared if self.is_bridge(it)]
        others = [it for it in self.starts.shared if not self.is_bridge(it)]
        shared = [*(of_simulator if simulated else ()), *others]
        opened = self.starts.windows if self.is_on("rviz") else ()
        of_all, number = self.around("", None), 0
        for it in shared:
            yield from self.process(it, of_all, number)
        for robot in self.chosen():
            for one in self.of_robot(robot, number):
                number += one.kind == "LifecycleNode"
                yield one
        for it in opened:
            yield from self.process(it, of_all, number)

    def is_on(self, argument: str) -> bool:
        """Is a launch argument that switches something true?"""
        return self.arguments.get(argument) in ("true", "1")

    def is_bridge(self, it: Start) -> bool:
        """Is it of no use without the simulator?"""
        return bool(self.starts.simulators) and it.package == _BRIDGES

    def chosen(self) -> list[RobotStarts]:
        """Return the robots that are launched."""
        word = self.arguments["robots"]
        if word.isdigit():
            return list(self.starts.robots[: int(word)])
        wanted = word.split(",")
        return [it for it in self.starts.robots if not word or it.name in wanted]

    def around(self, robot: str, clock: bool | None) -> _Around:
        """Return what the processes of a robot have, or those for all (empty)."""
        domains = self.starts.domains
        environment = {"ROS_DOMAIN_ID": f"{domains[robot]}"} if domains else {}
        return _Around(environment, self.is_on("use_sim_time") if clock is None else clock)

    def of_robot(self, it: RobotStarts, number: int) -> Iterator[Action]:
        """Yield what one robot does; ``number`` is that of its first node with a life cycle."""
        around = self.around(it.name, it.clock)
        bridged = it.bridged_tf if BRIDGE in self.launch.installed else ()
        spawned = it.spawned if self.is_on("simulator") else ()
        opened = it.windows if self.is_on("rviz") else ()
        for start in it.starts:
            yield from self.process(start, around, number)
            number += start.brought_up
        if it.bridged_tf and not bridged:
            yield Action("LogInfo", {"msg": it.not_bridged})
        for start in (*bridged, *spawned, *opened):
            yield from self.process(start, around, number)

    def simulator(self, name: str) -> Action:
        """Return the include that starts a simulator."""
        package, file = _INCLUDED[name].split("/")
        world, headless = self.arguments["world"], self.is_on("headless")
        given = [["gz_args", f'-r {"-s " if headless else ""}"{world}"']]
        if name == CLASSIC:
            given = [["gui", "false" if headless else "true"], ["world", world]]
        source = f"{share(package)}/launch/{file}.launch.py"
        values = {"launch_description_source": source, "launch_arguments": given}
        return Action("IncludeLaunchDescription", values)

    def process(self, it: Start, around: _Around, number: int) -> Iterator[Action]:
        """Yield a process; one that is brought up is configured, then activated."""
        kind = "ComposableNodeContainer" if it.components else "Node"
        values = {
            "package": it.package,
            "executable": it.executable,
            **self.node(it, around.clock),
            "arguments": [self.value(word) for word in it.arguments],
            "output": "screen",
            "composable_node_descriptions": [
                self.component(one, around.clock) for one in it.components
            ],
        }
        told = {name: one for name, one in values.items() if one}
        told["environment"] = dict(around.environment)
        yield Action("LifecycleNode" if it.brought_up else kind, told)
        if it.brought_up:
            entities = [{"event": _change(number, _ACTIVATE)}]
            target = {"target_lifecycle_node": number, "entities": entities}
            yield Action("RegisterEventHandler", {**target, **_CONFIGURED})
            yield Action("EmitEvent", {"event": _change(number, _CONFIGURE)})

    def component(self, it: Component, clock: bool) -> dict[str, Any]:
        """Return the values of a component."""
        names = {"namespace": "node_namespace", "name": "node_name"}
        own = {names.get(key, key): one for key, one in self.node(it, clock).items()}
        return {"package": it.package, "node_plugin": it.plugin, **own}

    def node(self, it: Start | Component, clock: bool) -> dict[str, Any]:
        """Return what a process and a component have in common."""
        values = {
            "namespace": it.namespace,
            "name": it.name,
            "parameters": [*(self.value(one) for one in it.parameters), {"use_sim_time": clock}],
            "remappings": [[old, new] for old, new in it.remappings],
        }
        return {name: one for name, one in values.items() if one}

    def value(self, it: Any) -> Any:
        """Return a value as the launch has it."""
        if isinstance(it, File):
            return os.path.join(self.home, it.path)
        if isinstance(it, Text):
            return _text_of(it.path)
        if isinstance(it, Mapping):
            return {key: self.value(one) for key, one in it.items()}
        return it


def _planned(starts: FleetStarts, launch: Launching, home: str) -> _Planned:
    found = _Planned(starts, launch, home)
    usual = {name: found.value(it) for name, it, _ in launch_arguments(starts)}
    return found._replace(arguments={**usual, **launch.arguments})


def _change(number: int, transition: int) -> dict[str, Any]:
    return {"lifecycle_node_matcher": [number], "transition_id": transition}


def _differences(planned: list[Action], printed: Iterable[Action]) -> Iterator[Difference]:
    """Yield the first difference of each action, or the actions that are there too often or not."""
    found = list(printed)
    if len(planned) != len(found):
        yield from _not_paired(planned, found)
        return
    for one, other in zip(planned, found, strict=True):
        if one.kind != other.kind:
            message = f"{_who(one)} is planned, and {_who(other)} is started in its place"
            yield Difference(message, other.place)
        elif at := _first(one.values, other.values):
            where, wanted, given = at
            message = f"{_who(one)}: {where} is {_shown(given)}, planned is {_shown(wanted)}"
            yield Difference(message, other.place)


def _not_paired(planned: list[Action], printed: list[Action]) -> Iterator[Difference]:
    wanted, given = (Counter(map(_who, it)) for it in (planned, printed))
    for it in wanted - given:
        yield Difference(f"{it} is planned and is not started", Place("", 1))
    for it in given - wanted:
        place = next(one.place for one in printed if _who(one) == it)
        yield Difference(f"{it} is started and is not planned", place)


def _who(it: Action) -> str:
    """Return what an action is called in a message."""
    values = it.values
    program = "/".join(filter(None, (values.get(key, "") for key in ("package", "executable"))))
    if not program:
        return f"{it.kind} {values.get('name', '')}".rstrip()
    name = "/".join((values.get("namespace", "").rstrip("/"), values.get("name", "")))
    return f"{program} {name}" if name != "/" else program


def _first(planned: Any, printed: Any, where: str = "") -> tuple[str, Any, Any] | None:
    """Return the first value that differs: where it is, as planned, as printed; None for none."""
    if planned == printed and type(planned) is type(printed) and not _is_deep(planned):
        return None
    if type(planned) is not type(printed) or not _is_deep(planned):
        return where, planned, printed
    if isinstance(planned, dict):
        keys = dict.fromkeys((*planned, *printed))
        pairs = [(f"{where}.{key}".lstrip("."), key) for key in keys]
        every = ((at, planned.get(key, _NOTHING), printed.get(key, _NOTHING)) for at, key in pairs)
    else:
        both = enumerate(zip_longest(planned, printed, fillvalue=_NOTHING))
        every = ((f"{where}[{at}]", one, other) for at, (one, other) in both)
    return next(filter(None, (_first(one, other, at) for at, one, other in every)), None)


def _is_deep(it: Any) -> bool:
    return isinstance(it, dict | list)


def _shown(it: Any) -> str:
    """Return a value for a message."""
    text = "missing" if it is _NOTHING else repr(it)
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]}..."
