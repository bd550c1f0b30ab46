# SPDX-License-Identifier: Apache-2.0
"""One robot of a fleet file: its row and what the file says for all robots -> a record."""

import math
import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.base.naming import NAMESPACE, Naming
from multibot_rewrite.description.joining.part import Part, files_of
from multibot_rewrite.description.sources.own_names import filled, name_robot
from multibot_rewrite.description.sources.read import JOIN as LIST
from multibot_rewrite.fleet.file.checked_yaml import Path
from multibot_rewrite.fleet.file.fleet_data import (
    JOIN,
    FleetData,
    given_arguments,
    listed,
    texts_of,
)
from multibot_rewrite.fleet.fleet import facts_of
from multibot_rewrite.producers.launch.records import LaunchOrder, launch_order
from multibot_rewrite.related_files.named_file import PARAMS
from multibot_rewrite.related_files.rviz.read_config import read_colour

# Description, SRDF and arguments; the robot's name, if the arguments hold a word of it; the model.
Sources = tuple[str, str, tuple[tuple[str, str], ...], str, str]
# What ``simulator`` says of a real robot.
REAL = "none"
WORLD_LINK = "world"


class Pose(NamedTuple):
    """Where a robot starts in the world: metres and radians."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    roll: float = 0.0
    pitch: float = 0.0
    yaw: float = 0.0


class RobotSpec(NamedTuple):
    """One robot of a fleet file; paths are absolute or relative to the working directory.

    ``namespace`` has no leading slash; ``tag`` is the prefix or postfix of its frames and joints;
    ``pose`` is None if the file has none; ``model`` is empty until the description is rewritten if
    the file has none. ``related_files`` maps a kind of ``KINDS`` to files; a kind
    without files is not there. ``line``
    is its line in ``file``. ``filled`` are texts of files that are not as on disk, by path: parameters
    in the fleet file itself, parameter files in which a launch replaces something, and what is made of
    ``parts``, which are joined.
    ``simulator`` is ``REAL``, or what the robot runs in; empty if nothing says so. ``use_sim_time``
    is what all its nodes have, None if the file does not say. ``simulated`` is the model that the
    simulator gets, empty where that is the description. ``bridge_namespace`` is the one below its
    own that its bridge files are for, ``bridges_below`` what launch files say of single ones.
    ``fills`` says that arguments of its xacro which name robots are filled where ``arguments`` has
    no value for them. ``places`` are those of outputs below
    the robot's folder, by the names that they have else.
    """

    name: str
    description: str
    srdf: str
    arguments: Mapping[str, str]
    namespace: str
    tag: str
    model: str
    pose: Pose | None
    colour: str | tuple[int, ...]
    node_sets: tuple[str, ...]
    related_files: Mapping[str, tuple[str, ...]]
    file: str
    line: int
    launch: tuple[LaunchOrder, ...] = ()
    filled: tuple[tuple[str, str], ...] = ()
    simulator: str = ""
    use_sim_time: bool | None = None
    simulated: str = ""
    bridge_namespace: str = ""
    bridges_below: tuple[tuple[str, str], ...] = ()
    fills: bool = True
    places: tuple[tuple[str, str], ...] = ()
    parts: tuple[Part, ...] = ()

    @property
    def files(self) -> Iterator[str]:
        """Every file of a disk that it is made of."""
        # Parameters in the fleet file itself are called as if it were a folder.
        made = {it for it, _ in self.filled if os.path.dirname(it) == self.file}
        made |= {self.description, *dict(self.filled)} if self.parts else set()
        own = (self.description, self.srdf, self.simulated)
        beside = (path for paths in self.related_files.values() for path in paths)
        yield from (it for it in (*own, *beside) if it and (it not in made or it.endswith(LIST)))
        yield from (it for part in self.parts for it in files_of(part))
        yield from (it.file for it in self.launch)

    @property
    def words(self) -> tuple[str, str, str]:
        """The texts that stand for it in names; the first is ``{robot}`` in its arguments."""
        return self.name, self.namespace, self.tag

    def bridge_namespace_of(self, path: str) -> str:
        """Return the namespace, below the robot's, of one of its bridge files."""
        return dict(self.bridges_below).get(path, self.bridge_namespace)

    @property
    def sources(self) -> Sources:
        """All that decides its texts besides its names."""
        own = self.name if name_robot(self.arguments, self.words) else ""
        return self.description, self.srdf, tuple(self.arguments.items()), own, self.simulated


def is_simulated(data: Mapping[str, Any], own: Mapping[str, Any]) -> bool:
    """Return whether a robot runs in a simulator."""
    return bool(own.get("simulator", data.get("simulator", REAL)) != REAL)


def robot_spec(read: FleetData, naming: Naming, at: int, release: str) -> RobotSpec:
    """Return the robot in row ``at``; raises InputError with file and line."""
    data, own = read.data, read.data["robots"][at]
    file, line = read.places["robots", at]
    place, name = f"{file}:{line}", own["name"]
    description, parts = described(read, at)
    if not description:
        raise InputError(f"{place}: robot {name!r} has no description; name its URDF or xacro")
    related_files = {**data.get("related_files", {}), **own.get("related_files", {})}
    simulator = own.get("simulator", data.get("simulator", ""))
    if simulator == REAL:
        related_files.pop("bridge", None)
    texts = texts_of(listed(related_files.get(PARAMS, [])), file)
    node_sets = tuple(listed(own.get("node_sets", data.get("node_sets", []))))
    _check_node_sets(read, at, node_sets, release)
    namespace = str(own.get("namespace", name)).strip("/")
    if "/" in namespace and naming.topics != NAMESPACE:
        what = f"{name!r} has the namespace {namespace!r}, but here names get no namespace"
        hint = "write one word, or take a layout with namespaces"
        raise InputError(f"{place}: {what}; {hint}")
    side, other = ("prefix", "postfix") if naming.affix == "prefix" else (naming.affix, "prefix")
    if other in own:
        what = f"{name!r} has a {other}, but the fleet's affix is {side}"
        raise InputError(f"{place}: {what}; write {side}: instead, or affix: {other}")
    # Parameters in the fleet file itself have the path of their text.
    made = iter(texts)
    files = {
        kind: tuple(path if isinstance(path, str) else next(made) for path in listed(it))
        for kind, it in related_files.items()
        if it
    }
    return RobotSpec(
        name,
        description,
        own.get("srdf", data.get("srdf", "")),
        given_arguments(data, own, [description, *(str(it.description) for it in parts)], place),
        namespace,
        str(own.get(side, name)),
        own.get("model", ""),
        _pose(own, place),
        _colour(own, place),
        node_sets,
        files,
        file,
        line,
        tuple(_launch(data, own, place)),
        tuple(texts.items()),
        simulator=simulator,
        use_sim_time=own.get("use_sim_time", data.get("use_sim_time")),
        simulated="" if simulator == REAL else own.get("simulated", data.get("simulated", "")),
        bridge_namespace=own.get("bridge_namespace", data.get("bridge_namespace", "")).strip("/"),
        fills=own.get("fill_arguments", data.get("fill_arguments", True)),
        parts=parts,
    )


def _check_node_sets(read: FleetData, at: int, node_sets: Sequence[str], release: str) -> None:
    """Raise InputError with the line that names a node set or node which is not known."""
    try:
        nodes, nodl = read.data.get("nodes") or None, listed(read.data.get("nodl", []))
        facts_of(node_sets, nodes, release, nodl)
    except UsageError as error:
        above: tuple[Path, ...] = (("node_sets",), ("nodes",), ("nodl",))
        keys = (("robots", at, "node_sets"), *above)
        file, line = next(read.places[it] for it in keys if it in read.places)
        raise InputError(f"{file}:{line}: {error}") from None


def _launch(data: Mapping[str, Any], own: Mapping[str, Any], place: str) -> Iterator[LaunchOrder]:
    """Yield the launch files of a robot; raises InputError for wrong arguments."""
    roots = listed(data.get("launch_roots", []))
    try:
        for text in listed(own.get("launch", data.get("launch", []))):
            order = launch_order(text, roots)
            full = filled(dict(order.arguments), own["name"])
            # Robots with files of their own start other nodes; else one look is enough for all.
            own_files = {
                name: full[name] for name, text in order.arguments if os.path.splitext(text)[1]
            }
            yield order._replace(arguments=tuple({**dict(order.arguments), **own_files}.items()))
    except UsageError as error:
        raise InputError(f"{place}: {own['name']!r}: {error}") from None


def _pose(own: Mapping[str, Any], place: str) -> Pose | None:
    """Return the start pose of a robot; None without one, raises InputError."""
    if "pose" not in own:
        return None
    values = {key: float(value) for key, value in own["pose"].items()}
    for key, value in values.items():
        if not math.isfinite(value):
            raise InputError(f"{place}: {own['name']!r}: pose {key} is {value}; write a number")
    return Pose(**values)


def _colour(own: Mapping[str, Any], place: str) -> str | tuple[int, ...]:
    """Return the colour of a robot as written; raises InputError if there is none such."""
    value = own.get("colour", "")
    colour = value if isinstance(value, str) else tuple(value)
    try:
        read_colour(colour) if colour else None
    except InputError as error:
        raise InputError(f"{place}: {own['name']!r}: {error}") from None
    return colour


DESCRIPTION = "description"
# What a robot is called where the fleet file lists its parts.
_MADE = "robot.urdf"


def described(read: FleetData, at: int) -> tuple[str, tuple[Part, ...]]:
    """Return a robot's description and the parts that it is joined from; raises InputError."""
    # A list of parts in the fleet file gets a path as if it were a file below.
    data, own = read.data, read.data["robots"][at]
    file, line = read.places["robots", at]
    if any(JOIN in it and DESCRIPTION in it for it in (own, data)):
        what = "join and description are both there: a robot has one of them; remove the other"
        raise InputError(f"{file}:{line}: {what}")
    given = own if JOIN in own or DESCRIPTION in own else data
    if JOIN not in given:
        path = given.get(DESCRIPTION, "")
        if not path.endswith(LIST):
            return path, ()
    from multibot_rewrite.description.joining.from_file import part_of, parts_of  # few are joined

    if JOIN not in given:
        return path, parts_of(path)
    like = next(it["name"] for it in data["robots"] if it.get(JOIN) == own.get(JOIN))
    try:
        parts = tuple(map(part_of, given[JOIN]))
    except UsageError as error:
        raise InputError(f"{file}:{line}: {error}") from None
    return os.path.join(read.file, like if given is own else "", _MADE), parts
