# SPDX-License-Identifier: Apache-2.0
"""What is known of an include: arguments without effect, and the simulator that it starts."""

from __future__ import annotations

import os
import re
import shlex
from collections.abc import Iterator
from contextlib import suppress
from typing import Any

from multibot_rewrite.producers.launch.describe import SIMULATOR, SIMULATORS, Visit, text
from multibot_rewrite.producers.launch.failures import missing_package
from multibot_rewrite.producers.launch.include_arguments import not_among, unread
from multibot_rewrite.producers.launch.kept_paths import lasting
from multibot_rewrite.producers.launch.records import LaunchedNode, UnreadArgument

# The launch files that start Gazebo and nothing else.
_SIMULATES = (
    *("gz_sim.launch.py", "gz_server.launch.py", "ign_gazebo.launch.py"),
    *("gazebo.launch.py", "gzserver.launch.py", "gzclient.launch.py"),
)
# Arguments of gz_sim.launch.py and of Classic's gazebo.launch.py with the world.
_WORLDS = ("gz_args", "ign_args", "world")
_SIM_WORDS = (*_WORLDS, "gz_version", "ign_version", "debugger", "on_exit_shutdown")
# What ros_gz_sim spawns with: its arguments, and the words of create that they are
# (ros_gz jazzy ros_gz_sim/launch/gz_spawn_model.launch.py).
_SPAWNS = ("gz_spawn_model.launch.py", "ros_gz_spawn_model.launch.py")
_SPAWN_WORDS = {
    **{it: f"-{it}" for it in ("world", "file", "topic", "x", "y", "z", "R", "P", "Y")},
    "entity_name": "-name",
    "model_string": "-string",
}
_LAUNCH_FILE = re.compile(r"\w+\.launch\.py")
_SHARE = re.compile(r"/share/([\w-]+)/")


def simulator(error: BaseException, include: Any, here: Visit) -> LaunchedNode | None:
    """The simulator of a package that is missing here, or whose launch file only a build makes: that it
    starts one is known without it, and with which words."""
    path = _path_of(include, here.context)
    of_path = _SHARE.search(path)
    package = missing_package(error) or (of_path[1] if of_path else "")
    # Before it is read, launch has the parts of the path (jazzy launch_description_source.py).
    name = (_LAUNCH_FILE.findall(path) or [""])[-1]
    spawns = name in _SPAWNS
    if package not in SIMULATORS or not (spawns or name in _SIMULATES):
        return None
    known = _SPAWN_WORDS if spawns else _SIM_WORDS
    for one, near in not_among(given_names(include, here.context), known, whole=spawns):
        here.unread.append(UnreadArgument(here.place, name, one, near))
    words = (_spawner_words if spawns else _simulator_words)(include, here.context)
    program = "create" if spawns else SIMULATOR
    kept = (*lasting(words),)
    return LaunchedNode(package, program, "", "/", (), (), "", kept, here.later, here.place)


def without_effect(include: Any, here: Visit) -> None:
    """Keep the arguments that the file of an include does not read."""
    path = _path_of(include, here.context)
    for name, near in unread(path, given_names(include, here.context)):
        here.unread.append(UnreadArgument(here.place, os.path.basename(path), name, near))


def given_names(include: Any, context: Any) -> list[str]:
    """The names of the arguments of an include, where they are known."""
    found = []
    for name, _ in include.launch_arguments or ():
        with suppress(Exception):
            found.append(text(name, context))
    return found


def _path_of(include: Any, context: Any) -> str:
    """The path of the file that is included; its last part where a package of it is missing."""
    with suppress(Exception):
        path: Any = include.launch_description_source.location
        with suppress(LookupError):
            return text(path, context)
        while not hasattr(path, "text") and not isinstance(path, str):
            path = [*getattr(path, "substitutions", path)][-1]
        return text(path, context)
    return ""


def _spawner_words(include: Any, context: Any) -> Iterator[str]:
    """The words of the program that gz_spawn_model.launch.py starts."""
    for name, value in include.launch_arguments:
        with suppress(Exception):
            word = _SPAWN_WORDS.get(text(name, context))
            yield from (word, text(value, context)) if word else ()


def _simulator_words(include: Any, context: Any) -> Iterator[str]:
    """The words of ``gz_args`` and ``world``, where they are known."""
    for name, value in include.launch_arguments:
        with suppress(Exception):
            if text(name, context) in _WORLDS:
                yield from shlex.split(text(value, context))
