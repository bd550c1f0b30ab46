"""The fleet file: YAML -> frozen records, or one line that says what is wrong and where."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache
from importlib.resources import files
from typing import Any, NamedTuple

import yaml

from multibot_rewrite.companions.yaml_text import line_of, pairs, read_yaml
from multibot_rewrite.model import InputError
from multibot_rewrite.sources import read_file

SCHEMA = "fleet.schema.json"
KINDS = ("params", "rviz", "moveit", "bridge", "behavior_trees", "lua")
LISTS = ("include", "stack", "vocabulary", "shared_frames", "shared_topics")
POLICY = ("layout", "affix", "topics", "groups", "separators", "shared_frames", "shared_topics")
_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
Path = tuple[Any, ...]
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
    vocabulary."""

    file: str
    policy: Mapping[str, Any]
    world: str
    distro: str
    nodes: str
    vocabulary: tuple[str, ...]
    robots: tuple[RobotSpec, ...]
    files: tuple[str, ...] = ()


class _Read(NamedTuple):
    """One file's data, the line of each of its values by path, and the files it is made of."""

    file: str
    data: dict[str, Any]
    lines: Mapping[Path, int]
    files: tuple[str, ...]


def read_fleet(path: str) -> FleetFile:
    """Read a fleet file and those it includes; raises InputError with file and line."""
    read = _with_includes(path, ())
    data = read.data
    policy = {key: _policy(key, data[key]) for key in POLICY if key in data}
    robots = tuple(_robot(read, policy, at) for at in range(len(data["robots"])))
    _check_apart(read, robots)
    nodes, vocabulary = data.get("nodes", ""), tuple(_listed(data.get("vocabulary", [])))
    return FleetFile(
        path,
        policy,
        data.get("world", ""),
        data.get("distro", "jazzy"),
        nodes,
        vocabulary,
        robots,
        tuple(filter(None, (*read.files, nodes, *vocabulary))),
    )


def is_fleet(data: bytes) -> bool:
    """Is this a fleet file? Its robots are a list; those of a plan have their names as keys."""
    found = _ROBOTS.search(data)
    return found is not None and found[1][:1] in (b"-", b"[")


def _with_includes(path: str, above: tuple[str, ...]) -> _Read:
    real = os.path.realpath(path)
    if real in above:
        raise InputError(
            f"{path}: it includes itself ({' -> '.join([*above, real])}); leave one out"
        )
    read = _read(path)
    for other in _listed(read.data.pop("include", [])):
        under = _with_includes(other, (*above, real))
        both = {**under.data, **read.data}, {**under.lines, **read.lines}
        read = _Read(path, *both, (*read.files, *under.files))
    if not above and "robots" not in read.data:
        raise InputError(f"{path}: there is no list of robots; write robots: with a name each")
    return read


def _read(path: str) -> _Read:
    document = read_yaml(read_file(path), path)
    if document.root is None:
        raise InputError(f"{path}: the fleet file is empty; write robots: with a name each")
    lines = dict(_lines(document.root, path, ()))
    data = yaml.load(document.text, Loader=_LOADER)
    _validate(data, path, lines)
    return _Read(path, _from(os.path.dirname(path), data), lines, (path,))


def _lines(node: yaml.Node, file: str, path: Path) -> Iterator[tuple[Path, int]]:
    """The line of every value and key; a key that is there twice is an error."""
    yield path, line_of(node)
    if isinstance(node, yaml.SequenceNode):
        for at, item in enumerate(node.value):
            yield from _lines(item, file, (*path, at))
    seen: dict[str, int] = {}
    for key, value in pairs(node):
        first = seen.setdefault(key.value, line_of(key))
        if key.value in seen and first != line_of(key):
            place = f"{file}:{line_of(key)}"
            raise InputError(f"{place}: {key.value!r} is there twice, first at line {first}")
        for below, line in _lines(value, file, (*path, key.value)):
            yield below, line_of(key) if below == (*path, key.value) else line


@cache
def schema() -> dict[str, Any]:
    """The published JSON Schema of fleet files."""
    text = files("multibot_rewrite.fleets").joinpath(SCHEMA).read_text()
    return dict(json.loads(text))


def _validate(data: object, file: str, lines: Mapping[Path, int]) -> None:
    from jsonschema import Draft202012Validator
    from jsonschema.exceptions import best_match

    wanted = schema()
    # A file that is included may leave the robots to the one that includes it.
    checked = {key: value for key, value in wanted.items() if key != "required"}
    error = best_match(Draft202012Validator(checked).iter_errors(data))
    if error is None:
        return
    path = tuple(error.absolute_path)
    line = next(lines[path[:end]] for end in range(len(path), -1, -1) if path[:end] in lines)
    if error.validator == "additionalProperties" and isinstance(error.instance, dict):
        unknown = next(key for key in error.instance if key not in error.schema["properties"])
        line = lines.get((*path, unknown), line)
    raise InputError(f"{file}:{line}: {_said(error, path)}")


def _said(error: Any, path: Path) -> str:
    """A validation error in words, with what is allowed."""
    where = _where(path)
    if error.validator == "additionalProperties":
        known = error.schema["properties"]
        unknown = next(key for key in error.instance if key not in known)
        return f"{where}unknown key {unknown!r}{_nearest(str(unknown), known)}"
    if error.validator == "required":
        missing = next(key for key in error.validator_value if key not in error.instance)
        return f"{where}the key {missing!r} is missing"
    if error.validator == "enum":
        allowed = ", ".join(map(str, error.validator_value))
        near = _nearest(str(error.instance), error.validator_value)
        return f"{where}{error.instance!r} is not known{near}; use one of {allowed}"
    if error.validator == "pattern":
        return f"{where}{error.instance!r} is no name: {error.schema.get('description', '')}"
    if error.validator == "type" and isinstance(error.instance, int | float | bool):
        return f"{where}{error.instance!r} is no {error.validator_value}; write it in quotes"
    about = error.schema.get("description") or error.message
    return f"{where}{error.instance!r} does not fit: {about}"


def _where(path: Path) -> str:
    text = "".join(f"[{it}]" if isinstance(it, int) else f".{it}" for it in path).lstrip(".")
    return f"{text}: " if text else ""


def _nearest(word: str, known: Iterable[str]) -> str:
    from difflib import get_close_matches

    near = get_close_matches(word, list(map(str, known)), 1, 0.5)
    return f", did you mean {near[0]!r}?" if near else f"; known are {', '.join(known)}"


def _from(folder: str, data: dict[str, Any]) -> dict[str, Any]:
    """The data with every path seen from the working directory."""

    def seen(value: Any) -> Any:
        return os.path.join(folder, value) if isinstance(value, str) else [seen(it) for it in value]

    result = dict(data)
    for key in ("include", "description", "srdf", "nodes", "vocabulary"):
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


def _robot(read: _Read, policy: Mapping[str, Any], at: int) -> RobotSpec:
    data, own = read.data, read.data["robots"][at]
    line = read.lines.get(("robots", at), 1)
    place, name = f"{read.file}:{line}", own["name"]
    description = own.get("description", data.get("description", ""))
    if not description:
        raise InputError(f"{place}: robot {name!r} has no description; name its URDF or xacro")
    arguments = {**data.get("arguments", {}), **own.get("arguments", {})}
    companions = {**data.get("companions", {}), **own.get("companions", {})}
    return RobotSpec(
        name,
        description,
        own.get("srdf", data.get("srdf", "")),
        {key: _argument(value) for key, value in arguments.items()},
        own.get("namespace", name).strip("/"),
        _spelled(own, policy.get("affix", "postfix"), place),
        own.get("model", name),
        Pose(**{key: float(value) for key, value in own["pose"].items()})
        if "pose" in own
        else None,
        _colour(own.get("colour", "")),
        tuple(_listed(own.get("stack", data.get("stack", [])))),
        {kind: tuple(_listed(it)) for kind, it in companions.items()},
        read.file,
        line,
    )


def _colour(value: str | list[int]) -> str | tuple[int, ...]:
    return value if isinstance(value, str) else tuple(value)


def _argument(value: object) -> str:
    """As xacro takes it: YAML's true is xacro's true."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def _spelled(own: Mapping[str, Any], side: str, place: str) -> str:
    other = "postfix" if side == "prefix" else "prefix"
    if other in own:
        raise InputError(f"{place}: {own['name']!r} has a {other}, and the fleet's affix is {side}")
    return str(own.get(side, own["name"]))


def _check_apart(read: _Read, robots: Sequence[RobotSpec]) -> None:
    """No two robots of one name, namespace, spelling or model, nor at one place."""
    for what in ("name", "namespace", "spelled", "model", "pose"):
        seen: dict[object, RobotSpec] = {}
        for robot in robots:
            value = getattr(robot, what)
            first = seen.setdefault(value, robot) if value is not None else robot
            if first is not robot:
                shown = "the same pose" if what == "pose" else f"the {what} {value!r}"
                both = f"{first.name!r} (line {first.line}) and {robot.name!r} have {shown}"
                raise InputError(f"{robot.file}:{robot.line}: {both}; every robot needs its own")
