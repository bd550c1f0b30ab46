# SPDX-License-Identifier: Apache-2.0
"""Reads what a fleet file has to know of a description, with values from launch files."""

import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from lxml import etree

from multibot_rewrite.base.conventions import WORLD_FRAMES
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.reports.xacro_arguments import (
    declared_arguments,
    find_arguments,
    names_robots,
)
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.sources.access import Reach
from multibot_rewrite.description.sources.expand import expand, expand_whole
from multibot_rewrite.description.sources.known_arguments import known_arguments
from multibot_rewrite.description.sources.own_names import ROBOT, filled
from multibot_rewrite.description.sources.read import read_model
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.fleet.file.simulator_switch import (
    Suits,
    hardware_classes,
    loads_hardware,
    of_simulator,
    suits_real,
    suits_simulator,
    switch_for,
)
from multibot_rewrite.producers.launch.kept_paths import GONE
from multibot_rewrite.producers.launch.records import LaunchArgument
from multibot_rewrite.proposal.launches import Bringup, Reading, read_any
from multibot_rewrite.proposal.searching import text_of

GZ, CLASSIC, NO_SIMULATOR = "gz", "classic", "none"
# How the file names of plugins for Gazebo Classic begin.
_CLASSIC = ("libgazebo_", "libhector_gazebo")
# The end of the message about an argument that a xacro needs.
_NEEDED = lazy_compile(r"give it as (\w+):=VALUE$")
MOST_ARGUMENTS = 20
# An argument of a xacro that is empty where nobody gives it.
_EMPTY = lazy_compile(r"""<xacro:arg\b(?=[^<>]*\bdefault=(?:""|''))[^<>]*\bname=["'](\w+)""")
# A robot to expand a xacro for.
ANY = "robot1"
# A link of this name is where sdformat and MoveIt hold a robot.
WORLD = "world"


class Looked(NamedTuple):
    """A description and what a fleet file has to know of it; ``fault`` is why it is unreadable.

    ``control``: it has ``<ros2_control>``, for a simulator with the plugin that makes its
    controller manager. ``arguments`` give each robot its own names (``{robot}`` is its name) or
    are needed to expand it; ``needed`` are those that were not given, ``switch`` is the one that
    makes it simulated or real. ``own_tf``: its plugins send tf on a topic of each robot.
    ``model`` is the file that the simulator gets, where that is another one. ``bringup`` is the
    launch file that starts it."""

    path: str
    name: str = ""
    tag: str = ""
    links: int = 0
    simulator: str = NO_SIMULATOR
    control: bool = False
    arguments: tuple[tuple[str, str], ...] = ()
    needed: tuple[str, ...] = ()
    switch: str = ""
    own_tf: bool = False
    root: etree._Element | None = None
    model: str = ""
    bringup: Bringup | None = None
    fault: str = ""

    @property
    def files(self) -> tuple[str, ...]:
        """The files that it is taken from; raises nothing."""
        return tuple(filter(None, (self.path, self.model)))


def filled_for_any(it: Looked) -> tuple[tuple[str, str], ...]:
    """Return names and values of a description's xacro arguments, as they are for one robot."""
    return tuple(filled(dict(it.arguments), ANY).items())


def look(path: str, given: Mapping[str, str], reach: Reach, values: "NeededValues") -> Looked:
    """Return what a description is, with ``given`` arguments and those of ``values`` it needs."""
    known = dict(given)
    for _ in range(MOST_ARGUMENTS):
        found = _look_once(path, known, reach)
        if not found.fault:
            break
        needed = _NEEDED.search(found.fault)
        launched = {} if needed else values.of_file(path)
        other = {**launched, **known} == known
        more = values.of_mandatory(path) if other else launched
        more = {needed[1]: values.of(needed[1])} if needed else more
        if "" in more.values() or more.keys() <= known.keys():
            break
        known = {**more, **known}
    return found._replace(needed=tuple(it for it in known if it not in given))


def _look_once(path: str, given: Mapping[str, str], reach: Reach) -> Looked:
    try:
        xacro = path.endswith(".xacro")
        text = expand(path, filled(given, ANY), None, reach) if xacro else read_model(path)
        return _description_in(path, text, tuple(given.items()) if xacro else ())
    except InputError as error:
        return Looked(path, fault=str(error))


def with_bringup(
    it: Looked, bringup: Bringup | None, given: Mapping[str, str], reach: Reach
) -> Looked:
    """Return the description with its launch file, and the arguments that this gives its xacro."""
    # What was ``given`` counts, and what names a robot stays. A launch file that loads hardware of
    # a simulator is for one, whoever starts that.
    launched = it._replace(bringup=bringup)
    read = bringup.graph.read if bringup and not it.model else ()
    own = next((dict(one.arguments) for one in read if one.file == os.path.realpath(it.path)), {})
    if not own:
        return launched
    defaults = declared_arguments(it.path, filled({**own, **given}, ANY), reach)
    values = {
        name: value
        for name, value in _own_values(own.items(), it.path).items()
        if name not in given and defaults.get(name, own[name]) != own[name]
    }
    other = _look_once(it.path, {**dict(it.arguments), **values}, reach)
    if other.fault:
        return launched
    needed = tuple(one for one in it.needed if one not in values)
    if bringup and other.root is not None and any(map(of_simulator, hardware_classes(other.root))):
        bringup = bringup._replace(is_simulated=True)
    return other._replace(bringup=bringup, needed=needed)


def _own_values(given: Iterable[tuple[str, str]], path: str) -> dict[str, str]:
    """Return a xacro's arguments that name no robot and no file of a launch, paths by its folder."""
    folder = os.path.dirname(path)
    return {
        name: os.path.relpath(value, folder) if os.path.isabs(value) else value
        for name, value in given
        if value != ANY and not (names_robots(name) or GONE in value)
    }


def with_own_arguments(it: Looked, tree: Tree, reach: Reach) -> Looked:
    """Return the description with xacro arguments that name robots, without unknown ones."""
    if not it.path.endswith(".xacro"):
        return it
    given = dict(it.arguments)
    filled_in = filled(given, ANY)
    found = find_arguments(it.path, filled_in, tree, reach=reach, wanted=names_robots)
    own = {name: value for name, value in found.for_robots.items() if name not in given}
    texts = expand_whole(it.path, filled_in, None, reach).texts
    lacking = known_arguments(texts.values()).lacks(given)
    kept = {name: value for name, value in given.items() if name not in lacking}
    return it._replace(arguments=tuple({**kept, **own}.items()))


def with_semantic_arguments(it: Looked, srdf: str, reach: Reach, values: "NeededValues") -> Looked:
    """Return the description with the arguments that its SRDF requires, where a value is known."""
    more: dict[str, str] = {}
    for _ in range(MOST_ARGUMENTS if srdf.endswith(".xacro") else 0):
        given = {**more, **dict(it.arguments)}
        try:
            expand(srdf, filled(given, ANY), None, reach)
        except InputError as error:
            needed = _NEEDED.search(str(error))
            if not needed or needed[1] in given:
                return it
            # MoveIt wants the name of the model.
            value = it.name if needed[1] == "name" else values.of(needed[1])
            if not value:
                return it
            more[needed[1]] = value
            continue
        arguments = (*it.arguments, *more.items())
        return it._replace(arguments=arguments, needed=(*it.needed, *more))
    return it


def without_names(it: Looked, given: Mapping[str, str]) -> Looked:
    """Return the description with empty arguments for names, unless given or needed."""
    kept = {*given, *it.needed}
    values = {
        name: value if name in kept or ROBOT not in value else "" for name, value in it.arguments
    }
    return it._replace(arguments=tuple(values.items()))


def in_its_world(it: Looked, simulated: bool, reach: Reach) -> Looked:
    """Return the description with the argument that makes it simulated, or real, if it has one."""

    def suits_its_simulator(root: etree._Element) -> bool:
        """Return whether a description is for a simulator, and loads what that one needs."""
        return _simulator_of(root) != NO_SIMULATOR and suits_simulator(root)

    return _with_switch(it, suits_its_simulator if simulated else suits_real, reach)


def with_hardware_loaded(it: Looked, reach: Reach) -> Looked:
    """Return a description with the argument that makes a simulator's plugin load its hardware."""
    return _with_switch(it, lambda root: loads_hardware(root) and suits_simulator(root), reach)


def _with_switch(it: Looked, suits: Suits, reach: Reach) -> Looked:
    """Return the description with the argument, if there is one, that makes it ``suits``."""
    given = dict(it.arguments)
    if it.model:
        return it
    found = switch_for(it.path, filled(given, ANY), suits, reach)
    if not found:
        return it
    name, value = found
    other = _look_once(it.path, {**given, name: value}, reach)
    return it if other.fault else other._replace(needed=it.needed, switch=name, bringup=it.bringup)


def with_controllers(it: Looked, files: Sequence[str], reach: Reach) -> Looked:
    """Return the description with the controllers' file as argument, if no plugin got one."""
    # Launch files give it. The path is relative to the description's folder.
    file = next((one for one in files if "controller_manager" in text_of(one)), "")
    if not (it.control and file and it.path.endswith(".xacro") and _loads_nothing(it.root)):
        return it
    path = os.path.relpath(file, os.path.dirname(it.path))
    given = dict(it.arguments)
    for name in _EMPTY.findall(text_of(it.path)):
        other = _look_once(it.path, {**given, name: path}, reach) if not given.get(name) else it
        if not other.fault and not _loads_nothing(other.root):
            return it._replace(arguments=(*it.arguments, (name, path)), root=other.root)
    return it


def _loads_nothing(root: etree._Element | None) -> bool:
    """Return whether all parameter files of a controller manager's plugin are empty."""
    parts = _gazebo_parts(root) if root is not None else []
    plugins = (it for part in parts for it in part.iter("plugin"))
    made = (it for it in plugins if "ros2_control" in (it.get("filename") or ""))
    texts = [one.text or "" for it in made for one in it.iter("parameters")]
    return bool(texts) and not any(text.strip() for text in texts)


def with_model(it: Looked, sdf: Looked) -> Looked:
    """Return a URDF for robot_state_publisher with the same robot's SDF for the simulator."""
    return it._replace(
        model=sdf.path, simulator=sdf.simulator, control=sdf.control, own_tf=sdf.own_tf
    )


def _description_in(path: str, text: bytes, arguments: tuple[tuple[str, str], ...]) -> Looked:
    root = read_document(text, path).root
    model = root if root.tag != "sdf" else next(root.iter("model"), root)
    rules = root.iter("remapping", "argument")
    return Looked(
        path,
        model.get("name", ""),
        str(root.tag),
        sum(1 for it in root.iter("link") if it.get("name")),
        _simulator_of(root),
        _is_controlled(root),
        arguments,
        own_tf=any((it.text or "").strip() == "/tf:=tf" for it in rules),
        root=root,
    )


def _is_controlled(root: etree._Element) -> bool:
    """Return whether ros2_control runs; other simulator plugins leave a real robot's block unused."""
    if next(root.iter("ros2_control"), None) is None:
        return False
    # gz_ros2_control, ign_ros2_control, gazebo_ros2_control and what vendors make of them.
    made = any("ros2_control" in it for it in _plugin_files(root))
    return made or _simulator_of(root) == NO_SIMULATOR


def _gazebo_parts(root: etree._Element) -> list[etree._Element]:
    """Return the elements with what is for Gazebo: of an SDF its root, otherwise each ``<gazebo>``."""
    return [root] if root.tag == "sdf" else root.findall("gazebo")


def _plugin_files(root: etree._Element) -> list[str]:
    return [it.get("filename") or "" for part in _gazebo_parts(root) for it in part.iter("plugin")]


def _simulator_of(root: etree._Element) -> str:
    """Return the simulator, by the plugins of ``<gazebo>`` or an SDF; sensors alone are for gz-sim."""
    parts, files = _gazebo_parts(root), _plugin_files(root)
    if any(it.startswith(_CLASSIC) for it in files):
        return CLASSIC
    sensors = any(part.find(".//sensor") is not None for part in parts)
    return GZ if files or sensors or root.tag == "sdf" else NO_SIMULATOR


def holds_the_world(it: Looked) -> bool:
    """Return whether a robot is fixed to the world by its own description."""
    links = it.root.iterfind("link") if it.root is not None else ()
    return any(link.get("name") == WORLD for link in links)


def is_placed(it: Looked) -> bool:
    """Return whether a real robot's description fixes it to a shared frame, such as map."""
    links = it.root.iterfind("link") if it.root is not None else ()
    shared = {*WORLD_FRAMES} - {WORLD}
    return it.simulator == NO_SIMULATOR and any(link.get("name") in shared for link in links)


# What gives each robot its own names.
_PREFIX, _NAME = ("prefix", "tf_prefix"), ("name", "robot_name", "namespace", "ns")
_ARGUMENT = re.compile(r"""<xacro:arg\b[^<>]*\bname=["'](\w+)["']""")


class NeededValues(NamedTuple):
    """Values for xacro arguments from the launch files ``read``, or ``launch`` for other xacros."""

    read: Sequence[Reading]
    launch: Sequence[str] = ()

    def of(self, name: str) -> str:
        """Return an argument's value: the robot's name, or a launch file's; raises nothing."""
        if name in _PREFIX:
            return "{robot}_"
        if name in _NAME:
            return "{robot}"
        pairs = (pair for it in self.read for one in it.graph.read for pair in one.arguments)
        given = [value for key, value in pairs if key == name]
        declared = [it.default for it in self._declared(name)]
        return next(filter(None, (*given, *declared)), self._choice(name))

    def of_file(self, path: str) -> dict[str, str]:
        """Return what the first launch file gives a xacro, if it is more than names. Raises nothing."""
        real = os.path.realpath(path)
        read = (one for it in self._every() for one in it.graph.read if one.file == real)
        given = (_own_values(one.arguments, path) for one in read)
        return next(filter(None, given), {})

    def _every(self) -> Iterator[Reading]:
        yield from self.read
        yield from read_any(self.launch)

    def of_mandatory(self, path: str) -> dict[str, str]:
        """Return arguments that every launch must choose, with the first value; raises nothing."""
        names = dict.fromkeys(_ARGUMENT.findall(text_of(path)))
        free = (it for it in names if not any(one.default for one in self._declared(it)))
        return {name: value for name in free if (value := self._choice(name))}

    def _declared(self, name: str) -> list[LaunchArgument]:
        return [one for it in self.read for one in it.graph.declared if one.name == name]

    def _choice(self, name: str) -> str:
        return next((word for it in self._declared(name) for word in it.choices), "")
