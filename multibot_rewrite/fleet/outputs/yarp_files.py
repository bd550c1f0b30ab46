# SPDX-License-Identifier: Apache-2.0
"""The files that plugins of gazebo-yarp-plugins load: each robot has its own and loads that.

``<yarpConfigurationFile>`` is found as Gazebo finds a URI (gazebo common/SystemPaths.cc FindFileURI:
``model://`` below the model paths, ``file://`` as it stands). The keys are those of icub-models 3.2.0:
``jointNames``, ``parentLinkName``, ``sensorName``, and ``gazeboYarpPluginsRobotName``, with which the
robot's ports begin.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator

from lxml.etree import _Element

from multibot_rewrite.base.findings.finding import NOTE
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.loose_xml import ESCAPES
from multibot_rewrite.base.model import Edit, InputError
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.companions.names.rename_map import spell
from multibot_rewrite.description.rewriters.text import text_of
from multibot_rewrite.description.sources.packages import HIGHEST, package_folder
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.description.steps.document import text_slot
from multibot_rewrite.fleet.outputs.output_file import FilesAndFindings, OutputFile
from multibot_rewrite.fleet.robots.own_values import YARP_FILES
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot, at_robot

CONFIGURATION, INTERFACE = YARP_FILES
MOST_INCLUDED = 50
_URI = lazy_compile(r"(?:model|package)://([^/]+)/(.+)")
_INCLUDE = lazy_compile(r'^[ \t]*\[include\b[^"\n]*"([^"\n]+)"', re.MULTILINE)
_LINE = lazy_compile(r"^([ \t]*)(\w+)([ \t]+)([^#\n]*)", re.MULTILINE)
_WORD = lazy_compile(r"[^\s()\"]+")
_KINDS = (("joint", "joint"), ("link", "link"), ("sensor", "sensor"))
_ROBOT_NAME = "gazeboYarpPluginsRobotName"
_ROVER = """\
<robot name="rover">
  <link name="base_link"/>
  <gazebo>
    <plugin name="yarp" filename="libgazebo_yarp_robotinterface.so">
      <{0}>model://rover/conf/rover.{1}</{0}>
    </plugin>
  </gazebo>
</robot>
"""
_FLEET = "layout: both\nrobots:\n  - {name: robot1, description: rover.urdf}\n"
SAME_FOR_ALL = declare(
    "MF842",
    "yarp-file-of-all-robots",
    NOTE,
    what="A plugin of yarp loads a file that is the same for all robots. The file is not there, or "
    "it is of a form that is not rewritten.",
    why="Two robots would open ports of the same names, and look for the joints of one robot.",
    fix="Put the file where the description names it, or give each robot its own file.",
    bad=_FLEET,
    good=_FLEET.replace("rover.urdf", "follows.urdf"),
    line=3,
    formats=("fleet",),
    beside={
        "rover.urdf": _ROVER.format(INTERFACE, "xml"),
        "follows.urdf": _ROVER.format(CONFIGURATION, "ini"),
        "rover/conf/rover.ini": "name /rover\n",
    },
)


class YarpFile(NamedTuple):
    """A file that a description names: the text there and its place, the file, empty where it is not
    found, and its path below a robot's folder."""

    written: str
    slot: tuple[int, int]
    file: str
    below: str


def own_yarp_paths(robot: RewrittenRobot, folder: str) -> Iterator[Edit]:
    """What the description of a robot names in place of the files, in the ``folder`` of the build."""
    for it in _files(robot) if folder else ():
        if it.file:
            made = f"file://{os.path.join(folder, robot.spec.name, it.below)}".translate(ESCAPES)
            yield Edit(*it.slot, made.encode(), None)


def yarp_files(robots: Iterable[RewrittenRobot]) -> FilesAndFindings:
    """Every robot's own files, and what they include; a finding for each that is not followed."""
    for robot in robots:
        found = list(_files(robot))
        texts = {below: file for it in found if it.file for below, file in _with_included(it)}
        for below, file in texts.items():
            text = _rewritten(_text(file), robot)
            yield OutputFile(f"{robot.spec.name}/{below}", text.encode(), (file,))
        lost = [it.written for it in found if not it.file]
        for path in dict.fromkeys((*lost, *map(text_of, _named(robot, INTERFACE)))):
            message = f"robot {robot.spec.name!r}: its description loads {path!r}, as all robots do"
            hint = "give each robot its own file" if path not in lost else "put the file there"
            yield at_robot(SAME_FOR_ALL, robot, message, hint)


def _named(robot: RewrittenRobot, tag: str) -> Iterator[_Element]:
    root = robot.member.inventory.document.root
    yield from (it for it in root.iter(tag) if text_of(it))


def _files(robot: RewrittenRobot) -> Iterator[YarpFile]:
    document = robot.member.inventory.document
    elements = list(_named(robot, CONFIGURATION))
    starts = dict(zip(document.elements, document.starts, strict=True)) if elements else {}
    for element in elements:
        path = text_of(element)
        slot = text_slot(document.source, starts[element], path)
        if slot is not None:
            yield YarpFile(
                path, slot, *_found(path, robot.spec.simulated or robot.spec.description)
            )


def _found(path: str, description: str) -> tuple[str, str]:
    """The file, and its path below a robot's folder."""
    uri = _URI.fullmatch(path)
    if not uri:
        plain = path.removeprefix("file://")
        beside = os.path.join(os.path.dirname(description), plain)
        return (beside if os.path.isfile(beside) else ""), os.path.basename(plain)
    name, rest = uri.groups()
    whole = (os.path.join(it, rest) for it in _folders(name, description))
    below = os.path.normpath(rest)
    inside = not below.startswith((os.pardir, os.sep))
    return next((it for it in whole if inside and os.path.isfile(it)), ""), below


def _folders(name: str, description: str) -> Iterator[str]:
    """The folders that may be the model: its package, and one of its name above the description."""
    yield from filter(None, (package_folder(name, description, ()),))
    above = os.path.dirname(os.path.abspath(description))
    for _ in range(HIGHEST):
        yield above if os.path.basename(above) == name else os.path.join(above, name)
        above = os.path.dirname(above)


def _with_included(it: YarpFile) -> Iterator[tuple[str, str]]:
    """A file and those that it includes, each with its path below the robot's folder."""
    waiting, seen = [(it.below, it.file)], set[str]()
    while waiting and len(seen) < MOST_INCLUDED:
        below, file = waiting.pop()
        if below in seen:
            continue
        seen.add(below)
        yield below, file
        for name in _INCLUDE.findall(_text(file)):
            inner = os.path.normpath(os.path.join(os.path.dirname(below), name))
            target = os.path.join(os.path.dirname(file), name)
            if os.path.isfile(target) and not inner.startswith((os.pardir, os.sep)):
                waiting.append((inner, target))


def _text(file: str) -> str:
    try:
        return read_file(file).decode()
    except UnicodeDecodeError:
        raise InputError(f"{file}: it is not UTF-8; save it as UTF-8") from None


def _rewritten(text: str, robot: RewrittenRobot) -> str:
    """The text with the robot's own names behind the keys that have names."""

    def line(found: re.Match[str]) -> str:
        indent, key, space, value = found.groups()
        if key == _ROBOT_NAME:
            return f"{indent}{key}{space}{robot.spec.name}"
        kind = next((kind for word, kind in _KINDS if word in key.lower()), "")
        own = _WORD.sub(lambda it: spell(robot.names, kind, it[0]), value) if kind else value
        return f"{indent}{key}{space}{own}"

    return _LINE.sub(line, text)
