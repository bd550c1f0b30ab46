"""The fleet file: YAML -> frozen records, or one line that says what is wrong and where."""

from __future__ import annotations

import json
import math
import os
import re
from collections.abc import Mapping, Sequence
from functools import cache
from importlib.resources import files
from typing import Any, NamedTuple, cast

from multibot_rewrite.companions.rviz.colours import read_colour
from multibot_rewrite.fleets.by_schema import Path, read_fitting
from multibot_rewrite.fleets.fleet import facts_of
from multibot_rewrite.model import InputError, UsageError
from multibot_rewrite.naming import LAYOUTS, Naming, Policy, make_naming

SCHEMA = "fleet.schema.json"
KINDS = ("params", "rviz", "moveit", "bridge", "behavior_trees", "lua")
LISTS = ("include", "stack", "vocabulary", "shared_frames", "shared_topics")
POLICY = tuple(Policy.__annotations__)
PATHS = ("include", "description", "srdf", "nodes", "parameters", "vocabulary")
Places = Mapping[Path, tuple[str, int]]
# What stands behind ``robots:``, empty lines and comments aside.
_ROBOTS = re.compile(rb"^robots:[ \t]*(?:#[^\n]*)?(?:\s*#[^\n]*\n)*\s*(\S)", re.MULTILINE)


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

    ``namespace`` has no slash in front; ``spelled`` is what stands before or behind its frames and
    joints; ``pose`` is None where the file says none. ``companions`` maps a kind of ``KINDS`` to
    files. ``line`` is where it is in ``file``.
    """

    name: str
    description: str
    srdf: str
    arguments: Mapping[str, str]
    namespace: str
    spelled: str
    model: str
    pose: Pose | None
    colour: str | tuple[int, ...]
    stacks: tuple[str, ...]
    companions: Mapping[str, tuple[str, ...]]
    file: str
    line: int


class FleetFile(NamedTuple):
    """A fleet file as it is meant; ``policy`` are the options of ``make_naming`` that it gives,
    ``files`` all that was read or will be beside the robots' own: it, what it includes, nodes,
    parameters, vocabulary."""

    file: str
    policy: Policy
    world: str
    distro: str
    nodes: str
    parameters: str
    vocabulary: tuple[str, ...]
    robots: tuple[RobotSpec, ...]
    files: tuple[str, ...] = ()


class _Read(NamedTuple):
    """One file's data, file and line of each of its values by path, and the files it is made of."""

    file: str
    data: dict[str, Any]
    places: Places
    files: tuple[str, ...]


def read_fleet(path: str) -> FleetFile:
    """Read a fleet file and those it includes; raises InputError with file and line."""
    read = _with_includes(path, ())
    data = read.data
    policy = cast(Policy, {key: _policy(key, data[key]) for key in POLICY if key in data})
    naming = _naming(read, policy)
    robots = tuple(_robot(read, naming, at) for at in range(len(data["robots"])))
    _check_apart(robots)
    _check_world(read, naming)
    nodes, parameters = data.get("nodes", ""), data.get("parameters", "")
    vocabulary = tuple(_listed(data.get("vocabulary", [])))
    return FleetFile(
        path,
        policy,
        data.get("world", ""),
        data.get("distro", "jazzy"),
        nodes,
        parameters,
        vocabulary,
        robots,
        tuple(filter(None, (*read.files, nodes, parameters, *vocabulary))),
    )


def is_fleet(data: bytes) -> bool:
    """Is this a fleet file? Its robots are a list; those of a plan have their names as keys."""
    found = _ROBOTS.search(data)
    return found is not None and found[1][:1] in (b"-", b"[")


def _with_includes(path: str, above: tuple[str, ...]) -> _Read:
    real = os.path.realpath(path)
    if real in above:
        ring = " -> ".join(os.path.basename(it) for it in (*above, real))
        raise InputError(f"{path}: it includes itself ({ring}); leave one out")
    read = _read(path)
    for other in _listed(read.data.pop("include", [])):
        under = _with_includes(other, (*above, real))
        both = {**under.data, **read.data}, {**under.places, **read.places}
        read = _Read(path, *both, (*read.files, *under.files))
    if not above and "robots" not in read.data:
        raise InputError(f"{path}: there is no list of robots; write robots: with a name each")
    return read


def _read(path: str) -> _Read:
    # A file that is included may leave the robots to the one that includes it.
    wanted = {key: value for key, value in schema().items() if key != "required"}
    data, lines = read_fitting(path, wanted, "write robots: with a name each")
    places = {at: (path, line) for at, line in lines.items()}
    seen = _from(os.path.dirname(path), data)
    _check_files(seen, (), places)
    return _Read(path, seen, places, (path,))


def _check_files(data: Mapping[str, Any], at: Path, places: Places) -> None:
    """Every file that is named is there; what it holds is looked at later."""
    for key in (*PATHS, "companions", "robots"):
        value = data.get(key, ())
        if key == "robots":
            for number, robot in enumerate(value):
                _check_files(robot, ("robots", number), places)
            continue
        kinds = value.items() if key == "companions" and value else [("", value)]
        for kind, paths in kinds:
            here = (*at, key, kind) if kind else (*at, key)
            for path in (it for it in _listed(paths) if not os.path.isfile(it)):
                file, line = places[here]
                what = "a folder" if os.path.isdir(path) else "not there"
                raise InputError(f"{file}:{line}: {path} is {what}; name a file")


@cache
def schema() -> dict[str, Any]:
    """The published JSON Schema of fleet files, with the layouts that there are."""
    text = files("multibot_rewrite.fleets").joinpath(SCHEMA).read_text()
    result: dict[str, Any] = json.loads(text)
    names = [*(it.name for it in LAYOUTS), *(it.short for it in LAYOUTS)]
    result["properties"]["layout"]["enum"] = names
    return result


def _from(folder: str, data: dict[str, Any]) -> dict[str, Any]:
    """The data with every path seen from the working directory."""

    def seen(value: Any) -> Any:
        return os.path.join(folder, value) if isinstance(value, str) else [seen(it) for it in value]

    result = dict(data)
    for key in PATHS:
        if key in result:
            result[key] = seen(result[key])
    if "companions" in result:
        result["companions"] = {kind: seen(it) for kind, it in result["companions"].items()}
    if "robots" in result:
        result["robots"] = [_from(folder, robot) for robot in result["robots"]]
    return result


def _policy(key: str, value: Any) -> Any:
    return tuple(_listed(value)) if key in LISTS else value


def _listed(value: Any) -> Sequence[Any]:
    return [value] if isinstance(value, str) else value


def _naming(read: _Read, policy: Policy) -> Naming:
    try:
        return make_naming(**policy)
    except UsageError as error:
        # What the schema cannot say is about separators.
        file, line = read.places.get(("separators",), (read.file, 1))
        raise InputError(f"{file}:{line}: {error}") from None


def _check_world(read: _Read, naming: Naming) -> None:
    world = read.data.get("world", "")
    if world and world not in naming.shared_frames:
        file, line = read.places["world",]
        shared = ", ".join(sorted(naming.shared_frames)) or "none"
        hint = "put it into shared_frames"
        raise InputError(f"{file}:{line}: world {world!r} is no shared frame ({shared}); {hint}")


def _robot(read: _Read, naming: Naming, at: int) -> RobotSpec:
    data, own = read.data, read.data["robots"][at]
    file, line = read.places["robots", at]
    place, name = f"{file}:{line}", own["name"]
    description = own.get("description", data.get("description", ""))
    if not description:
        raise InputError(f"{place}: robot {name!r} has no description; name its URDF or xacro")
    companions = {**data.get("companions", {}), **own.get("companions", {})}
    stacks = tuple(_listed(own.get("stack", data.get("stack", []))))
    _check_stacks(read, at, stacks)
    return RobotSpec(
        name,
        description,
        own.get("srdf", data.get("srdf", "")),
        _arguments(data, own, description, place),
        own.get("namespace", name).strip("/"),
        _spelled(own, naming.affix, place),
        own.get("model", name),
        _pose(own, place),
        _colour(own, place),
        stacks,
        {kind: tuple(_listed(it)) for kind, it in companions.items()},
        file,
        line,
    )


def _check_stacks(read: _Read, at: int, stacks: tuple[str, ...]) -> None:
    try:
        facts_of(stacks, read.data.get("nodes") or None)
    except UsageError as error:
        own = ("robots", at, "stack")
        file, line = read.places[own if own in read.places else ("stack",)]
        raise InputError(f"{file}:{line}: {error}") from None


def _arguments(
    data: Mapping[str, Any], own: Mapping[str, Any], description: str, place: str
) -> dict[str, str]:
    """A robot's own xacro arguments over those of the fleet, which are for those that are xacro."""
    files = (description, own.get("srdf", data.get("srdf", "")))
    if not any(it.endswith(".xacro") for it in files):
        if own.get("arguments"):
            hint = "take them out, or name a file ….xacro"
            raise InputError(f"{place}: {own['name']!r} has arguments and no xacro; {hint}")
        return {}
    arguments = {**data.get("arguments", {}), **own.get("arguments", {})}
    return {key: _argument(value) for key, value in arguments.items()}


def _pose(own: Mapping[str, Any], place: str) -> Pose | None:
    if "pose" not in own:
        return None
    values = {key: float(value) for key, value in own["pose"].items()}
    for key, value in values.items():
        if not math.isfinite(value):
            raise InputError(f"{place}: {own['name']!r}: pose {key} is {value}; write a number")
    return Pose(**values)


def _colour(own: Mapping[str, Any], place: str) -> str | tuple[int, ...]:
    value = own.get("colour", "")
    colour = value if isinstance(value, str) else tuple(value)
    try:
        read_colour(colour) if colour else None
    except InputError as error:
        raise InputError(f"{place}: {own['name']!r}: {error}") from None
    return colour


def _argument(value: object) -> str:
    """As xacro takes it: YAML's true is xacro's true."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def _spelled(own: Mapping[str, Any], side: str, place: str) -> str:
    other = "postfix" if side == "prefix" else "prefix"
    if other in own:
        what = f"{own['name']!r} has a {other}, and the fleet's affix is {side}"
        raise InputError(f"{place}: {what}; write {side}:")
    return str(own.get(side, own["name"]))


def _check_apart(robots: Sequence[RobotSpec]) -> None:
    """No two robots of one name, namespace, spelling or model, nor at one place."""
    for what in ("name", "namespace", "spelled", "model", "pose"):
        seen: dict[object, RobotSpec] = {}
        for robot in robots:
            value = getattr(robot, what)
            first = seen.setdefault(value, robot) if value is not None else robot
            if first is robot:
                continue
            word = {"spelled": "prefix or postfix"}.get(what, what)
            shown = "the pose" if what == "pose" else f"the {word} {value!r}"
            both = f"{robot.name!r} has {shown} of {first.name!r} (line {first.line})"
            both = (
                f"{robot.name!r} is there twice, first at line {first.line}"
                if what == "name"
                else both
            )
            raise InputError(f"{robot.file}:{robot.line}: {both}; every robot needs its own")
