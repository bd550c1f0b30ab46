# SPDX-License-Identifier: Apache-2.0
"""The repositories of ``bringups.tsv``, and which launch files of a checkout may be its bringup."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import NamedTuple

import yaml

from tools.bringups.running import Ran

LIST = Path(__file__).parents[1] / "bringups.tsv"
# What starts a description's publisher, or puts the robot into a simulator.
_STARTS = re.compile(
    r"robot_state_publisher|spawn_entity|ros_gz_sim|ros_ign_gazebo|controller_manager"
)
# What puts the description of a file into a simulator.
_PLACE = ("create", "spawn_entity.py", "gz_spawn_model")
_NAMES = re.compile(r"[\w.-]+(?:\.launch\.py|\.launch\.xml|\.launch\.yaml|_launch\.py|\.py|\.xml)")


class Choice(NamedTuple):
    """A repository with its bringup: the launch file, its arguments, and the part of the list."""

    name: str
    half: str
    release: str
    file: str
    arguments: tuple[str, ...]


def chosen(path: Path = LIST) -> list[Choice]:
    """Return the repositories of the list."""
    rows = [it.split("\t") for it in path.read_text().splitlines() if not it.startswith("#")]
    return [
        Choice(name, half, release, *_words(file)) for name, half, release, file, *_ in rows[1:]
    ]


def _words(text: str) -> tuple[str, tuple[str, ...]]:
    file, *arguments = text.split(" ")
    return file, tuple(arguments)


def launch_files(folder: Path) -> Iterator[str]:
    """Return the launch files that no other includes and that start a robot, if by an include."""
    files = [
        it
        for it in sorted(folder.rglob("*"))
        if it.is_file()
        and re.search(r"launch", it.name if it.suffix != ".py" else str(it))
        and it.suffix in (".py", ".xml", ".yaml")
        and "test" not in it.name
    ]
    texts = {it: it.read_text(errors="replace") for it in files}
    texts = {it: text for it, text in texts.items() if "launch" in text}
    names = {it: set(_NAMES.findall(text)) for it, text in texts.items()}
    for file in texts:
        others = (names[it] for it in texts if it != file)
        if any(file.name in it for it in others):
            continue
        whole, more = {file}, [file]
        while more:
            one = more.pop()
            inside = [it for it in texts if it.name in names[one] and it not in whole]
            whole.update(inside)
            more += inside
        if any(_STARTS.search(texts[it]) for it in whole):
            yield str(file.relative_to(folder))


def released(file: Path) -> set[str]:
    """Return the names of the packages of a ``distribution.yaml``."""
    found: set[str] = set()
    for name, row in yaml.safe_load(file.read_text())["repositories"].items():
        if release := row.get("release"):
            found.update(release.get("packages", [name]))
    return found


def unfit(checkout: Path) -> str:
    """Return why a checkout has no bringup by its files, or nothing."""
    files = [it for it in checkout.rglob("*") if it.is_file()]
    if not any(
        "ament" in it.read_text(errors="replace") for it in files if it.name == "package.xml"
    ):
        return "no package of ament"
    if not any(it.suffix in (".urdf", ".xacro", ".sdf") for it in files):
        return "no description"
    return "" if any(launch_files(checkout)) else "no launch file of it starts a robot"


def unstarted(bringup: Ran) -> str:
    """Return why what a launch file starts is no bringup, or nothing."""
    if bringup.fault:
        return f"it does not start: {bringup.fault}"
    if len(bringup.processes) < 3:
        return "fewer than three processes"
    for it in bringup.processes:
        text = str(it.parameters.get("robot_description", ""))
        if it.program == "robot_state_publisher" and not _is_expanded(text):
            return "a description that xacro does not expand"
    return ""


def unread(bringup: Ran, known: Collection[str]) -> str:
    """Return which files of a bringup cannot be read: of no known package, or of no robot."""
    absent = {it.package for it in bringup.processes if it.kind == "include"} - set(known)
    if absent:
        return f"includes of {', '.join(sorted(absent))}, in no release"
    texts = [str(it.parameters.get("robot_description", "")) for it in bringup.processes]
    words = (Path(word) for it in bringup.processes if it.program in _PLACE for word in it.words)
    texts += [it.read_text(errors="replace") for it in words if it.is_absolute() and it.is_file()]
    return "" if any(_is_expanded(it) and "<joint" in it for it in texts) else "no robot of its own"


def _is_expanded(text: str) -> bool:
    return re.search(r"<(?:robot|model)\b", text) is not None and not re.search(
        r"not_expanded|not_made", text
    )
