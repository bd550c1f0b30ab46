"""The files that a fleet file names: where they are, and that they are there."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

from multibot_rewrite.fleets.checked_yaml import Path
from multibot_rewrite.model import InputError

PATHS = ("include", "description", "srdf", "nodes", "parameters", "vocabulary")
Places = Mapping[Path, tuple[str, int]]


def check_files(data: Mapping[str, Any], at: Path, places: Places) -> None:
    """Check that every named file exists; its content is checked later."""
    for key in (*PATHS, "companions", "robots"):
        value = data.get(key, ())
        if key == "robots":
            for number, robot in enumerate(value):
                check_files(robot, ("robots", number), places)
            continue
        kinds = value.items() if key == "companions" and value else [("", value)]
        for kind, paths in kinds:
            here = (*at, key, kind) if kind else (*at, key)
            for path in (it for it in listed(paths) if not os.path.isfile(it)):
                file, line = places[here]
                what = "is a folder, not a file" if os.path.isdir(path) else "does not exist"
                raise InputError(f"{file}:{line}: {path} {what}; correct the path")


def below(folder: str, data: dict[str, Any]) -> dict[str, Any]:
    """The data with every path relative to the working directory."""

    def resolve(value: Any) -> Any:
        return (
            os.path.join(folder, value) if isinstance(value, str) else [resolve(it) for it in value]
        )

    result = dict(data)
    for key in PATHS:
        if key in result:
            result[key] = resolve(result[key])
    if "companions" in result:
        result["companions"] = {kind: resolve(it) for kind, it in result["companions"].items()}
    if "robots" in result:
        result["robots"] = [below(folder, robot) for robot in result["robots"]]
    return result


def listed(value: Any) -> Sequence[Any]:
    """A list, or the one word that stands for a list of it."""
    return [value] if isinstance(value, str) else value
