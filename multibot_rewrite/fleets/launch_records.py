"""What a fleet's launch file starts, whichever form it is written in."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple


class File(NamedTuple):
    """The path of a file of the build."""

    path: str


class Text(NamedTuple):
    """What a file of the build holds."""

    path: str


Value = str | int | float | bool | File | Text | list[str]


class Component(NamedTuple):
    """A node that is loaded into the process of another."""

    package: str
    plugin: str
    namespace: str
    name: str
    parameters: tuple[File | Mapping[str, Any], ...]
    remappings: tuple[tuple[str, str], ...]


class Start(NamedTuple):
    """A process: its program, its node's name and namespace (empty for those of its code), and what it
    is given. ``components`` are loaded into it."""

    package: str
    executable: str
    namespace: str = ""
    name: str = ""
    parameters: tuple[File | Mapping[str, Any], ...] = ()
    remappings: tuple[tuple[str, str], ...] = ()
    arguments: tuple[str | File, ...] = ()
    components: tuple[Component, ...] = ()


class RobotStarts(NamedTuple):
    """What one robot runs; ``files`` are its parameter files, ``spawned`` is what brings it into the
    simulator, ``left`` are nodes that are not started, each with the reason; ``commands`` are
    lines of a shell that run beside."""

    name: str
    about: str
    files: tuple[str, ...]
    starts: tuple[Start, ...]
    spawned: tuple[Start, ...]
    left: tuple[tuple[str, str], ...]
    commands: tuple[str, ...] = ()
