"""A fleet file with those it includes, or a dict -> checked data, with the place of each value."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from typing import Any

import yaml

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.naming import LAYOUTS
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.fleet.file.checked_yaml import CheckedYaml, read_checked, text_checked
from multibot_rewrite.fleet.file.fleet_paths import Places, check_files, listed, with_paths

SCHEMA = "fleet.schema.json"
EXAMPLE = "robots: [{name: robot1}, {name: robot2}]"
# What a dict is called where a file would be named.
DICT = "the fleet's dict"


class FleetData(NamedTuple):
    """One file's data, the file and line of each value by path, and the files that were read."""

    file: str
    data: dict[str, Any]
    places: Places
    files: tuple[str, ...]


def read_data(source: str | Mapping[str, Any]) -> FleetData:
    """The data of a fleet; paths in a dict are relative to the working directory. Raises InputError."""
    if isinstance(source, str):
        return _with_includes(_of_file(source), ())
    try:
        text = yaml.safe_dump(dict(source), sort_keys=False)
    except yaml.YAMLError as error:
        hint = "write texts, numbers, lists and dicts"
        raise InputError(f"{DICT}: {str(error).splitlines()[0]}; {hint}") from None
    checked = text_checked(text.encode(), DICT, _wanted(), f"write {EXAMPLE}")
    return _with_includes(_placed(DICT, "", checked)._replace(files=()), ())


def _with_includes(read: FleetData, above: tuple[str, ...]) -> FleetData:
    path, real = read.file, os.path.realpath(read.file)
    for other in listed(read.data.pop("include", [])):
        if os.path.realpath(other) in (*above, real):
            ring = " -> ".join(os.path.basename(it) for it in (*above, real, other))
            raise InputError(f"{other}: the file includes itself ({ring}); remove one include")
        under = _with_includes(_of_file(other), (*above, real))
        both = {**under.data, **read.data}, {**under.places, **read.places}
        read = FleetData(path, *both, (*read.files, *under.files))
    if not above and "robots" not in read.data:
        raise InputError(f"{path}: there are no robots; write {EXAMPLE}")
    return read


def _of_file(path: str) -> FleetData:
    return _placed(path, os.path.dirname(path), read_checked(path, _wanted(), f"write {EXAMPLE}"))


def _placed(path: str, folder: str, checked: CheckedYaml) -> FleetData:
    data, lines = checked
    places = {at: (path, line) for at, line in lines.items()}
    resolved = with_paths(folder, data)
    check_files(resolved, (), places)
    return FleetData(path, resolved, places, (path,))


def _wanted() -> dict[str, Any]:
    """The schema; an included file need not list robots."""
    return {key: value for key, value in schema().items() if key != "required"}


@cache
def schema() -> dict[str, Any]:
    """The published JSON Schema of fleet files, with the layouts and releases that there are."""
    text = files("multibot_rewrite.fleet").joinpath(SCHEMA).read_text()
    result: dict[str, Any] = json.loads(text)
    names = [*(it.name for it in LAYOUTS), *(it.short for it in LAYOUTS)]
    result["properties"]["layout"]["enum"] = names
    result["properties"]["distro"]["enum"] = list(RELEASES)
    return result
