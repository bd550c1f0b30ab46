# SPDX-License-Identifier: Apache-2.0
"""What is known of an include: the simulator that it starts, and arguments that nothing there reads.

launch hands on any argument (jazzy include_launch_description.py): one that nothing reads has no
effect, and nobody says so. By the text of the file: what it declares, and the names in quotes.
"""

from __future__ import annotations

import os
import re
import shlex
from collections.abc import Collection, Iterator, Mapping
from contextlib import suppress
from typing import Any

from multibot_rewrite.base.nearest import SLIP, differ_in_numbers, nearest
from multibot_rewrite.producers.launch.describe import (
    SIMULATOR,
    SIMULATORS,
    Visit,
    changed_environment,
    namespace_of,
    parameters,
    text,
)
from multibot_rewrite.producers.launch.failures import is_no_text, missing_package
from multibot_rewrite.producers.launch.kept_paths import GONE, lasting, read_text
from multibot_rewrite.producers.launch.records import LaunchedNode, LaunchInclude, UnreadArgument
from multibot_rewrite.producers.launch.source_packages import NOT_INSTALLED

_DECLARED = re.compile(
    r"""DeclareLaunchArgument\(\s*(?:name\s*=\s*)?["']([\w.-]+)["']|<arg\s[^<>]*\bname="([\w.-]+)\""""
    r"""|-\s*arg:\s*(?:\{\s*)?name:\s*["']?([\w.-]+)"""
)
# It may read any name: one that is made when it runs, or one for a file that it includes itself.
_ANY = re.compile(
    r"LaunchConfiguration\(\s*(?!name)[^\s\"']|launch_configurations|nclude|import \w*\."
)


def unread(file: str, given: Collection[str]) -> Iterator[tuple[str, str]]:
    """Yield each argument that the file does not read, with a declared one of a similar name."""
    if not os.path.isfile(file):
        return
    text = read_text(file)
    declared = arguments_declared(text)
    yield from not_among(given, declared, text, whole=bool(declared) and not _ANY.search(text))


def arguments_declared(text: str) -> set[str]:
    """Return the names of the arguments that the text of a launch file declares."""
    return {name for found in _DECLARED.findall(text) for name in found if name}


def not_among(
    given: Collection[str], declared: Collection[str], text: str = "", whole: bool = False
) -> Iterator[tuple[str, str]]:
    """Yield the undeclared arguments, with a near name; ``whole``: all declared ones are known."""
    for name in given:
        if name in declared or re.search(rf"[\"'({{ ]{re.escape(name)}[\"')}}]", text):
            continue
        near = nearest(name, sorted(declared), SLIP)
        # robot1_x and robot2_x are two things; what is given as it should be needs no other name.
        if not differ_in_numbers(near, name) if near else whole:
            yield name, "" if near in given else near


# The launch files that start Gazebo and nothing else.
_OF_GZ = ("gz_sim.launch.py", "ign_gazebo.launch.py")
_SIMULATES = (
    *(*_OF_GZ, "gz_server.launch.py"),
    *("gazebo.launch.py", "gzserver.launch.py", "gzclient.launch.py"),
)
# All arguments of gz_sim.launch.py, and those of it and of Classic's gazebo.launch.py with the world.
_GZ_WORDS = ("gz_args", "ign_args", "gz_version", "ign_version", "debugger", "on_exit_shutdown")
_WORLDS = ("gz_args", "ign_args", "world")
# What ros_gz_sim spawns with: its arguments, and the words of create that they are
# (ros_gz jazzy and ros2 ros_gz_sim/launch/gz_spawn_model.launch.py); the second starts a bridge, too.
_SPAWNS, _SPAWNS_BRIDGED = "gz_spawn_model.launch.py", "ros_gz_spawn_model.launch.py"
_SAME = ("world", "file", "string", "topic", "allow_renaming", "x", "y", "z", "R", "P", "Y")
_SPAWN_WORDS = {**{it: f"-{it}" for it in _SAME}, "entity_name": "-name", "model_string": "-string"}
_BRIDGE = "ros_gz_bridge", "bridge_node"
_LAUNCH_FILE = re.compile(r"(?<!\w)\w+\.launch\.py")
_SHARE = re.compile(r"/share/([\w-]+)/")


def simulator(error: BaseException, include: Any, here: Visit) -> list[LaunchedNode]:
    """Return the simulator that a missing launch file would start, with the known arguments."""
    path = path_of(include, here.context)
    # A launch file that is here may itself ask for that package, and be called as one of it.
    of_path = _SHARE.findall(path) or [""] * os.path.isfile(path)
    package = of_path[-1] if of_path else missing_package(error)
    # Before it is read, launch has the parts of the path (jazzy launch_description_source.py).
    name = (_LAUNCH_FILE.findall(path) or [""])[-1]
    spawns = name in (_SPAWNS, _SPAWNS_BRIDGED)
    if package not in SIMULATORS or not (spawns or name in _SIMULATES):
        return []
    words = given(include, here.context)
    known = _SPAWN_WORDS if spawns else _GZ_WORDS if name in _OF_GZ else _WORLDS
    for one, near in not_among(words, known, whole=name in (_SPAWNS, *_OF_GZ)):
        here.unread.append(UnreadArgument(here.place, name, one, near))
    kept = (*lasting((_spawner_words if spawns else _simulator_words)(words)),)
    program = "create" if spawns else SIMULATOR
    own = LaunchedNode(package, program, "", "/", (), (), "", kept, here.later, here.place)
    return [own, *(_bridge(words, here) if name == _SPAWNS_BRIDGED else ())]


def not_here(error: BaseException, include: Any, here: Visit) -> list[LaunchedNode]:
    """Return a launch file of a package that is missing here, with its arguments."""
    it, package = included(include, here), missing_package(error)
    if not package or not it.file.startswith(f"{package}/"):
        return []
    values = given(include, here.context, GONE).items()
    words = tuple(f"{name}:={value}" for name, value in values if value)
    names = package, it.file.removeprefix(f"{package}/"), "", namespace_of(None, here.context)
    environment = tuple(changed_environment(here).items())
    how = here.waits._replace(is_include=True)
    return [LaunchedNode(*names, (), (), "", words, here.later, here.place, environment, how)]


def _bridge(given: Mapping[str, str], here: Visit) -> Iterator[LaunchedNode]:
    """Yield the bridge that starts with a spawner (ros_gz jazzy ros_gz_bridge.launch.py)."""
    if path := given.get("config_file"):
        space = f"/{given.get('namespace', '').strip('/')}"
        rows = tuple(parameters({"config_file": path}, here))
        name = given.get("bridge_name", "")
        yield LaunchedNode(*_BRIDGE, name, space, (), rows, "", (), here.later, here.place)


def included(include: Any, here: Visit) -> LaunchInclude:
    """Return the file of an include, and its arguments."""
    file = path_of(include, here.context).rpartition(f"{NOT_INSTALLED}/share/")[2]
    return LaunchInclude(here.place, file, tuple(given(include, here.context).items()))


def unread_of(path: str, names: Collection[str], here: Visit) -> None:
    """Note which of these arguments a launch file does not read."""
    for name, near in unread(path, names):
        here.unread.append(UnreadArgument(here.place, os.path.basename(path), name, near))


def given(include: Any, context: Any, unknown: str = "") -> dict[str, str]:
    """Return an include's arguments and values (or ``unknown``); raises TypeError for no text."""
    found = {}
    for name, value in include.launch_arguments or ():
        # What only a run tells, or would fail in one for another reason, is passed over.
        try:
            key = text(name, context)
            found[key] = unknown
            found[key] = text(value, context)
        except Exception as error:
            if is_no_text(error):
                raise
    return found


def path_of(include: Any, context: Any) -> str:
    """Return the path of the included file; its last part if a package of it is missing."""
    with suppress(Exception):
        path: Any = include.launch_description_source.location
        with suppress(LookupError):
            return text(path, context)
        while not hasattr(path, "text") and not isinstance(path, str):
            path = [*getattr(path, "substitutions", path)][-1]
        return text(path, context)
    return ""


def _spawner_words(given: Mapping[str, str]) -> Iterator[str]:
    """Yield the arguments of the program that gz_spawn_model.launch.py starts."""
    for name, value in given.items():
        if value and name in _SPAWN_WORDS:
            yield from (_SPAWN_WORDS[name], value)


def _simulator_words(given: Mapping[str, str]) -> Iterator[str]:
    """Yield the words of ``gz_args`` and ``world``, where they are known."""
    for value in (given.get(it, "") for it in _WORLDS):
        with suppress(ValueError):
            yield from shlex.split(value)
