"""The paths in a fleet file: relative to its folder, and there."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.fleet.file.checked_yaml import Path
from multibot_rewrite.knowledge.nodl.lookup import NO_DOCUMENTS, find_interfaces

PATHS = ("include", "description", "simulated", "srdf", "nodes", "vocabulary")
Places = Mapping[Path, tuple[str, int]]


def check_files(data: Mapping[str, Any], at: Path, places: Places) -> None:
    """Check that every named file exists; its content is checked later."""
    for key in (*PATHS, "launch", "companions", "robots"):
        value = data.get(key, ())
        if key == "robots":
            for number, robot in enumerate(value):
                check_files(robot, ("robots", number), places)
            continue
        if key == "launch":
            value = [it.partition(" ")[0] for it in listed(value) if not _of_package(it)]
        kinds = value.items() if key == "companions" and value else [("", value)]
        for kind, paths in kinds:
            here = (*at, key, kind) if kind else (*at, key)
            for path in (it for it in listed(paths) if not os.path.isfile(it)):
                file, line = places[here]
                what = "is a folder, not a file" if os.path.isdir(path) else "does not exist"
                raise InputError(f"{file}:{line}: {path} {what}; correct the path")


def with_paths(folder: str, data: dict[str, Any]) -> dict[str, Any]:
    """The data with every path relative to the working directory."""

    def resolve(value: Any) -> Any:
        return (
            os.path.join(folder, value) if isinstance(value, str) else [resolve(it) for it in value]
        )

    result = dict(data)
    for key in PATHS:
        if key in result:
            result[key] = resolve(result[key])
    if result.get("nodl", NO_DOCUMENTS) != NO_DOCUMENTS:
        result["nodl"] = resolve(result["nodl"])
    if "launch_roots" in result:
        result["launch_roots"] = resolve(result["launch_roots"])
    if "launch" in result:
        result["launch"] = [_launch_path(folder, it) for it in listed(result["launch"])]
    if "companions" in result:
        result["companions"] = {kind: resolve(it) for kind, it in result["companions"].items()}
    if "robots" in result:
        result["robots"] = [with_paths(folder, robot) for robot in result["robots"]]
    return result


def _launch_path(folder: str, text: str) -> str:
    """What follows ``ros2 launch``, with the path of its file relative to the working directory."""
    if _of_package(text):
        return text
    file, blank, arguments = text.partition(" ")
    return f"{os.path.join(folder, file)}{blank}{arguments}"


def _of_package(text: str) -> bool:
    """Is it a package and the name of a file in it, not a path?"""
    words = text.split()
    return len(words) > 1 and not any("=" in it for it in words[:2])


def listed(value: Any) -> Sequence[Any]:
    """A list as it is, one word as a list."""
    return [value] if isinstance(value, str) else value


def nodl_files(nodl: Sequence[str], places: Places) -> list[str]:
    """The NoDL files that a fleet file names, those in its folders too; InputError with its line."""
    try:
        return list(find_interfaces(nodl).given.values())
    except UsageError as error:
        file, line = places["nodl",]
        raise InputError(f"{file}:{line}: {error}") from None
