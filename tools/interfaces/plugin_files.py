# SPDX-License-Identifier: Apache-2.0
"""Checkouts of simulator plugins and ros2_control hardware -> values for the plugin definitions.

Which libraries there are and what they are made of is in CMakeLists.txt, which classes in the
macros that register them; hardware classes are in the files that describe plugins.
"""

from __future__ import annotations

import re
from collections.abc import Container, Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.description.rewriters.plugin_definitions import Definitions, Value
from multibot_rewrite.description.rewriters.plugin_definitions.values import VALUE, read_values
from tools.interfaces.hardware_parameters import read_hardware
from tools.interfaces.helper_classes import by_prefix
from tools.interfaces.plugin_parameters import (
    ALL,
    ANY,
    Parameter,
    parameters_of,
    reads_any,
)

HEAD = "# What code reads and the plugin definitions lack: lines to be put in, or to correct them by.\n"
# The releases of a tag by how it begins, or of the folder that a checkout is in; in the order of time.
OF_RELEASES = (
    (("ignition-gazebo6", "humble"), ("humble",)),
    (("gz-sim8", "jazzy"), ("jazzy",)),
    (("gz-sim9", "kilted"), ("kilted",)),
    (("gz-sim10", "lyrical"), ("lyrical", "rolling")),
)
# What else a plugin reads, by what its code mentions: a file of the checkout, or a name.
ALSO_FILES = {
    "ICommsModel": "src/comms/ICommsModel.cc",
    "TrackedVehiclePlugin::Load(": "plugins/TrackedVehiclePlugin.cc",
    "FlashLightPlugin::Load(": "plugins/FlashLightPlugin.cc",
}
ALSO_NAMES = {"gazebo_ros::SensorFrameID(": "frame_name"}
_CAMERA = "gazebo_ros_camera_utils.cpp"
_HELPERS = "include/gazebo_plugins/gazebo_ros_utils.h"
# What plugins of several packages call, a block: its name, what calls it, its files.
SHARED = (
    ("ros", "gazebo_ros::Node::Get(", "gazebo_ros/src", ("node.cpp", "qos.cpp")),
    (
        "gazebo_ros_utils",
        "GazeboRosPtr",
        "gazebo_plugins",
        ("src/gazebo_ros_utils.cpp", _HELPERS),
    ),
    ("gazebo_ros_camera_utils", "GazeboRosCameraUtils", "gazebo_plugins/src", (_CAMERA,)),
)
ROS_1, BLOCK, HARDWARE = "ros1 ", "block ", "hardware "
# A package of ROS 1.
_CATKIN = "catkin_package("
_SYSTEM = re.compile(r"(?:gz|ign)_add_system\(\s*([\w-]+)([^)]*)\)")
_LIBRARY = re.compile(r"add_library\(\s*([\w${}-]+)\s+(?:SHARED |MODULE )?([^)]*)\)")
_INCLUDED = re.compile(r"^\s*#\s*include\s*[<\"]([\w./-]+)[>\"]", re.MULTILINE)
# A library for each word of a list.
_EACH = re.compile(r"foreach\s*\(\s*(\w+)\s+([^)]*)\)(.*?)endforeach", re.DOTALL)
_SET = re.compile(r"\bset\s*\(\s*(\w+)\s+([^)]*)\)")
_PROJECT = re.compile(r"^\s*project\(\s*([\w-]+)", re.MULTILINE)
_ALIAS = re.compile(r'ADD_PLUGIN_ALIAS\(\s*[\w:]+\s*,((?:\s*"[^"]+"\s*,?)+)\)')
_REGISTERED = re.compile(r"ADD_PLUGIN\(\s*([\w:]+::[\w:]+)")
_IS_PLUGIN = re.compile(r"Load\s*\(|ADD_PLUGIN")
_CODE = (".cc", ".cpp", ".hh", ".hpp", ".h")


class Plugin(NamedTuple):
    """A plugin of one tag: ``names`` are its library and classes, ``releases`` those of the tag."""

    names: tuple[str, ...]
    repository: str
    tag: str
    releases: tuple[str, ...]
    folder: str
    is_open: bool
    parameters: tuple[Parameter, ...]
    shared: tuple[str, ...] = ()


def new_values(folders: Iterable[Path], definitions: Definitions) -> str:
    """Sections of what the plugin definitions has not, or otherwise; raises UsageError for what is no
    checkout."""
    found: dict[str, list[Plugin]] = {}
    for folder in folders:
        for it in read_plugins(folder):
            found.setdefault(it.names[0], []).append(it)
    sections = (_section(found[name], definitions) for name in sorted(found))
    return "\n".join([HEAD, *("\n".join(it) + "\n" for it in sections if it)])


def read_plugins(folder: Path) -> Iterator[Plugin]:
    """Yield the plugins of a checkout that is called OWNER+REPOSITORY@TAG."""
    if not folder.is_dir() or "@" not in folder.name:
        raise UsageError(f"{folder}: not a folder called OWNER+REPOSITORY@TAG")
    repository, _, tag = folder.name.partition("@")
    repository, releases = repository.replace("+", "/"), _releases_of(folder, tag)
    for cmake in sorted(folder.rglob("CMakeLists.txt")):
        if "test" in cmake.relative_to(folder).parts:
            continue
        of_ros_1 = ROS_1 * (_CATKIN in cmake.read_text(encoding="utf-8", errors="replace"))
        for library, files in _libraries(cmake):
            plugin = _plugin(of_ros_1 + library, files, folder)
            if plugin:
                yield plugin._replace(repository=repository, tag=tag, releases=releases)
    for it in _shared(folder):
        yield it._replace(repository=repository, tag=tag, releases=releases)
    for class_, path, parameters in read_hardware(folder):
        names = (f"{HARDWARE}{class_}",)
        yield Plugin(names, repository, tag, releases, path, False, parameters)


def _releases_of(folder: Path, tag: str) -> tuple[str, ...]:
    """Those that have a checkout, in order; all where neither its tag nor its folder says it."""
    named = (tag, folder.absolute().parent.name)
    found = (ours for starts, ours in OF_RELEASES if any(it.startswith(starts) for it in named))
    return next(found, RELEASES)


def _libraries(cmake: Path) -> Iterator[tuple[str, list[Path]]]:
    """Yield the libraries of a CMakeLists.txt with their files."""
    text = _with_lists(cmake.read_text(encoding="utf-8", errors="replace"))
    project = (_PROJECT.findall(text) or [""])[0]
    systems = _SYSTEM.findall(text)
    for name, rest in systems:
        own = [cmake.parent / it for it in rest.split() if it.endswith(_CODE)]
        whole = sorted(it for it in cmake.parent.iterdir() if it.suffix in _CODE)
        yield f"gz-sim-{name}-system", whole if len(systems) == 1 else own
    for name, rest in _LIBRARY.findall(text):
        files = [cmake.parent / it for it in rest.split() if it.endswith(_CODE)]
        yield name.replace("${PROJECT_NAME}", project), files


def _with_lists(text: str) -> str:
    """Return a CMakeLists.txt with lists in place of their names, and with loops unrolled."""
    lists: dict[str, str] = {}
    for name, words in _SET.findall(text):
        lists[name] = words.replace(f"${{{name}}}", lists.get(name, ""))
    for name, words in lists.items():
        text = text.replace(f"${{{name}}}", words)
    for name, listed, body in _EACH.findall(text):
        text += "".join(body.replace(f"${{{name}}}", it) for it in listed.split())
    return text


def _headers(code: dict[str, str], folder: Path) -> dict[str, str]:
    """Return the headers of its own checkout that code includes."""
    found: dict[str, str] = {}
    for path, text in code.items():
        homes = [it for it in (folder / path).parents if it.is_relative_to(folder)]
        for name in _INCLUDED.findall(text):
            places = (home / below / name for home in homes for below in ("", "include"))
            header = next((it for it in places if it.is_file()), None)
            if header:
                key = header.relative_to(folder).as_posix()
                found[key] = header.read_text(encoding="utf-8", errors="replace")
    return found


def _plugin(library: str, files: list[Path], folder: Path) -> Plugin | None:
    texts = {
        it.relative_to(folder).as_posix(): it.read_text(encoding="utf-8", errors="replace")
        for it in files
        if it.exists() and "test" not in it.name.lower()
    }
    whole = "\n".join(texts.values())
    if not _IS_PLUGIN.search(whole) or any(it.endswith(_CAMERA) for it in texts):
        return None
    for word, path in ALSO_FILES.items():
        if word in whole and (folder / path).exists():
            texts[path] = (folder / path).read_text(encoding="utf-8")
    classes = [it.strip(' "\n') for names in _ALIAS.findall(whole) for it in names.split(",")]
    known = [it.replace("ignition::gazebo::", "gz::sim::") for it in classes if it]
    own = _REGISTERED.findall(whole)
    names = tuple(dict.fromkeys([library, *known, *own]))
    headers = _headers(texts, folder)
    headers |= _headers(headers, folder)
    parameters = _parameters(texts, headers)
    is_open = reads_any(whole) or any(it.name == ALL for it in parameters)
    where = files[0].parent.relative_to(folder).as_posix()
    shared = tuple(name for name, word, _, _ in SHARED if word in whole)
    rows = tuple(it for it in parameters if it.name != ALL)
    return Plugin(names, "", "", (), where, is_open, rows, shared)


def _parameters(code: dict[str, str], headers: dict[str, str]) -> tuple[Parameter, ...]:
    """Return what a plugin reads itself, what helpers read for it, and what its code mentions."""
    helped, prefixes = by_prefix(code, headers)
    own = parameters_of(code.items(), headers.values())
    known = {it.name: it for it in helped} | {it.name: it for it in own if it.name not in prefixes}
    for word, name in ALSO_NAMES.items():
        if any(word in text for text in code.values()):
            known.setdefault(name, Parameter(name, ANY, *_place(code, word)))
    return tuple(known[name] for name in sorted(known))


def _shared(folder: Path) -> Iterator[Plugin]:
    """Yield what plugins of several packages call, where this checkout has it."""
    for name, _, where, files in SHARED:
        paths = [folder / where / it for it in files]
        if all(it.exists() for it in paths):
            texts = ((it.relative_to(folder).as_posix(), it.read_text()) for it in paths)
            yield Plugin((f"{BLOCK}{name}",), "", "", (), where, False, parameters_of(texts))


def _place(texts: dict[str, str], word: str) -> tuple[str, int]:
    path, text = next((path, text) for path, text in texts.items() if word in text)
    return path, text.count("\n", 0, text.index(word)) + 1


def _section(plugins: list[Plugin], definitions: Definitions) -> list[str]:
    """Return a plugin over all its tags, each row as the newest tag that has it says it."""
    newest = plugins[-1]
    # A library that was renamed keeps the classes it was known by.
    names = list(dict.fromkeys(name for it in plugins for name in it.names))
    there = _together(it.releases for it in plugins)
    rows: dict[str, list[tuple[Plugin, Parameter]]] = {}
    for plugin in plugins:
        for it in plugin.parameters:
            rows.setdefault(it.name, []).append((plugin, it))
    made = [_row(rows[name], newest, there) for name in sorted(rows)]
    known = _known(names[0], definitions)
    new = [it for it in made if next(read_values("", 0, [it])) not in known]
    kind, _, own = names[0].rpartition(" ")
    head = [f"[{'block' if kind == 'block' else 'values'} {' '.join([own, *names[1:]])}]"]
    head += [f"read: {newest.repository} {newest.tag} {newest.folder}"]
    head += ["open: yes"] * any(it.is_open for it in plugins)
    head += [f"with: {' '.join(newest.shared)}"] * bool(newest.shared)
    head += ["ros: 1"] * (kind == "ros1")
    return [*head, *new] if new or (not made and not known) else []


def _known(name: str, definitions: Definitions) -> Container[Value]:
    """Return what the plugin definitions have, without what comes from elsewhere: units, ranges."""
    kind, _, own = name.rpartition(" ")
    found = definitions.values(own, kind == "ros1")
    return [
        it._replace(unit="", low=None, high=None, is_open=False, checked=it.place)
        for it in (found.rows.values() if found else ())
    ]


def _row(rows: list[tuple[Plugin, Parameter]], newest: Plugin, there: tuple[str, ...]) -> str:
    plugin, it = rows[-1]
    of_hardware = newest.names[0].startswith(HARDWARE)
    path = it.path.removeprefix(f"{plugin.folder}/")
    tag = f"@{plugin.tag}" * (plugin.tag != newest.tag)
    words = [f"param[@name={it.name}]" if of_hardware else it.name, VALUE, it.type]
    words += [f"read={path}:{it.line}{tag}"]
    words += _words(_together(one.releases for one, _ in rows), there)
    words += ["required=yes"] if it.required and all(one.required for _, one in rows) else []
    words += [f"one={'|'.join(it.words)}"] if it.words else []
    return " ".join(words)


def _together(releases: Iterable[tuple[str, ...]]) -> tuple[str, ...]:
    found = {it for some in releases for it in some}
    return tuple(it for it in RELEASES if it in found)


def _words(releases: tuple[str, ...], whole: tuple[str, ...]) -> list[str]:
    return [] if releases == whole else [f"releases={','.join(releases)}"]
