"""Checkouts of simulator plugins and ros2_control hardware -> ``rules/schema/plugins.schema``.

Which libraries there are and what they are made of is in CMakeLists.txt, which classes in the
macros that register them; hardware classes are in the files that describe plugins.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.base.releases import RELEASES
from tools.interfaces.hardware_parameters import read_hardware
from tools.interfaces.helper_classes import by_prefix
from tools.interfaces.plugin_parameters import (
    ALL,
    ANY,
    Parameter,
    parameters_of,
    reads_any,
)

HEAD = """\
# Parameters that plugins of simulators and ros2_control hardware read. Made by
# python -m tools.interfaces --plugins FOLDER... >
# multibot_rewrite/rules/schema/plugins.schema
#
#   [NAME...] REPOSITORY TAG FOLDER [open] [+SECTION] [releases=WORDS]
#                                               a plugin by its library and classes,
#                                               "ros1 LIBRARY" or "hardware CLASS"; open: it takes any
#                                               other parameter too; +: all of that section as well
#   NAME TYPE FILE:LINE [TAG] [releases=WORDS] [required] [one:A|B] [=DEFAULT]
#                                               TAG where it is another one than the section's; a/b: in
#                                               <a>; a/*: whatever <a> has
"""
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
# What plugins of several packages call, a section of its own: name, what calls it, its files.
SHARED = (
    ("gazebo_ros::Node", "gazebo_ros::Node::Get(", "gazebo_ros/src", ("node.cpp", "qos.cpp")),
    ("GazeboRos", "GazeboRosPtr", "gazebo_plugins", ("src/gazebo_ros_utils.cpp", _HELPERS)),
    ("Camera", "GazeboRosCameraUtils", "gazebo_plugins/src", (_CAMERA,)),
)
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


def to_schema(folders: Iterable[Path]) -> str:
    """The text of ``plugins.schema``; raises UsageError for what is no checkout."""
    found: dict[str, list[Plugin]] = {}
    for folder in folders:
        for it in read_plugins(folder):
            found.setdefault(it.names[0], []).append(it)
    sections = (_section(found[name]) for name in sorted(found))
    return "\n".join([HEAD, *("\n".join(it) + "\n" for it in sections)])


def read_plugins(folder: Path) -> Iterator[Plugin]:
    """The plugins of a checkout that is called OWNER+REPOSITORY@TAG."""
    if not folder.is_dir() or "@" not in folder.name:
        raise UsageError(f"{folder}: not a folder called OWNER+REPOSITORY@TAG")
    repository, _, tag = folder.name.partition("@")
    repository, releases = repository.replace("+", "/"), _releases_of(folder, tag)
    for cmake in sorted(folder.rglob("CMakeLists.txt")):
        if "test" in cmake.relative_to(folder).parts:
            continue
        of_ros_1 = "ros1 " * (_CATKIN in cmake.read_text(encoding="utf-8", errors="replace"))
        for library, files in _libraries(cmake):
            plugin = _plugin(of_ros_1 + library, files, folder)
            if plugin:
                yield plugin._replace(repository=repository, tag=tag, releases=releases)
    for it in _shared(folder):
        yield it._replace(repository=repository, tag=tag, releases=releases)
    for class_, path, parameters in read_hardware(folder):
        names = (f"hardware {class_}",)
        yield Plugin(names, repository, tag, releases, path, False, parameters)


def _releases_of(folder: Path, tag: str) -> tuple[str, ...]:
    """Those that have a checkout, in order; all where neither its tag nor its folder says it."""
    named = (tag, folder.absolute().parent.name)
    found = (ours for starts, ours in OF_RELEASES if any(it.startswith(starts) for it in named))
    return next(found, RELEASES)


def _libraries(cmake: Path) -> Iterator[tuple[str, list[Path]]]:
    """The libraries of a CMakeLists.txt with their files."""
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
    """A CMakeLists.txt with its lists in place of their names, and what is done for each of them."""
    lists: dict[str, str] = {}
    for name, words in _SET.findall(text):
        lists[name] = words.replace(f"${{{name}}}", lists.get(name, ""))
    for name, words in lists.items():
        text = text.replace(f"${{{name}}}", words)
    for name, listed, body in _EACH.findall(text):
        text += "".join(body.replace(f"${{{name}}}", it) for it in listed.split())
    return text


def _headers(code: dict[str, str], folder: Path) -> dict[str, str]:
    """The headers of its own checkout that code includes."""
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
    """What a plugin reads itself, what helpers read for it, and what its code mentions."""
    helped, prefixes = by_prefix(code, headers)
    own = parameters_of(code.items(), headers.values())
    known = {it.name: it for it in helped} | {it.name: it for it in own if it.name not in prefixes}
    for word, name in ALSO_NAMES.items():
        if any(word in text for text in code.values()):
            known.setdefault(name, Parameter(name, ANY, *_place(code, word)))
    return tuple(known[name] for name in sorted(known))


def _shared(folder: Path) -> Iterator[Plugin]:
    """What plugins of several packages call, where this checkout has it."""
    for name, _, where, files in SHARED:
        paths = [folder / where / it for it in files]
        if all(it.exists() for it in paths):
            texts = ((it.relative_to(folder).as_posix(), it.read_text()) for it in paths)
            yield Plugin((name,), "", "", (), where, False, parameters_of(texts))


def _place(texts: dict[str, str], word: str) -> tuple[str, int]:
    path, text = next((path, text) for path, text in texts.items() if word in text)
    return path, text.count("\n", 0, text.index(word)) + 1


def _section(plugins: list[Plugin]) -> Iterator[str]:
    """A plugin over all its tags, each row as the newest tag that has it says it."""
    newest = plugins[-1]
    names = dict.fromkeys(name for it in plugins for name in it.names)
    # A library that was renamed keeps the classes it was known by.
    there = _together(it.releases for it in plugins)
    head = [f"[{' '.join(names)}]", newest.repository, newest.tag, newest.folder]
    head += ["open"] * any(it.is_open for it in plugins)
    head += [f"+{it}" for it in newest.shared]
    yield " ".join([*head, *_words(there, RELEASES)])
    rows: dict[str, list[tuple[Plugin, Parameter]]] = {}
    for plugin in plugins:
        for it in plugin.parameters:
            rows.setdefault(it.name, []).append((plugin, it))
    for name in sorted(rows):
        yield _row(rows[name], newest, there)


def _row(rows: list[tuple[Plugin, Parameter]], newest: Plugin, there: tuple[str, ...]) -> str:
    plugin, it = rows[-1]
    path = it.path.removeprefix(f"{plugin.folder}/")
    words = [it.name, it.type, f"{path}:{it.line}", plugin.tag if plugin.tag != newest.tag else ""]
    words += _words(_together(one.releases for one, _ in rows), there)
    words += ["required"] if it.required and all(one.required for _, one in rows) else []
    words += [f"one:{'|'.join(it.words)}"] if it.words else []
    return " ".join(filter(None, [*words, it.default and f"={it.default}"]))


def _together(releases: Iterable[tuple[str, ...]]) -> tuple[str, ...]:
    found = {it for some in releases for it in some}
    return tuple(it for it in RELEASES if it in found)


def _words(releases: tuple[str, ...], whole: tuple[str, ...]) -> list[str]:
    return [] if releases == whole else [f"releases={','.join(releases)}"]
