"""A description -> what a fleet file has to know of it: simulator, xacro arguments, size."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from lxml import etree

from multibot_rewrite.model import InputError
from multibot_rewrite.reports.xacro_arguments import find_arguments, names_robots
from multibot_rewrite.rewriters.tree import Tree
from multibot_rewrite.sources.access import Reach
from multibot_rewrite.sources.expand import expand
from multibot_rewrite.sources.own_names import filled
from multibot_rewrite.sources.read import read_file
from multibot_rewrite.steps.document import read_document

GZ, CLASSIC, NO_SIMULATOR = "gz", "classic", "none"
# How the file names of plugins for Gazebo Classic begin.
_CLASSIC = ("libgazebo_", "libhector_gazebo")
# A link of this name is where sdformat and MoveIt hold a robot.
WORLD = "world"


class Looked(NamedTuple):
    """A description: the name in it, its root's tag, how many links it has, its simulator, whether it
    has ``<ros2_control>``.

    ``arguments`` give each robot its own names (``{robot}`` is its name) or are needed to expand it.
    ``fault`` is why it cannot be read; the rest is empty then.
    """

    path: str
    name: str = ""
    tag: str = ""
    links: int = 0
    simulator: str = NO_SIMULATOR
    control: bool = False
    arguments: tuple[tuple[str, str], ...] = ()
    root: etree._Element | None = None
    fault: str = ""


def look(path: str, given: Mapping[str, str], reach: Reach) -> Looked:
    """What a description is; ``given`` are values for arguments of xacros."""
    try:
        xacro = path.endswith(".xacro")
        text = expand(path, filled(given), None, reach) if xacro else read_file(path)
        return _looked(path, text, tuple(given.items()) if xacro else ())
    except InputError as error:
        return Looked(path, fault=str(error))


def with_own_arguments(it: Looked, tree: Tree, reach: Reach) -> Looked:
    """The same with the arguments of its xacro that give each robot its own names, and without those
    that it does not have."""
    if not it.path.endswith(".xacro"):
        return it
    given = dict(it.arguments)
    found = find_arguments(it.path, given, tree, reach=reach, wanted=names_robots)
    own = {it.name: it.value for it in found.arguments if it.value and it.name not in given}
    known = {one.name for one in found.arguments} | set(found.untried)
    kept = {name: value for name, value in given.items() if name in known}
    return it._replace(arguments=tuple({**kept, **own}.items()))


def _looked(path: str, text: bytes, arguments: tuple[tuple[str, str], ...]) -> Looked:
    root = read_document(text, path).root
    model = root if root.tag != "sdf" else next(root.iter("model"), root)
    return Looked(
        path,
        model.get("name", ""),
        str(root.tag),
        sum(1 for it in root.iter("link") if it.get("name")),
        _simulator(root),
        next(root.iter("ros2_control"), None) is not None,
        arguments,
        root,
    )


def _simulator(root: etree._Element) -> str:
    """By the plugins below ``<gazebo>``, or of an SDF; sensors alone are for gz-sim."""
    parts = [root] if root.tag == "sdf" else root.findall("gazebo")
    files = [it.get("filename") or "" for part in parts for it in part.iter("plugin")]
    if any(it.startswith(tuple(_CLASSIC)) for it in files):
        return CLASSIC
    sensors = any(part.find(".//sensor") is not None for part in parts)
    return GZ if files or sensors or root.tag == "sdf" else NO_SIMULATOR


def holds_the_world(it: Looked) -> bool:
    """Is the robot fixed to the world by its own description?"""
    links = it.root.iterfind("link") if it.root is not None else ()
    return any(link.get("name") == WORLD for link in links)


def ranked(found: Sequence[Looked]) -> list[Looked]:
    """Those first that have several links, something for a simulator, ``<ros2_control>``, the shortest
    path."""

    def rank(it: Looked) -> tuple[bool, bool, bool, int, str]:
        without = it.simulator == NO_SIMULATOR, not it.control
        return it.links < 2, *without, len(it.path), it.path

    return sorted(found, key=rank)
