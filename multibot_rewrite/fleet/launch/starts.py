# SPDX-License-Identifier: Apache-2.0
"""What a fleet starts: its launch file does, and lines for a shell do some of it."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import NamedTuple

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.planning.start import NOTHING, File, Start, Text, name_in, values_in

# The simulators that it can start.
CLASSIC, GZ = "classic", "gz"
# The launch arguments of every build, or of some.
OWN_ARGUMENTS = ("robots", "use_sim_time", "rviz", "simulator", "headless", "world")
# Those that switch something on.
SIMULATOR, RVIZ = "simulator", "rviz"
TOGETHER: Mapping[str, int] = {}


class RobotStarts(NamedTuple):
    """What one robot runs; ``where`` is its namespace in words, ``files`` its parameter files.

    ``left`` are nodes that are not started, with the reason; ``not_bridged`` is the message if a
    needed package is missing; ``nodes`` are the full names of started nodes, ``clock`` its
    ``use_sim_time`` if robots differ."""

    name: str
    description: str
    where: str
    files: tuple[File, ...]
    starts: tuple[Start, ...]
    left: tuple[tuple[str, str], ...] = ()
    not_bridged: str = ""
    nodes: tuple[str, ...] = ()
    clock: bool | None = None


class FleetStarts(NamedTuple):
    """All that the launch file of a fleet starts: simulators, shared nodes, robots, windows.

    ``head`` is its title, ``use_sim_time`` the default, ``driving`` are lines to type; ``world``
    is the default one, ``domains`` has those of robots and of all (empty name). ``shown`` are
    all windows, also those that are not opened. ``environment`` is for all processes; a value
    with ``:`` in front or at the end is added. ``options`` and ``headless`` are of gz-sim.
    ``switches`` are arguments of the robots' launch files, with the values by which these start
    all of it."""

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
    environment: Mapping[str, str] = NOTHING
    options: str = ""
    headless: bool = False
    switches: Mapping[str, str] = NOTHING

    @property
    def every(self) -> Iterator[Start]:
        """All processes and components."""
        of_robots = (start for it in self.robots for start in it.starts)
        for it in (*self.shared, *of_robots, *self.windows):
            yield from it.every

    @property
    def values(self) -> Mapping[str, Sequence[str]]:
        """The values of launch arguments that conditions name."""
        words = dict.fromkeys(word for it in self.every for word in it.terms)
        pairs = ((name_in(word), value) for word in words for value in values_in(word))
        return lists_by_key(dict.fromkeys(pairs))

    @property
    def nodes(self) -> frozenset[str]:
        """The full names of the planned nodes that are started."""
        shared = (it.full_name for it in self.shared if it.name)
        return frozenset((*shared, *(node for it in self.robots for node in it.nodes)))

    @property
    def texts(self) -> frozenset[str]:
        """The paths of the files whose texts are parameters."""
        rows = (row for it in self.every for row in it.parameters if isinstance(row, Mapping))
        return frozenset(it.path for row in rows for it in row.values() if isinstance(it, Text))


def launch_arguments(it: FleetStarts) -> Iterator[tuple[str, str | File, str]]:
    """Yield (name, default, what it is) of each launch argument."""
    yield "robots", "", "only these: robot1,robot2, or so many: 2"
    yield "use_sim_time", str(it.use_sim_time).lower(), "whether all nodes use /clock"
    if any(start.condition == RVIZ for start in it.every):
        yield RVIZ, "true", "whether to open RViz"
    if it.simulators:
        yield SIMULATOR, "true", "whether to start the simulator and to spawn the robots in it"
        yield "headless", str(it.headless).lower(), "whether the simulator has no window"
        yield "world", it.world, "the world of the simulator"
    for name, default in it.switches.items():
        values = ", ".join(it.values.get(name, ()))
        does = f"what starts depends on {values}" if values else "it turns something on or off"
        yield name, default, f"as in the launch files of the robots: {does}"


def with_switches(it: FleetStarts, others: Collection[str]) -> FleetStarts:
    """Return the fleet with launch arguments that turn on or off what launch files start."""
    # Only those of one value, by which ``others`` change nothing. What waits for something with a
    # condition of ours has not those of that, too.
    every = dict.fromkeys(one[:2] for start in it.every for one in start.process.switches)
    values, taken = lists_by_key(every), {*OWN_ARGUMENTS, *others}
    own = {name: its[0] for name, its in values.items() if len(its) == 1 and name not in taken}
    robots = [one._replace(starts=_switched(one.starts, own)) for one in it.robots]
    made = it._replace(shared=_switched(it.shared, own), robots=robots)
    used = {name_in(word) for one in made.every for word in one.terms}
    return made._replace(switches={name: text for name, text in own.items() if name in used})


def _switched(starts: Sequence[Start], own: Collection[str]) -> tuple[Start, ...]:
    """Return processes with the conditions of launch arguments."""
    # Components with more conditions than their container are loaded apart from it.
    numbered = {it.number: it for it in starts if it.number >= 0}

    def with_condition(it: Start) -> Start:
        """Return a process with the arguments that turn it on or off as its condition."""
        first: Start | None = it
        while first is not None and not first.condition:
            first = numbered.get(first.process.after)
        of_ours = first.process.switches if first else ()
        named = (one for one in it.process.switches if one.name in own and one not in of_ours)
        return it._replace(condition=it.condition or " ".join(one.word for one in named))

    def loaded(host: Start) -> Iterator[Start]:
        """Yield a container, and loads of its components under conditions of their own."""
        parts = [*map(with_condition, filter(there, host.components))]
        alike = lists_by_key((it.condition, it._replace(condition="")) for it in parts)
        yield host._replace(components=tuple(alike.pop(host.condition, ())))
        for condition, several in alike.items():
            yield Start("", "", name=host.full_name, components=(*several,), condition=condition)

    def there(it: Start) -> bool:
        return not it.process.off or it.process.off in own

    return tuple(part for it in filter(there, starts) for part in loaded(with_condition(it)))
