# SPDX-License-Identifier: Apache-2.0
"""Reads a fleet file with its includes, or a dict, as checked data with places of values.

Paths are relative to the file's folder, and must exist."""

import json
import os
import re
import shlex
from collections.abc import Mapping, Sequence
from contextlib import suppress
from functools import cache
from io import StringIO
from typing import Any, NamedTuple, TypeAlias

import yaml

from multibot_rewrite import fleet
from multibot_rewrite.base.bounded import own_text
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.base.naming import LAYOUTS
from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.description.sources.own_names import filled
from multibot_rewrite.description.sources.read import BESIDE, is_xacro, read_file
from multibot_rewrite.fleet.file.checked_yaml import Path, text_checked
from multibot_rewrite.knowledge.nodl.lookup import NO_DOCUMENTS, find_interfaces

PATHS = (
    *("include", "description", "simulated", "srdf", "rviz", "nodes", "definitions"),
    "simulator_world",
)
# The parts of a robot.
JOIN = "join"
Places = Mapping[Path, tuple[str, int]]


def check_files(data: Mapping[str, Any], at: Path, places: Places) -> None:
    """Raise InputError, with line and remedy, for a named file that does not exist."""
    for key in (*PATHS, *BESIDE, "launch", "related_files", "robots", JOIN):
        value = data.get(key, ())
        if key in ("robots", JOIN):
            for number, inner in enumerate(value):
                check_files(inner, (*at, key, number), places)
            continue
        if key == "launch":
            value = [_file_and_rest(it)[0] for it in listed(value) if not _of_package(it)]
        kinds = value.items() if key == "related_files" and value else [("", value)]
        for kind, paths in kinds:
            here = (*at, key, kind) if kind else (*at, key)
            words = (it for it in listed(paths) if isinstance(it, str))
            for path in (it for it in words if not os.path.isfile(it)):
                file, line = places[here]
                what = "is no file" if os.path.lexists(path) else "does not exist"
                what = "is a folder, not a file" if os.path.isdir(path) else what
                raise InputError(f"{file}:{line}: {path} {what}; correct the path")


def texts_of(values: Sequence[Any], file: str) -> dict[str, str]:
    """Return the texts of parameters written in the fleet file itself, by the path that each gets."""
    given = [it for it in values if not isinstance(it, str)]
    paths = (os.path.join(file, f"values{at or ''}.yaml") for at in range(len(given)))
    full = ({node: {"ros__parameters": own} for node, own in it.items()} for it in given)
    return {path: yaml.safe_dump(it, sort_keys=False) for path, it in zip(paths, full, strict=True)}


def with_paths(folder: str, data: dict[str, Any]) -> dict[str, Any]:
    """Return the data with every path relative to the working directory."""

    def resolve(value: Any) -> Any:
        """Return a path from the working directory; of a list each of its paths."""
        if isinstance(value, str):
            return _joined(folder, value)
        return value if isinstance(value, dict) else [resolve(it) for it in value]

    result = dict(data)
    for key in (*PATHS, *BESIDE, "launch_roots"):
        if key in result:
            result[key] = resolve(result[key])
    if result.get("nodl", NO_DOCUMENTS) != NO_DOCUMENTS:
        result["nodl"] = resolve(result["nodl"])
    if "launch" in result:
        # What follows ``ros2 launch``: a path of its file, or a package.
        launch = []
        for text in listed(result["launch"]):
            file, rest = _file_and_rest(text)
            path = f"{shlex.quote(_joined(folder, file))} {rest}".rstrip()
            launch.append(text if _of_package(text) else path)
        result["launch"] = launch
    if "related_files" in result:
        kinds = result["related_files"].items()
        result["related_files"] = {kind: resolve(it) for kind, it in kinds}
    for key in ("robots", JOIN):
        if key in result:
            result[key] = [with_paths(folder, inner) for inner in result[key]]
    return result


def _file_and_rest(text: str) -> tuple[str, str]:
    """Return (file, rest) of arguments for ``ros2 launch``, split as a shell does."""
    rest = StringIO(text)
    words = shlex.shlex(rest, posix=True)
    words.whitespace_split, words.commenters = True, ""
    with suppress(ValueError):  # it is told where the arguments are read
        return words.get_token() or "", rest.read()
    file, _, more = text.partition(" ")
    return file, more


def _joined(folder: str, path: str) -> str:
    """Return a path below a folder, normalized unless a link would change its meaning."""
    found = os.path.join(folder, path)
    short = os.path.normpath(found) if os.pardir in found else found
    return short if os.path.realpath(short) == os.path.realpath(found) else found


def _of_package(text: str) -> bool:
    """Return whether a text is ``PACKAGE FILE``, not a path."""
    package, rest = _file_and_rest(text)
    file = next(iter(rest.split()), "")
    return bool(file) and "=" not in package + file


def listed(value: Any) -> Sequence[Any]:
    """Return a list as it is, a single value as a list."""
    return [value] if isinstance(value, str) else value


def nodl_files(nodl: Sequence[str], places: Places) -> list[str]:
    """Return the NoDL files that a fleet file names, also by folder; raises InputError with a line."""
    try:
        return list(find_interfaces(nodl).given.values())
    except UsageError as error:
        file, line = places["nodl",]
        raise InputError(f"{file}:{line}: {error}") from None


SCHEMA = "fleet.schema.json"
EXAMPLE = "robots: [{name: robot1}, {name: robot2}]"
# What a dict is called where a file would be named.
DICT = "the fleet's dict as YAML"


class FleetText(NamedTuple):
    """The text of a fleet file that is not written yet, and the path that it will have."""

    path: str
    text: str


FleetSource: TypeAlias = str | Mapping[str, Any] | FleetText


def without_place(message: str, file: str = DICT) -> str:
    """Return a message about data that is in no file yet, without its place."""
    return re.sub(rf"^{re.escape(file)}(:\d+)*: ", "", message)


class FleetData(NamedTuple):
    """One file's data, the file and line of each value by path, and the files that were read."""

    file: str
    data: dict[str, Any]
    places: Places
    files: tuple[str, ...]


class _Dumper(yaml.SafeDumper):
    """Writes out what several keys share: a fleet file may have no alias."""

    def ignore_aliases(self, data: Any) -> bool:
        """Return whether a value is written out again; all are."""
        return True


def fleet_yaml(value: Any, **options: Any) -> str:
    """Return a value as fleet file text; raises YAMLError, or RecursionError if it holds itself."""
    return str(yaml.dump(value, Dumper=_Dumper, sort_keys=False, **options))


def read_data(source: FleetSource) -> FleetData:
    """Return the data of a fleet; in a dict paths are from the working directory. Raises InputError."""
    if isinstance(source, str):
        return _with_includes(_placed(source, read_file(source)), ())
    hint = "write texts, numbers, lists and dicts"
    try:
        path, text = source if isinstance(source, FleetText) else (DICT, fleet_yaml(dict(source)))
    except yaml.YAMLError as error:
        raise InputError(f"{DICT}: {str(error).splitlines()[0]}; {hint}") from None
    except RecursionError:
        raise InputError(f"{DICT}: a value holds itself; {hint}") from None
    return _with_includes(_placed(path, text.encode())._replace(files=()), ())


def _with_includes(read: FleetData, above: tuple[str, ...]) -> FleetData:
    """Return the data of a fleet file with that of all files it includes; its own values count."""
    path, real = read.file, os.path.realpath(read.file)
    for other in listed(read.data.pop("include", [])):
        if os.path.realpath(other) in (*above, real):
            ring = " -> ".join(os.path.basename(it) for it in (*above, real, other))
            raise InputError(f"{other}: the file includes itself ({ring}); remove one include")
        under = _with_includes(_placed(other, read_file(other)), (*above, real))
        both = {**under.data, **read.data}, {**under.places, **read.places}
        read = FleetData(path, *both, (*read.files, *under.files))
    if not above and "robots" not in read.data:
        raise InputError(f"{path}: there are no robots; write {EXAMPLE}")
    return read


def _placed(path: str, text: bytes) -> FleetData:
    """Return the checked data of a file; an included file need not have the keys that are required."""
    known = {key: value for key, value in schema().items() if key != "required"}
    data, lines = text_checked(text, path, known, f"write {EXAMPLE}")
    places = {at: (path, line) for at, line in lines.items()}
    resolved = with_paths(os.path.dirname(path), data)
    check_files(resolved, (), places)
    return FleetData(path, resolved, places, (path,))


@cache
def schema() -> dict[str, Any]:
    """Return the published JSON Schema of fleet files, with the existing layouts and releases."""
    result: dict[str, Any] = json.loads(own_text(fleet.__file__, SCHEMA))
    names = [*(it.name for it in LAYOUTS), *(it.short for it in LAYOUTS)]
    result["properties"]["layout"]["enum"] = names
    result["properties"]["distro"]["enum"] = list(RELEASES)
    return result


def given_arguments(
    data: Mapping[str, Any], own: Mapping[str, Any], described: Sequence[str], place: str
) -> dict[str, str]:
    """Return a robot's xacro arguments and the fleet's; raises InputError without a xacro."""
    files = (*described, *(own.get(it, data.get(it, "")) for it in ("srdf", "simulated")))
    if not any(is_xacro(it) for it in files):
        if own.get("arguments"):
            hint = "remove them, or give a xacro"
            raise InputError(f"{place}: {own['name']!r} has arguments but no xacro file; {hint}")
        return {}
    arguments = {**data.get("arguments", {}), **own.get("arguments", {})}
    # YAML's true is xacro's true.
    texts = {k: str(it).lower() if isinstance(it, bool) else str(it) for k, it in arguments.items()}
    try:
        filled(texts, own["name"])
    except UsageError as error:
        raise InputError(f"{place}: {own['name']!r}: {error}") from None
    return texts
