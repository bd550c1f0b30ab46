# SPDX-License-Identifier: Apache-2.0
"""The repositories of ``bringups.tsv``, and which launch files of a checkout may be its bringup."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

LIST = Path(__file__).parents[1] / "bringups.tsv"
# What starts a description's publisher, or puts the robot into a simulator.
_STARTS = re.compile(
    r"robot_state_publisher|spawn_entity|ros_gz_sim|ros_ign_gazebo|controller_manager"
)
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
