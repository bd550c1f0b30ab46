# SPDX-License-Identifier: Apache-2.0
"""A reader of descriptions that knows nothing of the program: what plugins and sensors open, by facts
that were read in the sources of their consumers (../shared/facts) and by the tables of the drive test.

Two outputs of one description meet where both open the same name.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

from lxml import etree
from paths import CORPUS

sys.path.insert(0, str(Path(__file__).parents[1] / "drive"))
import gazebo

FACTS = CORPUS.parent / "facts"
FILES = ("gazebo_classic.json", "gz_and_control.json")
# What every robot may have: ROS's own, and the one topic of transforms, which frames keep apart.
EVERYBODYS = {"/clock", "/rosout", "/parameter_events", "/diagnostics", "/tf", "/tf_static"}
# What the world sends to all (uuv_world_plugins UnderwaterCurrentPlugin.cc, gz-sim WindEffects.cc).
OF_THE_WORLD = {"/hydrodynamics/current_velocity", "/world/w/wind", "/world/w/wind_info"}
FRAMES_OF_ALL = {"world", "map", "earth", "utm"}
Paths: TypeAlias = Mapping[str, Mapping[str, Any]]
HELD = ("topic", "service", "node_name")
_SLOT = re.compile(r"<([^<>]+)>|\{([^{}]+)\}")
# A plugin element in these is a class's name (ros2_control), or another simulator's.
_OTHERS = {"hardware", "transmission", "webots", "mujoco_inputs", "raw_inputs"}


class Opened(NamedTuple):
    """A name that something opens: its kind, and which element and fact says so."""

    kind: str
    name: str
    source: str


class Node(NamedTuple):
    """A ROS node: where relative names go, and its remap rules as full names."""

    namespace: str
    name: str
    rules: tuple[tuple[str, str], ...] = ()

    def full(self, text: str) -> str:
        if text.startswith("~"):
            text = f"{self.namespace}/{self.name}/{text[1:].lstrip('/')}"
        elif not text.startswith("/"):
            text = f"{self.namespace}/{text}"
        return re.sub("/+", "/", f"/{text}").rstrip("/") or "/"

    def called(self, text: str) -> str:
        found = self.full(text)
        return next((self.full(to) for of, to in self.rules if self.full(of) == found), found)


@cache
def facts() -> Mapping[str, tuple[Mapping[str, Any], ...]]:
    """Return the facts by the bare name of a library."""
    found: dict[str, list[Mapping[str, Any]]] = {}
    for file in FILES:
        for fact in json.loads((FACTS / file).read_text()):
            for name in {bare(it) for it in fact["plugin_files"]}:
                found.setdefault(name, []).append(fact)
    return {name: tuple(every) for name, every in found.items()}


@cache
def only_in_ros_1() -> tuple[bytes, ...]:
    """Return the libraries that gazebo_ros_pkgs has in its branch for ROS 1 alone."""
    every = facts().items()
    return tuple(it.encode() for it, own in every if all("noetic" in one["source"] for one in own))


def bare(library: str) -> str:
    """``gz-sim-x-system`` of ``libignition-gazebo6-x-system.so`` (gz-sim SystemLoader.cc)."""
    name = Path(library.strip()).name.removesuffix(".so").removeprefix("lib")
    return re.sub(r"^(ignition-gazebo|gz-sim)\d*-", "gz-sim-", name)


def opened(text: bytes, robot: str, known: set[str]) -> Iterator[Opened]:
    """Yield what a description opens once it is spawned as ``robot``; ``known`` gets the
    libraries that a fact is there for."""
    root = etree.fromstring(text, etree.XMLParser(recover=True, huge_tree=False))
    model = next((it for it in root.iter("model", "robot") if it.get("name")), root)
    said = model.get("name", "")
    words = {"model": said if robot in said else robot, "model name": "", "world": "w"}
    words["model name"] = words["model"]
    for plugin in root.iter("plugin"):
        if plugin.get("filename") and not _OTHERS & {it.tag for it in plugin.iterancestors()}:
            fact = _fact(plugin)
            if fact is not None:
                known.add(bare(plugin.get("filename", "")))
                yield from _of_plugin(plugin, fact, words)
    for sensor in root.iter("sensor"):
        if next(sensor.iterancestors("gazebo", "sdf"), None) is not None:
            link = sensor.getparent().get("name") or sensor.getparent().get("reference") or ""
            for it in gazebo.of_sensor(sensor, words["model"], "w", link):
                # sdformat: this word is no topic, the default is taken (Sensor.cc).
                if it.topic != "/__default_topic__":
                    yield Opened("gz topic", it.topic, it.what)


def _fact(plugin: etree._Element) -> Mapping[str, Any] | None:
    """Return the fact of a plugin; of ROS 1 and ROS 2 the one that reads more of its children."""
    every = facts().get(bare(plugin.get("filename", "")), ())
    tags = {it.tag for it in plugin}

    def fits(fact: Mapping[str, Any]) -> tuple[bool, int]:
        read = {it["path"].partition("/")[0] for it in fact["elements"]}
        return ("ros" in tags) == ("ros" in read), len(tags & read)

    best = max(every, key=fits, default=None)
    return best if best is not None and (fits(best)[1] or not tags) else None


def _of_plugin(
    plugin: etree._Element, fact: Mapping[str, Any], words: Mapping[str, str]
) -> Iterator[Opened]:
    paths = {it["path"]: it for it in fact["elements"]}
    node = _node(plugin, paths, words)
    source = f"{fact['project']} {fact['source']}, of ROS {fact.get('ros', 2)}"
    topics = "gz topic" if "gazebosim" in fact["project"] else "topic"
    for kind, name in (*_written(plugin, paths, node, words), *_coded(plugin, fact, node, words)):
        yield Opened(topics if kind == "topic" else kind, name, source)


def _written(
    plugin: etree._Element, paths: Paths, node: Node, words: Mapping[str, str]
) -> Iterator[tuple[str, str]]:
    """Yield what its elements name, or their defaults."""
    if _reads_ros(plugin, paths) and "@name" in paths:
        yield "node", node.full(node.name)
    for path, it in paths.items():
        read = it["kind"] in ("topic", "service", "frame", "node_name") and path[:4] != "ros/"
        for value in values(plugin, it, words) if read else ():
            if it["kind"] == "frame":
                yield "frame", value
            elif path == "controller_manager_name":
                manager = _manager(plugin, value)
                yield "node", manager.full(manager.name)
                yield "topic", manager.called("robot_description")
            elif it["kind"] != "node_name":
                yield it["kind"], node.called(value)


def _coded(
    plugin: etree._Element, fact: Mapping[str, Any], node: Node, words: Mapping[str, str]
) -> Iterator[tuple[str, str]]:
    """Yield what its code names, where it does always."""
    paths = {it["path"]: it for it in fact["elements"]}
    for it in (*fact.get("interfaces", ()), *fact.get("implicit_names", ())):
        name = it.get("name") or it.get("value") or ""
        always = (
            it.get("when", "always").startswith("always") and it.get("transport", "ros") == "ros"
        )
        # That of the controller manager, which has rules of its own.
        if it["kind"] not in HELD or not always or name == "robot_description":
            continue
        for filled in _filled(plugin, name, paths, words):
            if it["kind"] == "node_name":
                yield "node", node.full(filled)
            elif re.fullmatch(r"[~\w/]+", filled):
                yield it["kind"], node.called(filled)


def values(
    plugin: etree._Element, it: Mapping[str, Any], words: Mapping[str, str]
) -> Iterator[str]:
    """Yield the values of an element of a plugin, or its default as far as it can be told."""
    path, _, attribute = it["path"].partition("@")
    path = path.rstrip("/")
    there = plugin.findall(path) if path else [plugin]
    given = [(e.get(attribute) if attribute else e.text) or "" for e in there]
    given = [each.strip() for each in given if each.strip()]
    if "presence enables" in str(it["notes"]):
        yield from given
        return
    default = it["default"] if isinstance(it["default"], str) else ""
    # A default made of other names in words ("topic of the sensor") tells no name.
    if not given and default and " " not in _SLOT.sub("", default):
        given = [_SLOT.sub(lambda m: words.get(m[1] or m[2], m[0]), default)]
    yield from (each for each in given if not _SLOT.search(each))


def _filled(
    plugin: etree._Element, name: str, paths: Paths, words: Mapping[str, str]
) -> Iterator[str]:
    """Yield a name of the code with its slots filled; none where one cannot be."""
    slot = _SLOT.search(name)
    if slot is None:
        yield name
        return
    word = slot[1] or slot[2]
    fill = [words[word]] if word in words else []
    if word in paths:
        fill = list(values(plugin, paths[word], words))
    for each in fill:
        yield from _filled(plugin, name.replace(slot[0], each, 1), paths, words)


def _node(plugin: etree._Element, paths: Paths, words: Mapping[str, str]) -> Node:
    """Return a plugin's node: gazebo_ros node.cpp for ROS 2; roscpp's NodeHandle for ROS 1."""
    if _reads_ros(plugin, paths):
        # gazebo_ros node.cpp: the plugin itself has the settings where it has no <ros>.
        path = "namespace" if plugin.find("ros") is None else "ros/namespace"
        namespace = "/" + (plugin.findtext(path) or "").strip().strip("/")
        return Node(namespace, plugin.get("name", ""), tuple(_rules(plugin)))
    row = paths.get("robotNamespace")
    there = plugin.find("robotNamespace")
    if row is None:
        return Node("/", "")
    text = "" if there is None else (there.text or "").strip()
    of_model = "model name" in str(row["default"]) or "odel's name" in str(row["notes"])
    empty_is_root = there is not None and "absent or empty" not in str(row["notes"])
    if not text and of_model and not empty_is_root:
        text = words["model"]
    # gazebo_ros_camera_utils.cpp: NodeHandle(robot_namespace_ + "/" + camera_name_).
    camera = next(values(plugin, paths["cameraName"], words), "") if "cameraName" in paths else ""
    return Node(f"/{text.strip('/')}/{camera}".rstrip("/"), "")


def _reads_ros(plugin: etree._Element, paths: Paths) -> bool:
    """Is it of ROS 2? One that both have is where it has no <ros> that of ROS 1."""
    both = "robotNamespace" in paths
    return "ros/namespace" in paths and (not both or plugin.find("ros") is not None)


def _manager(plugin: etree._Element, name: str) -> Node:
    """Return a controller manager: the plugin's namespace, but for a rule of its own (rcl remap.c)."""
    namespace = "/" + (plugin.findtext("ros/namespace") or "").strip().strip("/")
    rules = list(_rules(plugin))
    own = [to for of, to in rules if of in ("__ns", f"{name}:__ns")]
    return Node(own[0] if own else namespace, name, tuple(rules))


def _rules(plugin: etree._Element) -> Iterator[tuple[str, str]]:
    for it in plugin.iterfind("ros/argument"):
        if ":=" in (it.text or "") and (it.text or "").strip()[0] != "-":
            yield tuple((it.text or "").strip().split(":=", 1))  # type: ignore[misc]
    for it in plugin.iterfind("ros/remapping"):
        if ":=" in (it.text or ""):
            yield tuple((it.text or "").strip().split(":=", 1))  # type: ignore[misc]


def met(one: set[Opened], other: set[Opened], frames: bool) -> set[Opened]:
    """Return what two robots both open; frames count where all are in one tree."""
    theirs = {(it.kind, it.name) for it in other}
    both = {it for it in one if (it.kind, it.name) in theirs}
    return {
        it
        for it in both
        if it.name not in EVERYBODYS | OF_THE_WORLD
        and (it.kind != "frame" or (frames and it.name.strip("/") not in FRAMES_OF_ALL))
    }
