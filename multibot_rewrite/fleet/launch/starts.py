# SPDX-License-Identifier: Apache-2.0
"""What a fleet starts: its launch file does, and lines for a shell do some of it."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.spelling.ways import ros_arguments

# The simulators that it can start.
CLASSIC, GZ = "classic", "gz"
TOGETHER: Mapping[str, int] = {}


class File(NamedTuple):
    """The path of a file of the build."""

    path: str


class Text(NamedTuple):
    """What a file of the build holds."""

    path: str


class Component(NamedTuple):
    """A node that is loaded into the process of another."""

    package: str
    plugin: str
    namespace: str
    name: str
    parameters: tuple[File | Mapping[str, Any], ...]
    remappings: tuple[tuple[str, str], ...]


class Start(NamedTuple):
    """A process: its program, its node's name and namespace (empty for those of its code), and what it
    is given. ``components`` are loaded into it; ``brought_up`` is one with a life cycle that nobody
    else configures and activates."""

    package: str
    executable: str
    namespace: str = ""
    name: str = ""
    parameters: tuple[File | Mapping[str, Any], ...] = ()
    remappings: tuple[tuple[str, str], ...] = ()
    arguments: tuple[str | File, ...] = ()
    components: tuple[Component, ...] = ()
    brought_up: bool = False

    @property
    def full_name(self) -> str:
        """The full name of its node; without a name the namespace."""
        return f"{self.namespace.rstrip('/')}/{self.name}"


def shell_line(it: Start) -> str:
    """The line that starts a process without components or parameter files."""
    given = [word.path if isinstance(word, File) else word for word in it.arguments]
    rules = ros_arguments(it.namespace or "/", it.name, it.remappings)
    pairs = (pair for one in it.parameters if isinstance(one, Mapping) for pair in one.items())
    told = [word for pair in pairs for word in ("-p", ":=".join(pair))]
    return shlex.join(["ros2", "run", it.package, it.executable, *given, *rules, *told])


class RobotStarts(NamedTuple):
    """What one robot runs: ``description`` is the name of its file, ``where`` its namespace in words;
    ``files`` are its parameter files, ``spawned`` is what brings it into the simulator,
    ``left`` are nodes that are not started, each with the reason. ``bridged_tf`` brings its tf to
    ``/tf`` where tf_namespace_bridge is installed, otherwise ``not_bridged`` is said. ``windows`` show
    this robot alone. ``nodes`` are the full names of those that are started, ``clock`` is its
    ``use_sim_time`` where not all robots have the same."""

    name: str
    description: str
    where: str
    files: tuple[str, ...]
    starts: tuple[Start, ...]
    spawned: tuple[Start, ...]
    left: tuple[tuple[str, str], ...]
    bridged_tf: tuple[Start, ...] = ()
    not_bridged: str = ""
    windows: tuple[Start, ...] = ()
    nodes: tuple[str, ...] = ()
    clock: bool | None = None

    @property
    def every(self) -> tuple[Start, ...]:
        """All processes, whatever they are started under."""
        return (*self.starts, *self.bridged_tf, *self.spawned, *self.windows)


class FleetStarts(NamedTuple):
    """All that the launch file of a fleet starts: the simulators, what is for all robots, the robots,
    the windows for all. ``head`` is its title, ``use_sim_time`` the default, ``driving`` are lines to
    type; ``world`` is the simulator's by default, ``domains`` has that of each robot by its name, and
    of all (empty name), where they are not in one. ``shown`` are all windows, those that a fleet
    without any config has among them: the launch file does not open these."""

    head: str
    simulators: Sequence[str]
    shared: Sequence[Start]
    robots: Sequence[RobotStarts]
    windows: Sequence[Start]
    use_sim_time: bool
    driving: Sequence[str]
    world: File | str = ""
    domains: Mapping[str, int] = TOGETHER
    shown: Sequence[Start] = ()

    @property
    def nodes(self) -> frozenset[str]:
        """The full names of the planned nodes that are started."""
        shared = (it.full_name for it in self.shared if it.name)
        return frozenset((*shared, *(node for it in self.robots for node in it.nodes)))

    @property
    def texts(self) -> frozenset[str]:
        """The paths of the files whose texts are parameters."""
        starts = [*self.shared, *self.windows, *(one for it in self.robots for one in it.every)]
        given = [row for it in starts for row in it.parameters]
        given += [row for it in starts for one in it.components for row in one.parameters]
        values = (one for row in given if isinstance(row, Mapping) for one in row.values())
        return frozenset(it.path for it in values if isinstance(it, Text))


def launch_arguments(it: FleetStarts) -> Iterator[tuple[str, str | File, str]]:
    """The launch arguments: name, default, what it is."""
    yield "robots", "", "only these: robot1,robot2, or so many: 2"
    yield "use_sim_time", str(it.use_sim_time).lower(), "whether all nodes use /clock"
    if it.windows or any(robot.windows for robot in it.robots):
        yield "rviz", "true", "whether to open RViz"
    if it.simulators:
        yield "simulator", "true", "whether to start the simulator and to spawn the robots in it"
        yield "headless", "false", "whether the simulator has no window"
        yield "world", it.world, "the world of the simulator"
